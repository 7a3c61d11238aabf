//! What equality at random points says: the chance that an identity which does not hold is not noticed.
//!
//! Two rational functions that differ by one whose numerator has degree D agree at a random point of
//! both fields with probability ≤ (D/p)(D/q), at N such points with its N-th power, and one of K
//! comparisons errs with at most K times that (Schwartz and Zippel, with D of `algebra::degree`).
//! Coordinates that solve constraints of degrees d₁, d₂, … multiply D by Π dᵢ (Bézout); sums and
//! solutions in numbers of what was evaluated multiply it by the number of their terms.

use hamel_algebra::degree::Degrees;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::prime::PRIMES;
use hamel_language::model::Model;
use hamel_language::model::layout::Block;
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
        Compared::new(model, graph).merging()
    }

    /// Of sums of `terms` products of expressions of graphs, compared `comparisons` times at each point.
    pub fn new(
        model: &Model,
        expressions: &[(&Graph, &[Edge])],
        terms: usize,
        points: u64,
        comparisons: usize,
    ) -> Self {
        let degree = expressions
            .iter()
            .map(|(graph, roots)| Degrees::new(graph, groups(model)).bound(roots))
            .sum();
        Confidence::of_degree(degree, solved(model), terms, points, comparisons)
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

/// Many comparisons of expressions of one graph.
pub struct Compared<'a> {
    graph: &'a Graph,
    degrees: Degrees<'a>,
    solved: f64,
    merging: Option<Confidence>,
}

impl<'a> Compared<'a> {
    /// Of no expression yet.
    pub fn new(model: &Model, graph: &'a Graph) -> Self {
        Compared {
            graph,
            degrees: Degrees::new(graph, groups(model)),
            solved: solved(model),
            merging: None,
        }
    }

    /// Of the merging of all nodes, see [`Confidence::of_merging`].
    pub fn merging(&mut self) -> Confidence {
        *self.merging.get_or_insert_with(|| {
            let all: Vec<Edge> = (0..self.graph.len() as u32).map(Edge::of).collect();
            let degree = self.degrees.bound(&all);
            Confidence::of_degree(degree, self.solved, 2, 1, all.len() * all.len())
        })
    }

    /// Of expressions that are compared so many times at each of some points.
    pub fn at_points(&mut self, roots: &[Edge], points: u64, comparisons: usize) -> Confidence {
        let degree = self.degrees.bound(roots);
        Confidence::of_degree(degree, self.solved, 1, points, comparisons)
    }
}

/// The group of each coordinate: its block, where that has a norm; of symbols before them none.
fn groups(model: &Model) -> Vec<Option<usize>> {
    let mut groups = vec![None; model.points.first];
    for (index, block) in model.points.blocks.iter().enumerate() {
        let group = (!matches!(block, Block::Flat(_))).then_some(index);
        groups.extend(std::iter::repeat_n(group, block.len()));
    }
    groups
}

/// The product of the degrees of the constraints that coordinates solve.
fn solved(model: &Model) -> f64 {
    let constraints = model.points.constraints.iter();
    let degrees = constraints.map(|&row| {
        let mut degrees = Degrees::new(&model.points.free, Vec::new());
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
