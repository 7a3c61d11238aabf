//! Transfer of expressions from one graph to another with the same symbols.

use super::graph::{Edge, Graph, Node};

/// Rebuilds the expressions in another graph, where they merge with nodes of equal value.
pub fn rebuild(from: &Graph, into: &mut Graph, edges: &[Edge]) -> Vec<Edge> {
    carry(from, into, edges, same_symbol, merge)
}

/// Rebuilds the expressions with every symbol replaced by an expression of the other graph; `images` is in
/// the order of the symbols.
pub fn map_symbols(from: &Graph, into: &mut Graph, edges: &[Edge], images: &[Edge]) -> Vec<Edge> {
    carry(from, into, edges, |_, index| images[index as usize], merge)
}

fn same_symbol(into: &Graph, index: u32) -> Edge {
    Edge::of(into.symbols()[index as usize].node)
}

/// Maps an edge by the images of nodes.
pub(crate) fn read(image: &[Edge], edge: Edge) -> Edge {
    image[edge.node() as usize].signed(edge.is_negative())
}

/// Adds a node to a graph, where it merges with a node of equal value.
pub(crate) fn merge(into: &mut Graph, node: Node) -> Edge {
    match node {
        Node::Add(a, b) => into.add(a, b),
        Node::Mul(a, b) => into.mul(a, b),
        Node::Div(a, b) => into.div(a, b).unwrap_or(into.zero()),
        Node::Apply(function, a) => into.apply(function, a),
        Node::Atan2(y, x) => into.atan2(y, x),
        Node::Select(c, a, b) => into.select(c, a, b),
        Node::Listed(rest, a) => into.listed(rest, a),
        Node::External(component, list) => into.external_of(component, list),
        Node::Constant(_) | Node::Symbol(_) => into.zero(),
    }
}

/// Substitutes expressions for symbols, which are given by their indices; everything is in one graph.
pub fn substitute(graph: &mut Graph, edges: &[Edge], set: &[(usize, Edge)]) -> Vec<Edge> {
    if set.is_empty() {
        return edges.to_vec();
    }
    let mut image = vec![Edge::of(0); graph.len()];
    for id in graph.reachable(edges) {
        let made = match graph.node(id) {
            Node::Constant(_) => Edge::of(id),
            Node::Symbol(index) => {
                let found = set.iter().find(|(symbol, _)| *symbol == index as usize);
                found.map_or(Edge::of(id), |(_, value)| *value)
            }
            node => merge(graph, node.map_children(|child| read(&image, child))),
        };
        image[id as usize] = made;
    }
    edges.iter().map(|&edge| read(&image, edge)).collect()
}

/// Substitutes expressions for symbols only in the arguments of square roots.
pub fn substitute_under_roots(
    graph: &mut Graph,
    edges: &[Edge],
    set: &[(usize, Edge)],
) -> Vec<Edge> {
    if set.is_empty() {
        return edges.to_vec();
    }
    let mut image = vec![Edge::of(0); graph.len()];
    for id in graph.reachable(edges) {
        let made = match graph.node(id) {
            Node::Constant(_) | Node::Symbol(_) => Edge::of(id),
            node if node.is_root() => substitute(graph, &[Edge::of(id)], set)[0],
            node => merge(graph, node.map_children(|child| read(&image, child))),
        };
        image[id as usize] = made;
    }
    edges.iter().map(|&edge| read(&image, edge)).collect()
}

/// Copies the expressions node by node without merging. This serves functions that are needed off the
/// variety, such as φ itself, whose value on X would make it the number 0.
pub fn copy(from: &Graph, into: &mut Graph, edges: &[Edge]) -> Vec<Edge> {
    carry(from, into, edges, same_symbol, |into, node| {
        let (node, negative) = unsigned(node);
        into.push_unmerged(node).signed(negative)
    })
}

/// Rebuilds the expressions with the operations by which they are computed in `from`, whatever nodes of the
/// other graph have the same values: a value that another function computes at length is not reused.
/// Run-time constants merge, because they are computed once for all functions.
pub fn graft(from: &Graph, into: &mut Graph, edges: &[Edge]) -> Vec<Edge> {
    carry(from, into, edges, same_symbol, |into, node| {
        if node.children().all(|child| into.is_free(child.node())) {
            return merge(into, node);
        }
        match unsigned(node) {
            // The positive operand first, as sums are built.
            (Node::Add(a, b), _) if a.is_negative() && b.is_negative() => {
                -into.push_distinct(Node::Add(-a, -b))
            }
            (Node::Add(a, b), _) if a.is_negative() => into.push_distinct(Node::Add(b, a)),
            (other @ (Node::Add(..) | Node::Mul(..) | Node::Div(..)), negative) => {
                into.push_distinct(other).signed(negative)
            }
            _ => merge(into, node),
        }
    })
}

/// Moves the signs of the operands of a product or quotient to the result.
fn unsigned(node: Node) -> (Node, bool) {
    match node {
        Node::Mul(a, b) => (
            Node::Mul(a.abs(), b.abs()),
            a.is_negative() != b.is_negative(),
        ),
        Node::Div(a, b) => (
            Node::Div(a.abs(), b.abs()),
            a.is_negative() != b.is_negative(),
        ),
        other => (other, false),
    }
}

fn carry(
    from: &Graph,
    into: &mut Graph,
    edges: &[Edge],
    symbol: impl Fn(&Graph, u32) -> Edge,
    make: impl Fn(&mut Graph, Node) -> Edge,
) -> Vec<Edge> {
    let mut image = vec![Edge::of(0); from.len()];
    for id in from.reachable(edges) {
        let made = match from.node(id) {
            Node::Constant(index) => into.number(from.constant(index), from.value(Edge::of(id))),
            Node::Symbol(index) => symbol(into, index),
            node => {
                into.announce_copy(from, id);
                let made = make(into, node.map_children(|child| read(&image, child)));
                into.keep_label(from, id, made);
                made
            }
        };
        image[id as usize] = made;
    }
    edges.iter().map(|&edge| read(&image, edge)).collect()
}
