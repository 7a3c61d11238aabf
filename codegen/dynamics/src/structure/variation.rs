//! On which symbols expressions depend: they are evaluated modulo p with some symbols moved and all
//! others held. That an expression depends on none of them errs as node identity does.

use hamel_algebra::fp::Fp;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::lane::Lane;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::tape::Tape;
use hamel_language::model::Model;

/// Points tried where square roots have no value.
const TRIES: u64 = 400;
/// Two points from one another.
const SEED: u64 = 0x5711;

/// A point of X from which symbols are moved.
pub struct Variation<'a> {
    model: &'a Model,
    here: Lane,
}

impl<'a> Variation<'a> {
    /// Starts at a point at which all of the expressions have a value.
    pub fn new(model: &'a Model, graph: &Graph, edges: &[Edge]) -> Option<Self> {
        (0..TRIES).find_map(|seed| {
            let here = model.points.lane(SEED + seed)?;
            evaluate_at(graph, edges, &mut here.clone())?;
            Some(Variation { model, here })
        })
    }

    /// Prepares to ask on what expressions depend; `None` where they have no value here.
    pub fn of(&'a self, graph: &'a Graph, edges: &[Edge]) -> Option<Dependence<'a>> {
        let tape = Tape::new(graph, edges)?;
        Some(Dependence {
            variation: self,
            graph,
            values: tape.values(&self.here)?,
            tape,
        })
    }

    /// For each expression whether it changes with the symbols that `moved` are; where no second point
    /// was found, it is said to.
    pub fn changes(&self, graph: &Graph, edges: &[Edge], moved: &[Edge]) -> Vec<bool> {
        match self.of(graph, edges) {
            Some(dependence) => dependence.changes(moved),
            None => vec![true; edges.len()],
        }
    }
}

/// Expressions with their values at the point from which symbols are moved.
pub struct Dependence<'a> {
    variation: &'a Variation<'a>,
    graph: &'a Graph,
    tape: Tape,
    values: Vec<Fp>,
}

impl Dependence<'_> {
    /// For each expression whether it changes with the symbols that `moved` are; where no second point
    /// was found, it is said to.
    pub fn changes(&self, moved: &[Edge]) -> Vec<bool> {
        let places = self.graph.symbol_places(moved);
        let there = (0..TRIES).find_map(|seed| {
            let other = self.variation.model.points.lane(SEED + TRIES + seed)?;
            let mut there = self.variation.here.clone();
            for &place in &places {
                there.set_symbol(place, other.symbol(place));
            }
            self.tape.values(&there)
        });
        match there {
            Some(there) => self
                .values
                .iter()
                .zip(&there)
                .map(|(a, b)| a != b)
                .collect(),
            None => vec![true; self.values.len()],
        }
    }
}
