//! Newton's method for φ(x) = 0 with the least change of x, with Levenberg–Marquardt damping.

use super::dense::{dot, largest, solve};
use super::derivation::Derivation;
use super::graph::{Edge, Graph};
use super::linear::matrix;
use super::numeric::evaluate;

/// Largest |φᵢ| of a solution, relative to 1 or to max(1, Σⱼ |∂φᵢ/∂xⱼ xⱼ|).
const RESIDUAL_TOLERANCE: f64 = 1e-12;
/// Largest number of steps of a search that can be repeated from another point.
const MAX_RESTARTABLE_STEPS: usize = 40;

/// Constraints φ and their Jacobian ∂φ/∂x, to be solved for x.
#[derive(Debug)]
pub struct Newton {
    graph: Graph,
    phi: Vec<Edge>,
    slopes: Vec<Edge>,
    first: usize,
    dimension: usize,
}

/// Result of Newton's method.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Final value of x.
    pub x: Vec<f64>,
    /// max |φ| at the final x.
    pub residual: f64,
    /// Whether every residual φᵢ is small, relative to 1 or to max(1, Σⱼ |∂φᵢ/∂xⱼ xⱼ|).
    pub is_close: bool,
}

impl Newton {
    /// Creates the problem from φ, whose unknowns x are the `dimension` symbols from index `first` on.
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

    /// Returns x with φ(x) = 0 near the x in `numbers` (the values of all symbols), if Newton's method
    /// finds it soon. The method serves walks on the constraint variety with quantities of order 1: if φ is
    /// so large that its rounding errors exceed 1e-12, nothing is found.
    pub fn solve_near(&self, numbers: &[f64]) -> Option<Vec<f64>> {
        let x = numbers.get(self.first..self.first + self.dimension)?;
        let end = self.descend(x.to_vec(), numbers, MAX_RESTARTABLE_STEPS, false);
        end.is_close.then_some(end.x)
    }

    /// √det(∂φ/∂x ∂φ/∂xᵀ) at these values of all symbols. It is 0 if rows are linearly dependent, as they
    /// are where components of the constraint variety meet.
    pub fn volume(&self, numbers: &[f64]) -> f64 {
        let slopes = evaluate(&self.graph, &self.slopes, numbers);
        let mut rows: Vec<Vec<f64>> = matrix(&slopes, self.dimension);
        let mut volume = 1.0;
        // Gram–Schmidt orthogonalization.
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

    /// Runs Newton's method from a guess. Residuals are compared with their sizes if `relative` is set, and
    /// with 1 otherwise.
    pub fn descend(
        &self,
        mut x: Vec<f64>,
        numbers: &[f64],
        steps: usize,
        relative: bool,
    ) -> Outcome {
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
                .all(|(phi, size)| phi.abs() <= RESIDUAL_TOLERANCE * size);
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
        Outcome {
            x,
            residual: largest(&phi),
            is_close,
        }
    }
}
