//! Finds configurations nearest to a guess.
//!
//! For loops the distance is measured in the metric of M; for the description's own constraints, where velocities are
//! not known yet, in that of the coordinates.

use super::chart_difference::{chart_difference, chart_rate};
use super::layout::Block;
use super::loop_closure::{LoopClosure, normalise};
use crate::algebra::dense::{
    apply, backward, cholesky, cholesky_with, dot, forward, gram, least_norm, product,
};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::nearest_solution::NearestPointProblem;
use crate::algebra::numeric::evaluate;
use crate::algebra::residual_scale::{relative_residual, residual_scales};
use crate::algebra::slopes::slopes;

/// Smallest pivot of M relative to its diagonal entry; a smaller one is replaced by this fraction of the largest
/// diagonal entry.
const LEAST: f64 = 1e-9;

/// The equations of loops that are to be closed near a guess, in numbers, for Newton's method.
pub struct Loops<'c, 'a> {
    closure: &'c LoopClosure<'a>,
    guess: &'c [f64],
    given: Vec<usize>,
    /// For each entry of x, whether it is given.
    fixed: Vec<bool>,
    free: Vec<usize>,
    /// Scales of the loop residuals.
    sizes: Vec<f64>,
    /// S, where |S δ|² is the squared distance and δ the difference in the charts of the coordinates; `None` if M has
    /// no Cholesky factor.
    weight: Option<Vec<Vec<f64>>>,
}

impl<'c, 'a> Loops<'c, 'a> {
    /// Sets up the loops of a description with residuals scaled by `sizes`; the entries of x that are given stay as
    /// in the guess.
    pub fn new(
        closure: &'c LoopClosure<'a>,
        mass: &[Vec<f64>],
        guess: &'c [f64],
        given: &[bool],
        sizes: &[f64],
    ) -> Self {
        let directions = 0..closure.n;
        let mut loops = Loops {
            closure,
            guess,
            given: (0..given.len()).filter(|&alpha| given[alpha]).collect(),
            fixed: given.to_vec(),
            free: directions.filter(|&i| closure.time != Some(i)).collect(),
            sizes: sizes.to_vec(),
            weight: None,
        };
        loops.weight = loops.weights(mass);
        loops
    }

    /// Computes S = Lᵀ (CᵀC)⁻¹ Cᵀ, where M = L Lᵀ and C ξ are the chart rates at the guess.
    fn weights(&self, mass: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        let n = self.closure.n;
        let factor = root(mass)?;
        let rates = self.chart_rates(self.guess);
        let gram = cholesky(&gram(&rates, n))?;
        let columns = rates.iter().map(|c| backward(&gram, &forward(&gram, c)));
        let columns: Vec<Vec<f64>> = columns.collect();
        let entry = |i: usize, column: &[f64]| (i..n).map(|k| factor[k][i] * column[k]).sum();
        Some(
            (0..n)
                .map(|i| columns.iter().map(|column| entry(i, column)).collect())
                .collect(),
        )
    }

    fn a(&self, x: &[f64]) -> Vec<f64> {
        evaluate(
            self.closure.graph,
            &self.closure.a,
            &self.closure.numbers(x),
        )
    }

    /// Returns C by rows: the chart rates that each velocity causes.
    fn chart_rates(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let (a, n) = (self.a(x), self.closure.n);
        let columns: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                let rate: Vec<f64> = a.chunks(n.max(1)).map(|row| row[i]).collect();
                each(&self.closure.blocks, |block, place| {
                    let end = place + block.len();
                    chart_rate(block, &x[place..end], &rate[place..end])
                })
            })
            .collect();
        let rows = columns.first().map_or(0, Vec::len);
        (0..rows)
            .map(|row| columns.iter().map(|column| column[row]).collect())
            .collect()
    }
}

impl NearestPointProblem for Loops<'_, '_> {
    fn directions(&self) -> usize {
        self.free.len()
    }

    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        let mut residuals = self.closure.residuals(x);
        let sizes = residuals.iter_mut().zip(&self.sizes);
        sizes.for_each(|(residual, &size)| *residual = relative_residual(*residual, size));
        residuals.extend((self.given.iter()).map(|&alpha| kept(x[alpha], self.guess[alpha])));
        residuals
    }

    fn jacobian(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let n = self.closure.n;
        let loops = self.closure.loops().into_iter();
        let rows = loops.flat_map(|place| self.closure.constraints[place].row.iter().copied());
        let rows: Vec<Edge> = rows.collect();
        let b = evaluate(self.closure.graph, &rows, &self.closure.numbers(x));
        let a = self.a(x);
        let given =
            (self.given.iter()).map(|&alpha| (&a[alpha * n..][..n], length_of(self.guess[alpha])));
        let rows = b.chunks(n.max(1)).zip(self.sizes.iter().copied());
        rows.chain(given)
            .map(|(row, size)| {
                self.free
                    .iter()
                    .map(|&i| relative_residual(row[i], size))
                    .collect()
            })
            .collect()
    }

    fn error(&self, x: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let (mut apart, mut slopes): (Vec<f64>, Vec<Vec<f64>>) = Default::default();
        let rates = self.chart_rates(x);
        let mut place = 0;
        for &block in &self.closure.blocks {
            let end = place + block.len();
            let (way, bent) = chart_difference(block, &self.guess[place..end], &x[place..end]);
            let rows = &rates[apart.len()..apart.len() + way.len()];
            slopes.extend(bent.iter().map(|row| {
                let entry = |i: usize| row.iter().zip(rows).map(|(a, b)| a * b[i]).sum();
                self.free.iter().map(|&i| entry(i)).collect::<Vec<f64>>()
            }));
            apart.extend(way);
            place = end;
        }
        let Some(weight) = &self.weight else {
            return (apart, slopes);
        };
        (apply(weight, &apart), product(weight, &slopes))
    }

    fn retract(&self, x: &[f64], step: &[f64]) -> Vec<f64> {
        let (a, n) = (self.a(x), self.closure.n);
        let mut moved = x.to_vec();
        for (entry, row) in moved.iter_mut().zip(a.chunks(n.max(1))) {
            *entry += self
                .free
                .iter()
                .zip(step)
                .map(|(&i, h)| row[i] * h)
                .sum::<f64>();
        }
        self.closure.lead_back(&mut moved, &self.fixed);
        moved
    }
}

/// The constraints φ(x) = 0 of a description, which are to be satisfied near a guess.
pub struct Constraints<'a> {
    /// Graph of φ.
    pub graph: &'a Graph,
    /// Rows of φ, including the constraints of the coordinates' own kinds.
    pub phi: Vec<Edge>,
    /// Index of the symbol of the first coordinate.
    pub first: usize,
    /// Values of all symbols.
    pub numbers: &'a [f64],
    /// Blocks of x.
    pub blocks: &'a [Block],
    /// Guess for x.
    pub guess: &'a [f64],
    /// Indices of the entries of x that stay as in the guess.
    pub given: Vec<usize>,
    /// Scales of the residuals of φ.
    pub sizes: Vec<f64>,
}

/// Returns how far a given entry has moved from its guess, relative to its size or to 1 if that is larger.
fn kept(entry: f64, guess: f64) -> f64 {
    (entry - guess) / length_of(guess)
}

fn length_of(entry: f64) -> f64 {
    entry.abs().max(1.0)
}

impl Constraints<'_> {
    /// Sets the scales of the residuals from the sizes of their terms at the guess.
    pub fn measured(self) -> Self {
        let places = self.first..self.first + self.guess.len();
        Constraints {
            sizes: residual_scales(self.graph, &self.phi, &self.at(self.guess), places),
            ..self
        }
    }

    fn at(&self, x: &[f64]) -> Vec<f64> {
        let mut numbers = self.numbers.to_vec();
        numbers[self.first..self.first + x.len()].copy_from_slice(x);
        numbers
    }
}

impl NearestPointProblem for Constraints<'_> {
    fn directions(&self) -> usize {
        self.guess.len()
    }

    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        let mut residuals = evaluate(self.graph, &self.phi, &self.at(x));
        let sizes = residuals.iter_mut().zip(&self.sizes);
        sizes.for_each(|(residual, &size)| *residual = relative_residual(*residual, size));
        residuals.extend((self.given.iter()).map(|&alpha| kept(x[alpha], self.guess[alpha])));
        residuals
    }

    fn jacobian(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let unit = |alpha: usize| {
            let mut direction = vec![0.0; self.first + alpha + 1];
            direction[self.first + alpha] = 1.0;
            direction
        };
        let directions: Vec<Vec<f64>> = (0..x.len()).map(unit).collect();
        let rows = slopes(self.graph, &self.phi, &self.at(x), &directions).into_iter();
        let rows = rows.map(|row| (0..x.len()).map(|alpha| row.slope(alpha)).collect());
        let mut rows: Vec<Vec<f64>> = rows.collect();
        for (row, size) in rows.iter_mut().zip(&self.sizes) {
            row.iter_mut()
                .for_each(|slope| *slope = relative_residual(*slope, *size));
        }
        rows.extend(self.given.iter().map(|&alpha| {
            let mut row = vec![0.0; x.len()];
            row[alpha] = 1.0 / length_of(self.guess[alpha]);
            row
        }));
        rows
    }

    fn error(&self, x: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let apart = x.iter().zip(self.guess).map(|(a, b)| a - b).collect();
        let row = |alpha: usize| (0..x.len()).map(|beta| f64::from(alpha == beta)).collect();
        (apart, (0..x.len()).map(row).collect())
    }

    fn retract(&self, x: &[f64], step: &[f64]) -> Vec<f64> {
        let mut moved: Vec<f64> = x.iter().zip(step).map(|(x, h)| x + h).collect();
        normalise(self.blocks, &mut moved);
        moved
    }
}

/// Returns the ξ nearest to a guess, in the metric of M, with B ξ + b = 0 and the given entries kept.
pub fn velocities(
    rows: &[Vec<f64>],
    shifts: &[f64],
    mass: &[Vec<f64>],
    given: &[bool],
    guess: &[f64],
) -> Option<Vec<f64>> {
    let n = guess.len();
    let factor = root(mass)?;
    let unit = |i: usize| (0..n).map(|j| f64::from(i == j)).collect::<Vec<f64>>();
    let kept = (0..n).filter(|&i| given[i]).map(|i| (unit(i), -guess[i]));
    let rows = rows.iter().cloned().zip(shifts.iter().copied());
    let rows: Vec<(Vec<f64>, f64)> = rows.chain(kept).collect();
    let across: Vec<Vec<f64>> = rows.iter().map(|(row, _)| forward(&factor, row)).collect();
    let mut xi = guess.to_vec();
    for _ in 0..3 {
        let residual = |(row, shift): &(Vec<f64>, f64)| -> f64 { -shift - dot(row, &xi) };
        let target: Vec<f64> = rows.iter().map(residual).collect();
        let step = backward(&factor, &least_norm(&across, &target)?);
        xi.iter_mut().zip(step).for_each(|(xi, h)| *xi += h);
    }
    (0..n).filter(|&i| given[i]).for_each(|i| xi[i] = guess[i]);
    Some(xi)
}

/// Returns L with M = L Lᵀ. Pivots that vanish, or nearly so, belong to the time or to directions without mass; they
/// are raised.
fn root(mass: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let scale = (0..mass.len()).map(|i| mass[i][i]).fold(0.0, f64::max);
    let raised = LEAST * if scale > 0.0 { scale } else { 1.0 };
    cholesky_with(mass, &|i, pivot| match pivot <= LEAST * mass[i][i] {
        true => raised,
        false => pivot,
    })
}

/// Concatenates the results of `of` for each block and its place.
fn each(blocks: &[Block], mut of: impl FnMut(Block, usize) -> Vec<f64>) -> Vec<f64> {
    let mut place = 0;
    let mut all = Vec::new();
    for &block in blocks {
        all.extend(of(block, place));
        place += block.len();
    }
    all
}
