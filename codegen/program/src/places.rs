//! Places of values: where a statement finds each operand.

use super::schedule::is_hoisted;
use super::{Argument, Program};
use hamel_algebra::graph::{Edge, Graph, Node, NodeId};
use rustc_hash::FxHashMap;

/// Time at which a function runs.
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
    /// Entry of an argument.
    Argument(Argument, usize),
    /// Parameter, by its index among the parameters' symbols.
    Parameter(usize),
    /// Kept constant: computed when parameters are set, and stored.
    Kept(usize),
    /// Number known when code is generated.
    Number,
    /// Result of a statement.
    Temporary,
}

/// Places of all nodes of a program.
pub struct Places<'a> {
    graph: &'a Graph,
    /// First symbols of the parameters, x, ξ, u, z, ξ̇ and p, and the end of the last group.
    starts: [usize; 8],
    kept: Vec<NodeId>,
    index: FxHashMap<NodeId, usize>,
}

/// Arguments to which the symbols after the parameters belong, in the order of the symbols.
const ORDER: [Argument; 6] = [
    Argument::Coordinates,
    Argument::Velocities,
    Argument::Inputs,
    // z, which follows ξ in the argument.
    Argument::Velocities,
    Argument::Accelerations,
    Argument::Momenta,
];
/// Index of z in [`ORDER`].
const STATES: usize = 3;

impl<'a> Places<'a> {
    /// Assigns places for the given kept constants; pivots that are checked when parameters are set are kept, too.
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

    /// Returns the kept constants.
    pub fn kept(&self) -> Vec<Edge> {
        self.kept.iter().map(|&node| Edge::of(node)).collect()
    }

    /// Returns the number of parameters.
    pub fn parameters(&self) -> usize {
        self.starts[1] - self.starts[0]
    }

    /// Returns the graph of the program.
    pub fn graph(&self) -> &'a Graph {
        self.graph
    }

    /// Returns the place of a node's value for a function that runs at the given time.
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

    /// Returns whether a node is a number known when code is generated.
    pub fn is_number(&self, node: NodeId) -> bool {
        self.of(node, Time::Call) == Place::Number
    }

    /// Returns the index of the parameter that a node is, if it is one.
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

    /// Returns the user's name of an entry of an argument or of a parameter; `None` for other nodes.
    pub fn entry(&self, node: NodeId) -> Option<&'a str> {
        match self.graph.node(node) {
            Node::Symbol(symbol) if symbol > 0 => {
                Some(self.graph.symbols()[symbol as usize].name.as_str())
            }
            _ => None,
        }
    }
}
