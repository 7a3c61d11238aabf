//! Nodes to statements.
//!
//! Sums become chains of fused products; sine and cosine of one angle become one statement; a guard
//! follows the pivot that it checks.

use super::places::{Place, Places, Time};
use super::sums::sums;
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
    /// a where c > 0, else b
    Select(Edge, Edge, Edge),
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
            Operation::Fused(a, b, c) | Operation::Select(a, b, c) => [Some(a), Some(b), Some(c)],
            Operation::SinCos(a) | Operation::Apply(_, a) | Operation::Check(_, a) => {
                [Some(a), None, None]
            }
        };
        list.into_iter().flatten()
    }

    /// The same with other operands.
    fn map(self, to: impl Fn(Edge) -> Edge) -> Self {
        match self {
            Operation::Add(a, b) => Operation::Add(to(a), to(b)),
            Operation::Multiply(a, b) => Operation::Multiply(to(a), to(b)),
            Operation::Fused(a, b, c) => Operation::Fused(to(a), to(b), to(c)),
            Operation::Divide(a, b) => Operation::Divide(to(a), to(b)),
            Operation::SinCos(a) => Operation::SinCos(to(a)),
            Operation::Apply(function, a) => Operation::Apply(function, to(a)),
            Operation::Atan2(y, x) => Operation::Atan2(to(y), to(x)),
            Operation::Select(c, a, b) => Operation::Select(to(c), to(a), to(b)),
            Operation::Check(pivot, a) => Operation::Check(pivot, to(a)),
        }
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
    let roots = outputs.iter().chain(guards);
    let mut sums = sums(places, time, nodes, roots, named);
    // Functions that hold off X too are copied into the graph unmerged, so that a sine or cosine may have
    // several nodes. All are read from the first.
    let mut angles: FxHashMap<Edge, [Option<NodeId>; 2]> = FxHashMap::default();
    let mut first: FxHashMap<NodeId, NodeId> = FxHashMap::default();
    for &id in nodes {
        if let Node::Apply(function @ (Function::Sin | Function::Cos), angle) = graph.node(id) {
            let pair = angles.entry(angle).or_default();
            match pair[usize::from(function == Function::Cos)] {
                Some(known) => _ = first.insert(id, known),
                ref mut free => *free = Some(id),
            }
        }
    }
    let read = |edge: Edge| {
        let known = first.get(&edge.node());
        known.map_or(edge, |&node| Edge::of(node).signed(edge.is_negative()))
    };
    let guards: Vec<Edge> = guards.iter().map(|&guard| read(guard)).collect();
    let mut checks: FxHashMap<NodeId, Vec<usize>> = FxHashMap::default();
    let mut statements = Vec::new();
    for (pivot, &guard) in guards.iter().enumerate() {
        match places.of(guard.node(), time) {
            Place::Temporary => checks.entry(guard.node()).or_default().push(pivot),
            Place::Number if graph.as_rational(guard).is_some_and(|n| n.is_positive()) => {}
            _ => statements.push(check(pivot, guard)),
        }
    }
    let mut push = |mut statement: Statement| {
        statement.operation = statement.operation.map(read);
        statements.push(statement);
        for node in statement.defined() {
            let pivots = checks.remove(&node).unwrap_or_default();
            statements.extend(pivots.iter().map(|&pivot| check(pivot, guards[pivot])));
        }
    };
    for (index, &id) in nodes.iter().enumerate() {
        let mut results = [Some(id), None];
        let operation = match graph.node(id) {
            Node::Constant(_) | Node::Symbol(_) => None,
            _ if sums.absorbed.contains(&id) => None,
            Node::Mul(a, b) => Some(Operation::Multiply(a, b)),
            Node::Add(a, b) => Some(Operation::Add(a, b)),
            Node::Div(a, b) => Some(Operation::Divide(a, b)),
            Node::Apply(Function::Sin | Function::Cos, angle) => {
                angles.remove(&angle).map(|both| {
                    results = both;
                    Operation::SinCos(angle)
                })
            }
            Node::Apply(function, a) => Some(Operation::Apply(function, a)),
            Node::Atan2(y, x) => Some(Operation::Atan2(y, x)),
            Node::Select(c, a, b) => Some(Operation::Select(c, a, b)),
        };
        if let Some(operation) = operation {
            push(Statement { operation, results });
        }
        for statement in sums.after.remove(&index).unwrap_or_default() {
            push(statement);
        }
    }
    Body {
        statements,
        outputs: outputs.iter().map(|&output| read(output)).collect(),
    }
}

fn check(pivot: usize, guard: Edge) -> Statement {
    Statement {
        operation: Operation::Check(pivot, guard),
        results: [None, None],
    }
}
