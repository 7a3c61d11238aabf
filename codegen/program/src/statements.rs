//! Translation of the nodes of a graph to statements.
//!
//! Sums become chains of fused multiply-adds; the sine and cosine of one angle become one statement; a guard directly
//! follows the statement that computes its pivot.

use super::Cause;
use super::places::{Place, Places, Time};
use super::sums::sums;
use hamel_algebra::graph::{Component, Edge, Function, Graph, Node, NodeId};
use num_traits::Signed;
use rustc_hash::{FxHashMap, FxHashSet};

/// Operation of a statement.
#[derive(Clone, Debug, PartialEq, Eq)]
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
    /// a if c > 0, else b
    Select(Edge, Edge, Edge),
    /// Call of a function in Rust, or of its derivatives.
    Call(Call),
    /// Leaves the function if a pivot is not positive.
    Check(Cause, Edge),
}

/// Call of a function in Rust.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Call {
    /// Index of the function among the external functions of the graph.
    pub function: usize,
    /// Whether the partial derivatives are returned, and not the components.
    pub slopes: bool,
    /// Arguments of the call.
    pub arguments: Vec<Edge>,
    /// Nodes that receive the returned numbers, derivatives by rows; `None` for those that nobody reads.
    pub results: Vec<Option<NodeId>>,
}

impl Operation {
    /// Returns the operands, in order.
    pub fn operands(&self) -> impl Iterator<Item = Edge> {
        let mut call = &[][..];
        let list = match *self {
            Operation::Add(a, b)
            | Operation::Multiply(a, b)
            | Operation::Divide(a, b)
            | Operation::Atan2(a, b) => [Some(a), Some(b), None],
            Operation::Fused(a, b, c) | Operation::Select(a, b, c) => [Some(a), Some(b), Some(c)],
            Operation::SinCos(a) | Operation::Apply(_, a) | Operation::Check(_, a) => {
                [Some(a), None, None]
            }
            Operation::Call(ref of) => {
                call = &of.arguments;
                [None; 3]
            }
        };
        list.into_iter().flatten().chain(call.iter().copied())
    }

    /// Replaces the operands.
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
            Operation::Check(cause, a) => Operation::Check(cause, to(a)),
            Operation::Call(call) => Operation::Call(Call {
                arguments: call.arguments.iter().map(|&a| to(a)).collect(),
                ..call
            }),
        }
    }
}

/// One statement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Statement {
    /// Operation.
    pub operation: Operation,
    /// Nodes that receive the results: one, or a sine and a cosine; none for calls and checks.
    pub results: [Option<NodeId>; 2],
}

impl Statement {
    /// Returns whether the statement binds names.
    pub fn is_let(&self) -> bool {
        !matches!(self.operation, Operation::Check(..))
    }

    /// Returns the nodes that receive values.
    pub fn defined(&self) -> impl Iterator<Item = NodeId> {
        let called = match &self.operation {
            Operation::Call(call) => call.results.as_slice(),
            _ => &[],
        };
        self.results.iter().chain(called).copied().flatten()
    }
}

/// Body of a function: statements, operands before their readers, and results.
#[derive(Clone, Debug)]
pub struct Body {
    /// Statements.
    pub statements: Vec<Statement>,
    /// Results.
    pub outputs: Vec<Edge>,
    /// Nodes of which a statement has the name but not the value: it computes a part of a sum.
    pub partial: FxHashSet<NodeId>,
}

/// Translates nodes, given children first, to statements. Nodes in `named` keep a statement of their own.
pub fn statements(
    places: &Places,
    time: Time,
    nodes: &[NodeId],
    outputs: &[Edge],
    guards: &[(Edge, Cause)],
    named: &FxHashSet<NodeId>,
) -> Body {
    let graph = places.graph();
    let roots = outputs.iter().chain(guards.iter().map(|(guard, _)| guard));
    let mut sums = sums(places, time, nodes, roots, named);
    // Functions that have values off X, too, are copied into the graph without merging equal nodes, so that several
    // nodes may stand for one sine or cosine. All are read from the first.
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
    let mut calls = calls(graph, nodes);
    let read = |edge: Edge| {
        let known = first.get(&edge.node());
        known.map_or(edge, |&node| Edge::of(node).signed(edge.is_negative()))
    };
    let guards = guards.iter().map(|&(guard, cause)| (read(guard), cause));
    let mut checks: FxHashMap<NodeId, Vec<(Edge, Cause)>> = FxHashMap::default();
    let mut statements = Vec::new();
    for (guard, cause) in guards {
        match places.of(guard.node(), time) {
            Place::Temporary => {
                let checked = checks.entry(guard.node()).or_default();
                checked.push((guard, cause));
            }
            Place::Number if graph.as_rational(guard).is_some_and(|n| n.is_positive()) => {}
            _ => statements.push(check((guard, cause))),
        }
    }
    let mut push = |mut statement: Statement| {
        statement.operation = statement.operation.map(read);
        let checked = statement.defined().flat_map(|node| checks.remove(&node));
        let pivots: Vec<(Edge, Cause)> = checked.flatten().collect();
        statements.push(statement);
        statements.extend(pivots.into_iter().map(check));
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
            Node::Listed(..) => None,
            Node::External(component, list) => {
                results = [None, None];
                calls.remove(&key(component, list)).map(Operation::Call)
            }
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
        partial: sums.partial,
    }
}

/// Key that all components returned by one call have in common: function, order of derivative, arguments.
type Key = (u8, usize, Edge);

fn key(component: Component, list: Edge) -> Key {
    (component.function, component.order(), list)
}

/// Collects the calls of functions in Rust; one call gives all of its components that are read.
fn calls(graph: &Graph, nodes: &[NodeId]) -> FxHashMap<Key, Call> {
    let mut calls: FxHashMap<Key, Call> = FxHashMap::default();
    for &id in nodes {
        let Node::External(component, list) = graph.node(id) else {
            continue;
        };
        let function = usize::from(component.function);
        let Some(external) = graph.externals().get(function) else {
            continue;
        };
        let columns = match component.order() {
            0 => 1,
            _ => external.arguments.len(),
        };
        let call = calls.entry(key(component, list)).or_insert_with(|| Call {
            function,
            slopes: component.order() > 0,
            arguments: graph.list(list),
            results: vec![None; external.components * columns],
        });
        let place =
            usize::from(component.component) * columns + component.differentiated_by().unwrap_or(0);
        if let Some(result) = call.results.get_mut(place) {
            *result = Some(id);
        }
    }
    calls
}

fn check((guard, cause): (Edge, Cause)) -> Statement {
    Statement {
        operation: Operation::Check(cause, guard),
        results: [None, None],
    }
}
