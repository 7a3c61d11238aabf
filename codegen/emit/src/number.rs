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

/// Returns the shortest literal that parses to this number.
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

/// Returns a number as an expression of the generated scalar type.
pub fn scalar(value: f64) -> String {
    format!("S::from_f64({})", literal(value))
}

/// Returns a constant node as an expression of the scalar type: the double nearest to an exact rational, or π.
pub fn of(graph: &Graph, node: NodeId) -> String {
    match graph.node(node) {
        Node::Constant(_) => scalar(tape::number(graph, node)),
        _ => "S::from_f64(::core::f64::consts::PI)".into(),
    }
}

/// Returns the name of a number, if it has one.
pub fn name(graph: &Graph, node: NodeId) -> Option<&'static str> {
    let Node::Constant(index) = graph.node(node) else {
        return Some("pi");
    };
    let value = graph.constant(index);
    let known = NAMES
        .iter()
        .find(|(n, d, _)| value.numer() == &(*n).into() && value.denom() == &(*d).into());
    known.map(|&(_, _, name)| name)
}
