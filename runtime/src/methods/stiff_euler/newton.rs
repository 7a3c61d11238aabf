//! The iteration: Newton's method, factors that are kept and corrected, steps that are halved.

use core::array::from_fn;

use super::equations::{Equations, FactorsOf, reach};
use crate::error::StepError;
use crate::methods::backward_euler::{ENOUGH, MEMORY, Progress, Unknowns, ratio};
use crate::scalar::Scalar;
use crate::slopes::Tangent;
use crate::store::{is_finite, largest};
use crate::system::System;

/// Evaluations after which the iteration has failed.
const MOST: u32 = 64;
/// Corrections that are longer than this part of the ones before ask for new factors.
const SLOW: f64 = 0.1;
/// The least part of a step that is tried.
const LEAST: f64 = 1e-4;

impl<Sys, U> Equations<'_, Sys, U>
where
    Sys: Tangent,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    /// (x₁, ξ₁)
    pub(super) fn solve(&self) -> Result<(Sys::Coordinates, Sys::Velocities), StepError> {
        let (system, state, h, time) = (self.system, self.state, self.h, self.state.t);
        let of = Sys::Scalar::from_f64;
        let (zero, one) = (Sys::Scalar::default(), of(1.0));
        let mut iterations = 1;
        let mut z = Unknowns::<Sys> {
            u: system.zero_chart(),
            xi: state.xi.clone(),
        };
        let (mut here, mut factors) = self.linear(&mut z)?;
        if !is_finite(here.defect.as_ref()) {
            return Err(StepError::NonFinite { time });
        }
        let mut progress = Progress::new(system, state);
        let mut steps: [Sys::Velocities; MEMORY] = from_fn(|_| system.zero_velocities());
        let mut known = 0;
        // The factors are those of this point.
        let mut fresh = true;
        let mut step = correction::<Sys>(&factors, &here.defect);
        'nearer: loop {
            let mut part = one;
            let (next, raw, fed, rounding) = loop {
                iterations += 1;
                if iterations > MOST || !is_finite(step.as_ref()) || least(part) < LEAST {
                    return Err(StepError::NotConverged { time, iterations });
                }
                let mut next = z.clone();
                for (xi, step) in next.xi.as_mut().iter_mut().zip(step.as_ref()) {
                    *xi = part.mul_add(*step, *xi);
                }
                let found = self.point(&mut next);
                let found = found.map(|there| (correction::<Sys>(&factors, &there.defect), there));
                match found {
                    Ok((raw, there)) if is_finite(raw.as_ref()) => {
                        let fed = differ(here.inputs.as_ref(), there.inputs.as_ref());
                        let small = Unknowns {
                            u: system.zero_chart(),
                            xi: step.clone(),
                        };
                        let whole = progress.whole(&next, &small, h);
                        let moves = of(ENOUGH * Sys::Scalar::EPSILON).select_lt(whole, one, zero);
                        let limit = of(-0.25).mul_add(part, one) * largest(step.as_ref());
                        let farther = largest(raw.as_ref()).select_lt(limit, zero, moves);
                        if fed || farther.largest_lane() == 0.0 {
                            here = there;
                            break (next, raw, fed, moves.largest_lane() == 0.0);
                        }
                        part = zero.select_lt(farther, of(0.5) * part, part);
                    }
                    Err(error) if fresh && least(part) < 2.0 * LEAST => {
                        return Err(error);
                    }
                    _ => part *= of(0.5),
                }
                if !fresh {
                    (here, factors) = self.linear(&mut z)?;
                    (fresh, known) = (true, 0);
                    step = correction::<Sys>(&factors, &here.defect);
                    continue 'nearer;
                }
            };
            let exact = core::mem::take(&mut fresh) && !fed;
            let whole_step = least(part) == 1.0;
            let length = of(h.abs()) * largest(raw.as_ref());
            let mut after = raw;
            // Rounding teaches nothing.
            if whole_step && !rounding {
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
            if known == MEMORY || !whole_step || !(fed || shrinks || progress.idle > 1) {
                iterations += 1;
                (here, factors) = self.linear(&mut z)?;
                (fresh, known) = (true, 0);
                step = correction::<Sys>(&factors, &here.defect);
            }
        }
    }
}

/// The least of parts between 0 and 1.
fn least<S: Scalar>(part: S) -> f64 {
    1.0 / (S::from_f64(1.0) / part).largest_lane()
}

/// −(∂g/∂ξ₁)⁻¹ g
fn correction<Sys: Tangent>(factors: &FactorsOf<Sys>, defect: &Sys::Velocities) -> Sys::Velocities {
    let mut step = defect.clone();
    factors.solve(step.as_mut());
    for entry in step.as_mut() {
        *entry = -*entry;
    }
    step
}

/// The correction by the factors, with what the steps since then tell of them: Broyden's update as a product.
fn learnt<Sys: Tangent>(steps: &[Sys::Velocities], correction: &mut Sys::Velocities) {
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
fn slow<Sys: System>(
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
