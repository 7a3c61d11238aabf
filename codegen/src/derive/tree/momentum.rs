//! ∂ᵢT − γᵢⱼᵏ ξʲ pₖ by recursion: what turns momenta p = M ξ where no force acts, KR18 (30a).
//!
//! pᵢ = Sᵢ · h, with the freedom's twist Sᵢ and the momentum h = (k about the link's origin, l) of all that
//! hangs on its joint. Forces change h; what is left of ṗᵢ is Ṡᵢ · h with Ṡᵢ = V × Sᵢ, where V = (ω, v) is the
//! twist of the link and Sᵢ is constant in its axes. As a wrench on the link that is
//! (torque k × ω + l × v, force l × ω).

use super::Tree;
use super::inverse::{Wrench, collect_with, motions, wrench};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{add3, cross, zero3};

/// The part of ṗ that is quadratic in ξ; `None` where a freedom's twist varies in the axes of its link.
pub fn swing(graph: &mut Graph, tree: &Tree, xi: &[Edge]) -> Option<Vec<Edge>> {
    let none = zero3(graph);
    if tree.links.iter().any(|link| link.drift != (none, none)) {
        return None;
    }
    // As accelerations from rest the rates give twists, and the wrenches that go with them are momenta.
    let still = vec![graph.zero(); xi.len()];
    let twists = motions(graph, tree, &still, xi, none);
    let momenta: Vec<Wrench> = tree
        .links
        .iter()
        .zip(&twists)
        .map(|(link, twist)| wrench(graph, &link.mass, twist))
        .collect();
    let turned = |graph: &mut Graph, index: usize, h: &Wrench| {
        let (omega, v) = (twists[index].alpha, twists[index].a);
        let spin = cross(graph, h.torque, omega);
        let lever = cross(graph, h.force, v);
        Wrench {
            force: cross(graph, h.force, omega),
            torque: add3(graph, spin, lever),
        }
    };
    Some(collect_with(graph, tree, &momenta, xi.len(), turned))
}
