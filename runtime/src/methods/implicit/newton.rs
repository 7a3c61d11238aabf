//! The iteration: Newton's method, factors that are kept and corrected, and shorter steps on the way to one that is long.

use core::array::from_fn;

use crate::error::StepError;
use crate::methods::implicit::Derivative;
use crate::methods::implicit::equations::{Equations, reach};
use crate::methods::implicit::unknowns::{ENOUGH, MEMORY, Progress, Unknowns, ratio};
use crate::scalar::Scalar;
use crate::store::{is_finite, largest};
use crate::system::System;

/// Corrections after which the iteration of one length has failed.
const MOST: u32 = 64;
/// Evaluations after which all lengths have.
const MOST_OF_ALL: u32 = 1024;
/// Corrections that are longer than this part of the ones before ask for new factors.
const SLOW: f64 = 0.1;
/// Corrections by exact factors that are longer than this part of the ones before lead nowhere.
const ASTRAY: f64 = 0.75;
/// The least part of a correction that is taken on the way to the whole step. On the way to shorter ones, which begin near
/// their solutions, all of each is.
const LEAST: f64 = 0.1;
/// The part of the step that is tried first where the whole one is too long, and the least by which it grows.
const PARTS: (f64, f64) = (0.25, 1e-4);

impl<Sys: System + ?Sized> Equations<'_, Sys> {
    /// (x₁, ξ₁): from ξ, or else along the solutions of shorter steps, which begin there.
    pub(in crate::methods) fn solve<D: Derivative<Sys>>(
        mut self,
        derivative: &D,
    ) -> Result<(Sys::Coordinates, Sys::Velocities), StepError> {
        let (whole, time) = (self.h, self.state.t);
        let mut iterations = 0;
        let mut failure =
            match self.newton(derivative, self.state.xi.clone(), LEAST, &mut iterations) {
                Ok(found) => return Ok(found),
                Err(failure) => failure,
            };
        let (mut part, least) = PARTS;
        let (mut last, mut here) = ((0.0, self.state.xi.clone()), (0.0, self.state.xi.clone()));
        while part > least && iterations < MOST_OF_ALL {
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

    /// The solution near values of ξ₁.
    fn newton<D: Derivative<Sys>>(
        &mut self,
        derivative: &D,
        xi: Sys::Velocities,
        least: f64,
        iterations: &mut u32,
    ) -> Result<(Sys::Coordinates, Sys::Velocities), StepError> {
        let (system, state, h, time) = (self.system, self.state, self.h, self.state.t);
        let of = Sys::Scalar::from_f64;
        let (zero, one) = (Sys::Scalar::default(), of(1.0));
        let mut z = Unknowns::<Sys> {
            u: system.zero_chart(),
            xi,
        };
        let mut progress = Progress::new(system, state);
        let mut steps: [Sys::Velocities; MEMORY] = from_fn(|_| system.zero_velocities());
        let (mut known, mut part) = (0, 1.0);
        // Those of ∂g/∂ξ₁; none where they have to be made anew.
        let mut factors = None;
        // Whether they are those of this point.
        let mut fresh = true;
        let mut inputs = system.zero_inputs();
        let mut step = system.zero_velocities();
        for _ in 0..=MOST {
            let solved = match factors {
                Some(kept) => kept,
                None => {
                    let (here, new) = derivative.linear(self, &mut z, iterations)?;
                    if !is_finite(here.defect.as_ref()) {
                        return Err(StepError::NonFinite { time });
                    }
                    step = correction::<Sys, D>(&new, &here.defect);
                    inputs = here.inputs;
                    (fresh, known, part) = (true, 0, 1.0);
                    new
                }
            };
            *iterations += 1;
            let failed = StepError::NotConverged {
                time,
                iterations: *iterations,
            };
            if !is_finite(step.as_ref()) {
                return Err(failed);
            }
            let mut next = z.clone();
            for (xi, step) in next.xi.as_mut().iter_mut().zip(step.as_ref()) {
                *xi = of(part).mul_add(*step, *xi);
            }
            let nearer = self.point(&mut next).and_then(|there| {
                let raw = correction::<Sys, D>(&solved, &there.defect);
                let fed = !D::KNOWS_INPUTS && differ(inputs.as_ref(), there.inputs.as_ref());
                let small = Unknowns {
                    u: system.zero_chart(),
                    xi: step.clone(),
                };
                let whole = progress.whole(&next, &small, h);
                let moves = of(ENOUGH * Sys::Scalar::EPSILON).select_lt(whole, one, zero);
                let limit = of(1.0 - part * (1.0 - ASTRAY)) * largest(step.as_ref());
                let farther = largest(raw.as_ref()).select_lt(limit, zero, moves);
                match is_finite(raw.as_ref()) && (fed || farther.largest_lane() == 0.0) {
                    true => Ok((raw, there.inputs, fed, moves.largest_lane() == 0.0)),
                    false => Err(failed),
                }
            });
            let (raw, fed, rounding) = match nearer {
                Ok((raw, there, fed, rounding)) => {
                    inputs = there;
                    (raw, fed, rounding)
                }
                Err(error) if fresh && self.weighed => {
                    part *= 0.5;
                    if part < least {
                        return Err(error);
                    }
                    factors = Some(solved);
                    continue;
                }
                Err(_) => {
                    self.weighed |= fresh;
                    factors = None;
                    continue;
                }
            };
            if part < 1.0 {
                z = next;
                factors = None;
                continue;
            }
            let exact = core::mem::take(&mut fresh) && !fed;
            let length = of(h.abs()) * largest(raw.as_ref());
            let mut after = raw;
            // Rounding teaches nothing.
            if !rounding {
                if let Some(slot) = steps.get_mut(known) {
                    *slot = step.clone();
                    known += 1;
                }
                learnt::<Sys>(steps.get(..known).unwrap_or(&[]), &mut after);
            }
            let mut end = next.clone();
            for (xi, step) in end.xi.as_mut().iter_mut().zip(after.as_ref()) {
                *xi += *step;
            }
            if let Some(x) = reach(system, &state.x, h, &end.xi, &mut end.u) {
                let mut by = Unknowns::<Sys> {
                    u: end.u.clone(),
                    xi: after.clone(),
                };
                for (by, before) in by.u.as_mut().iter_mut().zip(next.u.as_ref()) {
                    *by -= *before;
                }
                let over = progress.is_over(&end, &by, length, h);
                // What exact factors do not make shorter is rounding.
                if over || rounding && exact && progress.idle > 1 {
                    return Ok((x, end.xi));
                }
            }
            z = next;
            let shrinks = progress.idle == 0 && !slow::<Sys>(&after, &step, &state.xi, &z.xi);
            step = after;
            let kept = known < MEMORY && (fed || shrinks || progress.idle > 1);
            factors = kept.then_some(solved);
        }
        Err(StepError::NotConverged {
            time,
            iterations: *iterations,
        })
    }
}

/// −(∂g/∂ξ₁)⁻¹ g
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

/// The correction by the factors, with what the steps since then tell of them: Broyden's update as a product.
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

/// Whether an entry that has yet to settle shrinks too little.
fn slow<Sys: System + ?Sized>(
    new: &Sys::Velocities,
    old: &Sys::Velocities,
    start: &Sys::Velocities,
    xi: &Sys::Velocities,
) -> bool {
    let of = Sys::Scalar::from_f64;
    let (zero, one) = (of(0.0), of(1.0));
    let enough = of(ENOUGH * Sys::Scalar::EPSILON);
    let entries = new.as_ref().iter().zip(old.as_ref());
    let sizes = start.as_ref().iter().zip(xi.as_ref());
    let slow = entries
        .zip(sizes)
        .fold(zero, |slow, ((new, old), (start, xi))| {
            let moves = enough.select_lt(new.beside(*start, *xi - *start), one, zero);
            let lags = (of(SLOW) * old.size()).select_lt(new.size(), moves, zero);
            Scalar::max(slow, lags)
        });
    slow.largest_lane() != 0.0
}

/// Whether numbers differ.
fn differ<S: Scalar>(a: &[S], b: &[S]) -> bool {
    let mut pairs = a.iter().zip(b);
    pairs.any(|(a, b)| (*a - *b).size().largest_lane() != 0.0)
}
