//! Nodes to statements.
//!
//! A product that is read once, by a sum, becomes one statement with it; sine and cosine of one
//! angle become one statement; a guard follows the pivot that it checks.

use super::places::{Place, Places, Time};
use crate::algebra::graph::{Edge, Function, Node, NodeId};
use num_traits::Signed;
use rustc_hash::{FxHashMap, FxHashSet};

/// What a statement computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// a + b
    Add(Edge, Edge),
    /// a b
    Multiply(Edge, Edge),
    /// a b + c
    Fused(Edge, Edge, Edge),
    /// a / b
    Divide(Edge, Edge),
    /// (sin a, cos a)
    SinCos(Edge),
    /// f(a)
    Apply(Function, Edge),
    /// atan2(y, x)
    Atan2(Edge, Edge),
    /// Leaves the function unless a pivot is positive.
    Check(usize, Edge),
}

impl Operation {
    /// What is read, in order.
    pub fn operands(self) -> impl Iterator<Item = Edge> {
        let list = match self {
            Operation::Add(a, b)
            | Operation::Multiply(a, b)
            | Operation::Divide(a, b)
            | Operation::Atan2(a, b) => [Some(a), Some(b), None],
            Operation::Fused(a, b, c) => [Some(a), Some(b), Some(c)],
            Operation::SinCos(a) | Operation::Apply(_, a) | Operation::Check(_, a) => {
                [Some(a), None, None]
            }
        };
        list.into_iter().flatten()
    }
}

/// One statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Statement {
    /// What it computes.
    pub operation: Operation,
    /// The nodes that it gives values to; the second for a cosine.
    pub results: [Option<NodeId>; 2],
}

impl Statement {
    /// Whether it binds names.
    pub fn is_let(self) -> bool {
        !matches!(self.operation, Operation::Check(..))
    }

    /// The nodes that it gives values to.
    pub fn defined(self) -> impl Iterator<Item = NodeId> {
        self.results.into_iter().flatten()
    }
}

/// The statements of a function, operands before their readers, and its results.
#[derive(Clone, Debug)]
pub struct Body {
    /// The statements.
    pub statements: Vec<Statement>,
    /// The results.
    pub outputs: Vec<Edge>,
}

/// Lowers nodes, given children first. Nodes in `named` keep a statement of their own.
pub fn lower(
    places: &Places,
    time: Time,
    nodes: &[NodeId],
    outputs: &[Edge],
    guards: &[Edge],
    named: &FxHashSet<NodeId>,
) -> Body {
    let graph = places.graph();
    let products = products(places, time, nodes, outputs.iter().chain(guards), named);
    let fused: FxHashSet<NodeId> = products.values().map(|product| product.node()).collect();
    let mut angles: FxHashMap<Edge, [Option<NodeId>; 2]> = FxHashMap::default();
    for &id in nodes {
        if let Node::Apply(function @ (Function::Sin | Function::Cos), angle) = graph.node(id) {
            angles.entry(angle).or_default()[usize::from(function == Function::Cos)] = Some(id);
        }
    }
    let mut checks: FxHashMap<NodeId, Vec<usize>> = FxHashMap::default();
    let mut statements = Vec::new();
    for (pivot, &guard) in guards.iter().enumerate() {
        match places.of(guard.node(), time) {
            Place::Temporary => checks.entry(guard.node()).or_default().push(pivot),
            Place::Number if graph.as_rational(guard).is_some_and(|n| n.is_positive()) => {}
            _ => statements.push(check(pivot, guard)),
        }
    }
    for &id in nodes {
        let operation = match graph.node(id) {
            Node::Constant(_) | Node::Symbol(_) => continue,
            Node::Mul(..) if fused.contains(&id) => continue,
            Node::Mul(a, b) => Operation::Multiply(a, b),
            Node::Add(a, b) => match products.get(&id) {
                Some(&product) => fuse(graph.node(product.node()), product, a, b),
                None => Operation::Add(a, b),
            },
            Node::Div(a, b) => Operation::Divide(a, b),
            Node::Apply(Function::Sin | Function::Cos, angle) => match angles.remove(&angle) {
                Some(results) => {
                    let operation = Operation::SinCos(angle);
                    statements.push(Statement { operation, results });
                    for node in results.into_iter().flatten() {
                        let pivots = checks.remove(&node).unwrap_or_default();
                        statements.extend(pivots.iter().map(|&pivot| check(pivot, guards[pivot])));
                    }
                    continue;
                }
                None => continue,
            },
            Node::Apply(function, a) => Operation::Apply(function, a),
            Node::Atan2(y, x) => Operation::Atan2(y, x),
        };
        let results = [Some(id), None];
        statements.push(Statement { operation, results });
        let pivots = checks.remove(&id).unwrap_or_default();
        statements.extend(pivots.iter().map(|&pivot| check(pivot, guards[pivot])));
    }
    Body {
        statements,
        outputs: outputs.to_vec(),
    }
}

fn check(pivot: usize, guard: Edge) -> Statement {
    Statement {
        operation: Operation::Check(pivot, guard),
        results: [None, None],
    }
}

/// The sums that take a product in, each with that product as it stands in the sum.
fn products<'a>(
    places: &Places,
    time: Time,
    nodes: &[NodeId],
    roots: impl Iterator<Item = &'a Edge>,
    named: &FxHashSet<NodeId>,
) -> FxHashMap<NodeId, Edge> {
    let graph = places.graph();
    let mut uses: FxHashMap<NodeId, usize> = FxHashMap::default();
    for edge in nodes.iter().flat_map(|&id| graph.node(id).children()) {
        *uses.entry(edge.node()).or_default() += 1;
    }
    for root in roots {
        *uses.entry(root.node()).or_default() += 1;
    }
    let is_free = |edge: Edge| {
        let id = edge.node();
        matches!(graph.node(id), Node::Mul(..))
            && places.of(id, time) == Place::Temporary
            && uses.get(&id) == Some(&1)
            && !named.contains(&id)
    };
    let mut products = FxHashMap::default();
    for &id in nodes {
        if let Node::Add(a, b) = graph.node(id)
            && let Some(product) = [b, a].into_iter().find(|&edge| is_free(edge))
        {
            products.insert(id, product);
        }
    }
    products
}

/// a + b with one of them a product.
fn fuse(node: Node, product: Edge, a: Edge, b: Edge) -> Operation {
    let rest = if product == a { b } else { a };
    match node {
        Node::Mul(x, y) => Operation::Fused(x.signed(product.is_negative()), y, rest),
        _ => Operation::Add(a, b),
    }
}
