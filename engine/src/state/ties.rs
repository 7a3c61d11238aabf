//! Coordinates or velocities that equations tie to one another, and that may have to follow when others are given.

use hamel_codegen::algebra::graph::{Edge, Graph, Node};
use std::collections::BTreeSet;

/// The indices that occur in each equation.
pub struct Ties(Vec<BTreeSet<usize>>);

impl Ties {
    /// Equations, each given by the indices that occur in it.
    pub fn new(equations: impl IntoIterator<Item = BTreeSet<usize>>) -> Self {
        Ties(equations.into_iter().collect())
    }

    /// The indices that violated equations tie together, directly and through other equations.
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

/// The indices of the symbols in an expression, relative to `first` and below `count`, except `but`.
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
