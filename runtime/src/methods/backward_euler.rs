//! Euler's implicit step in the chart, of order 1.
//!
//! u = h w(x ⊕ u, ξ₁), ξ₁ = ξ + h f(x ⊕ u, ξ₁), x₁ = x ⊕ u, solved for z = (u, ξ₁) by Broyden's method:
//! it starts as the fixed-point iteration, learns the stiff directions from its own steps, and needs no
//! derivatives. Source: C. T. Kelley, *Iterative Methods for Linear and Nonlinear Equations* (1995), 7.3.

use core::array::from_fn;

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::{Method, arrive};
use crate::scalar::Scalar;
use crate::state::State;
use crate::store::{add_scaled, scale};
use crate::system::System;

/// Order 1, some five evaluations of ξ̇ a step and more where the system is stiff.
///
/// Damps every oscillation; stable at any step that it can solve.
/// [`StepError::NotConverged`] where it cannot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BackwardEuler;

/// Steps that the iteration remembers before it starts anew.
const MEMORY: usize = 16;
/// Evaluations after which the iteration has failed.
const MOST: u32 = 64;
/// The residual at which it ends, in units of the last place.
const ENOUGH: f64 = 4096.0;

/// (u, ξ₁), or a change or a residual of it.
struct Unknowns<Sys: System + ?Sized> {
    u: Sys::Chart,
    xi: Sys::Velocities,
}

impl<Sys: System + ?Sized> Unknowns<Sys> {
    fn zero(system: &Sys) -> Self {
        Self {
            u: system.zero_chart(),
            xi: system.zero_velocities(),
        }
    }

    fn entries(&mut self) -> impl Iterator<Item = &mut Sys::Scalar> {
        self.u.as_mut().iter_mut().chain(self.xi.as_mut())
    }

    fn add_multiple(&mut self, a: Sys::Scalar, other: &Self) {
        let others = other.u.as_ref().iter().chain(other.xi.as_ref());
        for (own, other) in self.entries().zip(others) {
            *own = a.mul_add(*other, *own);
        }
    }

    fn dot(&self, other: &Self) -> Sys::Scalar {
        let u = self.u.as_ref().iter().zip(other.u.as_ref());
        let xi = self.xi.as_ref().iter().zip(other.xi.as_ref());
        u.chain(xi)
            .fold(Sys::Scalar::default(), |sum, (a, b)| a.mul_add(*b, sum))
    }

    /// The largest entry.
    fn size(&self) -> Sys::Scalar {
        let entries = self.u.as_ref().iter().chain(self.xi.as_ref());
        entries.fold(Sys::Scalar::default(), |largest, entry| {
            Scalar::max(largest, entry.abs())
        })
    }
}

impl<Sys: System + ?Sized> Clone for Unknowns<Sys> {
    fn clone(&self) -> Self {
        Self {
            u: self.u.clone(),
            xi: self.xi.clone(),
        }
    }
}

/// a / b, and 0 in the lanes where b is zero: those have converged.
fn ratio<S: Scalar>(a: S, b: S) -> S {
    S::default().select_lt(b.abs(), a / b, S::default())
}

impl<Sys: System + ?Sized> Method<Sys> for BackwardEuler {
    fn order(&self) -> u32 {
        1
    }

    fn step<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        state.check_shape(system)?;
        let one = Sys::Scalar::from_f64(1.0);
        let point = |u: &Sys::Chart| {
            let mut x = state.x.clone();
            manifold::retract(system.blocks(), x.as_mut(), u.as_ref());
            x
        };
        // (h w, ξ + h f) − z
        let defect = |z: &Unknowns<Sys>| {
            let x = point(&z.u);
            let mut u = system.chart_rate(&x, &z.xi);
            scale(u.as_mut(), h);
            let mut xi = state.xi.clone();
            let f = acceleration(system, state.t, h, &x, &z.xi, inputs)?;
            add_scaled(xi.as_mut(), h, f.as_ref());
            let mut defect: Unknowns<Sys> = Unknowns { u, xi };
            defect.add_multiple(-one, z);
            Ok(defect)
        };

        let mut z = Unknowns::<Sys> {
            u: system.chart_rate(&state.x, &state.xi),
            xi: state.xi.clone(),
        };
        scale(z.u.as_mut(), h);
        let mut steps: [Unknowns<Sys>; MEMORY] = from_fn(|_| Unknowns::zero(system));
        let mut known = 0;
        for iterations in 1..=MOST {
            let mut next = defect(&z)?;
            let residual = (next.size() / (one + z.size())).largest_lane();
            if residual <= ENOUGH * Sys::Scalar::EPSILON {
                return arrive(system, state, h, point(&z.u), z.xi);
            }
            if !residual.is_finite() {
                return Err(StepError::NotConverged {
                    time: state.t,
                    iterations,
                });
            }
            // next ← B⁻¹ defect, with B⁻¹ as the product of the updates that the steps define.
            let mut latest = None;
            for (index, s) in steps.iter().enumerate().take(known) {
                let along = ratio(s.dot(&next), s.dot(s));
                if index + 1 == known {
                    latest = Some(along);
                } else if let Some(following) = steps.get(index + 1) {
                    next.add_multiple(along, following);
                }
            }
            if let Some(along) = latest {
                let gain = ratio(one, one - along);
                next.entries().for_each(|entry| *entry *= gain);
            }
            z.add_multiple(one, &next);
            known = if known == MEMORY { 0 } else { known };
            if let Some(slot) = steps.get_mut(known) {
                *slot = next;
                known += 1;
            }
        }
        Err(StepError::NotConverged {
            time: state.t,
            iterations: MOST,
        })
    }
}
