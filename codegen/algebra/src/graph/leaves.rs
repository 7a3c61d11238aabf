//! Access to edges whose node is a leaf: a symbol or a number.

use super::{Edge, Graph, Node};
use num_rational::BigRational;

impl Graph {
    /// Returns the index of the symbol that an edge leads to, if its node is a symbol.
    pub fn as_symbol(&self, edge: Edge) -> Option<usize> {
        match self.nodes[edge.node() as usize] {
            Node::Symbol(index) => Some(index as usize),
            _ => None,
        }
    }

    /// Returns the indices of the symbols among the edges.
    pub fn symbol_places(&self, edges: &[Edge]) -> Vec<usize> {
        let place = |&edge: &Edge| self.as_symbol(edge);
        edges.iter().filter_map(place).collect()
    }

    /// Returns the number that an edge stands for, if it is a number.
    pub fn as_rational(&self, edge: Edge) -> Option<BigRational> {
        match self.nodes[edge.node() as usize] {
            Node::Constant(index) => {
                let value = &self.constants[index as usize];
                Some(if edge.is_negative() {
                    -value.clone()
                } else {
                    value.clone()
                })
            }
            _ => None,
        }
    }

    /// Whether an edge is a number.
    pub(super) fn is_number(&self, edge: Edge) -> bool {
        matches!(self.nodes[edge.node() as usize], Node::Constant(_))
    }
}
