//! Sums as chains of fused multiply-adds.
//!
//! A sum that is read only by another sum becomes part of it, and each product that is read once is fused:
//! (a b + c d) + (e f + g) takes three operations, not five. A chain starts with a term that is no product, and
//! continues at the places where its other terms are computed, so that they need not be kept.

use super::places::{Place, Places, Time};
use super::statements::{Operation, Statement};
use hamel_algebra::graph::{Edge, Graph, Node, NodeId};
use rustc_hash::{FxHashMap, FxHashSet};

/// Sums of a body.
#[derive(Clone, Debug, Default)]
pub struct Sums {
    /// Nodes without a statement of their own: sums, and the products and sums fused into them.
    pub absorbed: FxHashSet<NodeId>,
    /// Nodes whose names stand for a partial sum, or for the negative of a product, and not for their own values.
    pub partial: FxHashSet<NodeId>,
    /// Statements that follow the node at an index.
    pub after: FxHashMap<usize, Vec<Statement>>,
}

/// Term of a sum.
#[derive(Clone, Copy)]
struct Term {
    edge: Edge,
    product: Option<[Edge; 2]>,
    /// Index of the term's node, if it is computed in this body.
    at: Option<usize>,
}

/// Finds the sums among nodes, given children first. Nodes in `named` and `roots` keep their values.
pub fn sums<'a>(
    places: &Places,
    time: Time,
    nodes: &[NodeId],
    roots: impl Iterator<Item = &'a Edge>,
    named: &FxHashSet<NodeId>,
) -> Sums {
    let graph = places.graph();
    let mut uses: FxHashMap<NodeId, usize> = FxHashMap::default();
    let children = nodes.iter().flat_map(|&id| graph.node(id).children());
    for edge in children.chain(roots.copied()) {
        *uses.entry(edge.node()).or_default() += 1;
    }
    let once = |id: &NodeId| {
        places.of(*id, time) == Place::Temporary && uses.get(id) == Some(&1) && !named.contains(id)
    };
    let single: FxHashSet<NodeId> = nodes.iter().copied().filter(once).collect();
    let whole = one_sign_each(graph, nodes, &single);
    let index: FxHashMap<NodeId, usize> =
        nodes.iter().enumerate().map(|(i, &id)| (id, i)).collect();
    let mut sums = Sums::default();
    // Readers come last, so that, going backwards, a sum is visited before the sums within it.
    for (root_at, &root) in nodes.iter().enumerate().rev() {
        if !matches!(graph.node(root), Node::Add(..)) || !sums.absorbed.insert(root) {
            continue;
        }
        // Flattening a difference of sums that share a term would add the term and subtract it again.
        let whole = whole.contains(&root);
        let (mut terms, mut names, mut absorbed) = (Vec::new(), vec![root], Vec::new());
        let mut stack = vec![Edge::of(root)];
        while let Some(edge) = stack.pop() {
            let id = edge.node();
            let at = index.get(&id).copied();
            match graph.node(id) {
                Node::Add(a, b) if id == root || whole && single.contains(&id) => {
                    if id != root {
                        names.push(id);
                    }
                    absorbed.push(id);
                    let sign = edge.is_negative();
                    stack.extend([b.signed(sign), a.signed(sign)]);
                }
                Node::Mul(a, b) if single.contains(&id) => {
                    absorbed.push(id);
                    let product = Some([a.signed(edge.is_negative()), b]);
                    terms.push(Term { edge, product, at });
                }
                _ => {
                    let product = None;
                    terms.push(Term { edge, product, at });
                }
            }
        }
        sums.absorbed.extend(absorbed);
        sums.partial.extend(&names[1..]);
        let products = terms
            .iter()
            .filter(|term| term.product.is_some() && term.edge.is_negative());
        sums.partial.extend(products.map(|term| term.edge.node()));
        // Operands come before their readers.
        for (at, statement) in chain(terms, names, root_at).into_iter().rev() {
            sums.after.entry(at).or_default().insert(0, statement);
        }
    }
    sums
}

/// Finds the sums in which no term occurs with both signs once the sums that only they read are flattened into them.
fn one_sign_each(graph: &Graph, nodes: &[NodeId], single: &FxHashSet<NodeId>) -> FxHashSet<NodeId> {
    let mut found = FxHashSet::default();
    // Terms of sums that their reader has not yet taken over, with their signs; all signs are opposite if `opposite`.
    let mut signs: FxHashMap<NodeId, (FxHashMap<NodeId, bool>, bool)> = FxHashMap::default();
    for &id in nodes {
        let Node::Add(a, b) = graph.node(id) else {
            continue;
        };
        let mut part = |edge: Edge| {
            let (node, negative) = (edge.node(), edge.is_negative());
            if single.contains(&node) && matches!(graph.node(node), Node::Add(..)) {
                let (terms, opposite) = signs.remove(&node)?;
                return Some((terms, opposite != negative));
            }
            Some((FxHashMap::from_iter([(node, negative)]), false))
        };
        let (Some(one), Some(other)) = (part(a), part(b)) else {
            continue;
        };
        // The shorter list is merged into the longer one, so that terms are moved rarely.
        let (mut longer, shorter) = match one.0.len() < other.0.len() {
            true => (other, one),
            false => (one, other),
        };
        let turned = longer.1 != shorter.1;
        let mut terms = shorter.0.into_iter();
        if terms.all(|(node, sign)| {
            let sign = sign != turned;
            *longer.0.entry(node).or_insert(sign) == sign
        }) {
            found.insert(id);
            signs.insert(id, longer);
        }
    }
    found
}

/// Returns the statements of a sum, each with the index of the node that it follows; the last one defines the first of
/// the names.
fn chain(mut terms: Vec<Term>, mut names: Vec<NodeId>, root: usize) -> Vec<(usize, Statement)> {
    terms.sort_by_key(|term| (term.product.is_some(), term.at));
    let Some((&start, _)) = terms.split_first() else {
        return Vec::new();
    };
    if let Some(rest) = terms.get_mut(1..) {
        rest.sort_by_key(|term| term.at);
    }
    let earliest = terms
        .iter()
        .filter_map(|term| term.at)
        .min()
        .unwrap_or(root);
    let mut statements = Vec::new();
    let mut at = start.at.unwrap_or(earliest);
    let mut total = start.edge;
    if let Some([a, b]) = start.product {
        let node = start.edge.node();
        statements.push((at, binding(Operation::Multiply(a, b), node)));
        total = Edge::of(node);
    }
    for term in terms.iter().skip(1) {
        at = at.max(term.at.unwrap_or(earliest));
        let operation = match term.product {
            Some([a, b]) => Operation::Fused(a, b, total),
            None => Operation::Add(total, term.edge),
        };
        let Some(node) = names.pop() else {
            continue;
        };
        statements.push((at, binding(operation, node)));
        total = Edge::of(node);
    }
    statements
}

fn binding(operation: Operation, node: NodeId) -> Statement {
    Statement {
        operation,
        results: [Some(node), None],
    }
}
