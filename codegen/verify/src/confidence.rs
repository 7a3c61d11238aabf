//! Confidence in equality at random points: a bound on the chance that an identity that does not hold goes unnoticed.
//!
//! Two different rational functions whose difference has a numerator of degree D agree at a random point of both fields
//! with probability ≤ (D/p)(D/q), and at N such points with the N-th power of that; K comparisons err with at most K
//! times that probability (Schwartz and Zippel, with D of `algebra::degree`). Coordinates that solve constraints of
//! degrees d₁, d₂, … multiply D by Π dᵢ (Bézout); sums and linear solves that combine evaluated expressions in numbers
//! multiply it by the number of their terms.

use hamel_algebra::degree::DegreeBounds;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::prime::PRIMES;
use hamel_language::model::Model;
use hamel_language::model::layout::Block;
use std::fmt;

/// Equality at random points, with a chance of error of at most 10^−exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Confidence {
    /// Number of points, each in two fields.
    pub points: u64,
    /// k of 10^−k; 0 if the degrees are too high for a bound.
    pub exponent: u32,
}

impl Confidence {
    /// Bounds the chance that any pair of nodes that a graph merged, because their values modulo p agreed, is
    /// different.
    pub fn of_merging(model: &Model, graph: &Graph) -> Self {
        ConfidenceBounds::new(model, graph).merging()
    }

    /// Bounds the error for sums of `terms` products of expressions, compared `comparisons` times at each point.
    pub fn new(
        model: &Model,
        expressions: &[(&Graph, &[Edge])],
        terms: usize,
        points: u64,
        comparisons: usize,
    ) -> Self {
        let degree = expressions
            .iter()
            .map(|(graph, roots)| DegreeBounds::new(graph, groups(model)).bound(roots))
            .sum();
        Confidence::of_degree(degree, solved_degree(model), terms, points, comparisons)
    }

    fn of_degree(degree: f64, solved: f64, terms: usize, points: u64, comparisons: usize) -> Self {
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

/// Bounds on the chance that expressions of one graph agree at random points although they differ.
pub struct ConfidenceBounds<'a> {
    graph: &'a Graph,
    degrees: DegreeBounds<'a>,
    solved: f64,
    merging: Option<Confidence>,
}

impl<'a> ConfidenceBounds<'a> {
    /// Prepares bounds on the chance that expressions of a graph agree at random points although they differ; `model` gives
    /// the degrees of the constraints.
    pub fn new(model: &Model, graph: &'a Graph) -> Self {
        ConfidenceBounds {
            graph,
            degrees: DegreeBounds::new(graph, groups(model)),
            solved: solved_degree(model),
            merging: None,
        }
    }

    /// Returns the confidence in the merging of all nodes, see [`Confidence::of_merging`].
    pub fn merging(&mut self) -> Confidence {
        *self.merging.get_or_insert_with(|| {
            let all: Vec<Edge> = (0..self.graph.len() as u32).map(Edge::of).collect();
            let degree = self.degrees.bound(&all);
            Confidence::of_degree(degree, self.solved, 2, 1, all.len() * all.len())
        })
    }

    /// Returns the confidence in expressions that are compared `comparisons` times at each of some points.
    pub fn at_points(&mut self, roots: &[Edge], points: u64, comparisons: usize) -> Confidence {
        let degree = self.degrees.bound(roots);
        Confidence::of_degree(degree, self.solved, 1, points, comparisons)
    }
}

/// Returns the group of each symbol: for a coordinate its block, if that has a norm; `None` for all other symbols.
fn groups(model: &Model) -> Vec<Option<usize>> {
    let mut groups = vec![None; model.points.first];
    for (index, block) in model.points.blocks.iter().enumerate() {
        let group = (!matches!(block, Block::Flat(_))).then_some(index);
        groups.extend(std::iter::repeat_n(group, block.len()));
    }
    groups
}

/// Returns the product of the degrees of the constraints that coordinates solve.
fn solved_degree(model: &Model) -> f64 {
    let constraints = model.points.constraints.iter();
    let degrees = constraints.map(|&row| {
        let mut degrees = DegreeBounds::new(&model.points.free, Vec::new());
        degrees.bound(&[row]).max(1.0)
    });
    degrees.product()
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
