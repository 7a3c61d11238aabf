//! Finds states that close all loops and satisfy all constraints on the velocities.
//!
//! Given values are kept; the others are solved for, as near as possible to their current values: at the start of a
//! description these are the identity and rest. If everything is given, it has to satisfy the equations up to
//! rounding.

use super::closest::{Loops, velocities};
use super::layout::{Block, blocks};
use super::pfaffian::{Kind, Pfaffian};
use super::{Clock, Coordinate, Model};
use crate::algebra::dense::{dot, least_norm};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::least_norm_newton::{
    self, Linearized, NewtonTermination, Outcome, StoppingRule,
};
use crate::algebra::linear::matrix;
use crate::algebra::nearest_solution::find_nearest;
use crate::algebra::numeric::evaluate;
use crate::algebra::residual_scale::{relative_residual, residual_scales};
use crate::algebra::slopes::slopes;

/// Largest number of steps of Newton's method; near a solution, six are usual.
const MAX_NEWTON_STEPS: usize = 60;
/// Number of searches in `LoopClosure::assemble`; each scales the equations by their sizes where the last one ended.
const MAX_RESCALED_SEARCHES: usize = 3;
/// Smallest number of steps for constraints on velocities, so that rounding is refined away.
const MIN_VELOCITY_STEPS: usize = 3;
/// Ratio of the residuals of constraints on velocities after and before a step at which only rounding is left.
const VELOCITY_STAGNATION_RATIO: f64 = 0.5;
/// Ratio of the sums of squared residuals φ after and before a step at which only rounding is left.
const SQUARED_STAGNATION_RATIO: f64 = 0.25;
/// Largest residual of a solution, relative to its [scale](residual_scales).
const RESIDUAL_TOLERANCE: f64 = 1e-12;
/// Largest residual, relative to the size of its terms, that counts as rounding of the given numbers; those are then
/// corrected.
const ROUNDED_RESIDUAL: f64 = 1e-6;

/// The equations φ(x) = 0 of loops and B(x) ξ = 0, with numeric parameters.
pub struct LoopClosure<'a> {
    pub(super) graph: &'a Graph,
    pub(super) blocks: Vec<Block>,
    /// φ of the coordinates, in the graph with free points, if the description has constraints of its own.
    phi: Option<(&'a Graph, Vec<Edge>)>,
    pub(super) a: Vec<Edge>,
    pub(super) n: usize,
    /// Index of ξ⁰ among the velocities; the velocity of time is always given.
    pub(super) time: Option<usize>,
    pub(super) constraints: &'a [Pfaffian],
    params: &'a [f64],
    inputs: Option<&'a [f64]>,
}

/// A constraint that could not be satisfied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Open {
    /// Index of the constraint.
    pub constraint: usize,
    /// Size of its violation.
    pub residual: f64,
}

impl<'a> LoopClosure<'a> {
    /// Sets up the equations of a description that is being read, with φ if it has constraints of its own.
    pub fn new(
        graph: &'a Graph,
        coordinates: &[Coordinate],
        (a, n): (&[Vec<Edge>], usize),
        clock: Option<Clock>,
        constraints: &'a [Pfaffian],
        phi: Option<(&'a Graph, Vec<Edge>)>,
        params: &'a [f64],
    ) -> Self {
        let kinds = coordinates.iter().map(|coordinate| coordinate.kind);
        LoopClosure {
            graph,
            blocks: kinds.flat_map(blocks).collect(),
            phi,
            a: a.concat(),
            n,
            time: clock.map(|clock| clock.xi),
            constraints,
            params,
            inputs: None,
        }
    }

    /// Sets up the equations of a model, with the loops among all its constraints.
    pub fn of(model: &'a Model, params: &'a [f64]) -> Self {
        let rows = || model.phi.iter().map(|(edge, _)| *edge).collect();
        let constrained = !model.points.constraints.is_empty();
        LoopClosure {
            graph: &model.graph,
            blocks: model.blocks.clone(),
            phi: constrained.then(|| (&model.points.free, rows())),
            a: model.a.concat(),
            n: model.n(),
            time: model.clock.filter(|_| model.spans).map(|clock| clock.xi),
            constraints: &model.constraints,
            params,
            inputs: None,
        }
    }

    /// Sets inputs that are not zero, since prescribed motion may depend on them.
    pub fn with_inputs(mut self, inputs: &'a [f64]) -> Self {
        self.inputs = Some(inputs);
        self
    }

    /// Returns the indices of the loops among the constraints.
    pub(super) fn loops(&self) -> Vec<usize> {
        let is_loop = |&place: &usize| self.constraints[place].is_holonomic();
        (0..self.constraints.len()).filter(is_loop).collect()
    }

    /// Closes all loops by the coordinates that are not given. If the loops are open by rounding alone, given
    /// coordinates are corrected, too.
    ///
    /// # Errors
    /// Returns the worst constraint; x is unchanged then.
    pub fn close_loops(&self, x: &mut Vec<f64>, given: &[bool]) -> Result<(), Open> {
        let before = self.residuals(x);
        let sizes = self.sizes(x);
        let Some((which, beside)) = worst(&relative(&before, &sizes)) else {
            return Ok(());
        };
        let all = vec![false; given.len()];
        let attempts = [
            Some(given),
            (beside <= ROUNDED_RESIDUAL).then_some(&all[..]),
        ];
        for fixed in attempts.into_iter().flatten() {
            if let Some(closed) = self.newton(x, fixed, &sizes).filter(|x| self.is_closed(x)) {
                *x = closed;
                return Ok(());
            }
        }
        Err(Open {
            constraint: self.loops()[which],
            residual: before[which].abs(),
        })
    }

    /// Closes all loops as near to x as possible in the metric of M, by the coordinates that are not given.
    ///
    /// # Errors
    /// Returns the constraint that is worst at the guess; x is unchanged then.
    pub fn assemble(&self, x: &mut [f64], given: &[bool], mass: &[Vec<f64>]) -> Result<(), Open> {
        let before = self.residuals(x);
        let Some((which, _)) = worst(&relative(&before, &self.sizes(x))) else {
            return Ok(());
        };
        // Sizes at the guess say little about points far from it.
        let mut sizes = self.sizes(x);
        let mut found = None;
        for _ in 0..MAX_RESCALED_SEARCHES {
            let loops = Loops::new(self, mass, x, given, &sizes);
            found = find_nearest(&loops, x);
            let Some(there) = found.as_ref().filter(|x| !self.is_closed(x)) else {
                break;
            };
            let less = sizes.iter_mut().zip(self.sizes(there));
            less.for_each(|(size, there)| *size = size.min(there));
        }
        let Some(closed) = found.filter(|x| self.is_closed(x)) else {
            let constraint = self.loops()[which];
            return Err(Open {
                constraint,
                residual: before[which].abs(),
            });
        };
        let free = (0..x.len()).filter(|&alpha| !given[alpha]);
        free.for_each(|alpha| x[alpha] = closed[alpha]);
        Ok(())
    }

    /// Satisfies all constraints on the velocities as near to ξ as possible in the metric of M, by the velocities
    /// that are not given.
    ///
    /// # Errors
    /// Returns the constraint that cannot be satisfied; ξ is unchanged then.
    pub fn settle_near(
        &self,
        x: &[f64],
        xi: &mut Vec<f64>,
        given: &[bool],
        mass: &[Vec<f64>],
    ) -> Result<(), Open> {
        let rows = self.constraints.iter().flat_map(|c| c.row.iter().copied());
        let rows: Vec<Edge> = rows.collect();
        let b = evaluate(self.graph, &rows, &self.numbers(x));
        let b: Vec<Vec<f64>> = matrix(&b, self.n);
        let shifts: Vec<Edge> = self.constraints.iter().map(|c| c.shift).collect();
        let shifts = evaluate(self.graph, &shifts, &self.numbers(x));
        let mut fixed = given.to_vec();
        if let Some(time) = self.time {
            fixed[time] = true;
        }
        let mut settled = xi.clone();
        self.drive(&mut settled, &b, &shifts, &fixed);
        let near = velocities(&b, &shifts, mass, &fixed, &settled);
        // Contradictions with given velocities are found and reported by `settle`.
        let mut settled = near.unwrap_or(settled);
        self.settle(x, &mut settled, given)?;
        *xi = settled;
        Ok(())
    }

    /// Sets prescribed velocities to their values: like prescribed coordinates, they are not guesses.
    fn drive(&self, xi: &mut [f64], b: &[Vec<f64>], shifts: &[f64], fixed: &[bool]) {
        let drives =
            (0..b.len()).filter(|&row| matches!(self.constraints[row].kind, Kind::Drive { .. }));
        let drives: Vec<usize> = drives.collect();
        let free: Vec<usize> = (0..self.n).filter(|&i| !fixed[i]).collect();
        let speed = |row: usize| dot(&b[row], xi);
        let target: Vec<f64> = drives
            .iter()
            .map(|&row| -shifts[row] - speed(row))
            .collect();
        let rows = drives
            .iter()
            .map(|&row| free.iter().map(|&i| b[row][i]).collect());
        let rows: Vec<Vec<f64>> = rows.collect();
        if let Some(step) = least_norm(&rows, &target).filter(|_| !rows.is_empty()) {
            free.iter().zip(step).for_each(|(&i, h)| xi[i] += h);
        }
    }

    /// Returns x with all loops closed, moved along A without changing fixed entries; `None` if Newton's method
    /// fails.
    fn newton(&self, from: &[f64], fixed: &[bool], sizes: &[f64]) -> Option<Vec<f64>> {
        let n = self.n;
        let rows = self
            .loops()
            .into_iter()
            .map(|place| &self.constraints[place].row);
        let rows: Vec<Edge> = rows.flatten().copied().collect();
        let size = |residuals: &[f64]| Some(worst(&relative(residuals, sizes))?.1);
        let rule = StoppingRule {
            max_steps: MAX_NEWTON_STEPS,
            min_steps: 0,
            stagnation_ratio: 1.0,
            tolerance: RESIDUAL_TOLERANCE,
        };
        let linearize = |x: &[f64]| {
            let residuals = self.residuals(x);
            let numbers = self.numbers(x);
            let b = evaluate(self.graph, &rows, &numbers);
            let a = evaluate(self.graph, &self.a, &numbers);
            // A velocity that moves a fixed coordinate stays zero.
            let is_free = |i: usize| {
                self.time != Some(i)
                    && (0..x.len()).all(|alpha| !fixed[alpha] || a[alpha * n + i] == 0.0)
            };
            let free: Vec<bool> = (0..n).map(is_free).collect();
            let entry = |(&b, &free): (&f64, &bool)| if free { b } else { 0.0 };
            let jacobian = b
                .chunks(n.max(1))
                .map(|row| row.iter().zip(&free).map(entry).collect());
            Linearized {
                size: size(&residuals).unwrap_or(f64::NAN),
                jacobian: jacobian.collect(),
                residuals,
            }
        };
        let advance = |x: &mut Vec<f64>, step: &[f64]| {
            let a = evaluate(self.graph, &self.a, &self.numbers(x));
            for (entry, row) in x.iter_mut().zip(a.chunks(n.max(1))) {
                *entry += dot(row, step);
            }
            self.lead_back(x, fixed);
        };
        let Outcome { point, end, .. } =
            least_norm_newton::solve(from.to_vec(), rule, linearize, advance);
        match end {
            NewtonTermination::Converged => Some(point),
            NewtonTermination::OutOfSteps => {
                let left = size(&self.residuals(&point))?;
                (left <= RESIDUAL_TOLERANCE).then_some(point)
            }
            NewtonTermination::NoStep => None,
        }
    }

    /// Projects x back to φ = 0 of the coordinates, which a step along A violates to second order; fixed entries
    /// stay.
    pub fn lead_back(&self, x: &mut [f64], fixed: &[bool]) {
        normalise(&self.blocks, x);
        let Some((free, phi)) = &self.phi else {
            return;
        };
        let first = 1 + self.params.len();
        let open = |&alpha: &usize| !fixed.get(alpha).is_some_and(|&fixed| fixed);
        let open: Vec<usize> = (0..x.len()).filter(open).collect();
        let directions = open.iter().map(|&alpha| {
            let mut direction = vec![0.0; first + alpha + 1];
            direction[first + alpha] = 1.0;
            direction
        });
        let directions: Vec<Vec<f64>> = directions.collect();
        let rule = StoppingRule {
            max_steps: MAX_NEWTON_STEPS,
            min_steps: 0,
            stagnation_ratio: SQUARED_STAGNATION_RATIO,
            tolerance: f64::INFINITY,
        };
        let linearize = |x: &[f64]| {
            let mut numbers = self.numbers(x);
            numbers.resize(free.symbols().len(), 0.0);
            let rows = slopes(free, phi, &numbers, &directions);
            let jacobian = rows
                .iter()
                .map(|row| (0..open.len()).map(|k| row.slope(k)).collect());
            Linearized {
                size: rows
                    .iter()
                    .fold(0.0, |sum, row| sum + row.value * row.value),
                residuals: rows.iter().map(|row| row.value).collect(),
                jacobian: jacobian.collect(),
            }
        };
        let advance = |x: &mut Vec<f64>, step: &[f64]| {
            open.iter().zip(step).for_each(|(&alpha, h)| x[alpha] += h);
        };
        let outcome = least_norm_newton::solve(x.to_vec(), rule, linearize, advance);
        x.copy_from_slice(&outcome.before);
    }

    /// Returns whether at least one velocity is given, apart from that of time.
    pub fn any_speed(&self, given: &[bool]) -> bool {
        let mut given = given.iter().enumerate();
        given.any(|(i, &given)| given && self.time != Some(i))
    }

    /// Satisfies all constraints on the velocities by those that are not given. If the constraints are violated by
    /// rounding alone, given velocities are corrected, too.
    ///
    /// # Errors
    /// Returns the worst constraint; ξ is unchanged then.
    pub fn settle(&self, x: &[f64], xi: &mut Vec<f64>, given: &[bool]) -> Result<(), Open> {
        let n = self.n;
        let rows = self.constraints.iter().flat_map(|c| c.row.iter().copied());
        let rows: Vec<Edge> = rows.collect();
        let b = evaluate(self.graph, &rows, &self.numbers(x));
        let shifts: Vec<Edge> = self.constraints.iter().map(|c| c.shift).collect();
        let shifts = evaluate(self.graph, &shifts, &self.numbers(x));
        let speeds = |xi: &[f64]| -> Vec<f64> {
            let rows = b.chunks(n.max(1)).zip(&shifts);
            rows.map(|(row, shift)| dot(row, xi) + shift).collect()
        };
        // Relative to a speed of 1, or to the largest speed if that is more.
        let sizes = |xi: &[f64]| -> Vec<f64> {
            let most = xi.iter().fold(1.0f64, |most, v| most.max(v.abs()));
            let length = |row: &[f64]| row.iter().map(|b| b.abs()).sum::<f64>();
            let rows = b.chunks(n.max(1)).zip(&shifts);
            let rows = rows.map(|(row, shift)| length(row) * most + shift.abs());
            self.shared(0..self.constraints.len(), rows.collect())
        };
        let before = speeds(xi);
        let Some((constraint, beside)) = worst(&relative(&before, &sizes(xi))) else {
            return Ok(());
        };
        if beside == 0.0 {
            return Ok(());
        }
        let all = vec![false; n];
        for fixed in [
            Some(given),
            (beside <= ROUNDED_RESIDUAL).then_some(&all[..]),
        ]
        .into_iter()
        .flatten()
        {
            let free = (0..n).filter(|&i| !fixed[i] && self.time != Some(i));
            let free: Vec<usize> = free.collect();
            let jacobian: Vec<Vec<f64>> = b
                .chunks(n.max(1))
                .map(|row| free.iter().map(|&i| row[i]).collect())
                .collect();
            // Rows that are much shorter than others need several steps.
            let rule = StoppingRule {
                max_steps: MAX_NEWTON_STEPS,
                min_steps: MIN_VELOCITY_STEPS,
                stagnation_ratio: VELOCITY_STAGNATION_RATIO,
                tolerance: f64::INFINITY,
            };
            let linearize = |xi: &[f64]| {
                let residuals = speeds(xi);
                let left = worst(&relative(&residuals, &sizes(xi)));
                Linearized {
                    size: left.map_or(0.0, |(_, left)| left),
                    residuals,
                    jacobian: jacobian.clone(),
                }
            };
            let advance = |xi: &mut Vec<f64>, step: &[f64]| {
                free.iter().zip(step).for_each(|(&i, h)| xi[i] += h);
            };
            let settled = least_norm_newton::solve(xi.clone(), rule, linearize, advance).point;
            let left = relative(&speeds(&settled), &sizes(&settled));
            if worst(&left).is_none_or(|(_, size)| size <= RESIDUAL_TOLERANCE) {
                *xi = settled;
                return Ok(());
            }
        }
        Err(Open {
            constraint,
            residual: before[constraint].abs(),
        })
    }

    /// Returns whether all loops are closed, relative to their sizes at x.
    fn is_closed(&self, x: &[f64]) -> bool {
        let left = relative(&self.residuals(x), &self.sizes(x));
        worst(&left).is_none_or(|(_, left)| left <= 2.0 * RESIDUAL_TOLERANCE)
    }

    /// Returns the sizes relative to which residuals of the loops are judged.
    pub(super) fn sizes(&self, x: &[f64]) -> Vec<f64> {
        let loops = self.loops();
        let edges: Vec<Edge> = (loops.iter())
            .map(|&place| self.constraints[place].residual)
            .collect();
        let first = 1 + self.params.len();
        let sizes = residual_scales(self.graph, &edges, &self.numbers(x), first..first + x.len());
        self.shared(loops.iter().copied(), sizes)
    }

    /// Gives all rows of one vector equation the largest of their sizes.
    fn shared(&self, rows: impl Iterator<Item = usize>, sizes: Vec<f64>) -> Vec<f64> {
        let texts: Vec<&str> = rows
            .map(|row| self.constraints[row].written.as_str())
            .collect();
        let of = |text: &str| {
            let all = texts
                .iter()
                .zip(&sizes)
                .filter(|(other, _)| **other == text);
            all.fold(0.0, |most, (_, &size)| f64::max(most, size))
        };
        texts.iter().map(|text| of(text)).collect()
    }

    pub(super) fn residuals(&self, x: &[f64]) -> Vec<f64> {
        let loops = self.loops().into_iter();
        let edges: Vec<Edge> = loops
            .map(|place| self.constraints[place].residual)
            .collect();
        evaluate(self.graph, &edges, &self.numbers(x))
    }

    pub(super) fn numbers(&self, x: &[f64]) -> Vec<f64> {
        let mut numbers = vec![std::f64::consts::PI];
        numbers.extend_from_slice(self.params);
        numbers.extend_from_slice(x);
        if let Some(inputs) = self.inputs {
            numbers.resize(numbers.len() + self.n, 0.0);
            numbers.extend_from_slice(inputs);
        }
        numbers.resize(self.graph.symbols().len(), 0.0);
        numbers
    }
}

/// Divides residuals by the sizes of their terms.
fn relative(residuals: &[f64], sizes: &[f64]) -> Vec<f64> {
    let parts = residuals.iter().zip(sizes);
    parts
        .map(|(&left, &size)| relative_residual(left, size))
        .collect()
}

/// Returns index and absolute value of the largest entry; NaN counts as larger than any number.
fn worst(values: &[f64]) -> Option<(usize, f64)> {
    let sizes = values.iter().map(|v| v.abs()).enumerate();
    sizes.rev().max_by(|(_, a), (_, b)| a.total_cmp(b))
}

/// Projects x onto its blocks: scales to unit norm, or iterates Newton's method for the polar factor of a rotation
/// matrix.
pub fn normalise(blocks: &[Block], x: &mut [f64]) {
    let mut place = 0;
    for &block in blocks {
        let entries = &mut x[place..place + block.len()];
        match block {
            Block::Flat(_) => {}
            Block::Circle | Block::Quaternion => {
                let length = entries.iter().map(|e| e * e).sum::<f64>().sqrt();
                entries.iter_mut().for_each(|e| *e /= length);
            }
            Block::Rotation => {
                for _ in 0..8 {
                    polar_step(entries);
                }
            }
        }
        place += block.len();
    }
}

/// Performs one polar step, R ← R (3 I − RᵀR) / 2.
fn polar_step(r: &mut [f64]) {
    let old: Vec<f64> = r.to_vec();
    for i in 0..3 {
        for j in 0..3 {
            let mut value = 3.0 * old[3 * i + j];
            for k in 0..3 {
                let gram: f64 = (0..3).map(|l| old[3 * l + k] * old[3 * l + j]).sum();
                value -= old[3 * i + k] * gram;
            }
            r[3 * i + j] = value / 2.0;
        }
    }
}
