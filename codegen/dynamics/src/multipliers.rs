//! Multipliers λ of all constraints: M ξ̇ + Γ ξ ξ + ∂V = f + Bᵀ λ.
//!
//! The multipliers of rows that are kept come from the solution for ξ̇. The others follow from the
//! equations of motion of the velocities that were solved for, by the pivots of the reduction.

use super::accel::AccelerationCandidate;
use super::accel::parts::{ReferencePoint, TracingVariant, trace_terms};
use super::calculus::Calculus;
use super::reduction::Reduction;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::solve_symmetric;
use hamel_algebra::transplant::{map_symbols, rebuild};
use hamel_language::model::{Model, class};
use hamel_language::syntax::ast::Axes;

/// Returns M ξ̇ + h + ∂V − f, the force of constraints and drives, for some velocities of the full frame, with ξ̇ₐ as
/// symbols.
///
/// The bodies are traced in the full frame.
pub fn force_residuals(
    full: &Model,
    reduction: &Reduction,
    velocities: &[usize],
) -> (Graph, Vec<Edge>) {
    let mut model = full.clone();
    model.graph = reduction.graph.clone();
    let mut calculus = Calculus::new(&model);
    let variant = TracingVariant {
        axes: Axes::Body,
        reference: ReferencePoint::Com,
        shift: None,
    };
    let parts = trace_terms(&mut model, &mut calculus, variant);
    let residuals: Vec<Edge> = velocities
        .iter()
        .map(|&velocity| {
            let inner = &mut model.graph;
            let inertial = inner.dot(&parts.mass[velocity], &model.xi_dot);
            let column: Vec<Edge> = parts.groups.iter().map(|group| group[velocity]).collect();
            let sum = inner.sum(&column);
            inner.sub(inertial, sum)
        })
        .collect();
    let mut graph = reduction.model.graph.clone();
    let residuals = map_symbols(&model.graph, &mut graph, &residuals, &reduction.images);
    (graph, residuals)
}

/// Returns λ in order of the constraints, then the forces of drives with prescribed rates.
///
/// They are in the graph of the program, and follow from the residuals of the velocities that were
/// solved for and of those that are driven. Dropped rows have no multiplier.
pub fn multipliers(
    full: &Model,
    reduction: &Reduction,
    chosen: &AccelerationCandidate,
    (from, residuals): (&Graph, &[Edge]),
    graph: &mut Graph,
) -> Option<Vec<Edge>> {
    let rows: Vec<Edge> = full
        .constraints
        .iter()
        .flat_map(|c| c.row.clone())
        .collect();
    let images = rebuild(&reduction.model.graph, graph, &reduction.images);
    let residuals = rebuild(from, graph, residuals);
    let mut residuals = with_accelerations(graph, &residuals, &chosen.xi_dot);
    let drives = residuals.split_off(reduction.solved.len());
    let rows = map_symbols(&full.graph, graph, &rows, &images);
    let n = full.n();
    let mut multipliers = vec![graph.zero(); full.constraints.len()];
    for (&row, &multiplier) in reduction.kept.iter().zip(&chosen.multipliers) {
        multipliers[row] = multiplier;
    }
    let right: Vec<Vec<Edge>> = reduction
        .solved
        .iter()
        .zip(residuals)
        .map(|(&(_, velocity), residual)| {
            let known = reduction.kept.iter().fold(residual, |sum, &row| {
                let product = graph.mul(rows[row * n + velocity], multipliers[row]);
                graph.sub(sum, product)
            });
            vec![known]
        })
        .collect();
    let matrix: Vec<Vec<Edge>> = reduction
        .solved
        .iter()
        .map(|&(_, velocity)| {
            let row = |&(row, _): &(usize, usize)| rows[row * n + velocity];
            reduction.solved.iter().map(row).collect()
        })
        .collect();
    let solution = solve_symmetric(graph, &matrix, &right)?;
    for (&(row, _), value) in reduction.solved.iter().zip(&solution) {
        multipliers[row] = value[0];
    }
    // The drives provide the forces that the constraints do not.
    let drives = full.accelerated.iter().zip(drives);
    let drives: Vec<Edge> = drives
        .map(|(&(velocity, _), residual)| {
            (multipliers.iter().enumerate()).fold(residual, |sum, (row, &multiplier)| {
                let product = graph.mul(rows[row * n + velocity], multiplier);
                graph.sub(sum, product)
            })
        })
        .collect();
    let rows = full.constraints.iter().zip(multipliers);
    let rows = rows.filter(|(constraint, _)| !constraint.redundant);
    Some(
        rows.map(|(_, multiplier)| multiplier)
            .chain(drives)
            .collect(),
    )
}

/// Substitutes ξ̇ₐ for its symbols in expressions.
pub(super) fn with_accelerations(graph: &mut Graph, edges: &[Edge], xi_dot: &[Edge]) -> Vec<Edge> {
    let from = graph.clone();
    let mut values = xi_dot.iter();
    let images: Vec<Edge> = from
        .symbols()
        .iter()
        .map(|symbol| {
            let value = (symbol.class == class::ACCEL)
                .then(|| values.next())
                .flatten();
            value.copied().unwrap_or(Edge::of(symbol.node))
        })
        .collect();
    map_symbols(&from, graph, edges, &images)
}
