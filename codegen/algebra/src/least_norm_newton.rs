//! Newton's method by steps of least norm, for equations with more unknowns than rows, iterated to the last digit.
//!
//! The caller evaluates the equations and takes the steps: loops are closed along the rates of their coordinates,
//! constraints of coordinates along the coordinates themselves, and constraints on velocities along the velocities.
//! Steps are not shortened, which suits starts near a solution. From guesses that may be far from one,
//! [`nearest_solution`](super::nearest_solution) finds it; walks on a constraint variety, which can start again
//! elsewhere, use the damped method of [`newton`](super::newton).

use super::dense::least_norm;

/// Residuals of equations at a point, and their Jacobian along the directions of steps.
pub struct Linearized {
    /// Residuals, which are 0 at a solution.
    pub residuals: Vec<f64>,
    /// Size of the residuals, by which steps are judged.
    pub size: f64,
    /// Jacobian of the residuals, row by row.
    pub jacobian: Vec<Vec<f64>>,
}

/// Rule by which the iteration stops.
#[derive(Clone, Copy, Debug)]
pub struct StoppingRule {
    /// Largest number of steps.
    pub max_steps: usize,
    /// Number of steps that are taken whatever they achieve.
    pub min_steps: usize,
    /// Smallest ratio of the sizes after and before a step at which the step counts as the last one: what is left are
    /// rounding errors.
    pub stagnation_ratio: f64,
    /// Largest size at which the iteration may count as converged; infinite if the caller judges the result.
    pub tolerance: f64,
}

/// Reason why Newton's iteration by steps of least norm ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewtonTermination {
    /// Steps no longer reduce the residuals.
    Converged,
    /// The number of steps was reached.
    OutOfSteps,
    /// The residuals are not finite, or no step solves the linearized equations.
    NoStep,
}

/// Result of the iteration.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Point at which the iteration ended.
    pub point: Vec<f64>,
    /// Point from which the last step was taken, which is as good where that step changed only rounding errors.
    pub before: Vec<f64>,
    /// Reason why it ended.
    pub end: NewtonTermination,
}

/// Takes steps h of least norm with r + J h = 0 until the rule stops them.
///
/// `linearize` evaluates the equations at a point, `advance` moves a point by a step.
pub fn solve(
    start: Vec<f64>,
    rule: StoppingRule,
    linearize: impl Fn(&[f64]) -> Linearized,
    advance: impl Fn(&mut Vec<f64>, &[f64]),
) -> Outcome {
    let mut before = start.clone();
    let mut point = start;
    let mut last_size = f64::INFINITY;
    let mut end = NewtonTermination::OutOfSteps;
    for step in 0..rule.max_steps {
        let at = linearize(&point);
        if !at.size.is_finite() {
            end = NewtonTermination::NoStep;
            break;
        }
        let stagnates = at.size >= rule.stagnation_ratio * last_size;
        if stagnates && at.size <= rule.tolerance && step >= rule.min_steps {
            end = NewtonTermination::Converged;
            break;
        }
        last_size = at.size;
        before.clone_from(&point);
        let target: Vec<f64> = at.residuals.iter().map(|residual| -residual).collect();
        let Some(change) = least_norm(&at.jacobian, &target) else {
            end = NewtonTermination::NoStep;
            break;
        };
        advance(&mut point, &change);
    }
    Outcome { point, before, end }
}
