//! Calls of functions that are given elsewhere.

use super::{Edge, Graph, Node, NodeId};
use crate::external::{Component, External};
use num_rational::BigRational;
use num_traits::One;
use std::sync::Arc;

/// A class of lists alone: whatever is in them, they are no numbers to be kept.
const LIST: u8 = 1 << 7;

impl Graph {
    /// The functions that are given elsewhere.
    pub fn externals(&self) -> &[External] {
        &self.externals
    }

    /// Says which functions are given elsewhere; components know them by their places.
    pub fn set_externals(&mut self, externals: Vec<External>) {
        self.externals = Arc::new(externals);
    }

    /// A component of a function at these numbers.
    pub fn external(&mut self, component: Component, arguments: &[Edge]) -> Edge {
        let zero = self.zero();
        let list = arguments.iter().fold(zero, |list, &a| self.listed(list, a));
        self.external_of(component, list)
    }

    /// A list with one number more; 0 is the empty list.
    pub(crate) fn listed(&mut self, rest: Edge, last: Edge) -> Edge {
        let value = self.lane.listed(self.value(rest), self.value(last));
        let class = self.class(rest.node()) | self.class(last.node()) | LIST;
        let node = Node::Listed(rest, last);
        match self.known(node, value, class) {
            Some(known) => known,
            None => self.push(node, value, class),
        }
    }

    /// A component of a function at what is listed. Of numbers alone it is constant at run time, but no number.
    pub(crate) fn external_of(&mut self, component: Component, list: Edge) -> Edge {
        let value = self.lane.external(component, self.value(list));
        let given = self.list(list).into_iter();
        let class = given.fold(self.free_class, |class, a| class | self.class(a.node()));
        let node = Node::External(component, list);
        match self.known(node, value, class) {
            Some(known) => known,
            None => self.push(node, value, class),
        }
    }

    /// The numbers in a list.
    pub fn list(&self, list: Edge) -> Vec<Edge> {
        let mut numbers = Vec::new();
        let mut rest = list;
        while let Node::Listed(before, last) = self.node(rest.node()) {
            numbers.push(last);
            rest = before;
        }
        numbers.reverse();
        numbers
    }

    /// The numbers in a list by their nodes, each with its sign.
    pub(crate) fn signed_list(&self, list: Edge) -> Vec<(NodeId, BigRational)> {
        let signed = |edge: Edge| match edge.is_negative() {
            true => (edge.node(), -BigRational::one()),
            false => (edge.node(), BigRational::one()),
        };
        self.list(list).into_iter().map(signed).collect()
    }

    /// The component and the list of a call.
    pub fn called_with(&self, edge: Edge) -> Option<(Component, Edge)> {
        match self.node(edge.node()) {
            Node::External(component, list) => Some((component, list)),
            _ => None,
        }
    }

    /// The first call of a function in expressions, of the least order at least: its component and its list.
    pub fn find_external(&self, edges: &[Edge], order: usize) -> Option<(Component, Edge)> {
        if self.externals.is_empty() {
            return None;
        }
        let found = self.reachable(edges).into_iter();
        let mut found = found.filter_map(|id| match self.node(id) {
            Node::External(component, list) => Some((component, list)),
            _ => None,
        });
        found.find(|(component, _)| component.order() >= order)
    }

    /// A call as text: `lift(a, b)[1]`, and `lift_by_a(a, b)[1]` where it is differentiated by its argument `a`.
    pub fn called(&self, component: Component, given: &str) -> String {
        let Some(external) = self.externals.get(usize::from(component.function)) else {
            return format!("f{}({given})", component.function);
        };
        let by = match component.order() {
            0 => String::new(),
            1 => {
                let argument = component.first().and_then(|j| external.arguments.get(j));
                argument.map_or("'".into(), |argument| format!("_by_{argument}"))
            }
            order => "'".repeat(order),
        };
        let part = match external.components {
            1 => String::new(),
            _ => format!("[{}]", component.component + 1),
        };
        format!("{}{by}({given}){part}", external.name)
    }
}
