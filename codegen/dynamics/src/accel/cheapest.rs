//! Selection of the cheapest of several computations, separately for each function.

use super::parts::EquationTerms;
use crate::candidates::Candidates;
use crate::candidates::SHORT_SEARCH_NODES;
use crate::numerical_loss::NumericalLoss;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::matrix;
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;

/// Expressions of M and the generalised forces, in a graph of their own.
#[derive(Clone, Debug)]
pub struct MassAndForces {
    /// Graph of the expressions.
    pub graph: Graph,
    /// M and the forces.
    pub parts: EquationTerms,
}

/// Entries of the functions M, −Γ ξ ξ, −∂V, ∂T/∂ξ and M ξ̇ + Γ ξ ξ + ∂V.
type Functions = [Vec<Edge>; 5];

/// Returns M and the forces, each taken from that one of several computations in which it is cheapest; `None` if there
/// are none.
///
/// Each computation is considered both as traced and as it becomes in the graph `chosen`, where the expressions of
/// ξ̇ can be shared. The momentum ∂T/∂ξ and M ξ̇ + Γ ξ ξ + ∂V may also be composed from the cheapest of the other
/// functions. The result is in a copy of `chosen`. The loads are those of the first computation; returns `None` if
/// there is none.
pub fn cheapest_of_each_function(
    mut computations: Vec<MassAndForces>,
    chosen: &Graph,
    model: &Model,
    numerical_loss: &NumericalLoss,
) -> Option<MassAndForces> {
    let functions: Vec<Functions> = computations
        .iter_mut()
        .map(|MassAndForces { graph, parts }| functions(parts, graph, model))
        .collect();
    let merged: Vec<(Graph, Functions)> = computations
        .iter()
        .zip(&functions)
        .filter(|_| chosen.len() < SHORT_SEARCH_NODES)
        .map(|(MassAndForces { graph, .. }, functions)| {
            let mut merged = chosen.clone();
            let functions = functions.each_ref();
            let functions = functions.map(|roots| rebuild(graph, &mut merged, roots));
            (merged, functions)
        })
        .collect();
    let mut all: [Candidates; 5] = std::array::from_fn(|_| Candidates::new(numerical_loss));
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
    let composed = EquationTerms {
        mass: rows(mass.cheapest(&mut graph)),
        inertia: inertia.cheapest(&mut graph),
        conservative: conservative.cheapest(&mut graph),
        ..EquationTerms::default()
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
    let parts = EquationTerms {
        mass: rows(mass.cheapest(into)),
        inertia: inertia.cheapest(into),
        conservative: conservative.cheapest(into),
        momentum: Some(momentum.cheapest(into)),
        inverse_dynamics: Some(inverse.cheapest(into)),
        ..first.parts.copy_into(&first.graph, into)
    };
    Some(MassAndForces {
        graph: around,
        parts,
    })
}

fn functions(parts: &EquationTerms, graph: &mut Graph, model: &Model) -> Functions {
    [
        parts.mass.concat(),
        parts.inertia.clone(),
        parts.conservative.clone(),
        parts.momentum_of(graph, model),
        parts.inverse_dynamics_of(graph, model),
    ]
}
