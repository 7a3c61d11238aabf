//! Of each function the cheapest of several computations.

use super::parts::Parts;
use crate::algebra::graph::{Edge, Graph};
use crate::derive::choice::Choice;
use crate::model::Model;

/// A computation of M and forces, in a graph of its own.
#[derive(Clone, Debug)]
pub struct Computation {
    /// The graph.
    pub graph: Graph,
    /// M and forces.
    pub parts: Parts,
}

/// What a computation says of a function, built in its graph where it has to be put together.
type Function = fn(&Parts, &mut Graph, &Model) -> Vec<Edge>;

/// Of each function the cheapest of these computations, each as it was traced and as what it becomes
/// where ξ̇ is computed already; those of M ξ and M ξ̇ + Γ ξ ξ + ∂V may also be put together from the
/// cheapest others. All are in a copy of the graph `chosen` where ξ̇ is. Loads are those of the first;
/// `None` without any.
pub fn cheapest(
    computations: &[Computation],
    chosen: &Graph,
    model: &Model,
) -> Option<Computation> {
    let mut around = chosen.clone();
    let into = &mut around;
    let first = computations.first()?;
    let rows = |entries: Vec<Edge>| entries.chunks(model.n()).map(<[Edge]>::to_vec).collect();
    let mass = all(computations, chosen, model, |parts, _, _| {
        parts.mass.concat()
    });
    let inertia = all(computations, chosen, model, |parts, _, _| {
        parts.inertia.clone()
    });
    let conservative = all(computations, chosen, model, |parts, _, _| {
        parts.conservative.clone()
    });
    let mut graph = model.graph.clone();
    let composed = Parts {
        mass: rows(mass.take(&mut graph)),
        inertia: inertia.take(&mut graph),
        conservative: conservative.take(&mut graph),
        ..Parts::default()
    };
    let products = composed.momentum_of(&mut graph, model);
    let sums = composed.whole(&mut graph, model);
    let mut momentum = all(computations, chosen, model, |parts, graph, model| {
        parts.momentum_of(graph, model)
    });
    momentum.offer(&graph, products);
    let mut whole = all(computations, chosen, model, |parts, graph, model| {
        parts.whole(graph, model)
    });
    whole.offer(&graph, sums);
    let parts = Parts {
        mass: rows(mass.take(into)),
        inertia: inertia.take(into),
        conservative: conservative.take(into),
        momentum: Some(momentum.take(into)),
        inverse_dynamics: Some(whole.take(into)),
        ..first.parts.grafted(&first.graph, into)
    };
    Some(Computation {
        graph: around,
        parts,
    })
}

fn all<'a>(
    computations: &'a [Computation],
    around: &Graph,
    model: &Model,
    of: Function,
) -> Choice<'a> {
    let mut choice = Choice::new();
    for Computation { graph, parts } in computations {
        let mut own = graph.clone();
        let roots = of(parts, &mut own, model);
        choice.offer_both(own, roots, around);
    }
    choice
}
