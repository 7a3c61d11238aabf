//! The classical Runge-Kutta method on coordinates x treated as free, projected after each step.

use hamel::methods::Rk4;
use hamel::{Method, State, StepError, System, manifold};

/// [`Rk4`] without stabilisation, each step followed by [`manifold::normalise`]: order 4, four evaluations of
/// ξ̇ a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rk4Projected;

impl<Sys: System + ?Sized> Method<Sys> for Rk4Projected {
    fn order(&self) -> u32 {
        4
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
        let mut next = Rk4 { lambda: 0.0 }.step(system, state, h, inputs)?;
        manifold::normalise(system.blocks(), next.x.as_mut());
        if next.is_finite() {
            Ok(next)
        } else {
            Err(StepError::NonFinite { time: state.t })
        }
    }
}
