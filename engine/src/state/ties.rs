//! Which coordinates, and which velocities, are tied to one another: what may have to follow where some of them are given.

use hamel_codegen::algebra::graph::{Edge, Graph, Node};
use std::collections::BTreeSet;

/// What each equation is about, by places.
pub struct Ties(Vec<BTreeSet<usize>>);

impl Ties {
    /// Equations of which it is known what each is about.
    pub fn new(equations: impl IntoIterator<Item = BTreeSet<usize>>) -> Self {
        Ties(equations.into_iter().collect())
    }

    /// The places that equations in error tie together, by one another and by other equations.
    pub fn of(&self, wrong: impl Fn(usize) -> bool) -> BTreeSet<usize> {
        let start = (0..self.0.len()).filter(|&row| wrong(row));
        let mut tied: BTreeSet<usize> = start.flat_map(|row| self.0[row].clone()).collect();
        loop {
            let before = tied.len();
            for places in &self.0 {
                if !places.is_disjoint(&tied) {
                    tied.extend(places);
                }
            }
            if tied.len() == before {
                return tied;
            }
        }
    }
}

/// The symbols of an expression among those that stand from one place on, but one of them.
pub fn symbols(
    graph: &Graph,
    edge: Edge,
    (first, count): (usize, usize),
    but: Option<usize>,
) -> BTreeSet<usize> {
    let place = |id: u32| match graph.node(id) {
        Node::Symbol(index) => (index as usize).checked_sub(first),
        _ => None,
    };
    let all = graph.reachable(&[edge]).into_iter().filter_map(place);
    all.filter(|&place| place < count && but != Some(place))
        .collect()
}
