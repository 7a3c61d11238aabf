//! Calls of external functions, which are defined elsewhere.

use super::{Edge, Graph, Node, NodeId};
use crate::external::{Component, External};
use num_rational::BigRational;
use num_traits::One;
use std::sync::Arc;

/// Class bit of lists, which prevents them from being kept as run-time constants, whatever their entries.
const LIST_CLASS: u8 = 1 << 7;

impl Graph {
    /// External functions that the graph knows.
    pub fn externals(&self) -> &[External] {
        &self.externals
    }

    /// Sets the external functions; components refer to them by index.
    pub fn set_externals(&mut self, externals: Vec<External>) {
        self.externals = Arc::new(externals);
    }

    /// Calls a component of an external function with these arguments.
    pub fn external(&mut self, component: Component, arguments: &[Edge]) -> Edge {
        let zero = self.zero();
        let list = arguments.iter().fold(zero, |list, &a| self.listed(list, a));
        self.external_of(component, list)
    }

    /// Appends a number to a list; 0 is the empty list.
    pub(crate) fn listed(&mut self, rest: Edge, last: Edge) -> Edge {
        let value = self.point.listed(self.value(rest), self.value(last));
        let class = self.class(rest.node()) | self.class(last.node()) | LIST_CLASS;
        let node = Node::Listed(rest, last);
        match self.find_equal(node, value, class) {
            Some(known) => known,
            None => self.push(node, value, class),
        }
    }

    /// Calls a component with a list of arguments. If all of them are numbers, the result is constant at
    /// run time, but it is not a number.
    pub(crate) fn external_of(&mut self, component: Component, list: Edge) -> Edge {
        let value = self.point.external(component, self.value(list));
        let given = self.list(list).into_iter();
        let class = given.fold(self.free_class, |class, a| class | self.class(a.node()));
        let node = Node::External(component, list);
        match self.find_equal(node, value, class) {
            Some(known) => known,
            None => self.push(node, value, class),
        }
    }

    /// Returns the numbers in a list.
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

    /// Returns the nodes of the numbers in a list, each with its sign ±1.
    pub(crate) fn signed_list(&self, list: Edge) -> Vec<(NodeId, BigRational)> {
        let signed = |edge: Edge| match edge.is_negative() {
            true => (edge.node(), -BigRational::one()),
            false => (edge.node(), BigRational::one()),
        };
        self.list(list).into_iter().map(signed).collect()
    }

    /// Returns the component and the list of a call, if the edge is a call.
    pub fn as_external_call(&self, edge: Edge) -> Option<(Component, Edge)> {
        match self.node(edge.node()) {
            Node::External(component, list) => Some((component, list)),
            _ => None,
        }
    }

    /// Finds the first call of an external function in the expressions that is differentiated at least
    /// `order` times (0 finds any call), and returns its component and its list of arguments.
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

    /// Writes a call as text: `lift(a, b)[1]`, or `lift_by_a(a, b)[1]` for its derivative by the argument
    /// `a`.
    pub fn external_call_text(&self, component: Component, given: &str) -> String {
        let Some(external) = self.externals.get(usize::from(component.function)) else {
            return format!("f{}({given})", component.function);
        };
        let by = match component.order() {
            0 => String::new(),
            1 => {
                let argument = component
                    .differentiated_by()
                    .and_then(|j| external.arguments.get(j));
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
