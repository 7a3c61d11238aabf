//! The branch of the start: of a constraint that is a product, the factor that vanishes there.
//!
//! Where f g = 0, f = 0 at the start and g ≠ 0, X is {f = 0} as far as the motion gets without a point at which
//! both vanish, and there is no A at such a point: ∂(f g) = 0. So points of {f = 0} are points of X, on the
//! branch that matters. Emitted is the constraint as it was written.

use crate::algebra::graph::{Edge, Graph, Node};
use crate::algebra::numeric::evaluate;
use crate::model::class;

/// A factor that is smaller at the start vanishes there.
const ZERO: f64 = 1e-7;
/// A factor that is larger does not.
const APART: f64 = 1e-3;

/// The one factor with coordinates that vanishes at the numbers of the start; the edge itself where it is no
/// product, or none or several vanish.
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

/// What is multiplied, each once, without what has no coordinate in it.
fn factors(graph: &Graph, edge: Edge) -> Vec<Edge> {
    let mut open = vec![edge];
    let mut all: Vec<Edge> = Vec::new();
    while let Some(edge) = open.pop() {
        let edge = edge.abs();
        match graph.node(edge.node()) {
            Node::Mul(a, b) => open.extend([a, b]),
            // A constraint divides by what has no coordinate in it.
            Node::Div(a, _) => open.push(a),
            _ if graph.class(edge.node()) & class::COORD == 0 || all.contains(&edge) => {}
            _ => all.push(edge),
        }
    }
    all
}
