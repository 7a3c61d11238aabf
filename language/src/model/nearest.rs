//! The nearest configuration to a start that violates φ, for messages: Newton's method with the
//! least change of x, damped as Levenberg and Marquardt do.

use super::points::Points;
use crate::algebra::derivation::Derivation;
use crate::algebra::fp::Random;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::matrix;
use crate::algebra::numeric::evaluate;

/// Steps from one first guess.
const STEPS: usize = 200;
/// Steps where another point will do as well.
const FEW_STEPS: usize = 40;
/// Largest |φ| of a configuration, beside 1 or what its slopes make of the coordinates.
const CLOSE: f64 = 1e-12;
/// First guesses at random, beyond the start and its neighbours along each coordinate.
const GUESSES: usize = 12;

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub enum Nearest {
    /// A configuration.
    Found(Vec<f64>),
    /// None; the smallest |φ| that was reached.
    Nowhere(f64),
}

/// φ and ∂φ/∂x, to be solved for x.
pub struct Equations {
    graph: Graph,
    phi: Vec<Edge>,
    slopes: Vec<Edge>,
    first: usize,
    dimension: usize,
}

/// Where Newton's method ends.
struct End {
    x: Vec<f64>,
    /// max |φ| there.
    residual: f64,
    /// Whether each of φ is small beside 1 or what its slopes make of the coordinates.
    is_close: bool,
}

/// Looks for x with φ(x) = 0 near a start; `numbers` are those of all symbols there.
pub fn nearest(points: &Points, phi: &[(Edge, String)], numbers: &[f64], x: &[f64]) -> Nearest {
    let equations = Equations::new(points, phi);
    let mut least = f64::INFINITY;
    for guess in guesses(x) {
        let end = equations.descend(guess, numbers, STEPS, true);
        if end.is_close {
            return Nearest::Found(end.x);
        }
        least = least.min(end.residual);
    }
    Nearest::Nowhere(least)
}

/// The start, its neighbours along each coordinate, and some at random.
fn guesses(x: &[f64]) -> Vec<Vec<f64>> {
    let mut all = vec![x.to_vec()];
    for alpha in 0..x.len() {
        let mut guess = x.to_vec();
        guess[alpha] += 1.0;
        all.push(guess);
    }
    let mut random = Random::new(0x6e65_6172);
    let mut unit = || (random.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    all.extend((0..GUESSES).map(|_| x.iter().map(|x| x + unit()).collect()));
    all
}

impl Equations {
    /// φ and its slopes.
    pub fn new(points: &Points, phi: &[(Edge, String)]) -> Self {
        let mut graph = points.free.clone();
        let mut columns: Vec<Derivation> = (0..points.dimension())
            .map(|alpha| {
                Derivation::new([(graph.symbols()[points.first + alpha].node, graph.one())])
            })
            .collect();
        let rows: Vec<Edge> = phi.iter().map(|(row, _)| *row).collect();
        let mut slopes = Vec::new();
        for &row in &rows {
            for column in &mut columns {
                slopes.push(column.of(&mut graph, row));
            }
        }
        Equations {
            graph,
            phi: rows,
            slopes,
            first: points.first,
            dimension: points.dimension(),
        }
    }

    /// x with φ(x) = 0 near that of some values of all symbols, if Newton's method finds it soon. Walks on X are of the size of
    /// 1: where φ is so large that rounding hides 1e-12, nothing is found.
    pub fn near(&self, numbers: &[f64]) -> Option<Vec<f64>> {
        let x = numbers.get(self.first..self.first + self.dimension)?;
        let end = self.descend(x.to_vec(), numbers, FEW_STEPS, false);
        end.is_close.then_some(end.x)
    }

    /// √det(∂φ/∂x ∂φ/∂xᵀ) where all symbols have these values: 0 where rows depend on one another, as they do where
    /// components of X meet.
    pub fn volume(&self, numbers: &[f64]) -> f64 {
        let slopes = evaluate(&self.graph, &self.slopes, numbers);
        let mut rows: Vec<Vec<f64>> = matrix(&slopes, self.dimension);
        let mut volume = 1.0;
        // Gram and Schmidt.
        for i in 0..rows.len() {
            let (before, rest) = rows.split_at_mut(i);
            let row = &mut rest[0];
            for unit in before {
                let along = dot(unit, row);
                row.iter_mut().zip(unit).for_each(|(a, b)| *a -= along * *b);
            }
            let length = dot(row, row).sqrt();
            volume *= length;
            row.iter_mut().for_each(|a| *a /= length);
        }
        volume
    }

    fn at(&self, edges: &[Edge], numbers: &[f64], x: &[f64]) -> Vec<f64> {
        let mut numbers = numbers.to_vec();
        numbers[self.first..self.first + x.len()].copy_from_slice(x);
        evaluate(&self.graph, edges, &numbers)
    }

    /// Newton's method from a guess; φ is small beside its size where that is `relative`, and beside 1 else.
    fn descend(&self, mut x: Vec<f64>, numbers: &[f64], steps: usize, relative: bool) -> End {
        let mut phi = self.at(&self.phi, numbers, &x);
        let mut damping = 1e-6;
        let mut is_close = false;
        for _ in 0..steps {
            let slopes = self.at(&self.slopes, numbers, &x);
            let sizes = slopes.chunks(x.len().max(1)).map(|row| {
                let moved = row.iter().zip(&x).map(|(slope, x)| (slope * x).abs());
                if relative {
                    f64::max(1.0, moved.sum())
                } else {
                    1.0
                }
            });
            is_close = phi
                .iter()
                .zip(sizes)
                .all(|(phi, size)| phi.abs() <= CLOSE * size);
            if is_close {
                break;
            }
            let rows: Vec<&[f64]> = slopes.chunks(x.len().max(1)).collect();
            let mut gram: Vec<Vec<f64>> = rows
                .iter()
                .map(|a| rows.iter().map(|b| dot(a, b)).collect())
                .collect();
            let scale = (0..rows.len()).map(|i| gram[i][i]).fold(0.0, f64::max);
            for (i, row) in gram.iter_mut().enumerate() {
                row[i] += damping * scale;
            }
            let Some(multipliers) = solve(gram, phi.clone()) else {
                break;
            };
            let mut next = x.clone();
            for (row, factor) in rows.iter().zip(&multipliers) {
                next.iter_mut()
                    .zip(*row)
                    .for_each(|(x, slope)| *x -= factor * slope);
            }
            let after = self.at(&self.phi, numbers, &next);
            if dot(&after, &after) < dot(&phi, &phi) {
                (x, phi) = (next, after);
                damping = (damping * 0.1).max(1e-15);
            } else {
                damping *= 10.0;
                if damping > 1e8 {
                    break;
                }
            }
        }
        End {
            x,
            residual: largest(&phi),
            is_close,
        }
    }
}

/// Gauss with exchange of rows.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        if a[pivot][k] == 0.0 || !a[pivot][k].is_finite() {
            return None;
        }
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i][k] / a[k][k];
            for j in k..n {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    Some(b)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// max |a|, infinite where an entry is no number.
fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |most: f64, a| match a.is_nan() {
        true => f64::INFINITY,
        false => most.max(a.abs()),
    })
}
