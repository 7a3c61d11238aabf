//! Euler's explicit steps in the chart, of order 1.
//!
//! x ⊕ u moves x along its chart, w(x, ξ) is the chart rate, f(x, ξ) = ξ̇.

use super::step::{acceleration, add_scaled, arrive, scale};
use hamel::{Method, Scalar, State, StepError, System, manifold};

/// x₁ = x ⊕ h w(x, ξ), ξ₁ = ξ + h f(x, ξ): order 1, one evaluation of ξ̇ a step.
///
/// Gains energy at every oscillation; it is here to be seen failing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ForwardEuler;

/// ξ₁ = ξ + h f(x, ξ), x₁ = x ⊕ h w(x, ξ₁): order 1, one evaluation of ξ̇ a step, the step
/// of most engines.
///
/// Energy stays bounded where T does not depend on x and the forces not on ξ; spinning bodies, whose
/// gyroscopic torque depends on ξ, gain energy all the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SemiImplicitEuler;

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
        let xi = later(system, state, h, inputs)?;
        let w = system.chart_rate(&state.x, &state.xi);
        moved(system, state, h, w, xi)
    }
}

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
        let xi = later(system, state, h, inputs)?;
        let w = system.chart_rate(&state.x, &xi);
        moved(system, state, h, w, xi)
    }
}

/// ξ + h f(x, ξ)
#[inline]
fn later<Sys, U>(
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    inputs: &U,
) -> Result<Sys::Velocities, StepError>
where
    Sys: System + ?Sized,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    state.check_shape(system)?;
    let f = acceleration(system, state.t, 0.0, &state.x, &state.xi, inputs)?;
    let mut xi = state.xi.clone();
    add_scaled(xi.as_mut(), Sys::Scalar::from_f64(h), f.as_ref());
    Ok(xi)
}

/// The state with x ⊕ h w and the velocities ξ.
#[inline]
fn moved<Sys: System + ?Sized>(
    system: &Sys,
    state: &State<Sys>,
    h: f64,
    mut w: Sys::Chart,
    xi: Sys::Velocities,
) -> Result<State<Sys>, StepError> {
    scale(w.as_mut(), Sys::Scalar::from_f64(h));
    let mut x = state.x.clone();
    manifold::retract(system.blocks(), x.as_mut(), w.as_ref());
    arrive(system, state, h, x, xi)
}
