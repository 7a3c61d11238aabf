//! Of each function the cheapest of several computations.

use super::parts::Parts;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::transplant::rebuild;
use crate::model::Model;
use crate::program::count::count;

/// A computation of M and forces, in a graph of its own.
pub struct Computation {
    /// The graph.
    pub graph: Graph,
    /// M and forces.
    pub parts: Parts,
}

/// Of each function the cheapest of these computations, counted where nothing else has been built; those of
/// M ξ and M ξ̇ + Γ ξ ξ + ∂V may also be put together from the others. Loads are those of the first.
pub fn cheapest(mut computations: Vec<Computation>, into: &mut Graph, model: &Model) -> Parts {
    for Computation { graph, parts } in &mut computations {
        parts.momentum = Some(parts.momentum_of(graph, model));
        parts.inverse_dynamics = Some(parts.whole(graph, model));
    }
    let mut pick = |of: fn(&Parts) -> Vec<Edge>| -> Vec<Edge> {
        let roots: Vec<Vec<Edge>> = computations.iter().map(|c| of(&c.parts)).collect();
        let cost = |i: &usize| count(&computations[*i].graph, &roots[*i]).weight();
        let best = (0..roots.len()).min_by_key(cost).unwrap_or(0);
        rebuild(&computations[best].graph, into, &roots[best])
    };
    // The short ones first: what others share with them is then computed as they do.
    let mass = pick(|parts| parts.mass.concat());
    let momentum = pick(|parts| parts.momentum.clone().unwrap_or_default());
    let conservative = pick(|parts| parts.conservative.clone());
    let inertia = pick(|parts| parts.inertia.clone());
    let whole = pick(|parts| parts.inverse_dynamics.clone().unwrap_or_default());
    let Computation { graph, parts } = &computations[0];
    let mut found = Parts {
        mass: mass
            .chunks(inertia.len().max(1))
            .map(<[Edge]>::to_vec)
            .collect(),
        inertia,
        conservative,
        inverse_dynamics: None,
        momentum: None,
        ..parts.rebuilt(graph, into)
    };
    let cheaper = |graph: &Graph, a: Vec<Edge>, b: Vec<Edge>| {
        let weight = |roots: &[Edge]| count(graph, roots).weight();
        if weight(&b) < weight(&a) { b } else { a }
    };
    let products = found.momentum_of(into, model);
    let sums = found.whole(into, model);
    found.momentum = Some(cheaper(into, momentum, products));
    found.inverse_dynamics = Some(cheaper(into, whole, sums));
    found
}
