//! Implicit Euler method in the chart, of order 1, solved by Broyden's method.
//!
//! u = h w(x ⊕ u, ξ₁), ξ₁ = ξ + h f(x ⊕ u, ξ₁), x₁ = x ⊕ u, solved for z = (u, ξ₁) by Broyden's method: it starts as
//! fixed-point iteration, learns the stiff directions from its own steps, and needs no derivatives. In dual numbers it
//! learns from the values first, and from the slopes once the values have converged. If the system turns out to be
//! stiff, or Broyden's method does not converge, Newton's method takes over, with derivatives by finite differences
//! ([`implicit`](crate::methods::implicit)). Source: C. T. Kelley, *Iterative Methods for Linear and Nonlinear
//! Equations* (1995), 7.3.

use core::array::from_fn;

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::implicit::unknowns::{MAX_REMEMBERED_STEPS, Progress, Unknowns, ratio};
#[cfg(feature = "std")]
use crate::methods::implicit::{differences::Differences, equations::ImplicitStep};
use crate::methods::{Method, arrive};
use crate::scalar::Scalar;
use crate::state::State;
use crate::store::{add_scaled, scale};
use crate::system::{Energies, System};

/// Implicit Euler method: order 1, about six evaluations of ξ̇ per step, more if the system is stiff.
///
/// Damps every oscillation. It is stable at any step length for which it can solve its equations, and returns
/// [`StepError::NotConverged`] otherwise. Each unknown is solved to rounding relative to its own size, and so are the
/// slopes of dual numbers.
///
/// It learns the stiff directions from its own iterations. If h times the stiffest rate is above about 10, or Broyden's
/// method does not converge within 64 evaluations, it switches to Newton's method with finite-difference derivatives,
/// which takes one evaluation per velocity and allocates memory. Without the feature `std` it continues with Broyden's
/// method alone, and several stiff directions may end in the error. [`StiffEuler`](crate::methods::StiffEuler) takes
/// exact derivatives from a description with `generate all, linearize;`: fewer evaluations, and no allocation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BackwardEuler;

/// Evaluation budget of Broyden's method.
const MAX_EVALUATIONS: u32 = 64;
/// Largest size of an iterate relative to that of the first, explicit one; beyond it the iteration has failed.
const MAX_GROWTH: f64 = 1e3;

impl<Sys: Energies + ?Sized> Method<Sys> for BackwardEuler {
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
                let equations = ImplicitStep {
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

/// Makes the step by Broyden's method.
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
    // Residual (h w, ξ + h f) − z.
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
    let mut steps: [Unknowns<Sys>; MAX_REMEMBERED_STEPS] = from_fn(|_| Unknowns::zero(system));
    // A step whose square is not above this value is hidden by rounding.
    let mut rests = [Sys::Scalar::default(); MAX_REMEMBERED_STEPS];
    let (mut known, mut farthest) = (0, zero);
    let mut progress = Progress::new(system, state);
    for iterations in 1..=MAX_EVALUATIONS {
        let mut next = defect(&z)?;
        if !next.is_finite() {
            return Err(StepError::NotConverged {
                time: state.t,
                iterations,
            });
        }
        let length = next.length(h);
        // next ← B⁻¹ defect, where B⁻¹ is the product of the updates that the previous steps define.
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
        // Diverging iterates end the iteration: wrongly learnt directions can lead anywhere.
        let size = z.length(h);
        farthest = if iterations == 1 {
            of(MAX_GROWTH) * size
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
            // If learnt stiff directions are wrong, corrections may be small for that reason, so check the residual.
            let holds = !progress.is_stiff() || progress.is_solved(&z, &defect(&z)?, h);
            if holds {
                return arrive(system, state, h, point(&z.u), z.xi);
            }
        }
        // For stiff systems Newton's method takes fewer evaluations, and it finds the nearby solution.
        if cfg!(feature = "std") && progress.is_stiff() {
            return Err(StepError::NotConverged {
                time: state.t,
                iterations,
            });
        }
        known = if known == MAX_REMEMBERED_STEPS {
            0
        } else {
            known
        };
        if let (Some(slot), Some(rest)) = (steps.get_mut(known), rests.get_mut(known)) {
            *rest = rounding * z.dot(&z, Scalar::inner_plus);
            *slot = next;
            known += 1;
        }
    }
    Err(StepError::NotConverged {
        time: state.t,
        iterations: MAX_EVALUATIONS,
    })
}
