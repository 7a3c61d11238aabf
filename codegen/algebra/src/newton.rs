//! Newton's method for φ(x) = 0 with the least change of x, damped as Levenberg and Marquardt do.

use super::dense::{dot, largest, solve};
use super::derivation::Derivation;
use super::graph::{Edge, Graph};
use super::linear::matrix;
use super::numeric::evaluate;

/// Largest |φ| of a solution, beside 1 or what its slopes make of x.
const CLOSE: f64 = 1e-12;
/// Steps where another point will do as well.
const FEW_STEPS: usize = 40;

/// φ and ∂φ/∂x, to be solved for x.
#[derive(Debug)]
pub struct Newton {
    graph: Graph,
    phi: Vec<Edge>,
    slopes: Vec<Edge>,
    first: usize,
    dimension: usize,
}

/// Where Newton's method ends.
#[derive(Clone, Debug)]
pub struct End {
    /// x there.
    pub x: Vec<f64>,
    /// max |φ| there.
    pub residual: f64,
    /// Whether each of φ is small beside 1 or what its slopes make of x.
    pub is_close: bool,
}

impl Newton {
    /// φ and its slopes along so many symbols from the first of x on.
    pub fn new(graph: &Graph, phi: &[Edge], first: usize, dimension: usize) -> Self {
        let mut graph = graph.clone();
        let mut columns: Vec<Derivation> = (0..dimension)
            .map(|alpha| Derivation::new([(graph.symbols()[first + alpha].node, graph.one())]))
            .collect();
        let mut slopes = Vec::new();
        for &row in phi {
            for column in &mut columns {
                slopes.push(column.of(&mut graph, row));
            }
        }
        Newton {
            graph,
            phi: phi.to_vec(),
            slopes,
            first,
            dimension,
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
    pub fn descend(&self, mut x: Vec<f64>, numbers: &[f64], steps: usize, relative: bool) -> End {
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
