//! Numerical test of the symbols on which expressions depend.
//!
//! The expressions are evaluated modulo p with some symbols varied and all others held fixed. A
//! result that an expression depends on none of the varied symbols is wrong with the same
//! probability as node identity.

use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::tape::Tape;
use hamel_language::model::Model;

/// Number of points to try, since square roots have no value at some.
const MAX_POINTS_TRIED: u64 = 400;
/// Seed of the first point.
const FIRST_SEED: u64 = 0x5711;

/// Point of X from which symbols are varied.
pub struct Variation<'a> {
    model: &'a Model,
    here: FieldPoint,
}

impl<'a> Variation<'a> {
    /// Finds a point at which all of the expressions have a value; `None` if no tried one has that
    /// property.
    pub fn new(model: &'a Model, graph: &Graph, edges: &[Edge]) -> Option<Self> {
        (0..MAX_POINTS_TRIED).find_map(|seed| {
            let here = model.points.lane(FIRST_SEED + seed)?;
            evaluate_at(graph, edges, &mut here.clone())?;
            Some(Variation { model, here })
        })
    }

    /// Prepares tests on which symbols expressions depend; `None` if they have no value at the point.
    pub fn dependence_of(&'a self, graph: &'a Graph, edges: &[Edge]) -> Option<Dependence<'a>> {
        let tape = Tape::new(graph, edges)?;
        Some(Dependence {
            variation: self,
            graph,
            values: tape.values(&self.here)?,
            tape,
        })
    }

    /// Returns for each expression whether it changes with the symbols `moved`; true if no second
    /// point was found.
    pub fn changes(&self, graph: &Graph, edges: &[Edge], moved: &[Edge]) -> Vec<bool> {
        match self.dependence_of(graph, edges) {
            Some(dependence) => dependence.changes(moved),
            None => vec![true; edges.len()],
        }
    }
}

/// Expressions with their values at the point from which symbols are varied.
pub struct Dependence<'a> {
    variation: &'a Variation<'a>,
    graph: &'a Graph,
    tape: Tape,
    values: Vec<ResiduePair>,
}

impl Dependence<'_> {
    /// Returns for each expression whether it changes with the symbols `moved`; true if no second
    /// point was found.
    pub fn changes(&self, moved: &[Edge]) -> Vec<bool> {
        let places = self.graph.symbol_places(moved);
        let there = (0..MAX_POINTS_TRIED).find_map(|seed| {
            let other = self
                .variation
                .model
                .points
                .lane(FIRST_SEED + MAX_POINTS_TRIED + seed)?;
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
