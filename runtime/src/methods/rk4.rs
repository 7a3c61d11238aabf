//! The classical Runge-Kutta method of order 4 on the coordinates x themselves.
//!
//! The numerical solution drifts off φ(x) = 0 with the order of the method. The stabilising term of KR18 (8),
//! ẋ = A ξ − λ Ψ φ, bounds this drift. A fixed λ keeps order 4; λ proportional to 1/h acts on the stages and costs two
//! orders, and λ h ≥ 5 is unstable. [`Rkmk4`](crate::methods::Rkmk4) is more accurate and needs no λ; use this method
//! for initial states off the manifold, and for comparison.

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::methods::Method;
use crate::state::State;
use crate::store::add_scaled;
use crate::system::System;

/// Classical Runge-Kutta method: order 4, four evaluations of ξ̇ per step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rk4 {
    /// Stabilising rate λ ≥ 0 in 1/time; 0 for no stabilisation. Should be fixed, about 10/s: λ ~ 1/h costs two orders.
    pub lambda: f64,
}

impl<Sys: System + ?Sized> Method<Sys> for Rk4 {
    fn order(&self) -> u32 {
        4
    }

    /// Returns true, so that x is not corrected after a step: the stabilising term does that at the rate λ.
    #[inline]
    fn preserves_constraints(&self) -> bool {
        true
    }

    #[inline]
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
        step(system, state, h, self.lambda, inputs)
    }
}

/// Makes one step of length `h` with the stabilising rate `lambda`. For h < 0 the sign of the stabilising term is
/// reversed, so that it damps the defect in either direction of time.
#[inline]
fn step<Sys, U>(
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    lambda: f64,
    inputs: &U,
) -> Result<State<Sys>, StepError>
where
    Sys: System + ?Sized,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    state.check_shape(system)?;
    let rate = |x: &Sys::Coordinates, xi: &Sys::Velocities| {
        let mut rate = system.rate(x, xi);
        if lambda != 0.0 {
            let towards = if h < 0.0 { -lambda } else { lambda };
            add_scaled(rate.as_mut(), towards, system.correction(x).as_ref());
        }
        rate
    };

    let mut k = rate(&state.x, &state.xi);
    let mut f = acceleration(system, state.t, 0.0, &state.x, &state.xi, inputs)?;
    let mut k_sum = k.clone();
    let mut f_sum = f.clone();

    for (node, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
        let a = node * h;
        let mut x = state.x.clone();
        add_scaled(x.as_mut(), a, k.as_ref());
        let mut xi = state.xi.clone();
        add_scaled(xi.as_mut(), a, f.as_ref());

        k = rate(&x, &xi);
        f = acceleration(system, state.t, node * h, &x, &xi, inputs)?;

        add_scaled(k_sum.as_mut(), weight, k.as_ref());
        add_scaled(f_sum.as_mut(), weight, f.as_ref());
    }

    let mut next = state.clone();
    next.t += h;
    let sixth = h / 6.0;
    add_scaled(next.x.as_mut(), sixth, k_sum.as_ref());
    add_scaled(next.xi.as_mut(), sixth, f_sum.as_ref());
    if next.is_finite() {
        Ok(next)
    } else {
        Err(StepError::NonFinite { time: state.t })
    }
}
