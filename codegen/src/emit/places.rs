//! Where a value is found when a statement reads it.

use crate::algebra::graph::{Edge, Graph, Node, NodeId};
use crate::program::schedule::is_hoisted;
use crate::program::{Argument, Program};
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
    /// Numbers of parameters, x, ξ, u, ξ̇, p: the order of the symbols after π.
    sizes: [usize; 6],
    kept: Vec<NodeId>,
    index: FxHashMap<NodeId, usize>,
}

const ORDER: [Argument; 5] = [
    Argument::Coordinates,
    Argument::Velocities,
    Argument::Inputs,
    Argument::Accelerations,
    Argument::Momenta,
];

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
        let params: usize = program.params.iter().map(|group| group.len).sum();
        let n = program.n;
        let sizes = [params, program.nu, n, program.m, n, n];
        Places {
            graph,
            sizes,
            kept,
            index,
        }
    }

    /// The kept constants.
    pub fn kept(&self) -> Vec<Edge> {
        self.kept.iter().map(|&node| Edge::of(node)).collect()
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

    /// The number of the parameter that a node is.
    pub fn parameter(&self, node: NodeId) -> Option<usize> {
        match self.of(node, Time::Parameters) {
            Place::Parameter(index) => Some(index),
            _ => None,
        }
    }

    fn symbol(&self, symbol: usize) -> Place {
        let Some(mut rest) = symbol.checked_sub(1) else {
            return Place::Number;
        };
        for (part, &size) in self.sizes.iter().enumerate() {
            if rest < size {
                let argument = part.checked_sub(1).map(|part| ORDER[part]);
                return argument.map_or(Place::Parameter(rest), |argument| {
                    Place::Argument(argument, rest)
                });
            }
            rest -= size;
        }
        Place::Number
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
