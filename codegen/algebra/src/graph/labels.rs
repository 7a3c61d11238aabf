//! Labels of nodes: the quantities that they stand for.
//!
//! The graph keeps labels for whoever builds it. They change no expression, no comparison and no order, and follow
//! expressions into other graphs.

use super::{Edge, Graph, Node, NodeId};
use std::num::NonZeroU32;

/// Number of bits for the entry of a list, counted from 1 so that no label is 0.
const ENTRY_BITS: u32 = 24;
/// Bits of the entry.
const ENTRY_MASK: u32 = (1 << ENTRY_BITS) - 1;

/// Label of a node. Its meaning belongs to the caller: a kind of quantity, and an entry of a list of that kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Label(NonZeroU32);

impl Label {
    /// Creates the label of an entry of a list; `None` if the list is too long.
    pub fn new(kind: u8, entry: usize) -> Option<Self> {
        let entry = u32::try_from(entry)
            .ok()
            .filter(|&entry| entry < ENTRY_MASK)?;
        NonZeroU32::new((u32::from(kind) << ENTRY_BITS) + entry + 1).map(Label)
    }

    /// Returns the kind of quantity.
    pub fn kind(self) -> usize {
        (self.0.get() >> ENTRY_BITS) as usize
    }

    /// Returns the entry of the list.
    pub fn entry(self) -> usize {
        (self.0.get() & ENTRY_MASK) as usize - 1
    }
}

impl Graph {
    /// Labels the nodes of expressions, except those that have a label already. Numbers and symbols need none.
    pub fn label(&mut self, edges: &[Edge], label: Option<Label>) {
        for edge in edges {
            let id = edge.node();
            if matches!(self.node(id), Node::Constant(_) | Node::Symbol(_)) {
                continue;
            }
            let place = id as usize;
            if self.labels.len() <= place {
                self.labels.resize(place + 1, None);
            }
            self.labels[place] = self.labels[place].or(label);
        }
    }

    /// Returns the label of a node.
    pub fn label_of(&self, id: NodeId) -> Option<Label> {
        self.labels.get(id as usize).copied().flatten()
    }

    /// Copies the label of a node of another graph to the expression that it has become in this one.
    pub(crate) fn keep_label(&mut self, from: &Graph, id: NodeId, edge: Edge) {
        let label = from.label_of(id);
        if label.is_some() {
            self.label(&[edge], label);
        }
    }

    /// Copies the labels of another graph, at the same points, to the nodes with the same values.
    pub(crate) fn keep_labels(&mut self, from: &Graph) {
        for id in 0..from.labels.len() as NodeId {
            let label = from.label_of(id);
            if label.is_some()
                && let Some(edge) = self.lookup(from.value(Edge::of(id)))
            {
                self.label(&[edge], label);
            }
        }
    }
}
