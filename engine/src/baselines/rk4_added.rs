//! The classical Runge-Kutta method with angular velocities added as if they were vectors of one space.
//!
//! As in game engines, (w₁ + 2 w₂ + 2 w₃ + w₄) h/6 is one rotation vector. Each wᵢ is in the body axes of another
//! orientation; the correction by dexpinv of [`Rkmk4`](hamel::methods::Rkmk4) is omitted, and the order of rotations
//! falls to 2.

use super::step::{acceleration, add_scaled, arrive, scale};
use hamel::{Method, Scalar, State, StepError, System, manifold};

/// Order 2 if x has rotations, otherwise 4; four evaluations of ξ̇ a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rk4Added;

impl<Sys: System + ?Sized> Method<Sys> for Rk4Added {
    fn order(&self) -> u32 {
        2
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
        let mut w = system.chart_rate(&state.x, &state.xi);
        let mut f = acceleration(system, state.t, 0.0, &state.x, &state.xi, inputs)?;
        let mut w_sum = w.clone();
        let mut f_sum = f.clone();
        for (node, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            let a = Sys::Scalar::from_f64(node * h);
            scale(w.as_mut(), a);
            let mut x = state.x.clone();
            manifold::retract(system.blocks(), x.as_mut(), w.as_ref());
            let mut xi = state.xi.clone();
            add_scaled(xi.as_mut(), a, f.as_ref());

            w = system.chart_rate(&x, &xi);
            f = acceleration(system, state.t, node * h, &x, &xi, inputs)?;
            let weight = Sys::Scalar::from_f64(weight);
            add_scaled(w_sum.as_mut(), weight, w.as_ref());
            add_scaled(f_sum.as_mut(), weight, f.as_ref());
        }
        let sixth = Sys::Scalar::from_f64(h / 6.0);
        scale(w_sum.as_mut(), sixth);
        let mut x = state.x.clone();
        manifold::retract(system.blocks(), x.as_mut(), w_sum.as_ref());
        let mut xi = state.xi.clone();
        add_scaled(xi.as_mut(), sixth, f_sum.as_ref());
        arrive(system, state, h, x, xi)
    }
}
