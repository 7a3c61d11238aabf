//! Whether an energy is quadratic in the velocities.

use crate::algebra::derivation::Derivation;
use crate::algebra::fp::Random;
use crate::algebra::graph::{Edge, Graph};
use num_bigint::BigInt;
use num_rational::BigRational;

/// Whether a function of ξ is homogeneous of degree two, ξ · ∂T/∂ξ = 2 T, and has no third
/// derivative: none along a random direction. In a graph of its own, to leave no trace.
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
    let third = (0..3).fold(energy, |function, _| along.of(graph, function));
    twice == double && third == graph.zero()
}
