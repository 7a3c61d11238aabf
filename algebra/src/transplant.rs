//! Carrying expressions from one graph to another with the same symbols.

use super::graph::{Edge, Graph, Node, NodeId};
use rustc_hash::FxHashMap;

/// Builds the expressions again in another graph, where they merge with what is equal there.
pub fn rebuild(from: &Graph, into: &mut Graph, edges: &[Edge]) -> Vec<Edge> {
    carry(from, into, edges, same_symbol, merged)
}

/// Builds the expressions again with every symbol replaced by an expression of the other graph, by
/// the symbols' order.
pub fn map_symbols(from: &Graph, into: &mut Graph, edges: &[Edge], images: &[Edge]) -> Vec<Edge> {
    carry(from, into, edges, |_, index| images[index as usize], merged)
}

fn same_symbol(into: &Graph, index: u32) -> Edge {
    Edge::of(into.symbols()[index as usize].node)
}

fn merged(into: &mut Graph, node: Node, a: Edge, b: Edge) -> Edge {
    match node {
        Node::Add(..) => into.add(a, b),
        Node::Mul(..) => into.mul(a, b),
        Node::Div(..) => into.div(a, b).unwrap_or(into.zero()),
        Node::Apply(function, _) => into.apply(function, a),
        Node::Atan2(..) => into.atan2(a, b),
        Node::Constant(_) | Node::Symbol(_) => a,
    }
}

/// The expressions with expressions in the place of symbols, by the symbols' numbers; all of one
/// graph.
pub fn substitute(graph: &mut Graph, edges: &[Edge], set: &[(usize, Edge)]) -> Vec<Edge> {
    if set.is_empty() {
        return edges.to_vec();
    }
    let mut image: FxHashMap<NodeId, Edge> = FxHashMap::default();
    let read = |image: &FxHashMap<NodeId, Edge>, edge: Edge| {
        let known = image.get(&edge.node()).copied();
        known
            .unwrap_or(Edge::of(edge.node()))
            .signed(edge.is_negative())
    };
    for id in graph.reachable(edges) {
        let made = match graph.node(id) {
            Node::Constant(_) => Edge::of(id),
            Node::Symbol(index) => {
                let found = set.iter().find(|(symbol, _)| *symbol == index as usize);
                found.map_or(Edge::of(id), |(_, value)| *value)
            }
            node => {
                let mut children = node.children().map(|child| read(&image, child));
                let a = children.next().unwrap_or(graph.zero());
                let b = children.next().unwrap_or(a);
                match node {
                    Node::Add(..) => graph.add(a, b),
                    Node::Mul(..) => graph.mul(a, b),
                    Node::Div(..) => graph.div(a, b).unwrap_or(graph.zero()),
                    Node::Apply(function, _) => graph.apply(function, a),
                    Node::Atan2(..) => graph.atan2(a, b),
                    Node::Constant(_) | Node::Symbol(_) => Edge::of(id),
                }
            }
        };
        image.insert(id, made);
    }
    edges.iter().map(|&edge| read(&image, edge)).collect()
}

/// Copies the expressions node by node without merging: for functions that are wanted off the
/// variety, such as φ itself, whose value on X would make it the number 0.
pub fn copy(from: &Graph, into: &mut Graph, edges: &[Edge]) -> Vec<Edge> {
    carry(from, into, edges, same_symbol, |into, node, a, b| {
        let negative = a.is_negative() ^ b.is_negative();
        match node {
            Node::Add(..) => into.push_unmerged(Node::Add(a, b)),
            Node::Mul(..) => {
                let product = Node::Mul(a.abs(), b.abs());
                into.push_unmerged(product).signed(negative)
            }
            Node::Div(..) => {
                let quotient = Node::Div(a.abs(), b.abs());
                into.push_unmerged(quotient).signed(negative)
            }
            Node::Apply(function, _) => into.push_unmerged(Node::Apply(function, a)),
            Node::Atan2(..) => into.push_unmerged(Node::Atan2(a, b)),
            Node::Constant(_) | Node::Symbol(_) => a,
        }
    })
}

/// Builds the expressions again as they are computed there, whatever in the other graph has the same
/// values: what another function computes at length is not taken over. What is constant at run time
/// merges, as it is computed once for all functions.
pub fn graft(from: &Graph, into: &mut Graph, edges: &[Edge]) -> Vec<Edge> {
    carry(from, into, edges, same_symbol, |into, node, a, b| {
        if into.is_free(a.node()) && into.is_free(b.node()) {
            return merged(into, node, a, b);
        }
        let negative = a.is_negative() ^ b.is_negative();
        match node {
            // The positive operand first, as sums are built.
            Node::Add(..) if a.is_negative() && b.is_negative() => {
                -into.push_apart(Node::Add(-a, -b))
            }
            Node::Add(..) if a.is_negative() => into.push_apart(Node::Add(b, a)),
            Node::Add(..) => into.push_apart(Node::Add(a, b)),
            Node::Mul(..) => {
                let product = Node::Mul(a.abs(), b.abs());
                into.push_apart(product).signed(negative)
            }
            Node::Div(..) => {
                let quotient = Node::Div(a.abs(), b.abs());
                into.push_apart(quotient).signed(negative)
            }
            other => merged(into, other, a, b),
        }
    })
}

fn carry(
    from: &Graph,
    into: &mut Graph,
    edges: &[Edge],
    symbol: impl Fn(&Graph, u32) -> Edge,
    mut make: impl FnMut(&mut Graph, Node, Edge, Edge) -> Edge,
) -> Vec<Edge> {
    let mut image: FxHashMap<NodeId, Edge> = FxHashMap::default();
    let read = |image: &FxHashMap<NodeId, Edge>, into: &Graph, edge: Edge| {
        image
            .get(&edge.node())
            .copied()
            .unwrap_or(into.zero())
            .signed(edge.is_negative())
    };
    for id in from.reachable(edges) {
        let made = match from.node(id) {
            Node::Constant(index) => into.number(from.constant(index), from.value(Edge::of(id))),
            Node::Symbol(index) => symbol(into, index),
            node => {
                into.follow(from, id);
                let mut children = node.children().map(|child| read(&image, into, child));
                let a = children.next().unwrap_or(into.zero());
                let b = children.next().unwrap_or(a);
                drop(children);
                make(into, node, a, b)
            }
        };
        image.insert(id, made);
    }
    edges.iter().map(|&edge| read(&image, into, edge)).collect()
}
