//! Exact operation counts of straight-line code.

use hamel_algebra::function::Cost;
use hamel_algebra::graph::{Edge, Graph, Node, NodeId};

/// Number of operations of a function at run time, by kind.
///
/// Negation is free, and whatever depends on parameters alone is hoisted and does not count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Count {
    /// Additions, subtractions, and operations of the same cost: absolute values, signs, selections.
    pub add: usize,
    /// Multiplications.
    pub mul: usize,
    /// Divisions.
    pub div: usize,
    /// Square roots.
    pub sqrt: usize,
    /// Pairs of sine and cosine of one angle; a sine or cosine alone counts as a pair.
    pub sincos: usize,
    /// Other functions.
    pub other: usize,
}

impl Count {
    /// Returns mul + add + div.
    pub fn flops(self) -> usize {
        self.add + self.mul + self.div
    }

    /// Returns a weighted cost: a division counts 4, a square root 5, other functions 15.
    pub fn weight(self) -> usize {
        self.add + self.mul + 4 * self.div + 5 * self.sqrt + 15 * (self.sincos + self.other)
    }
}

/// Counts the operations that evaluate the roots at run time.
pub fn count(graph: &Graph, roots: &[Edge]) -> Count {
    count_nodes(graph, &graph.varying_nodes(roots))
}

/// Counts the operations of a list of nodes.
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
                Cost::SineOrCosine => angles.push(a.abs()),
                Cost::Quotient => count.div += 1,
                Cost::Product => count.mul += 1,
                Cost::Comparison => count.add += 1,
                Cost::Other => count.other += 1,
            },
            Node::Atan2(..) => count.other += 1,
            Node::Listed(..) => {}
            // One call returns all components of the value, another call all slopes.
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
