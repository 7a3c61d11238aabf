//! Search for the solution of equations that is nearest to a guess. Newton's method leads to a solution,
//! and a descent along the set of solutions then reduces the distance. The same is done from a few random
//! neighbours of the guess, and the nearest result counts.

use super::dense::{backward, cholesky, dot, forward, gram, largest, least_norm};
use super::residue_pair::Random;

/// Largest number of steps of Newton's method.
const MAX_NEWTON_STEPS: usize = 100;
/// Largest number of steps of the descent.
const MAX_DESCENT_STEPS: usize = 200;
/// Largest residual of a solution.
const RESIDUAL_TOLERANCE: f64 = 1e-12;
/// Step length, relative to 1 + the distance, at which the descent ends.
const STEP_TOLERANCE: f64 = 1e-11;
/// Largest number of refinement steps after the descent, which find the digits that comparing distances
/// cannot resolve.
const MAX_REFINEMENTS: usize = 20;
/// Largest number of times that a step is halved.
const MAX_HALVINGS: usize = 24;
/// Largest entry of a Newton step (rad, m), relative to 1 + the largest coordinate.
const MAX_NEWTON_ENTRY: f64 = 0.1;
/// Longest step of the descent, as a multiple of the step that would be right on a flat surface.
const MAX_STEP_FACTOR: f64 = 16.0;
/// Shortest refinement step after the descent, as a multiple of the same step.
const MIN_STEP_FACTOR: f64 = 1e-4;
/// Largest number of neighbours of the guess that are tried, times the number of directions.
const NEIGHBOUR_BUDGET: usize = 240;
/// Largest number of neighbours that are tried.
const MAX_NEIGHBOURS: usize = 40;
/// Largest displacement of a neighbour along each direction (rad, m).
const MAX_DISPLACEMENT: f64 = 3.0;
/// Regularization of the metric, relative to its largest entry, that makes it positive definite.
const METRIC_REGULARIZATION: f64 = 1e-9;

/// Equations for a point, and its distance from a guess. Directions are the rates (generalized velocities)
/// along which the point may move.
pub trait NearestPointProblem {
    /// Number of directions.
    fn directions(&self) -> usize;
    /// Residuals φ(x), which are 0 at a solution.
    fn residuals(&self, x: &[f64]) -> Vec<f64>;
    /// Jacobian of the residuals along the directions, row by row.
    fn jacobian(&self, x: &[f64]) -> Vec<Vec<f64>>;
    /// Error e(x), whose norm is the distance from the guess, and its Jacobian along the directions.
    fn error(&self, x: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>);
    /// Retraction: the point that a step along the directions leads to.
    fn retract(&self, x: &[f64], step: &[f64]) -> Vec<f64>;
}

/// Returns the solution nearest to the guess; `None` if none was found.
pub fn find_nearest(problem: &dyn NearestPointProblem, guess: &[f64]) -> Option<Vec<f64>> {
    if largest(&problem.residuals(guess)) <= RESIDUAL_TOLERANCE {
        return Some(guess.to_vec());
    }
    let count = problem.directions();
    let mut starts = vec![guess.to_vec()];
    let mut random = Random::new(0x6e65_6172);
    let mut number = || (random.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    for _ in 0..(NEIGHBOUR_BUDGET / count.max(1)).min(MAX_NEIGHBOURS) {
        let away = MAX_DISPLACEMENT * number();
        let step: Vec<f64> = (0..count).map(|_| away * number()).collect();
        starts.push(problem.retract(guess, &step));
    }
    let mut best: Option<(f64, Vec<f64>)> = None;
    for start in starts {
        let Some(x) = solve_newton(problem, start).and_then(|x| descend(problem, x)) else {
            continue;
        };
        let distance = distance(problem, &x);
        // A later solution has to be nearer by more than rounding errors.
        if best
            .as_ref()
            .is_none_or(|(least, _)| distance < least * (1.0 - 1e-9))
        {
            best = Some((distance, x));
        }
    }
    best.map(|(_, x)| x)
}

/// Newton's method with the shortest steps in the metric, iterated to full precision.
fn solve_newton(problem: &dyn NearestPointProblem, mut x: Vec<f64>) -> Option<Vec<f64>> {
    let mut residuals = problem.residuals(&x);
    for _ in 0..MAX_NEWTON_STEPS {
        let step = step(problem, &x, &residuals, false);
        if largest(&residuals) <= RESIDUAL_TOLERANCE {
            // Continue as long as full steps reduce the residuals.
            let next = step.map(|step| problem.retract(&x, &step));
            let after = next.as_ref().map(|next| problem.residuals(next));
            match (next, after) {
                (Some(next), Some(after))
                    if squared_norm(&after) < 0.25 * squared_norm(&residuals) =>
                {
                    (x, residuals) = (next, after);
                    continue;
                }
                _ => return Some(x),
            }
        }
        let mut step = step?;
        // Long steps would end on distant branches.
        let most = MAX_NEWTON_ENTRY * (1.0 + largest(&x));
        let size = largest(&step);
        if size > most {
            step.iter_mut().for_each(|h| *h *= most / size);
        }
        let (next, after) = halve_until(&step, |step| {
            let next = problem.retract(&x, step);
            let after = problem.residuals(&next);
            (squared_norm(&after) < squared_norm(&residuals)).then_some((next, after))
        })?;
        (x, residuals) = (next, after);
    }
    (largest(&residuals) <= RESIDUAL_TOLERANCE).then_some(x)
}

/// Descends along the set of solutions to where the distance from the guess is least.
fn descend(problem: &dyn NearestPointProblem, mut x: Vec<f64>) -> Option<Vec<f64>> {
    let mut before = distance(problem, &x);
    for _ in 0..MAX_DESCENT_STEPS {
        let step = step(problem, &x, &problem.residuals(&x), true)?;
        if squared_norm(&step).sqrt() <= STEP_TOLERANCE * (1.0 + before) {
            break;
        }
        let at = |factor: f64| -> Option<(Vec<f64>, f64)> {
            let step: Vec<f64> = step.iter().map(|h| factor * h).collect();
            let next = solve_newton(problem, problem.retract(&x, &step))?;
            let after = distance(problem, &next);
            (after < before).then_some((next, after))
        };
        // Along the step, the squared distance is nearly a parabola whose slope at the start is known.
        let (error, slopes) = problem.error(&x);
        let slope: f64 = slopes
            .iter()
            .zip(&error)
            .map(|(row, e)| e * dot(row, &step))
            .sum();
        let whole = at(1.0);
        let ahead = whole
            .as_ref()
            .map_or(f64::INFINITY, |(_, after)| after * after);
        let curvature = (ahead - before * before) / 2.0 - slope;
        let lowest = if curvature > 0.0 {
            -slope / (2.0 * curvature)
        } else {
            MAX_STEP_FACTOR
        };
        let lowest = lowest.min(MAX_STEP_FACTOR);
        let lower = if lowest > 0.0 { at(lowest) } else { None };
        let better = match (whole, lower) {
            (Some(one), Some(other)) if one.1 <= other.1 => Some(one),
            (Some(one), None) => Some(one),
            (_, other) => other,
        };
        let halves = (1..MAX_HALVINGS as i32).map(|k| 0.5_f64.powi(k));
        let nearer = better.or_else(|| halves.into_iter().find_map(at));
        let Some((next, after)) = nearer else {
            break;
        };
        (x, before) = (next, after);
    }
    refine(problem, x)
}

/// Refines the end of the descent. Near the minimum, distances differ by less than their rounding errors
/// while half of the digits are still missing. The steps are more precise: they are taken as long as they
/// become shorter.
fn refine(problem: &dyn NearestPointProblem, mut x: Vec<f64>) -> Option<Vec<f64>> {
    let ahead = |x: &[f64]| step(problem, x, &problem.residuals(x), true);
    let mut step = ahead(&x)?;
    let mut factor = 1.0;
    for _ in 0..MAX_REFINEMENTS {
        let taken: Vec<f64> = step.iter().map(|h| factor * h).collect();
        let next = solve_newton(problem, problem.retract(&x, &taken));
        let both = next.and_then(|next| ahead(&next).map(|after| (next, after)));
        let Some((next, after)) = both else {
            break;
        };
        let left = dot(&after, &step) / squared_norm(&step);
        let shorter = squared_norm(&after) < 0.5 * squared_norm(&step);
        if shorter {
            (x, step) = (next, after);
        }
        // The part of a step that is left after taking it tells how long the step should have been.
        let better = (factor / (1.0 - left)).clamp(MIN_STEP_FACTOR, MAX_STEP_FACTOR);
        if !shorter && (better / factor - 1.0).abs() < 0.1 || better.is_nan() {
            break;
        }
        factor = better;
    }
    Some(x)
}

/// Tries a step, its half, its quarter …, and returns the first result that `serves` accepts.
fn halve_until<T>(step: &[f64], mut serves: impl FnMut(&[f64]) -> Option<T>) -> Option<T> {
    let mut step = step.to_vec();
    for _ in 0..MAX_HALVINGS {
        if let Some(found) = serves(&step) {
            return Some(found);
        }
        step.iter_mut().for_each(|h| *h *= 0.5);
    }
    None
}

/// Computes a step h with φ + B h = 0: the shortest one in the metric EᵀE or, if `towards` is set, the one
/// with the shortest e + E h. B and E are the Jacobians of φ and e.
fn step(
    problem: &dyn NearestPointProblem,
    x: &[f64],
    residuals: &[f64],
    towards: bool,
) -> Option<Vec<f64>> {
    let (error, slopes) = problem.error(x);
    let count = problem.directions();
    let column = |i: usize| slopes.iter().map(move |row| row[i]);
    let mut metric = gram(&slopes, count);
    let scale = (0..count)
        .map(|i| metric[i][i])
        .fold(f64::MIN_POSITIVE, f64::max);
    (0..count).for_each(|i| metric[i][i] += METRIC_REGULARIZATION * scale);
    let factor = cholesky(&metric)?;
    let gradient: Vec<f64> = match towards {
        true => (0..count)
            .map(|i| column(i).zip(&error).map(|(a, b)| a * b).sum())
            .collect(),
        false => vec![0.0; count],
    };
    // In the variables u = Lᵀ h, the metric is the identity.
    let away = forward(&factor, &gradient);
    let rows: Vec<Vec<f64>> = problem
        .jacobian(x)
        .iter()
        .map(|row| forward(&factor, row))
        .collect();
    let target: Vec<f64> = rows
        .iter()
        .zip(residuals)
        .map(|(row, residual)| dot(row, &away) - residual)
        .collect();
    let across = match rows.is_empty() {
        true => vec![0.0; count],
        false => least_norm(&rows, &target)?,
    };
    let u: Vec<f64> = across.iter().zip(&away).map(|(a, b)| a - b).collect();
    Some(backward(&factor, &u))
}

fn distance(problem: &dyn NearestPointProblem, x: &[f64]) -> f64 {
    squared_norm(&problem.error(x).0).sqrt()
}

/// |a|²; infinite if an entry is NaN.
fn squared_norm(a: &[f64]) -> f64 {
    let sum = dot(a, a);
    if sum.is_nan() { f64::INFINITY } else { sum }
}
