//! Of several computations of the same values the cheapest.

use super::care::Care;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::resubstitute::resubstitute;
use hamel_algebra::transplant::{graft, rebuild};
use hamel_program::count::count;
use std::borrow::Cow;

/// Where more is computed it is not tried what a computation becomes.
const LARGE: usize = 3000;

/// The cheapest computation so far, in the graph that it was built in: what other functions compute
/// at length does not lengthen it.
#[derive(Default)]
pub struct Candidates<'a> {
    care: Care,
    best: Option<Computed<'a>>,
}

struct Computed<'a> {
    /// Loss of digits, as far as it counts, and operations.
    cost: (usize, usize),
    graph: Cow<'a, Graph>,
    roots: Vec<Edge>,
}

impl<'a> Candidates<'a> {
    /// No computation yet.
    pub fn with(care: &Care) -> Self {
        Candidates {
            care: care.clone(),
            best: None,
        }
    }

    fn cost(&self, graph: &Graph, roots: &[Edge]) -> (usize, usize) {
        let loss = self.care.loss(graph, roots, &[]);
        (loss, count(graph, roots).weight())
    }

    /// One more computation, in a graph that others share.
    pub fn offer(&mut self, graph: &'a Graph, roots: Vec<Edge>) {
        let cost = self.cost(graph, &roots);
        self.keep(cost, Cow::Borrowed(graph), roots);
    }

    /// One more computation, in a graph of its own.
    pub fn offer_own(&mut self, graph: Graph, roots: Vec<Edge>) {
        let cost = self.cost(&graph, &roots);
        self.keep(cost, Cow::Owned(graph), roots);
    }

    /// One more computation, as it stands and after resubstitution, where that finds something; `base` holds what
    /// is there anyway.
    pub fn offer_polished(&mut self, graph: Graph, roots: Vec<Edge>, base: &Graph) {
        if let Some((graph, roots)) = resubstitute(&graph, &roots, base) {
            self.offer_own(graph, roots);
        }
        self.offer_own(graph, roots);
    }

    /// One more computation, as it stands and as what it becomes where other things are computed already.
    pub fn offer_both(&mut self, graph: Graph, roots: Vec<Edge>, around: &Graph) {
        if around.len() < LARGE {
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

    /// The cheapest, in another graph as it stands; nothing where nothing was offered.
    pub fn cheapest(&self, into: &mut Graph) -> Vec<Edge> {
        let best = self.best.as_ref();
        best.map_or_else(Vec::new, |best| graft(&best.graph, into, &best.roots))
    }
}
