//! Where a value is found when a statement reads it.

use super::schedule::is_hoisted;
use super::{Argument, Program};
use hamel_algebra::graph::{Edge, Graph, Node, NodeId};
use rustc_hash::FxHashMap;

/// When a function runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Time {
    /// When parameters are set.
    Parameters,
    /// On every call.
    Call,
}

/// Where a value is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// An entry of an argument.
    Argument(Argument, usize),
    /// A parameter, by its number among the parameters' symbols.
    Parameter(usize),
    /// A kept constant.
    Kept(usize),
    /// A number known when code is generated.
    Number,
    /// The result of a statement.
    Temporary,
}

/// The places of all nodes of a program.
pub struct Places<'a> {
    graph: &'a Graph,
    /// Where the symbols of parameters, x, ξ, u, z, ξ̇, p begin.
    starts: [usize; 8],
    kept: Vec<NodeId>,
    index: FxHashMap<NodeId, usize>,
}

/// The arguments that the symbols after the parameters are entries of.
const ORDER: [Argument; 6] = [
    Argument::Coordinates,
    Argument::Velocities,
    Argument::Inputs,
    // z, behind ξ.
    Argument::Velocities,
    Argument::Accelerations,
    Argument::Momenta,
];
/// The place of z in this order.
const STATES: usize = 3;

impl<'a> Places<'a> {
    /// Places with these constants kept, and the pivots that are checked when parameters are set.
    pub fn new(program: &'a Program, kept: &[NodeId]) -> Self {
        let graph = &program.graph;
        let mut kept = kept.to_vec();
        let mut index: FxHashMap<NodeId, usize> = kept
            .iter()
            .enumerate()
            .map(|(i, &node)| (node, i))
            .collect();
        for guard in &program.constant_guards {
            let node = guard.node();
            if is_hoisted(graph, node) && !index.contains_key(&node) {
                index.insert(node, kept.len());
                kept.push(node);
            }
        }
        Places {
            graph,
            starts: program.symbols(),
            kept,
            index,
        }
    }

    /// The kept constants.
    pub fn kept(&self) -> Vec<Edge> {
        self.kept.iter().map(|&node| Edge::of(node)).collect()
    }

    /// How many parameters there are.
    pub fn parameters(&self) -> usize {
        self.starts[1] - self.starts[0]
    }

    /// The graph.
    pub fn graph(&self) -> &'a Graph {
        self.graph
    }

    /// Where a node's value is found.
    pub fn of(&self, node: NodeId, time: Time) -> Place {
        match self.graph.node(node) {
            Node::Constant(_) => Place::Number,
            Node::Symbol(symbol) => self.symbol(symbol as usize),
            _ => match self.index.get(&node) {
                Some(&index) if time == Time::Call => Place::Kept(index),
                _ => Place::Temporary,
            },
        }
    }

    /// Whether a node is a number that is known when code is generated.
    pub fn is_number(&self, node: NodeId) -> bool {
        self.of(node, Time::Call) == Place::Number
    }

    /// The number of the parameter that a node is.
    pub fn parameter(&self, node: NodeId) -> Option<usize> {
        match self.of(node, Time::Parameters) {
            Place::Parameter(index) => Some(index),
            _ => None,
        }
    }

    fn symbol(&self, symbol: usize) -> Place {
        let starts = &self.starts;
        let Some(part) = (0..=ORDER.len()).find(|&i| (starts[i]..starts[i + 1]).contains(&symbol))
        else {
            return Place::Number;
        };
        let rest = symbol - starts[part];
        match part.checked_sub(1) {
            None => Place::Parameter(rest),
            Some(STATES) => {
                let [_, _, velocities, inputs, ..] = self.starts;
                Place::Argument(Argument::Velocities, inputs - velocities + rest)
            }
            Some(part) => Place::Argument(ORDER[part], rest),
        }
    }

    /// The name of the entry that an argument or a parameter is, as the user wrote it.
    pub fn entry(&self, node: NodeId) -> Option<&'a str> {
        match self.graph.node(node) {
            Node::Symbol(symbol) if symbol > 0 => {
                Some(self.graph.symbols()[symbol as usize].name.as_str())
            }
            _ => None,
        }
    }
}
