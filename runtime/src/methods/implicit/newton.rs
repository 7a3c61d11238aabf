//! Newton's method with kept and updated factors, and continuation through shorter steps.

use core::array::from_fn;

use crate::error::StepError;
use crate::methods::implicit::Derivative;
use crate::methods::implicit::equations::{ImplicitStep, reach};
use crate::methods::implicit::unknowns::{
    CONVERGED_ULPS, MAX_REMEMBERED_STEPS, Progress, Unknowns, ratio,
};
use crate::scalar::Scalar;
use crate::store::{is_finite, largest};
use crate::system::{Energies, System};

/// Largest number of corrections for one step length.
const MAX_CORRECTIONS: u32 = 64;
/// Budget of evaluations for all step lengths together.
const MAX_EVALUATIONS: u32 = 1024;
/// Ratio of successive corrections above which new factors are computed.
const REFACTOR_RATIO: f64 = 0.1;
/// Ratio of successive corrections by exact factors above which the iteration is not approaching a solution.
const DIVERGENCE_RATIO: f64 = 0.75;
/// Smallest fraction of a correction that is tried for the whole step. For shorter steps, which start near their
/// solutions, only full corrections are taken.
const MIN_DAMPING: f64 = 0.1;
/// Fraction of the step that is tried first if the whole step is too long.
const FIRST_FRACTION: f64 = 0.25;
/// Smallest increment of this fraction.
const MIN_INCREMENT: f64 = 1e-4;

impl<Sys: Energies + ?Sized> ImplicitStep<'_, Sys> {
    /// Solves the equations and returns (x₁, ξ₁): starts from ξ, and if that fails, follows the solutions of shorter
    /// steps.
    pub(in crate::methods) fn solve<D: Derivative<Sys>>(
        mut self,
        derivative: &D,
    ) -> Result<(Sys::Coordinates, Sys::Velocities), StepError> {
        let (whole, time) = (self.h, self.state.t);
        let mut iterations = 0;
        let mut failure = match self.newton(
            derivative,
            self.state.xi.clone(),
            MIN_DAMPING,
            &mut iterations,
        ) {
            Ok(found) => return Ok(found),
            Err(failure) => failure,
        };
        let mut part = FIRST_FRACTION;
        let (mut last, mut here) = ((0.0, self.state.xi.clone()), (0.0, self.state.xi.clone()));
        while part > MIN_INCREMENT && iterations < MAX_EVALUATIONS {
            let next = f64::min(here.0 + part, 1.0);
            let mut xi = here.1.clone();
            if here.0 > last.0 {
                let along = Sys::Scalar::from_f64((next - here.0) / (here.0 - last.0));
                for (xi, before) in xi.as_mut().iter_mut().zip(last.1.as_ref()) {
                    *xi = along.mul_add(*xi - *before, *xi);
                }
            }
            self.h = next * whole;
            match self.newton(derivative, xi, 1.0, &mut iterations) {
                Ok(found) if next == 1.0 => return Ok(found),
                Ok((_, xi)) => {
                    last = core::mem::replace(&mut here, (next, xi));
                    part *= 2.0;
                }
                Err(error) => {
                    failure = error;
                    part *= 0.25;
                }
            }
        }
        Err(match failure {
            StepError::NotConverged { .. } => StepError::NotConverged { time, iterations },
            other => other,
        })
    }

    /// Returns the solution near the initial value `xi` of ξ₁.
    fn newton<D: Derivative<Sys>>(
        &mut self,
        derivative: &D,
        xi: Sys::Velocities,
        least: f64,
        iterations: &mut u32,
    ) -> Result<(Sys::Coordinates, Sys::Velocities), StepError> {
        let mut iteration = Iteration::new(self, xi);
        let mut factors = None;
        for _ in 0..=MAX_CORRECTIONS {
            let kept = match factors.take() {
                Some(kept) => kept,
                None => iteration.begin(self, derivative, iterations)?,
            };
            *iterations += 1;
            let failed = self.failed(*iterations);
            if !is_finite(iteration.step.as_ref()) {
                return Err(failed);
            }
            match iteration.ahead::<D>(self, &kept, failed) {
                // For M g = 0, a smaller fraction of the same correction may lead nearer to the solution.
                Err(error) if iteration.fresh && self.weighed => {
                    iteration.part *= 0.5;
                    if iteration.part < least {
                        return Err(error);
                    }
                    factors = Some(kept);
                }
                Err(_) => self.weighed |= iteration.fresh,
                Ok(ahead) if iteration.part < 1.0 => {
                    (iteration.z, iteration.inputs) = (ahead.z, ahead.inputs);
                }
                Ok(ahead) => match iteration.follow(self, ahead) {
                    Followed::Solved(x, xi) => return Ok((x, xi)),
                    Followed::Nearer => factors = Some(kept),
                    Followed::Slower => {}
                },
            }
        }
        Err(self.failed(*iterations))
    }

    fn failed(&self, iterations: u32) -> StepError {
        StepError::NotConverged {
            time: self.state.t,
            iterations,
        }
    }
}

/// State of an iteration.
struct Iteration<Sys: System + ?Sized> {
    z: Unknowns<Sys>,
    /// Inputs at z.
    inputs: Sys::Inputs,
    /// Correction of ξ₁ at z, and the fraction `part` of it that is tried.
    step: Sys::Velocities,
    part: f64,
    /// Whether the factors were computed at this point.
    fresh: bool,
    /// Steps since the factors were computed, of which `known` are in use.
    steps: [Sys::Velocities; MAX_REMEMBERED_STEPS],
    known: usize,
    progress: Progress<Sys>,
}

/// Point to which a correction leads.
struct Ahead<Sys: System + ?Sized> {
    z: Unknowns<Sys>,
    inputs: Sys::Inputs,
    /// Correction at this point by the factors alone, without Broyden's update.
    step: Sys::Velocities,
    /// Whether the inputs change with the state in a way that the factors do not include.
    fed: bool,
    /// Whether the correction that led here is only of the size of rounding.
    rounding: bool,
}

/// Outcome of a full correction.
enum Followed<Sys: System + ?Sized> {
    /// The equations are solved: (x₁, ξ₁).
    Solved(Sys::Coordinates, Sys::Velocities),
    /// Corrections shrink; the factors are kept.
    Nearer,
    /// Corrections shrink too slowly; new factors are needed.
    Slower,
}

impl<Sys: Energies + ?Sized> Iteration<Sys> {
    fn new(equations: &ImplicitStep<'_, Sys>, xi: Sys::Velocities) -> Self {
        let system = equations.system;
        Iteration {
            z: Unknowns {
                u: system.zero_chart(),
                xi,
            },
            inputs: system.zero_inputs(),
            step: system.zero_velocities(),
            part: 1.0,
            fresh: true,
            steps: from_fn(|_| system.zero_velocities()),
            known: 0,
            progress: Progress::new(system, equations.state),
        }
    }

    /// Computes factors at this point, and the correction by them.
    fn begin<D: Derivative<Sys>>(
        &mut self,
        equations: &ImplicitStep<'_, Sys>,
        derivative: &D,
        iterations: &mut u32,
    ) -> Result<D::Factors, StepError> {
        let (here, factors) = derivative.linear(equations, &mut self.z, iterations)?;
        if !is_finite(here.defect.as_ref()) {
            let time = equations.state.t;
            return Err(StepError::NonFinite { time });
        }
        self.step = correction::<Sys, D>(&factors, &here.defect);
        self.inputs = here.inputs;
        (self.fresh, self.known, self.part) = (true, 0, 1.0);
        Ok(factors)
    }

    /// Evaluates the point to which the correction leads; an error, `farther`, if it is no nearer to the solution.
    fn ahead<D: Derivative<Sys>>(
        &self,
        equations: &ImplicitStep<'_, Sys>,
        factors: &D::Factors,
        farther: StepError,
    ) -> Result<Ahead<Sys>, StepError> {
        let of = Sys::Scalar::from_f64;
        let (zero, one) = (of(0.0), of(1.0));
        let mut z = self.z.clone();
        for (xi, step) in z.xi.as_mut().iter_mut().zip(self.step.as_ref()) {
            *xi = of(self.part).mul_add(*step, *xi);
        }
        let there = equations.point(&mut z)?;
        let step = correction::<Sys, D>(factors, &there.defect);
        let fed = !D::KNOWS_INPUTS && differ(self.inputs.as_ref(), there.inputs.as_ref());
        let small = Unknowns {
            u: equations.system.zero_chart(),
            xi: self.step.clone(),
        };
        let whole = self.progress.whole(&z, &small, equations.h);
        let moves = of(CONVERGED_ULPS * Sys::Scalar::EPSILON).select_lt(whole, one, zero);
        let limit = of(1.0 - self.part * (1.0 - DIVERGENCE_RATIO)) * largest(self.step.as_ref());
        let astray = largest(step.as_ref()).select_lt(limit, zero, moves);
        if !is_finite(step.as_ref()) || !fed && astray.largest_lane() != 0.0 {
            return Err(farther);
        }
        Ok(Ahead {
            z,
            inputs: there.inputs,
            step,
            fed,
            rounding: moves.largest_lane() == 0.0,
        })
    }

    /// Continues from the point to which a full correction has led.
    fn follow(&mut self, equations: &ImplicitStep<'_, Sys>, ahead: Ahead<Sys>) -> Followed<Sys> {
        let Ahead { fed, rounding, .. } = ahead;
        let (system, state, h) = (equations.system, equations.state, equations.h);
        let exact = core::mem::take(&mut self.fresh) && !fed;
        let length = Sys::Scalar::from_f64(h.abs()) * largest(ahead.step.as_ref());
        let mut after = ahead.step;
        // Corrections of the size of rounding carry no information for Broyden's update.
        if !rounding {
            if let Some(slot) = self.steps.get_mut(self.known) {
                *slot = self.step.clone();
                self.known += 1;
            }
            learnt::<Sys>(self.steps.get(..self.known).unwrap_or(&[]), &mut after);
        }
        let mut end = ahead.z.clone();
        for (xi, step) in end.xi.as_mut().iter_mut().zip(after.as_ref()) {
            *xi += *step;
        }
        if let Some(x) = reach(system, &state.x, h, &end.xi, &mut end.u) {
            let mut by = Unknowns::<Sys> {
                u: end.u.clone(),
                xi: after.clone(),
            };
            for (by, before) in by.u.as_mut().iter_mut().zip(ahead.z.u.as_ref()) {
                *by -= *before;
            }
            let over = self.progress.is_over(&end, &by, length, h);
            // A correction that exact factors do not shrink is rounding.
            if over || rounding && exact && self.progress.idle > 1 {
                return Followed::Solved(x, end.xi);
            }
        }
        (self.z, self.inputs) = (ahead.z, ahead.inputs);
        let shrinks =
            self.progress.idle == 0 && !slow::<Sys>(&after, &self.step, &state.xi, &self.z.xi);
        self.step = after;
        match self.known < MAX_REMEMBERED_STEPS && (fed || shrinks || self.progress.idle > 1) {
            true => Followed::Nearer,
            false => Followed::Slower,
        }
    }
}

/// Returns the Newton correction −(∂g/∂ξ₁)⁻¹ g.
fn correction<Sys: System + ?Sized, D: Derivative<Sys>>(
    factors: &D::Factors,
    defect: &Sys::Velocities,
) -> Sys::Velocities {
    let mut step = defect.clone();
    D::solve(factors, &mut step);
    for entry in step.as_mut() {
        *entry = -*entry;
    }
    step
}

/// Applies Broyden's update, as a product over the steps since the factors were computed, to the correction by the
/// factors.
fn learnt<Sys: System + ?Sized>(steps: &[Sys::Velocities], correction: &mut Sys::Velocities) {
    let inner = |a: &Sys::Velocities, b: &Sys::Velocities| {
        let entries = a.as_ref().iter().zip(b.as_ref());
        entries.fold(Sys::Scalar::default(), |sum, (a, b)| a.inner_plus(*b, sum))
    };
    for (index, step) in steps.iter().enumerate() {
        let along = ratio(inner(step, correction), inner(step, step));
        match steps.get(index + 1) {
            Some(following) => {
                for (entry, by) in correction.as_mut().iter_mut().zip(following.as_ref()) {
                    *entry = along.mul_add(*by, *entry);
                }
            }
            None => {
                let gain = ratio(
                    Sys::Scalar::from_f64(1.0),
                    Sys::Scalar::from_f64(1.0) - along,
                );
                for entry in correction.as_mut() {
                    *entry *= gain;
                }
            }
        }
    }
}

/// Returns whether an entry that has not converged shrinks too slowly.
fn slow<Sys: System + ?Sized>(
    new: &Sys::Velocities,
    old: &Sys::Velocities,
    start: &Sys::Velocities,
    xi: &Sys::Velocities,
) -> bool {
    let of = Sys::Scalar::from_f64;
    let (zero, one) = (of(0.0), of(1.0));
    let enough = of(CONVERGED_ULPS * Sys::Scalar::EPSILON);
    let entries = new.as_ref().iter().zip(old.as_ref());
    let sizes = start.as_ref().iter().zip(xi.as_ref());
    let slow = entries
        .zip(sizes)
        .fold(zero, |slow, ((new, old), (start, xi))| {
            let moves = enough.select_lt(new.relative_to(*start, *xi - *start), one, zero);
            let lags =
                (of(REFACTOR_RATIO) * old.magnitude()).select_lt(new.magnitude(), moves, zero);
            Scalar::max(slow, lags)
        });
    slow.largest_lane() != 0.0
}

/// Returns whether any numbers differ.
fn differ<S: Scalar>(a: &[S], b: &[S]) -> bool {
    let mut pairs = a.iter().zip(b);
    pairs.any(|(a, b)| (*a - *b).magnitude().largest_lane() != 0.0)
}
