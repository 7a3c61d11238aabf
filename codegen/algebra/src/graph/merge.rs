//! Merging of nodes: an expression gets an existing node or a new one.

use super::{Edge, Function, Graph, Node, NodeId};
use crate::real_enclosure::RealValues;
use crate::residue_pair::ResiduePair;

impl Graph {
    /// Returns an existing node with this value, or the small rational that has it. An expression that is
    /// constant at run time is not replaced by one that is not, and no expression is replaced by one that
    /// is a different number according to the real samples.
    pub(super) fn find_equal(&mut self, node: Node, value: ResiduePair, class: u8) -> Option<Edge> {
        let known = match self.lookup(value) {
            Some(edge) => {
                let improves = class & !self.free_class == 0 && !self.is_free(edge.node());
                (!improves).then_some(edge)?
            }
            None => {
                // An operation on a number and another operand is a number only if the other operand is
                // one.
                if class != 0 && node.children().any(|child| self.is_number(child)) {
                    return None;
                }
                if value == self.copied || value == -self.copied {
                    return None;
                }
                let (n, d) = value.to_small_rational(29)?;
                is_plain(n, d).then(|| self.ratio(n, d))?
            }
        };
        (!self.disputes(node, class, known)).then_some(known)
    }

    /// Whether real numbers disprove that a node equals `known`, which has the same value modulo the
    /// primes.
    pub(crate) fn disputes(&mut self, node: Node, class: u8, known: Edge) -> bool {
        if self.node(known.node()) == node && !known.is_negative() {
            return false;
        }
        let (nodes, constants) = (&self.nodes, &self.constants);
        // Numbers are not protected by a random point, so they are compared with certainty.
        if class == 0 && self.classes[known.node() as usize] == 0 {
            return self
                .real_values
                .disputes_number(nodes, constants, node, known);
        }
        self.real_values.disputes(nodes, constants, node, known)
    }

    /// Returns the real samples of all nodes, if one of the given nodes contains a square root.
    pub(crate) fn compute_samples(&self, ids: &[NodeId]) -> Option<RealValues> {
        self.real_values.filled(&self.nodes, &self.constants, ids)
    }

    /// Finds an existing number whose square is the given number.
    pub(super) fn known_number_root(&mut self, square: Edge) -> Option<Edge> {
        if self.class(square.node()) != 0 {
            return None;
        }
        let root = self.value(square).sqrt()?;
        let node = Node::Apply(Function::Sqrt, square);
        for value in [root, root.flipped()] {
            let Some(known) = self.lookup(value) else {
                continue;
            };
            for known in [known, -known] {
                if self.class(known.node()) == 0 && !self.disputes(node, 0, known) {
                    return Some(known);
                }
            }
        }
        None
    }

    /// Adds a node that later expressions do not merge with.
    pub(crate) fn push_unmerged(&mut self, node: Node) -> Edge {
        if let Node::Apply(function, argument) = node {
            self.note_content(function, argument);
        }
        let id = self.nodes.len() as NodeId;
        let class = node
            .children()
            .fold(0, |class, child| class | self.class(child.node()));
        self.nodes.push(node);
        self.real_values.push(node);
        self.values.push(ResiduePair::ZERO);
        self.classes.push(class);
        Edge::of(id)
    }

    /// Adds a sum, product or quotient that does not merge with a node of equal value that is computed in
    /// another way.
    pub(crate) fn push_distinct(&mut self, node: Node) -> Edge {
        let value = |edge: Edge| self.value(edge);
        let value = match node {
            Node::Add(a, b) => value(a) + value(b),
            Node::Mul(a, b) => value(a) * value(b),
            Node::Div(a, b) => value(a) * value(b).inv().unwrap_or(value(b)),
            _ => return self.push_unmerged(node),
        };
        match self.lookup(value) {
            Some(edge) if self.node(edge.node()) == node => edge,
            _ => {
                let class = node
                    .children()
                    .fold(0, |c, child| c | self.class(child.node()));
                self.push(node, value, class)
            }
        }
    }

    /// Announces that the next node is a copy of a node of another graph at the same points. If that node
    /// is not a number, the copy is none either, which saves the search for the number.
    pub(crate) fn announce_copy(&mut self, from: &Graph, id: NodeId) {
        self.copied = from.values[id as usize];
    }

    pub(crate) fn lookup(&self, value: ResiduePair) -> Option<Edge> {
        let (key, negative) = canonical(value);
        self.by_value.get(&key).map(|edge| edge.signed(negative))
    }

    pub(super) fn push(&mut self, node: Node, value: ResiduePair, class: u8) -> Edge {
        let id = self.nodes.len() as NodeId;
        self.nodes.push(node);
        self.real_values.push(node);
        self.values.push(value);
        self.classes.push(class);
        let (key, negative) = canonical(value);
        let edge = Edge::of(id).signed(negative);
        let known = *self.by_value.entry(key).or_insert(edge);
        if !self.is_free(known.node()) && self.is_free(id) {
            self.by_value.insert(key, edge);
        }
        Edge::of(id)
    }
}

/// Whether n/d is a fraction that descriptions lead to: small, or with a denominator of factors 2, 3, 5 and
/// 7. An irrational number, which has the same value at all points, passes by chance only once in a
/// million.
fn is_plain(n: i64, d: i64) -> bool {
    let mut rest = d;
    for factor in [2, 3, 5, 7] {
        while rest % factor == 0 {
            rest /= factor;
        }
    }
    rest == 1 || (n.abs() < 1 << 16 && d < 1 << 16)
}

/// Returns the representative of {v, −v}, and whether v is its negative.
pub(crate) fn canonical(value: ResiduePair) -> (ResiduePair, bool) {
    let negative = value.is_negative();
    (if negative { -value } else { value }, negative)
}
