//! Selection of the cheapest of several equivalent computations.

use super::numerical_loss::NumericalLoss;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::resubstitute::resubstitute;
use hamel_algebra::transplant::{graft, rebuild};
use hamel_program::count::count;
use std::borrow::Cow;

/// Largest number of velocities for which all routes, elimination orders and axes are tried.
pub(crate) const MAX_SEARCHED_VELOCITIES: usize = 8;
/// Number of nodes of a graph from which on the search is short: computations are not rebuilt in the graph to share
/// its expressions, and two elimination orders are tried alone. Each trial would take as long as the graph is large.
pub(crate) const SHORT_SEARCH_NODES: usize = 3000;

/// The cheapest of several computations of the same expressions, of those offered so far.
///
/// It stays in the graph in which it was built, so that its expressions are not replaced by longer
/// ones of other functions.
#[derive(Default)]
pub struct Candidates<'a> {
    numerical_loss: NumericalLoss,
    best: Option<Computed<'a>>,
}

struct Computed<'a> {
    /// Loss of digits, as far as it counts, and weight of the operations.
    cost: (usize, usize),
    graph: Cow<'a, Graph>,
    roots: Vec<Edge>,
}

impl<'a> Candidates<'a> {
    /// Creates an empty collection; candidates are compared by operations and by their loss of digits.
    pub fn new(numerical_loss: &NumericalLoss) -> Self {
        Candidates {
            numerical_loss: numerical_loss.clone(),
            best: None,
        }
    }

    fn cost(&self, graph: &Graph, roots: &[Edge]) -> (usize, usize) {
        let loss = self.numerical_loss.loss(graph, roots, &[]);
        (loss, count(graph, roots).weight())
    }

    /// Adds a candidate in a graph that others share.
    pub fn offer(&mut self, graph: &'a Graph, roots: Vec<Edge>) {
        let cost = self.cost(graph, &roots);
        self.keep(cost, Cow::Borrowed(graph), roots);
    }

    /// Adds a candidate in a graph of its own.
    pub fn offer_own(&mut self, graph: Graph, roots: Vec<Edge>) {
        let cost = self.cost(&graph, &roots);
        self.keep(cost, Cow::Owned(graph), roots);
    }

    /// Adds a candidate, and its form after resubstitution if that finds anything to replace.
    ///
    /// `base` contains what is computed in any case.
    pub fn offer_polished(&mut self, graph: Graph, roots: Vec<Edge>, base: &Graph) {
        if let Some((graph, roots)) = resubstitute(&graph, &roots, base) {
            self.offer_own(graph, roots);
        }
        self.offer_own(graph, roots);
    }

    /// Adds a candidate as it is, and as it becomes when it is rebuilt in the graph `around`, where
    /// it shares the values that are computed there already.
    pub fn offer_both(&mut self, graph: Graph, roots: Vec<Edge>, around: &Graph) {
        if around.len() < SHORT_SEARCH_NODES {
            let mut merged = around.clone();
            let roots = rebuild(&graph, &mut merged, &roots);
            self.offer_own(merged, roots);
        }
        self.offer_own(graph, roots);
    }

    fn keep(&mut self, cost: (usize, usize), graph: Cow<'a, Graph>, roots: Vec<Edge>) {
        if self.best.as_ref().is_none_or(|best| cost < best.cost) {
            self.best = Some(Computed { cost, graph, roots });
        }
    }

    /// Copies the cheapest candidate into another graph; empty if there is none.
    pub fn cheapest(&self, into: &mut Graph) -> Vec<Edge> {
        let best = self.best.as_ref();
        best.map_or_else(Vec::new, |best| graft(&best.graph, into, &best.roots))
    }
}
