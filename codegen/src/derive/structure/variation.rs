//! On which symbols expressions depend: they are evaluated modulo p with some symbols moved and all
//! others held. That an expression depends on none of them errs as node identity does.

use crate::algebra::fp::Fp;
use crate::algebra::graph::{Edge, Graph, Node};
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::model::Model;

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

    /// For each expression whether it changes with the symbols that `moved` are; where no second point
    /// was found, it is said to.
    pub fn changes(&self, graph: &Graph, edges: &[Edge], moved: &[Edge]) -> Vec<bool> {
        let places: Vec<usize> = moved
            .iter()
            .filter_map(|edge| match graph.node(edge.node()) {
                Node::Symbol(index) => Some(index as usize),
                _ => None,
            })
            .collect();
        self.pair(graph, edges, &places).map_or_else(
            || vec![true; edges.len()],
            |(a, b)| a.iter().zip(&b).map(|(a, b)| a != b).collect(),
        )
    }

    /// Values here, and with symbols moved.
    fn pair(&self, graph: &Graph, edges: &[Edge], places: &[usize]) -> Option<(Vec<Fp>, Vec<Fp>)> {
        let here = evaluate_at(graph, edges, &mut self.here.clone())?;
        (0..TRIES).find_map(|seed| {
            let other = self.model.points.lane(SEED + TRIES + seed)?;
            let mut there = self.here.clone();
            for &place in places {
                there.set_symbol(place, other.symbol(place));
            }
            Some((here.clone(), evaluate_at(graph, edges, &mut there)?))
        })
    }
}
