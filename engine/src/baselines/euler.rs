//! Euler's explicit step in the chart, of order 1.
//!
//! x ⊕ u moves x along its chart, w(x, ξ) is the chart rate, f(x, ξ) = ξ̇.

use super::step::{acceleration, add_scaled, arrive, scale};
use hamel::{Method, Scalar, State, StepError, System, manifold};

/// x₁ = x ⊕ h w(x, ξ), ξ₁ = ξ + h f(x, ξ): order 1, one evaluation of ξ̇ a step.
///
/// Gains energy in every oscillation, to demonstrate this failure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ForwardEuler;

impl<Sys: System + ?Sized> Method<Sys> for ForwardEuler {
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
        let length = Sys::Scalar::from_f64(h);
        let f = acceleration(system, state.t, 0.0, &state.x, &state.xi, inputs)?;
        let mut xi = state.xi.clone();
        add_scaled(xi.as_mut(), length, f.as_ref());
        let mut w = system.chart_rate(&state.x, &state.xi);
        scale(w.as_mut(), length);
        let mut x = state.x.clone();
        manifold::retract(system.blocks(), x.as_mut(), w.as_ref());
        arrive(system, state, h, x, xi)
    }
}
