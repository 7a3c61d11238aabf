//! Turns a table of numbers into an expression of its argument.
//!
//! A table selects between polynomials in t = a − xₖ and is exact at its points: at xₖ the piece that begins there
//! applies, which gives yₖ to the last bit. The slopes of `pchip` are those of Fritsch and Butland (1984), with
//! one-sided three-point slopes at the ends, as in SciPy and Matlab: harmonic means weighted by the lengths of the
//! intervals, and 0 at local extrema.

use crate::algebra::graph::{Edge, Function, Graph};
use crate::syntax::ast::{Between, Beyond};
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use std::cmp::Ordering;

/// A table of points of a function of one variable, with its interpolation and extrapolation.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Arguments, increasing.
    knots: Vec<BigRational>,
    /// Values at the arguments.
    values: Vec<BigRational>,
    /// Pieces, each with its slopes at both ends and its coefficients c₂, c₃ of t², t³.
    pieces: Vec<Piece>,
    between: Between,
    beyond: Beyond,
}

#[derive(Clone, Debug)]
struct Piece {
    slope: BigRational,
    square: BigRational,
    cube: BigRational,
    last: BigRational,
}

impl Curve {
    /// Makes this table has at least two points with increasing arguments.
    pub(super) fn new(
        knots: Vec<BigRational>,
        values: Vec<BigRational>,
        between: Between,
        beyond: Beyond,
    ) -> Self {
        let lengths: Vec<BigRational> = knots.windows(2).map(|x| &x[1] - &x[0]).collect();
        let rises: Vec<BigRational> = values
            .windows(2)
            .zip(&lengths)
            .map(|(y, length)| (&y[1] - &y[0]) / length)
            .collect();
        let slopes = slopes(&lengths, &rises);
        let number = |n: i64| BigRational::from_integer(n.into());
        let pieces = lengths
            .iter()
            .zip(&rises)
            .enumerate()
            .map(|(k, (length, rise))| {
                let zero = BigRational::zero();
                if between == Between::Linear {
                    return Piece {
                        slope: rise.clone(),
                        square: zero.clone(),
                        cube: zero,
                        last: rise.clone(),
                    };
                }
                let (first, last) = (&slopes[k], &slopes[k + 1]);
                Piece {
                    slope: first.clone(),
                    square: (number(3) * rise - number(2) * first - last) / length,
                    cube: (first + last - number(2) * rise) / (length * length),
                    last: last.clone(),
                }
            });
        Curve {
            pieces: pieces.collect(),
            knots,
            values,
            between,
            beyond,
        }
    }

    /// Returns whether the table has a value at a number.
    pub(super) fn reaches(&self, number: &BigRational) -> bool {
        let within = Some(number) >= self.knots.first() && Some(number) <= self.knots.last();
        within || self.beyond != Beyond::Error
    }

    pub(super) fn value(&self, graph: &mut Graph, at: Edge) -> Edge {
        let last = self.knots.len() - 1;
        let from = |graph: &mut Graph, k: usize| {
            let knot = graph.rational(&self.knots[k]);
            graph.sub(at, knot)
        };
        let mut pieces: Vec<Edge> = Vec::new();
        // The beginning of each piece but the first.
        let mut bounds: Vec<Edge> = Vec::new();
        for (k, piece) in self.pieces.iter().enumerate() {
            let t = from(graph, k);
            if k > 0 {
                bounds.push(t);
            }
            pieces.push(polynomial(
                graph,
                t,
                [&self.values[k], &piece.slope, &piece.square, &piece.cube],
            ));
        }
        let whole = match (self.between, self.beyond) {
            // The outermost lines are extended.
            (Between::Linear, Beyond::Linear) => return choose(graph, &bounds, &pieces),
            (_, Beyond::Error) => choose(graph, &bounds, &pieces),
            _ => {
                let (first, end) = (from(graph, 0), from(graph, last));
                let zero = BigRational::zero();
                let [before, after] = [(first, 0), (end, last)].map(|(t, k)| {
                    let slope = match (self.beyond, k) {
                        (Beyond::Linear, 0) => &self.pieces[0].slope,
                        (Beyond::Linear, _) => &self.pieces[last - 1].last,
                        _ => &zero,
                    };
                    polynomial(graph, t, [&self.values[k], slope, &zero, &zero])
                });
                pieces.insert(0, before);
                pieces.push(after);
                bounds.insert(0, first);
                bounds.push(end);
                return choose(graph, &bounds, &pieces);
            }
        };
        // Beyond the points there is neither a value nor a slope: log² of a negative number.
        let (first, end) = (from(graph, 0), from(graph, last));
        [-first, end].into_iter().fold(whole, |whole, outside| {
            let nothing = graph.apply(Function::Log, -outside);
            let nothing = graph.mul(nothing, nothing);
            graph.select(outside, nothing, whole)
        })
    }
}

/// Selects a piece by bisection: the first one if the first bound is negative, and so on.
fn choose(graph: &mut Graph, bounds: &[Edge], pieces: &[Edge]) -> Edge {
    if bounds.is_empty() {
        return pieces.first().copied().unwrap_or(graph.zero());
    }
    let middle = bounds.len() / 2;
    let left = choose(graph, &bounds[..middle], &pieces[..=middle]);
    let right = choose(graph, &bounds[middle + 1..], &pieces[middle + 1..]);
    graph.select(-bounds[middle], left, right)
}

/// Returns c₀ + t (c₁ + t (c₂ + t c₃)).
fn polynomial(graph: &mut Graph, t: Edge, coefficients: [&BigRational; 4]) -> Edge {
    let mut sum = graph.zero();
    for number in coefficients.into_iter().rev() {
        let number = graph.rational(number);
        let product = graph.mul(t, sum);
        sum = graph.add(number, product);
    }
    sum
}

/// Returns the slopes of a pchip at its points, from the lengths and slopes of its intervals.
fn slopes(lengths: &[BigRational], rises: &[BigRational]) -> Vec<BigRational> {
    let number = |n: i64| BigRational::from_integer(n.into());
    let side = |a: &BigRational| a.cmp(&BigRational::zero());
    if let [rise] = rises {
        return vec![rise.clone(); 2];
    }
    let end = |k: usize, next: usize| {
        let (h, g) = (&lengths[k], &lengths[next]);
        let (d, e) = (&rises[k], &rises[next]);
        let slope = ((number(2) * h + g) * d - h * e) / (h + g);
        if side(&slope) != side(d) {
            BigRational::zero()
        } else if side(d) != side(e) && slope.abs() > number(3) * d.abs() {
            number(3) * d
        } else {
            slope
        }
    };
    let mut slopes = vec![end(0, 1)];
    for (h, d) in lengths.windows(2).zip(rises.windows(2)) {
        slopes.push(match side(&(&d[0] * &d[1])) {
            Ordering::Greater => {
                let (w, v) = (number(2) * &h[1] + &h[0], &h[1] + number(2) * &h[0]);
                (&w + &v) / (w / &d[0] + v / &d[1])
            }
            _ => BigRational::zero(),
        });
    }
    slopes.push(end(rises.len() - 1, rises.len() - 2));
    slopes
}
