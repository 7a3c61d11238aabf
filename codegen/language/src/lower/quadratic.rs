//! Decides whether an energy is quadratic in the velocities.

use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph, NodeId};
use crate::algebra::residue_pair::Random;
use num_bigint::BigInt;
use num_rational::BigRational;

/// Returns whether a function of ξ is homogeneous of degree two, ξ · ∂T/∂ξ = 2 T, and has no third derivative: that
/// along a random direction is 0, and the second one has no branches selected by ξ, as |v| v has. The check works on
/// its own copy of the graph, so that it leaves no trace.
pub fn is_quadratic(mut graph: Graph, energy: Edge, xi: &[Edge]) -> bool {
    let graph = &mut graph;
    let twice = Derivation::new(xi.iter().map(|xi| (xi.node(), *xi))).of(graph, energy);
    let double = graph.add(energy, energy);
    let mut random = Random::new(0x71);
    let mut direction = Vec::new();
    for xi in xi {
        let component = BigRational::from_integer(BigInt::from(random.bits() >> 3));
        direction.push((xi.node(), graph.rational(&component)));
    }
    let mut along = Derivation::new(direction);
    let second = (0..2).fold(energy, |function, _| along.of(graph, function));
    let third = along.of(graph, second);
    let moving = xi
        .iter()
        .fold(0, |class, xi| class | graph.class(xi.node()));
    let chosen = |id: NodeId| {
        let by = graph.condition_of(id);
        by.is_some_and(|by| graph.class(by.node()) & moving != 0)
    };
    twice == double && third == graph.zero() && !graph.reachable(&[second]).into_iter().any(chosen)
}
