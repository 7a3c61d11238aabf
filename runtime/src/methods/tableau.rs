//! Explicit Runge-Kutta methods in the chart, for any tableau (Runge-Kutta-Munthe-Kaas).
//!
//! Each step starts at u = 0: uᵢ = h Σⱼ aᵢⱼ kⱼ, ξᵢ = ξ + h Σⱼ aᵢⱼ fⱼ, kᵢ = dexpinv(uᵢ, wᵢ), where wᵢ is the chart rate
//! and fᵢ = ξ̇ at x moved along uᵢ; the step ends with the weights b. The order is that of the tableau. Source: H.
//! Munthe-Kaas, *High order Runge-Kutta methods on manifolds*, Appl. Numer. Math. 29 (1999) 115.

use core::array::from_fn;

use crate::error::StepError;
use crate::integrate::acceleration;
use crate::manifold;
use crate::methods::{InChart, Method, arrive};
use crate::slopes::{Tangent, TangentStep};
use crate::state::State;
use crate::store::{add, add_scaled};
use crate::system::System;

/// Nonzero coefficients, each with the index of its stage, from 0.
pub type Weights = &'static [(usize, f64)];

/// One stage of a tableau: cᵢ and row i of a.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Node cᵢ = Σⱼ aᵢⱼ
    pub node: f64,
    /// Nonzero aᵢⱼ of the stages j < i
    pub weights: Weights,
}

/// An explicit tableau of N stages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tableau<const N: usize> {
    /// The order p.
    pub order: u32,
    /// The stages; the first has no weights.
    pub rows: [Row; N],
    /// Weights b of the end of the step.
    pub closing: Weights,
}

/// Runge-Kutta-Munthe-Kaas method of a tableau: N evaluations of ξ̇ per step; for any system.
///
/// x stays on its manifold to rounding: rotations by a polar step, quaternions and circles by normalisation. Flat
/// blocks move as in the plain method.
///
/// ```
/// use hamel::methods::tableau::{Rkmk, Row, Tableau};
///
/// /// Ralston's third-order method.
/// static RALSTON: Tableau<3> = Tableau {
///     order: 3,
///     rows: [
///         Row { node: 0.0, weights: &[] },
///         Row { node: 0.5, weights: &[(0, 0.5)] },
///         Row { node: 0.75, weights: &[(1, 0.75)] },
///     ],
///     closing: &[(0, 2.0 / 9.0), (1, 1.0 / 3.0), (2, 4.0 / 9.0)],
/// };
/// let method = Rkmk(&RALSTON);
/// # let _ = method;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rkmk<const N: usize>(pub &'static Tableau<N>);

impl<Sys: System + ?Sized, const N: usize> Method<Sys> for Rkmk<N> {
    fn order(&self) -> u32 {
        self.0.order
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
        let mut stages: Stages<Sys, N> = Stages::start(system, state, inputs)?;
        for (index, row) in self.0.rows.iter().enumerate().skip(1) {
            stages.evaluate(system, state, h, inputs, index, row)?;
        }
        stages.sums(system, h, self.0.closing).end(system, state, h)
    }
}

impl<const N: usize> InChart for Rkmk<N> {
    #[inline]
    fn step_slopes<Sys: Tangent>(
        &self,
        step: &TangentStep<'_, Sys>,
        slopes: &mut Sys::Slopes,
        in_dual_numbers: impl FnOnce(&mut Sys::Slopes) -> Result<State<Sys>, StepError>,
    ) -> Result<State<Sys>, StepError> {
        match Sys::PLAIN {
            true => step.explicit::<N>(&self.0.rows, self.0.closing, slopes),
            false => in_dual_numbers(slopes),
        }
    }
}

/// Rates kᵢ and fᵢ of the stages of one step.
///
/// Its functions are `inline(always)`: calls would pass stages through memory, which costs a third of a step of a small
/// system.
pub(crate) struct Stages<Sys: System + ?Sized, const N: usize> {
    pub(crate) k: [Sys::Chart; N],
    pub(crate) f: [Sys::Velocities; N],
}

/// Weighted sums of the stages, u = h Σ aⱼ kⱼ and Δξ = h Σ aⱼ fⱼ.
pub(crate) struct Sums<Sys: System + ?Sized> {
    pub(crate) u: Sys::Chart,
    pub(crate) dxi: Sys::Velocities,
}

impl<Sys: System + ?Sized, const N: usize> Stages<Sys, N> {
    /// Creates stages that are all zero.
    #[inline(always)]
    pub(crate) fn empty(system: &Sys) -> Self {
        Self {
            k: from_fn(|_| system.zero_chart()),
            f: from_fn(|_| system.zero_velocities()),
        }
    }

    /// Evaluates the first stage, at u = 0, where dexpinv is the identity.
    #[inline(always)]
    pub(crate) fn start<U>(system: &Sys, state: &State<Sys>, inputs: &U) -> Result<Self, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let mut stages = Self::empty(system);
        let f = acceleration(system, state.t, 0.0, &state.x, &state.xi, inputs)?;
        stages.set(0, system.chart_rate(&state.x, &state.xi), f);
        Ok(stages)
    }

    /// Evaluates stage `index` from those before it; returns the sums that lead to its point.
    #[inline(always)]
    pub(crate) fn evaluate<U>(
        &mut self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
        index: usize,
        row: &Row,
    ) -> Result<Sums<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let sums = self.sums(system, h, row.weights);
        let (x, xi) = sums.point(system, state);
        let mut k = system.chart_rate(&x, &xi);
        manifold::dexpinv(system.blocks(), sums.u.as_ref(), k.as_mut());
        let f = acceleration(system, state.t, row.node * h, &x, &xi, inputs)?;
        self.set(index, k, f);
        Ok(sums)
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, index: usize, k: Sys::Chart, f: Sys::Velocities) {
        if let (Some(k_slot), Some(f_slot)) = (self.k.get_mut(index), self.f.get_mut(index)) {
            (*k_slot, *f_slot) = (k, f);
        }
    }

    #[inline(always)]
    pub(crate) fn sums(&self, system: &Sys, h: f64, weights: Weights) -> Sums<Sys> {
        let mut sums = Sums::<Sys> {
            u: system.zero_chart(),
            dxi: system.zero_velocities(),
        };
        for (j, weight) in weights {
            let a = h * weight;
            if let (Some(k), Some(f)) = (self.k.get(*j), self.f.get(*j)) {
                add_scaled(sums.u.as_mut(), a, k.as_ref());
                add_scaled(sums.dxi.as_mut(), a, f.as_ref());
            }
        }
        sums
    }
}

impl<Sys: System + ?Sized> Sums<Sys> {
    /// Returns x moved along u, and ξ + Δξ.
    #[inline(always)]
    pub(crate) fn point(
        &self,
        system: &Sys,
        state: &State<Sys>,
    ) -> (Sys::Coordinates, Sys::Velocities) {
        let mut x = state.x.clone();
        manifold::retract(system.blocks(), x.as_mut(), self.u.as_ref());
        let mut xi = state.xi.clone();
        add(xi.as_mut(), self.dxi.as_ref());
        (x, xi)
    }

    /// Returns the state at the end of a step, on its manifold.
    #[inline(always)]
    pub(crate) fn end(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
    ) -> Result<State<Sys>, StepError> {
        let (x, xi) = self.point(system, state);
        arrive(system, state, h, x, xi)
    }
}
