//! Resubstitution: a node that is the sum or product of two other nodes which are computed anyway is
//! computed from these, and the nodes that only its old definition needed are removed.
//!
//! Values modulo p decide: for every node n and every node x that does not depend on n, a node of value n −
//! x, n + x or n / x is looked up. Sums that are used only as factors are eliminated where that adds no
//! other operation. Thus the number of operations can only decrease.

mod sieve;
mod spread;

use crate::graph::{Graph, canonical};
use crate::node::{Edge, Node, NodeId};
use crate::prime::Residue;
use crate::real_enclosure::RealValues;
use crate::residue_pair::ResiduePair;
use crate::transplant::{merge, read, rebuild};
use rustc_hash::FxHashMap;
use sieve::Sieve;
use spread::{Spread, spreads};
use std::cell::OnceCell;

/// Largest number of varying nodes; larger expressions are left as they are.
const MAX_VARYING_NODES: usize = 400;

/// Rebuilds the roots in `base`, a graph with the same symbols, with fewer operations if some can be saved;
/// `None` if nothing was found.
pub fn resubstitute(graph: &Graph, roots: &[Edge], base: &Graph) -> Option<(Graph, Vec<Edge>)> {
    // This is checked before the inverses of many values are computed.
    let varying = |id: &&NodeId| !graph.is_free(**id);
    if graph.reachable(roots).iter().filter(varying).count() > MAX_VARYING_NODES {
        return None;
    }
    let mut graph = graph.clone();
    let order = graph.reachable(roots);
    let spreads = spreads(&mut graph, roots, &order);
    let mut network = Network::new(&graph, roots, &spreads);
    let mut improved = network.improve();
    while network.spread(&spreads) {
        improved = true;
        network.improve();
    }
    if !improved {
        return None;
    }
    let mut result = base.clone();
    let edges = network.rebuild(&mut result);
    result.keep_labels(&graph);
    Some((result, edges))
}

/// Current definitions of the nodes that vary at run time.
struct Network<'a> {
    graph: &'a Graph,
    roots: &'a [Edge],
    definitions: Vec<Option<Node>>,
    /// Real samples, if square roots are involved.
    real_values: Option<RealValues>,
    /// 1 / value of every node whose value has an inverse.
    inverses: Vec<Option<ResiduePair>>,
    /// Nodes by their values, up to sign.
    by_value: FxHashMap<ResiduePair, Vec<NodeId>>,
    sieve: Sieve,
    nodes: Vec<NodeId>,
    /// Pairs of nodes whose sum, difference or product each node is, computed on demand.
    pairs: Vec<OnceCell<Vec<(NodeId, NodeId)>>>,
}

impl<'a> Network<'a> {
    fn new(graph: &'a Graph, roots: &'a [Edge], spreads: &[Spread]) -> Self {
        let terms = spreads.iter().flat_map(|spread| &spread.terms);
        let parts: Vec<Edge> = terms.map(|term| term.part).collect();
        let nodes = graph.reachable(&[roots, &parts].concat());
        let mut definitions = vec![None; graph.len()];
        for &id in &nodes {
            definitions[id as usize] = Some(graph.node(id));
        }
        let value = |&id: &NodeId| graph.value(Edge::of(id));
        let mut inverses = vec![None; graph.len()];
        for (&id, inverse) in nodes
            .iter()
            .zip(ResiduePair::inverses(nodes.iter().map(value)))
        {
            inverses[id as usize] = inverse;
        }
        let mut by_value: FxHashMap<ResiduePair, Vec<NodeId>> = FxHashMap::default();
        for id in &nodes {
            by_value
                .entry(canonical(value(id)).0)
                .or_default()
                .push(*id);
        }
        Network {
            graph,
            roots,
            real_values: graph.compute_samples(&nodes),
            sieve: Sieve::new(nodes.iter().map(value)),
            inverses,
            by_value,
            definitions,
            pairs: vec![OnceCell::new(); graph.len()],
            nodes,
        }
    }

    /// Returns the pairs (x, y) such that x + y, y − x or x y has the value of a node, up to signs. Values
    /// do not depend on definitions, so the pairs are looked up only once.
    fn pairs(&self, id: NodeId) -> &[(NodeId, NodeId)] {
        self.pairs[id as usize].get_or_init(|| {
            let target = self.value(id);
            let mut pairs = Vec::new();
            for &x in &self.nodes {
                let Some(inverse) = self.inverses[x as usize] else {
                    continue;
                };
                let value = self.value(x);
                let mut look = |part, whole: &dyn Fn() -> ResiduePair| {
                    if self.sieve.passes(part)
                        && let Some(found) = self.by_value.get(&canonical(whole()).0)
                    {
                        pairs.extend(found.iter().map(|&y| (x, y)));
                    }
                };
                look(target.0 - value.0, &|| target - value);
                look(target.0 + value.0, &|| target + value);
                look(target.0 * inverse.0, &|| target * inverse);
            }
            pairs
        })
    }

    /// Whether a node is a sum or product of nodes other than its present operands.
    fn is_replaceable(&self, id: NodeId) -> bool {
        let mut children = self.children(id);
        let own = (children.next(), children.next());
        let mut pairs = self.pairs(id).iter();
        pairs.any(|&(x, y)| own != (Some(x), Some(y)) && own != (Some(y), Some(x)))
    }

    fn children(&self, id: NodeId) -> impl Iterator<Item = NodeId> + use<> {
        self.definitions[id as usize]
            .into_iter()
            .flat_map(Node::children)
            .map(Edge::node)
    }

    /// Returns the nodes that the roots need, children first; `leaf` and run-time constants count as given.
    fn live_nodes(&self, leaf: Option<NodeId>) -> Vec<NodeId> {
        self.below(self.roots, leaf)
    }

    fn below(&self, roots: &[Edge], leaf: Option<NodeId>) -> Vec<NodeId> {
        let mut order = Vec::new();
        let mut seen = vec![false; self.definitions.len()];
        let mut stack: Vec<(NodeId, bool)> = roots
            .iter()
            .rev()
            .map(|root| (root.node(), false))
            .collect();
        while let Some((id, done)) = stack.pop() {
            if done {
                order.push(id);
            } else if !std::mem::replace(&mut seen[id as usize], true) {
                stack.push((id, true));
                if Some(id) != leaf && !self.graph.is_free(id) {
                    stack.extend(self.children(id).map(|child| (child, false)));
                }
            }
        }
        order
    }

    /// Number of run-time operations in a set of nodes.
    fn cost(&self, nodes: &[NodeId]) -> usize {
        let costs = |id: &&NodeId| {
            !self.graph.is_free(**id)
                && matches!(
                    self.definitions[**id as usize],
                    Some(Node::Add(..) | Node::Mul(..) | Node::Div(..))
                )
        };
        nodes.iter().filter(costs).count()
    }

    /// Replaces definitions until no replacement saves an operation; returns whether one did.
    fn improve(&mut self) -> bool {
        let mut improved = false;
        loop {
            let order = self.live_nodes(None);
            let total = self.cost(&order);
            let mut uses: FxHashMap<NodeId, usize> = FxHashMap::default();
            for child in order
                .iter()
                .filter(|id| !self.graph.is_free(**id))
                .flat_map(|&id| self.children(id))
            {
                *uses.entry(child).or_default() += usize::from(!self.graph.is_free(child));
            }
            let found = order.iter().find_map(|&id| {
                let operation = matches!(
                    self.definitions[id as usize],
                    Some(Node::Add(..) | Node::Mul(..))
                );
                if self.graph.is_free(id)
                    || !operation
                    || !self.children(id).any(|child| uses.get(&child) == Some(&1))
                    || !self.is_replaceable(id)
                {
                    return None;
                }
                let rest = self.live_nodes(Some(id));
                // The node itself is among the rest, and keeps its cost.
                (self.cost(&rest) < total)
                    .then(|| self.other_definition(id, &rest))
                    .flatten()
                    .map(|node| (id, node))
            });
            let Some((id, node)) = found else {
                return improved;
            };
            self.definitions[id as usize] = Some(node);
            improved = true;
        }
    }

    /// Eliminates a sum where that saves an operation; returns whether one was found.
    fn spread(&mut self, spreads: &[Spread]) -> bool {
        let total = self.cost(&self.live_nodes(None));
        spreads
            .iter()
            .any(|spread| self.eliminate_sum(spread, total))
    }

    /// Computes all terms without their sum if that takes fewer than `total` operations; returns whether it
    /// does.
    fn eliminate_sum(&mut self, spread: &Spread, total: usize) -> bool {
        let ends = spread.terms.iter().flat_map(|term| [term.rest, term.part]);
        let below = self.below(&ends.collect::<Vec<_>>(), None);
        let sums = spread.terms.iter().map(|term| {
            let node = Node::Add(term.rest, term.part);
            let agrees = |real_values: &RealValues| !real_values.refuses(term.whole, node);
            let usable =
                !below.contains(&term.whole) && self.real_values.as_ref().is_none_or(agrees);
            usable.then_some((term.whole, node))
        });
        let Some(sums) = sums.collect::<Option<Vec<_>>>() else {
            return false;
        };
        let before = self.definitions.clone();
        for (whole, node) in sums {
            self.definitions[whole as usize] = Some(node);
        }
        let better = self.cost(&self.live_nodes(None)) < total;
        if !better {
            self.definitions = before;
        }
        better
    }

    /// Finds a sum or product of two nodes among `rest` that has the value of `id`.
    fn other_definition(&self, id: NodeId, rest: &[NodeId]) -> Option<Node> {
        // Nodes that depend on `id` cannot define it; children come first in the order.
        let mut above = vec![false; self.definitions.len()];
        above[id as usize] = true;
        for &node in rest {
            above[node as usize] |= self.children(node).any(|child| above[child as usize]);
        }
        let usable: Vec<NodeId> = rest
            .iter()
            .copied()
            .filter(|&node| !above[node as usize])
            .collect();
        let mut places = vec![0; self.definitions.len()];
        for (place, &node) in usable.iter().enumerate() {
            places[node as usize] = place + 1;
        }
        // The last usable node with a value.
        let signed = |value: ResiduePair| -> Option<Edge> {
            let nodes = self.by_value.get(&canonical(value).0)?.iter();
            let last = nodes.max_by_key(|&&node| places[node as usize])?;
            let edge = Edge::of(*last).signed(self.value(*last) != value);
            (places[*last as usize] > 0).then_some(edge)
        };
        let target = self.value(id);
        let pairs = self.pairs(id);
        let agrees = |node: &Node| {
            let refused = self
                .real_values
                .as_ref()
                .map(|real_values| real_values.refuses(id, *node));
            !refused.unwrap_or(false)
        };
        let paired = usable
            .iter()
            .filter(|&&x| pairs.iter().any(|pair| pair.0 == x));
        paired.copied().find_map(|x| {
            let inverse = self.inverses[x as usize]?;
            let value = self.value(x);
            let difference = target - value;
            if let Some(y) = signed(difference) {
                return Some(Node::Add(Edge::of(x), y)).filter(agrees);
            }
            let sum = target + value;
            if let Some(y) = signed(sum) {
                return Some(Node::Add(-Edge::of(x), y)).filter(agrees);
            }
            let quotient = target * inverse;
            let y = signed(quotient).filter(|y| !y.is_negative())?;
            Some(Node::Mul(Edge::of(x), y)).filter(agrees)
        })
    }

    fn value(&self, id: NodeId) -> ResiduePair {
        self.graph.value(Edge::of(id))
    }

    fn rebuild(&self, into: &mut Graph) -> Vec<Edge> {
        let mut image = vec![Edge::of(0); self.graph.len()];
        let alive = self.live_nodes(None);
        let is_constant = |id: &&NodeId| self.graph.is_free(**id);
        let constants: Vec<Edge> = alive
            .iter()
            .filter(is_constant)
            .map(|&id| Edge::of(id))
            .collect();
        let moved = rebuild(self.graph, into, &constants);
        for (edge, made) in constants.iter().zip(moved) {
            image[edge.node() as usize] = made;
        }
        for id in alive.into_iter().filter(|&id| !self.graph.is_free(id)) {
            into.announce_copy(self.graph, id);
            image[id as usize] = match self.definitions[id as usize] {
                Some(Node::Symbol(index)) => Edge::of(into.symbols()[index as usize].node),
                Some(node) => merge(into, node.map_children(|child| read(&image, child))),
                None => continue,
            };
        }
        self.roots.iter().map(|&root| read(&image, root)).collect()
    }
}
