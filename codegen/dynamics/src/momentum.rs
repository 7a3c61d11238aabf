//! Hamiltonian form: p = M ξ, ṗᵢ = ∂ᵢL − γᵢⱼᵏ ξʲ pₖ + fᵢ (KR18 (30a)), and ξ = M⁻¹ p.

use super::accel::parts::EquationTerms;
use super::accel::solve::all_plans;
use super::accel::solve::{Solution, solve};
use super::calculus::Calculus;
use super::{commutation, energy, inertia, kinematics};
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;
use hamel_program::count::count;

/// Largest number of velocities for which ṗ is also written out.
///
/// In larger models the n² entries of M and n³ of γ are long and never the cheapest, so that ṗ is
/// computed from the quantities traced for ξ̇.
pub const MAX_EXPLICIT_VELOCITIES: usize = 8;

/// Returns the rates ṗ of the momenta p = ∂T/∂ξ as expressions in (x, ξ, u), in the graph of `parts`.
///
/// The cheapest of these is chosen: ∂ᵢT − γᵢⱼᵏ ξʲ pₖ written out, or Ṁ ξ − Γ ξ ξ with the terms
/// that ξ̇ needs anyway and M either written out or as traced. −∂V and the applied forces are then
/// added.
pub fn momentum_rate(model: &Model, graph: &mut Graph, parts: &EquationTerms) -> Vec<Edge> {
    if model.n() > MAX_EXPLICIT_VELOCITIES {
        return momentum_rate_of_traced(model, graph, parts);
    }
    let mut own = model.clone();
    let mut calculus = Calculus::new(&own);
    let mass = inertia::mass_matrix(&mut own, &mut calculus);
    let n = own.n();
    let xi = own.xi.clone();
    // Ṁ ξ.
    let mass_rate: Vec<Edge> = mass
        .iter()
        .map(|row| {
            let rates: Vec<Edge> = row
                .iter()
                .map(|&entry| calculus.rate(&mut own.graph, entry))
                .collect();
            own.graph.dot(&rates, &xi)
        })
        .collect();
    let mass_rate = rebuild(&own.graph, graph, &mass_rate);
    let mut candidates = vec![
        (0..n)
            .map(|i| graph.add(mass_rate[i], parts.inertia[i]))
            .collect::<Vec<_>>(),
    ];
    if let Some(rows) = kinematics::left_inverse(&mut own) {
        let gamma = commutation::gamma(&mut own, &mut calculus, &rows);
        let kinetic = energy::kinetic(&mut own, &mass);
        let p: Vec<Edge> = mass.iter().map(|row| own.graph.dot(row, &xi)).collect();
        let hamel: Vec<Edge> = (0..n)
            .map(|i| {
                let mut sum = calculus.along(&mut own.graph, i, kinetic);
                for j in 0..n {
                    let turned = own.graph.dot(&gamma[i][j], &p);
                    let product = own.graph.mul(turned, xi[j]);
                    sum = own.graph.sub(sum, product);
                }
                sum
            })
            .collect();
        candidates.push(rebuild(&own.graph, graph, &hamel));
    }
    let with_forces = |graph: &mut Graph, inner: &[Edge]| -> Vec<Edge> {
        (0..n)
            .map(|i| {
                let sum = graph.add(inner[i], parts.conservative[i]);
                graph.add(sum, parts.applied[i])
            })
            .collect()
    };
    let mut sums: Vec<Vec<Edge>> = candidates
        .iter()
        .map(|candidate| with_forces(graph, candidate))
        .collect();
    sums.push(momentum_rate_of_traced(model, graph, parts));
    let cost = |sum: &Vec<Edge>| count(graph, sum).weight();
    sums.into_iter().min_by_key(cost).unwrap_or_default()
}

/// Returns d/dt (M ξ) at ξ̇ = 0, differentiated from M as traced, minus Γ ξ ξ and ∂V, plus the
/// applied forces.
fn momentum_rate_of_traced(model: &Model, graph: &mut Graph, parts: &EquationTerms) -> Vec<Edge> {
    let rates = rebuild(&model.graph, graph, &model.rate);
    let moving = model.x.iter().map(|x| x.node()).zip(rates);
    let mut motion = Derivation::new(moving);
    let rows = parts.mass.iter().enumerate();
    rows.map(|(i, row)| {
        let momentum = graph.dot(row, &model.xi);
        let mass_rate = motion.of(graph, momentum);
        let terms = [
            mass_rate,
            parts.inertia[i],
            parts.conservative[i],
            parts.applied[i],
        ];
        graph.sum(&terms)
    })
    .collect()
}

/// Computes M⁻¹ p with the cheapest elimination; returns its cost, its graph and the solution, or
/// `None` if M is singular everywhere.
pub fn velocity_from_momentum(
    graph: &Graph,
    parts: &EquationTerms,
    p: &[Edge],
) -> Option<(usize, Graph, Solution)> {
    let parts = EquationTerms {
        mass: parts.mass.clone(),
        groups: vec![p.to_vec()],
        inertia: Vec::new(),
        conservative: Vec::new(),
        applied: Vec::new(),
        ..EquationTerms::default()
    };
    let mut best: Option<(usize, Graph, Solution)> = None;
    for plan in all_plans(graph, &parts) {
        let mut own = graph.clone();
        let Some(solution) = solve(&mut own, &parts, &plan) else {
            continue;
        };
        let mut roots = solution.xi_dot.clone();
        roots.extend(solution.pivots.iter().filter(|p| !own.is_free(p.node())));
        let cost = count(&own, &roots).weight();
        if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
            best = Some((cost, own, solution));
        }
    }
    best
}
