//! The commutator-free method of order 4.
//!
//! With kᵢ = h wᵢ (chart rates), the stages are at x, x ⊕ k₁/2, x ⊕ k₂/2, (x ⊕ k₁/2) ⊕ (k₃ − k₁/2); the step ends at
//! x ⊕ (3 k₁ + 2 k₂ + 2 k₃ − k₄)/12 ⊕ (−k₁ + 2 k₂ + 2 k₃ + 3 k₄)/12, where ⊕ moves x along its chart. Velocities follow
//! the classical tableau, and so do flat blocks and circles, whose moves commute. Source: E. Celledoni, A. Marthinsen,
//! B. Owren, *Commutator-free Lie group methods*, Future Gener. Comput. Syst. 19 (2003) 341.

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::{Method, arrive};
use crate::state::State;
use crate::store::{add, add_scaled, scale};
use crate::system::System;

/// Commutator-free method: order 4, four evaluations of ξ̇ and five retractions per step; for any system.
///
/// Needs no dexpinv; its errors equal those of [`Rkmk4`](crate::methods::Rkmk4) within a few per cent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cf4;

impl<Sys: System + ?Sized> Method<Sys> for Cf4 {
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
        let half = 0.5 * h;
        // x ⊕ Σ cⱼ wⱼ
        let moved = |x: &Sys::Coordinates, weights: &[(f64, &Sys::Chart)]| {
            let mut u = system.zero_chart();
            for (weight, w) in weights {
                add_scaled(u.as_mut(), h * weight, w.as_ref());
            }
            let mut x = x.clone();
            manifold::retract(system.blocks(), x.as_mut(), u.as_ref());
            x
        };
        let later = |a: f64, f: &Sys::Velocities| {
            let mut xi = state.xi.clone();
            add_scaled(xi.as_mut(), a, f.as_ref());
            xi
        };
        let force = |offset: f64, x: &Sys::Coordinates, xi: &Sys::Velocities| {
            acceleration(system, state.t, offset, x, xi, inputs)
        };

        let w1 = system.chart_rate(&state.x, &state.xi);
        let f1 = force(0.0, &state.x, &state.xi)?;

        let x2 = moved(&state.x, &[(0.5, &w1)]);
        let xi2 = later(half, &f1);
        let w2 = system.chart_rate(&x2, &xi2);
        let f2 = force(0.5 * h, &x2, &xi2)?;

        let x3 = moved(&state.x, &[(0.5, &w2)]);
        let xi3 = later(half, &f2);
        let w3 = system.chart_rate(&x3, &xi3);
        let f3 = force(0.5 * h, &x3, &xi3)?;

        let x4 = moved(&x2, &[(1.0, &w3), (-0.5, &w1)]);
        let xi4 = later(h, &f3);
        let w4 = system.chart_rate(&x4, &xi4);
        let f4 = force(h, &x4, &xi4)?;

        let (large, middle, small) = (0.25, 1.0 / 6.0, -1.0 / 12.0);
        let first = [(large, &w1), (middle, &w2), (middle, &w3), (small, &w4)];
        let second = [(small, &w1), (middle, &w2), (middle, &w3), (large, &w4)];
        let x = moved(&moved(&state.x, &first), &second);

        let mut sum = f1;
        add_scaled(sum.as_mut(), 2.0, f2.as_ref());
        add_scaled(sum.as_mut(), 2.0, f3.as_ref());
        add(sum.as_mut(), f4.as_ref());
        scale(sum.as_mut(), h / 6.0);
        let xi = later(1.0, &sum);

        arrive(system, state, h, x, xi)
    }
}
