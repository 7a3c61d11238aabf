//! Labels of nodes: the quantities that they stand for.
//!
//! The graph keeps labels for whoever builds it. They change no expression, no comparison and no order, and follow
//! expressions into other graphs.

use super::{Edge, Graph, Node, NodeId};

/// Label of a node. Its meaning belongs to the caller: a kind of quantity, and an entry of a list of that kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Label {
    /// Kind of quantity.
    pub kind: u16,
    /// Entry of the list that belongs to the kind.
    pub entry: u32,
}

impl Graph {
    /// Labels the nodes of expressions, except those that have a label already. Numbers and symbols need none.
    pub fn label(&mut self, edges: &[Edge], label: Label) {
        for edge in edges {
            if !matches!(self.node(edge.node()), Node::Constant(_) | Node::Symbol(_)) {
                self.labels.entry(edge.node()).or_insert(label);
            }
        }
    }

    /// Returns the label of a node.
    pub fn label_of(&self, id: NodeId) -> Option<Label> {
        self.labels.get(&id).copied()
    }

    /// Copies the label of a node of another graph to the expression that it has become in this one.
    pub(crate) fn keep_label(&mut self, from: &Graph, id: NodeId, edge: Edge) {
        if let Some(label) = from.label_of(id) {
            self.label(&[edge], label);
        }
    }

    /// Copies the labels of another graph, at the same points, to the nodes with the same values.
    pub(crate) fn keep_labels(&mut self, from: &Graph) {
        for (&id, &label) in &from.labels {
            if let Some(edge) = self.lookup(from.value(Edge::of(id))) {
                self.label(&[edge], label);
            }
        }
    }
}
