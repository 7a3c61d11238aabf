//! Euler's implicit step in the chart, of order 1.
//!
//! u = h w(x ⊕ u, ξ₁), ξ₁ = ξ + h f(x ⊕ u, ξ₁), x₁ = x ⊕ u, solved for z = (u, ξ₁) by Broyden's method:
//! it starts as the fixed-point iteration, learns the stiff directions from its own steps, and needs no
//! derivatives. In numbers with slopes it learns from the values, and from the slopes once the values rest. Where that
//! shows a system to be stiff, or does not converge, Newton's method follows, with derivatives by differences
//! ([`implicit`](crate::methods::implicit)). Source: C. T. Kelley, *Iterative Methods for Linear and Nonlinear Equations*
//! (1995), 7.3.

use core::array::from_fn;

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::implicit::unknowns::{MEMORY, Progress, Unknowns, ratio};
#[cfg(feature = "std")]
use crate::methods::implicit::{differences::Differences, equations::Equations};
use crate::methods::{Method, arrive};
use crate::scalar::Scalar;
use crate::state::State;
use crate::store::{add_scaled, scale};
use crate::system::System;

/// Order 1, some six evaluations of ξ̇ a step and more where the system is stiff.
///
/// Damps every oscillation; stable at any step that it can solve, and [`StepError::NotConverged`] where it cannot. Each
/// unknown is found to rounding by itself, and in numbers with slopes so are the slopes.
///
/// It learns what is stiff from its own iterations. Where h times the stiffest rate is above about 10, or 64
/// evaluations do not suffice, it switches to Newton's method with derivatives by differences, which takes an
/// evaluation for each velocity, and memory (with the feature `std`; without it, it goes on with Broyden's method
/// alone, and several stiff directions may end in the error). [`StiffEuler`](crate::methods::StiffEuler) takes the
/// derivatives of a description that has `generate all, linearize;`: with fewer evaluations, without memory, and exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BackwardEuler;

/// Evaluations after which what is stiff has not been learnt.
const MOST: u32 = 64;
/// How many times farther than the explicit step the implicit one may lead while it is looked for.
const FAR: f64 = 1e3;

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
        match learnt(system, state, h, inputs) {
            #[cfg(feature = "std")]
            Err(_) => {
                let equations = Equations {
                    system,
                    state,
                    h,
                    inputs,
                    weighed: false,
                };
                let (x, xi) = equations.solve(&Differences)?;
                arrive(system, state, h, x, xi)
            }
            found => found,
        }
    }
}

/// The step by Broyden's method.
fn learnt<Sys, U>(
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    inputs: &U,
) -> Result<State<Sys>, StepError>
where
    Sys: System + ?Sized,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    let of = Sys::Scalar::from_f64;
    let (zero, one) = (of(0.0), of(1.0));
    let rounding = Sys::Scalar::from_f64(Sys::Scalar::EPSILON * Sys::Scalar::EPSILON);
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
    // Steps that rounding hides have squares below these.
    let mut rests = [Sys::Scalar::default(); MEMORY];
    let (mut known, mut farthest) = (0, zero);
    let mut progress = Progress::new(system, state);
    for iterations in 1..=MOST {
        let mut next = defect(&z)?;
        if !next.is_finite() {
            return Err(StepError::NotConverged {
                time: state.t,
                iterations,
            });
        }
        let length = next.length(h);
        // next ← B⁻¹ defect, with B⁻¹ as the product of the updates that the steps define.
        let mut latest = None;
        for (index, (s, rest)) in steps.iter().zip(&rests).enumerate().take(known) {
            let along = s.along(&next, *rest);
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
        // Where the explicit step leads, or some way beyond: what was learnt wrong goes anywhere.
        let size = z.length(h);
        farthest = if iterations == 1 {
            of(FAR) * size
        } else {
            farthest
        };
        if farthest.select_lt(size, one, zero).largest_lane() != 0.0 {
            return Err(StepError::NotConverged {
                time: state.t,
                iterations,
            });
        }
        if progress.is_over(&z, &next, length, h) {
            // What was learnt of stiff directions may be wrong, and corrections small for that.
            let holds = !progress.is_stiff() || progress.is_solved(&z, &defect(&z)?, h);
            if holds {
                return arrive(system, state, h, point(&z.u), z.xi);
            }
        }
        // Newton's method takes fewer evaluations then, and ends at the solution that is near.
        if cfg!(feature = "std") && progress.is_stiff() {
            return Err(StepError::NotConverged {
                time: state.t,
                iterations,
            });
        }
        known = if known == MEMORY { 0 } else { known };
        if let (Some(slot), Some(rest)) = (steps.get_mut(known), rests.get_mut(known)) {
            *rest = rounding * z.dot(&z, Scalar::inner_plus);
            *slot = next;
            known += 1;
        }
    }
    Err(StepError::NotConverged {
        time: state.t,
        iterations: MOST,
    })
}
