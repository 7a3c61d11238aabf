//! The classical Runge-Kutta method of order 4 in the chart (Runge-Kutta-Munthe-Kaas).
//!
//! Each step starts at u = 0 and computes u and ξ by the classical tableau, uᵢ = h Σⱼ aᵢⱼ kⱼ, ξᵢ = ξ + h Σⱼ aᵢⱼ fⱼ,
//! kᵢ = dexpinv(uᵢ, wᵢ), where the chart rate wᵢ and ξ̇ = fᵢ are taken at x moved along uᵢ; the step ends with the
//! weights b. Adding the wᵢ without dexpinv would lower the order to 2. Source: H. Munthe-Kaas, *High order Runge-Kutta
//! methods on manifolds*, Appl. Numer. Math. 29 (1999) 115.

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::tableau::{Row, Weights};
use crate::methods::{InChart, Method};
use crate::slopes::{Tangent, TangentStep};
use crate::state::State;
use crate::store::{add_scaled, scale};
use crate::system::System;

/// Runge-Kutta-Munthe-Kaas method: order 4, four evaluations of ξ̇ per step; for any system.
///
/// Local error O(h⁵). x stays on its manifold to rounding: rotations by a polar step, quaternions and circles by
/// normalisation; flat blocks move as in the plain method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rkmk4;

impl<Sys: System + ?Sized> Method<Sys> for Rkmk4 {
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
        state.check_shape(system)?;
        let blocks = system.blocks();

        let mut k = system.chart_rate(&state.x, &state.xi);
        let mut f = acceleration(system, state.t, 0.0, &state.x, &state.xi, inputs)?;
        let mut k_sum = k.clone();
        let mut f_sum = f.clone();

        for (node, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            let a = node * h;
            let mut u = k;
            scale(u.as_mut(), a);
            let mut x = state.x.clone();
            manifold::retract(blocks, x.as_mut(), u.as_ref());
            let mut xi = state.xi.clone();
            add_scaled(xi.as_mut(), a, f.as_ref());

            k = system.chart_rate(&x, &xi);
            manifold::dexpinv(blocks, u.as_ref(), k.as_mut());
            f = acceleration(system, state.t, node * h, &x, &xi, inputs)?;

            add_scaled(k_sum.as_mut(), weight, k.as_ref());
            add_scaled(f_sum.as_mut(), weight, f.as_ref());
        }

        let mut next = state.clone();
        next.t += h;
        let sixth = h / 6.0;
        scale(k_sum.as_mut(), sixth);
        manifold::retract(blocks, next.x.as_mut(), k_sum.as_ref());
        manifold::normalise(blocks, next.x.as_mut());
        add_scaled(next.xi.as_mut(), sixth, f_sum.as_ref());
        if next.is_finite() {
            Ok(next)
        } else {
            Err(StepError::NonFinite { time: state.t })
        }
    }
}

impl InChart for Rkmk4 {
    #[inline]
    fn step_slopes<Sys: Tangent>(
        &self,
        step: &TangentStep<'_, Sys>,
        slopes: &mut Sys::Slopes,
        in_dual_numbers: impl FnOnce(&mut Sys::Slopes) -> Result<State<Sys>, StepError>,
    ) -> Result<State<Sys>, StepError> {
        match Sys::PLAIN {
            true => step.explicit::<4>(&ROWS, CLOSING, slopes),
            false => in_dual_numbers(slopes),
        }
    }
}

/// The stages of the method as a tableau, for steps with slopes.
static ROWS: [Row; 4] = [
    Row {
        node: 0.0,
        weights: &[],
    },
    Row {
        node: 0.5,
        weights: &[(0, 0.5)],
    },
    Row {
        node: 0.5,
        weights: &[(1, 0.5)],
    },
    Row {
        node: 1.0,
        weights: &[(2, 1.0)],
    },
];

const CLOSING: Weights = &[
    (0, 1.0 / 6.0),
    (1, 1.0 / 3.0),
    (2, 1.0 / 3.0),
    (3, 1.0 / 6.0),
];
