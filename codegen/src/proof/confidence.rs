//! What equality at random points says: the chance that an identity which does not hold is not noticed.
//!
//! Two rational functions that differ by one whose numerator has degree D agree at a random point of
//! both fields with probability ≤ (D/p)(D/q), at N such points with its N-th power, and one of K
//! comparisons errs with at most K times that (Schwartz and Zippel, with D of `algebra::degree`).
//! Coordinates that solve constraints of degrees d₁, d₂, … multiply D by Π dᵢ (Bézout); sums and
//! solutions in numbers of what was evaluated multiply it by the number of their terms.

use crate::algebra::degree::bound;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::prime::PRIMES;
use crate::model::Model;
use crate::model::layout::Block;
use std::fmt;

/// Equality at points, and the chance that it errs, 10^−exponent at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Confidence {
    /// Points, each in two fields.
    pub points: u64,
    /// k of 10^−k; 0 where the degrees allow no statement.
    pub exponent: u32,
}

impl Confidence {
    /// Of the merging of all nodes of a graph: each pair of them could be equal at its point by chance.
    pub fn of_merging(model: &Model, graph: &Graph) -> Self {
        let all: Vec<Edge> = (0..graph.len() as u32).map(Edge::of).collect();
        Confidence::new(model, &[(graph, &all)], 2, 1, all.len() * all.len())
    }

    /// Of sums of `terms` products of expressions of graphs, compared `comparisons` times at each point.
    pub fn new(
        model: &Model,
        expressions: &[(&Graph, &[Edge])],
        terms: usize,
        points: u64,
        comparisons: usize,
    ) -> Self {
        // The group of each coordinate: its block, where that has a norm.
        let mut groups: Vec<Option<usize>> = Vec::new();
        for (index, block) in model.points.blocks.iter().enumerate() {
            let group = (!matches!(block, Block::Flat(_))).then_some(index);
            groups.extend(std::iter::repeat_n(group, block.len()));
        }
        let first = model.points.first;
        let group = |symbol: usize| {
            let coordinate = symbol.checked_sub(first)?;
            groups.get(coordinate).copied().flatten()
        };
        let plain = |_: usize| None;
        let solved: f64 = model
            .points
            .constraints
            .iter()
            .map(|&row| bound(&model.points.free, &[row], &plain).max(1.0))
            .product();
        let degree: f64 = expressions
            .iter()
            .map(|(graph, roots)| bound(graph, roots, &group))
            .sum();
        let degree = 2.0 * degree.max(1.0) * solved * terms.max(1) as f64;
        let one: f64 = PRIMES
            .iter()
            .map(|&p| (p as f64).log10() - degree.log10())
            .sum();
        let all = one * points as f64 - (comparisons.max(1) as f64).log10();
        Confidence {
            points,
            exponent: all.max(0.0) as u32,
        }
    }
}

impl fmt::Display for Confidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Confidence { points, exponent } = self;
        let plural = if *points == 1 { "" } else { "s" };
        write!(f, "checked at {points} point{plural} in two fields, ")?;
        match exponent {
            0 => write!(f, "degrees too high to bound the chance of error"),
            _ => write!(f, "chance of error < 10^-{exponent}"),
        }
    }
}
