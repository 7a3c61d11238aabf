//! Selection of the cheapest of several computations, separately for each function.

use super::LARGE;
use super::parts::Parts;
use crate::candidates::Candidates;
use crate::care::Care;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::matrix;
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;

/// One computation of M and the forces, in its own graph.
#[derive(Clone, Debug)]
pub struct Computation {
    /// Graph of the expressions.
    pub graph: Graph,
    /// M and the forces.
    pub parts: Parts,
}

/// Entries of the functions M, −Γ ξ ξ, −∂V, ∂T/∂ξ and M ξ̇ + Γ ξ ξ + ∂V.
type Functions = [Vec<Edge>; 5];

/// Picks, for each function, the cheapest of several computations.
///
/// Each computation is considered both as traced and as it becomes in the graph `chosen`, where the expressions of
/// ξ̇ can be shared. The momentum ∂T/∂ξ and M ξ̇ + Γ ξ ξ + ∂V may also be composed from the cheapest of the other
/// functions. The result is in a copy of `chosen`. The loads are those of the first computation; returns `None` if
/// there is none.
pub fn cheapest(
    mut computations: Vec<Computation>,
    chosen: &Graph,
    model: &Model,
    care: &Care,
) -> Option<Computation> {
    let functions: Vec<Functions> = computations
        .iter_mut()
        .map(|Computation { graph, parts }| functions(parts, graph, model))
        .collect();
    let merged: Vec<(Graph, Functions)> = computations
        .iter()
        .zip(&functions)
        .filter(|_| chosen.len() < LARGE)
        .map(|(Computation { graph, .. }, functions)| {
            let mut merged = chosen.clone();
            let functions = functions.each_ref();
            let functions = functions.map(|roots| rebuild(graph, &mut merged, roots));
            (merged, functions)
        })
        .collect();
    let mut all: [Candidates; 5] = std::array::from_fn(|_| Candidates::with(care));
    let traced = computations.iter().map(|computation| &computation.graph);
    let computed = traced
        .zip(&functions)
        .chain(merged.iter().map(|(graph, functions)| (graph, functions)));
    for (graph, functions) in computed {
        for (candidates, roots) in all.iter_mut().zip(functions) {
            candidates.offer(graph, roots.clone());
        }
    }
    let rows = |entries: Vec<Edge>| matrix(&entries, model.n());
    let [mass, inertia, conservative, mut momentum, mut inverse] = all;
    let mut graph = model.graph.clone();
    let composed = Parts {
        mass: rows(mass.cheapest(&mut graph)),
        inertia: inertia.cheapest(&mut graph),
        conservative: conservative.cheapest(&mut graph),
        ..Parts::default()
    };
    let products = composed.momentum_of(&mut graph, model);
    let sums = composed.inverse_dynamics_of(&mut graph, model);
    if !model.is_affine() {
        momentum.offer(&graph, products);
    }
    inverse.offer(&graph, sums);
    let mut around = chosen.clone();
    let into = &mut around;
    let first = computations.first()?;
    let parts = Parts {
        mass: rows(mass.cheapest(into)),
        inertia: inertia.cheapest(into),
        conservative: conservative.cheapest(into),
        momentum: Some(momentum.cheapest(into)),
        inverse_dynamics: Some(inverse.cheapest(into)),
        ..first.parts.grafted(&first.graph, into)
    };
    Some(Computation {
        graph: around,
        parts,
    })
}

fn functions(parts: &Parts, graph: &mut Graph, model: &Model) -> Functions {
    [
        parts.mass.concat(),
        parts.inertia.clone(),
        parts.conservative.clone(),
        parts.momentum_of(graph, model),
        parts.inverse_dynamics_of(graph, model),
    ]
}
