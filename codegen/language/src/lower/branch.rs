//! Chooses the branch of the start: of a constraint that is a product, the factor that vanishes there.
//!
//! If f g = 0 with f = 0 and g ≠ 0 at the start, X is {f = 0} up to points where both factors vanish. The motion
//! cannot pass through such points: ∂(f g) = 0 there, so that A does not exist. Hence points of {f = 0} are points of
//! X on the branch that matters. The generated code contains the constraint as it was written.

use crate::algebra::graph::{Edge, Graph, Node};
use crate::algebra::numeric::evaluate;
use crate::model::class;

/// Value at the start below which a factor vanishes.
const ZERO: f64 = 1e-7;
/// Value at the start above which a factor does not vanish.
const APART: f64 = 1e-3;

/// Returns the only factor of a product that depends on coordinates and vanishes at the start; returns the edge itself
/// if it is not a product, or if not exactly one factor vanishes.
pub fn at_start(graph: &Graph, edge: Edge, start: &[f64]) -> Edge {
    let factors = factors(graph, edge);
    let values = evaluate(graph, &factors, start);
    let mut vanishing = None;
    for (&factor, value) in factors.iter().zip(values) {
        match value.abs() {
            size if size < ZERO && vanishing.is_none() => vanishing = Some(factor),
            size if size > APART => {}
            _ => return edge,
        }
    }
    vanishing.unwrap_or(edge)
}

/// Returns the distinct factors that contain a coordinate.
fn factors(graph: &Graph, edge: Edge) -> Vec<Edge> {
    let mut open = vec![edge];
    let mut all: Vec<Edge> = Vec::new();
    while let Some(edge) = open.pop() {
        let edge = edge.abs();
        match graph.node(edge.node()) {
            Node::Mul(a, b) => open.extend([a, b]),
            // The denominator of a constraint contains no coordinate.
            Node::Div(a, _) => open.push(a),
            _ if graph.class(edge.node()) & class::COORD == 0 || all.contains(&edge) => {}
            _ => all.push(edge),
        }
    }
    all
}
