//! The motion nearby, without redundant directions: with δx = A(x) h and ξ̇ = F(x, ξ, u)
//!
//! ḣᵏ = δξᵏ − γᵢⱼᵏ ξⁱ hʲ, δξ̇ = (∂ⱼF) hʲ + (∂F/∂ξ) δξ + (∂F/∂u) δu.
//!
//! Some velocities may be held at zero (nonholonomic constraints): the n displacements h stay, of ξ
//! only the active ones vary, and the matrices have n + nₐ rows.

use super::calculus::Calculus;
use super::{commutation, kinematics};
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::solve_symmetric;
use crate::algebra::resubstitute::resubstitute;
use crate::algebra::transplant::rebuild;
use crate::derive::normal::{NormalForms, build};
use crate::model::Model;
use crate::program::count::count;

/// Systems with more velocities are not expanded.
const MOST_EXPANDED: usize = 8;
/// Entries with more terms are not expanded.
const MOST_TERMS: usize = 40;

/// ξ̇ = F as edges of a graph that grew from the model's.
pub struct Motion<'a> {
    /// The graph.
    pub graph: &'a Graph,
    /// F, one entry for each active velocity.
    pub xi_dot: &'a [Edge],
    /// Places in ξ of the velocities that are not held at zero.
    pub active: &'a [usize],
    /// M and f − Γ ξ ξ − ∂V of the active velocities, where M F = right-hand side holds.
    pub implicit: Option<(&'a [Vec<Edge>], &'a [Edge])>,
}

/// [A B]: n + nₐ rows of n + nₐ + m, for (h, δξ, δu).
pub struct Linear {
    /// The graph that it lives in.
    pub graph: Graph,
    /// The rows.
    pub rows: Vec<Vec<Edge>>,
}

/// Linearises; `model` is that of the full frame. The cheapest of three ways is taken: F itself
/// differentiated; M⁻¹ (∂(f − Γ ξ ξ − ∂V) − (∂M) F) with one factorisation for all columns; the
/// entries expanded, their coefficients computed when parameters are set.
pub fn linearize(model: &Model, motion: &Motion) -> Option<Linear> {
    let upper = upper(model, motion)?;
    let explicit = explicit(model, motion, &upper);
    let mut candidates = Vec::new();
    if model.n() <= MOST_EXPANDED {
        candidates.extend(expanded(model, &explicit, motion.graph));
    }
    candidates.extend(implicit(model, motion, &upper));
    candidates.push(explicit);
    let cost = |linear: &Linear| count(&linear.graph, &linear.rows.concat()).weight();
    let mut best = candidates.into_iter().min_by_key(cost)?;
    let roots = best.rows.concat();
    if let Some((graph, edges)) = resubstitute(&best.graph, &roots, motion.graph) {
        let columns = best.rows.first().map_or(1, |row| row.len().max(1));
        let rows: Vec<Vec<Edge>> = edges.chunks(columns).map(<[Edge]>::to_vec).collect();
        let polished = Linear { graph, rows };
        if cost(&polished) < cost(&best) {
            best = polished;
        }
    }
    Some(best)
}

/// The rows of ḣ.
fn upper(model: &Model, motion: &Motion) -> Option<Linear> {
    let mut own = model.clone();
    let mut calculus = Calculus::new(&own);
    let rows = kinematics::left_inverse(&mut own)?;
    let gamma = commutation::gamma(&mut own, &mut calculus, &rows);
    let (n, zero, one) = (own.n(), own.graph.zero(), own.graph.one());
    let rows = (0..n)
        .map(|k| {
            let mut row = vec![zero; n + motion.active.len() + own.u.len()];
            for j in 0..n {
                for &i in motion.active {
                    let product = own.graph.mul(gamma[i][j][k], own.xi[i]);
                    row[j] = own.graph.sub(row[j], product);
                }
            }
            if let Some(place) = motion.active.iter().position(|&active| active == k) {
                row[n + place] = one;
            }
            row
        })
        .collect();
    Some(Linear {
        graph: own.graph,
        rows,
    })
}

/// The derivations of all columns: ∂ⱼ, ∂/∂ξ of active velocities, ∂/∂u.
fn columns(model: &Model, graph: &mut Graph, active: &[usize]) -> Vec<Derivation> {
    let a: Vec<Vec<Edge>> = model
        .a
        .iter()
        .map(|row| rebuild(&model.graph, graph, row))
        .collect();
    let one = graph.one();
    let along =
        |j: usize| Derivation::new(model.x.iter().zip(&a).map(|(x, row)| (x.node(), row[j])));
    let by = |symbol: &Edge| Derivation::new([(symbol.node(), one)]);
    (0..model.n())
        .map(along)
        .chain(active.iter().map(|&i| by(&model.xi[i])))
        .chain(model.u.iter().map(by))
        .collect()
}

/// F differentiated as it stands.
fn explicit(model: &Model, motion: &Motion, upper: &Linear) -> Linear {
    let mut graph = motion.graph.clone();
    let mut columns = columns(model, &mut graph, motion.active);
    let mut rows = carried(upper, &mut graph);
    rows.extend(motion.xi_dot.iter().map(|&rate| {
        let entries = columns.iter_mut().map(|column| column.of(&mut graph, rate));
        entries.collect::<Vec<Edge>>()
    }));
    Linear { graph, rows }
}

/// M δξ̇ = ∂(M F) − (∂M) F, all columns with one factorisation.
fn implicit(model: &Model, motion: &Motion, upper: &Linear) -> Option<Linear> {
    let (mass, right) = motion.implicit?;
    let mut graph = motion.graph.clone();
    let mut columns = columns(model, &mut graph, motion.active);
    let changes: Vec<Vec<Edge>> = mass
        .iter()
        .zip(right)
        .map(|(row, &force)| {
            columns
                .iter_mut()
                .map(|column| {
                    let change = column.of(&mut graph, force);
                    let masses = column.all(&mut graph, row);
                    let held = graph.dot(&masses, motion.xi_dot);
                    graph.sub(change, held)
                })
                .collect()
        })
        .collect();
    let solved = solve_symmetric(&mut graph, mass, &changes)?;
    let mut rows = carried(upper, &mut graph);
    rows.extend(solved);
    Some(Linear { graph, rows })
}

/// Every entry as a sum of monomials with coefficients of parameters alone, where all are short.
fn expanded(model: &Model, explicit: &Linear, base: &Graph) -> Option<Linear> {
    let mut forms = NormalForms::new(&model.points);
    let mut source = explicit.graph.clone();
    let mut polynomials = Vec::new();
    for &edge in explicit.rows.iter().flatten() {
        let polynomial = forms.expand(&source, edge)?;
        let reduced = forms.reduce(&source, &polynomial);
        let shorter = if reduced.terms().len() <= polynomial.terms().len() {
            reduced
        } else {
            polynomial
        };
        if shorter.terms().len() > MOST_TERMS {
            return None;
        }
        polynomials.push(shorter);
    }
    let built: Vec<Edge> = polynomials
        .iter()
        .map(|polynomial| build(&mut source, polynomial))
        .collect();
    let mut graph = base.clone();
    let entries = rebuild(&source, &mut graph, &built);
    let columns = explicit.rows.first().map_or(1, |row| row.len().max(1));
    Some(Linear {
        graph,
        rows: entries.chunks(columns).map(<[Edge]>::to_vec).collect(),
    })
}

/// The rows of ḣ in another graph.
fn carried(upper: &Linear, graph: &mut Graph) -> Vec<Vec<Edge>> {
    let rows = upper.rows.iter();
    rows.map(|row| rebuild(&upper.graph, graph, row)).collect()
}
