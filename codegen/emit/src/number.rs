//! Numbers as decimal literals.

use hamel_algebra::graph::{Graph, Node, NodeId};
use hamel_program::tape;

/// Numbers with names of their own: numerator, denominator, name.
const NAMES: &[(i32, i32, &str)] = &[
    (0, 1, "zero"),
    (1, 1, "one"),
    (2, 1, "two"),
    (3, 1, "three"),
    (4, 1, "four"),
    (1, 2, "half"),
    (1, 3, "third"),
    (1, 4, "quarter"),
];

/// Returns the shortest Rust literal that parses to this `f64`.
pub fn literal(value: f64) -> String {
    if value.is_nan() {
        "f64::NAN".into()
    } else if value.is_infinite() {
        let sign = if value < 0.0 { "-" } else { "" };
        format!("{sign}f64::INFINITY")
    } else {
        format!("{value:?}")
    }
}

/// Returns an `f64` as a Rust expression of the generated scalar type, such as `S::from_f64(0.5)`.
pub fn scalar_expression(value: f64) -> String {
    format!("S::from_f64({})", literal(value))
}

/// Returns a constant node of the graph as a Rust expression of the scalar type: the double nearest to an exact
/// rational, or π.
pub fn constant_expression(graph: &Graph, node: NodeId) -> String {
    match graph.node(node) {
        Node::Constant(_) => scalar_expression(tape::number(graph, node)),
        _ => "S::from_f64(::core::f64::consts::PI)".into(),
    }
}

/// Returns the name under which a constant node is bound, such as `pi`; `None` for most numbers.
pub fn constant_name(graph: &Graph, node: NodeId) -> Option<&'static str> {
    let Node::Constant(index) = graph.node(node) else {
        return Some("pi");
    };
    let value = graph.constant(index);
    let known = NAMES
        .iter()
        .find(|(n, d, _)| value.numer() == &(*n).into() && value.denom() == &(*d).into());
    known.map(|&(_, _, name)| name)
}
