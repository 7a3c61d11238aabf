//! Exact operation counts of straight-line code.

use hamel_algebra::function::Cost;
use hamel_algebra::graph::{Edge, Graph, Node, NodeId};

/// Operations of a function at run time; negation is free, parameters are hoisted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Count {
    /// Additions and subtractions, and what is as dear: absolute values, signs, choices.
    pub add: usize,
    /// Multiplications.
    pub mul: usize,
    /// Divisions.
    pub div: usize,
    /// Square roots.
    pub sqrt: usize,
    /// Pairs of sine and cosine of one angle (one of the two alone is a pair too).
    pub sincos: usize,
    /// Other functions.
    pub other: usize,
}

impl Count {
    /// mul + add + div.
    pub fn flops(self) -> usize {
        self.add + self.mul + self.div
    }

    /// A cost that weighs the dearer operations: a division 4, a root 5, functions 15.
    pub fn weight(self) -> usize {
        self.add + self.mul + 4 * self.div + 5 * self.sqrt + 15 * (self.sincos + self.other)
    }
}

/// The operations that the roots need at run time.
pub fn count(graph: &Graph, roots: &[Edge]) -> Count {
    count_nodes(graph, &graph.varying(roots))
}

/// The operations of a list of nodes.
pub fn count_nodes(graph: &Graph, nodes: &[NodeId]) -> Count {
    let mut count = Count::default();
    let (mut angles, mut calls) = (Vec::new(), Vec::new());
    for &id in nodes {
        match graph.node(id) {
            Node::Constant(_) | Node::Symbol(_) => {}
            Node::Add(..) | Node::Select(..) => count.add += 1,
            Node::Mul(..) => count.mul += 1,
            Node::Div(..) => count.div += 1,
            Node::Apply(function, a) => match function.row().cost {
                Cost::Root => count.sqrt += 1,
                Cost::Turn => angles.push(a.abs()),
                Cost::Quotient => count.div += 1,
                Cost::Product => count.mul += 1,
                Cost::Choice => count.add += 1,
                Cost::Other => count.other += 1,
            },
            Node::Atan2(..) => count.other += 1,
            Node::Listed(..) => {}
            // One call gives all components, another one all slopes.
            Node::External(component, list) => {
                calls.push((component.function, component.order(), list));
            }
        }
    }
    angles.sort_unstable();
    angles.dedup();
    count.sincos = angles.len();
    calls.sort_unstable();
    calls.dedup();
    count.other += calls.len();
    count
}
