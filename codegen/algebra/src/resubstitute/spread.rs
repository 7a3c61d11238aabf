//! Elimination of sums that are used only as factors: where x (a + b) + c is needed and x a + c is computed
//! anyway, adding x b to the latter is as short, and a + b is not needed.

use crate::graph::{Graph, canonical};
use crate::node::{Edge, Node, NodeId};
use crate::residue_pair::ResiduePair;
use rustc_hash::{FxHashMap, FxHashSet};

/// A sum that is no longer needed once all these terms are computed without it.
pub(super) struct Spread {
    pub terms: Vec<Term>,
}

/// A node `whole`, x (a + b) + c, as the sum of `rest`, x a + c, and `part`, x b.
pub(super) struct Term {
    pub whole: NodeId,
    pub rest: Edge,
    pub part: Edge,
}

/// Finds the sums that can be eliminated among the nodes that some roots need, children first. The parts
/// are entered into the graph.
pub(super) fn spreads(graph: &mut Graph, roots: &[Edge], order: &[NodeId]) -> Vec<Spread> {
    let found = Nodes::new(graph, roots, order).spreads();
    let parts = found.into_iter().map(|(moved, terms)| Spread {
        terms: terms
            .into_iter()
            .map(|(whole, x, sign, rest)| Term {
                whole,
                rest,
                part: graph.mul(x, moved).signed(sign),
            })
            .collect(),
    });
    parts.collect()
}

/// The whole, the factor x, whether the product is negative in the whole, and the rest.
type Found = (NodeId, Edge, bool, Edge);

struct Nodes<'a> {
    graph: &'a Graph,
    order: &'a [NodeId],
    roots: FxHashSet<NodeId>,
    users: FxHashMap<NodeId, Vec<NodeId>>,
    by_value: FxHashMap<ResiduePair, NodeId>,
}

impl<'a> Nodes<'a> {
    fn new(graph: &'a Graph, roots: &[Edge], order: &'a [NodeId]) -> Self {
        let mut users: FxHashMap<NodeId, Vec<NodeId>> = FxHashMap::default();
        let mut by_value = FxHashMap::default();
        for &id in order {
            for child in graph.node(id).children() {
                users.entry(child.node()).or_default().push(id);
            }
            by_value
                .entry(canonical(graph.value(Edge::of(id))).0)
                .or_insert(id);
        }
        Nodes {
            graph,
            order,
            roots: roots.iter().map(|root| root.node()).collect(),
            users,
            by_value,
        }
    }

    /// Returns for each sum that is used only as a factor the operand that remains to be multiplied, and
    /// the terms.
    fn spreads(&self) -> Vec<(Edge, Vec<Found>)> {
        let sums = self.order.iter().filter(|id| !self.graph.is_free(**id));
        let each = sums.filter_map(|&sum| {
            let Node::Add(a, b) = self.graph.node(sum) else {
                return None;
            };
            let products = self.products(sum)?;
            let above = self.above(sum);
            [a, b].into_iter().find_map(|moved| {
                let terms = products.iter().map(|&(x, product)| {
                    let wholes = self.users.get(&product)?.iter();
                    let terms = wholes.map(|&whole| self.term(whole, product, x, moved, &above));
                    terms.collect::<Option<Vec<_>>>()
                });
                let terms: Vec<Vec<Found>> = terms.collect::<Option<_>>()?;
                Some((moved, terms.concat()))
            })
        });
        each.collect()
    }

    /// Returns the products in which a sum is a factor, each with the other factor; `None` if the sum has
    /// any other use, or if the sum or one of the products is a root.
    fn products(&self, sum: NodeId) -> Option<Vec<(Edge, NodeId)>> {
        let kept = |id: &NodeId| self.roots.contains(id);
        let users = self.users.get(&sum).filter(|_| !kept(&sum))?;
        let factors = users.iter().map(|&user| match self.graph.node(user) {
            Node::Mul(a, b) if a != b && !kept(&user) => {
                Some((if a.node() == sum { b } else { a }, user))
            }
            _ => None,
        });
        factors.collect()
    }

    /// Returns the nodes that depend on a sum, including the sum.
    fn above(&self, sum: NodeId) -> FxHashSet<NodeId> {
        let mut above = FxHashSet::from_iter([sum]);
        for &id in self.order {
            let mut children = self.graph.node(id).children();
            if children.any(|child| above.contains(&child.node())) {
                above.insert(id);
            }
        }
        above
    }

    fn term(
        &self,
        whole: NodeId,
        product: NodeId,
        x: Edge,
        moved: Edge,
        above: &FxHashSet<NodeId>,
    ) -> Option<Found> {
        let Node::Add(a, b) = self.graph.node(whole) else {
            return None;
        };
        let sign = match (a.node() == product, b.node() == product) {
            (true, false) => a.is_negative(),
            (false, true) => b.is_negative(),
            _ => return None,
        };
        let part = self.graph.value(x) * self.graph.value(moved);
        let whole_value = self.graph.value(Edge::of(whole));
        let value = if sign {
            whole_value + part
        } else {
            whole_value - part
        };
        let rest = *self.by_value.get(&canonical(value).0)?;
        let edge = Edge::of(rest).signed(self.graph.value(Edge::of(rest)) != value);
        (!above.contains(&rest)).then_some((whole, x, sign, edge))
    }
}
