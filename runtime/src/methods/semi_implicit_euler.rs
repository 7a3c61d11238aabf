//! The semi-implicit Euler method: first the velocities, then the coordinates with the new velocities.
//!
//! ξ⁺ = ξ + h ξ̇(x, ξ, u); then x is moved along the chart vector h w, with the chart rate w at (x, ξ⁺). One evaluation
//! of ξ̇ per step; this is the step of many contact simulators and of model-predictive control. For one coordinate and
//! its momentum, with forces that depend on x alone, it is the symplectic Euler method. Source: E. Hairer, C. Lubich,
//! G. Wanner, *Geometric Numerical Integration*, Springer (2006), I.1.2.

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::{InChart, Method, arrive};
use crate::slopes::{Tangent, TangentStep};
use crate::state::State;
use crate::store::{add_scaled, scale};
use crate::system::System;

/// Semi-implicit Euler method: order 1, one evaluation of ξ̇ per step; for any system.
///
/// Local error O(h²). x stays on its manifold to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SemiImplicitEuler;

impl<Sys: System + ?Sized> Method<Sys> for SemiImplicitEuler {
    fn order(&self) -> u32 {
        1
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
        state.check_shape(system)?;
        let f = acceleration(system, state.t, 0.0, &state.x, &state.xi, inputs)?;
        let mut xi = state.xi.clone();
        add_scaled(xi.as_mut(), h, f.as_ref());
        let mut u = system.chart_rate(&state.x, &xi);
        scale(u.as_mut(), h);
        let mut x = state.x.clone();
        manifold::retract(system.blocks(), x.as_mut(), u.as_ref());
        arrive(system, state, h, x, xi)
    }
}

impl InChart for SemiImplicitEuler {
    #[inline]
    fn step_slopes<Sys: Tangent>(
        &self,
        step: &TangentStep<'_, Sys>,
        slopes: &mut Sys::Slopes,
        in_dual_numbers: impl FnOnce(&mut Sys::Slopes) -> Result<State<Sys>, StepError>,
    ) -> Result<State<Sys>, StepError> {
        match Sys::CHARTED && !Sys::PROJECTED {
            true => step.semi_implicit(slopes),
            false => in_dual_numbers(slopes),
        }
    }
}
