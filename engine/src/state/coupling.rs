//! Finds the coordinates or velocities that are coupled by violated equations, and that have to change with one
//! another.

use hamel_codegen::algebra::graph::{Edge, Graph, Node};
use std::collections::BTreeSet;

/// Which unknowns occur in which equations, to find those that must change together with a violated equation.
pub struct Coupling(Vec<BTreeSet<usize>>);

impl Coupling {
    /// Takes for each equation the indices of its unknowns.
    pub fn new(equations: impl IntoIterator<Item = BTreeSet<usize>>) -> Self {
        Coupling(equations.into_iter().collect())
    }

    /// Returns the unknowns that violated equations couple, directly and through other equations.
    pub fn coupled_to(&self, wrong: impl Fn(usize) -> bool) -> BTreeSet<usize> {
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

/// Returns the indices of those symbols in an expression that are in a range, relative to `first` and below `count`,
/// except `but`.
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
