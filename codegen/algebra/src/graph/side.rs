//! Choices that depend on the sign of a value.

use super::{Edge, Graph, Node, NodeId};
use crate::function::Law;
use num_rational::BigRational;
use num_traits::Zero;
use std::cmp::Ordering;

impl Graph {
    /// Selects a if c > 0, else b.
    pub fn select(&mut self, c: Edge, a: Edge, b: Edge) -> Edge {
        if let Some(side) = self.side(c) {
            return if side == Ordering::Greater { a } else { b };
        }
        // The sign of the first branch that is not 0 is moved out of the selection.
        let negative = match a == self.zero() {
            true => b.is_negative(),
            false => a.is_negative(),
        };
        let (a, b) = (a.signed(negative), b.signed(negative));
        let other = self.value(b);
        let value = other + self.point.positive(self.value(c)) * (self.value(a) - other);
        let node = Node::Select(c, a, b);
        let class = node
            .children()
            .fold(0, |class, child| class | self.class(child.node()));
        let edge = match self.find_equal(node, value, class) {
            Some(known) => known,
            None => self.push(node, value, class),
        };
        edge.signed(negative)
    }

    /// Returns the expression whose sign decides the value of a node, if the node is a selection or a
    /// function of the sign.
    pub fn condition_of(&self, id: NodeId) -> Option<Edge> {
        match self.node(id) {
            Node::Select(by, ..) => Some(by),
            Node::Apply(function, by) if function.row().law == Law::Side => Some(by),
            _ => None,
        }
    }

    /// Compares a number with 0; `None` if the result is not certain.
    pub(super) fn side(&mut self, edge: Edge) -> Option<Ordering> {
        if let Some(number) = self.as_rational(edge) {
            return Some(number.cmp(&BigRational::zero()));
        }
        if self.class(edge.node()) != 0 {
            return None;
        }
        let bounds = self
            .real_values
            .number(&self.nodes, &self.constants, edge)?;
        bounds.side()
    }
}
