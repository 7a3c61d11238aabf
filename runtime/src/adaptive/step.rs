//! An accepted step with its dense output.
//!
//! u(θ) and ξ(θ) are polynomials in θ ∈ (0, 1); the orientation at θ is R₀ exp(u(θ)). With the changes Δ over the step
//! and the rates at its ends, y(θ) = y₀ + θ (r₂ + θ' (r₃ + θ (r₄ + θ' (r₅ + …)))), θ' = 1 − θ, r₂ = Δ, r₃ = h y'₀ − Δ,
//! r₄ = Δ − h y'₁ − r₃, and further terms h Σ dⱼ kⱼ of the method. Source: E. Hairer, S. P. Nørsett, G. Wanner,
//! *Solving Ordinary Differential Equations I* (1993), II.6.

use core::fmt;

use crate::adaptive::Pair;
use crate::clock::Clock;
use crate::manifold;
use crate::methods::tableau::{Stages, Sums};
use crate::state::State;
use crate::store::{add, add_scaled, scale};
use crate::system::System;

/// An accepted step, with the state at any time within it.
pub struct Step<'s, Sys: System + ?Sized, const D: usize> {
    pub(crate) system: &'s Sys,
    pub(crate) start: &'s State<Sys>,
    pub(crate) end: State<Sys>,
    /// Length of the step for which the polynomials hold, even if an event shortens the step.
    pub(crate) h: f64,
    /// Clock of the run, if the description declares time.
    pub(crate) clock: Option<Clock<Sys::Scalar>>,
    hermite: [Sums<Sys>; 3],
    further: [Sums<Sys>; D],
}

impl<Sys: System + ?Sized, const D: usize> Step<'_, Sys, D> {
    /// Returns the state at the start of the step.
    pub fn start(&self) -> &State<Sys> {
        self.start
    }

    /// Returns the state at the end of the step.
    pub fn end(&self) -> &State<Sys> {
        &self.end
    }

    /// Returns the state at any time from the start to the end of the step; times outside give the nearer end.
    ///
    /// The error is of the size of the error of the step. Constraints that multipliers enforce hold exactly only at the
    /// ends.
    pub fn at(&self, t: f64) -> State<Sys> {
        let theta = (t - self.start.t) / self.h;
        if theta.is_nan() || theta <= 0.0 {
            self.start.clone()
        } else if theta >= (self.end.t - self.start.t) / self.h {
            self.end.clone()
        } else {
            let mut state = self.within(theta);
            state.t = t;
            if let Some(clock) = &self.clock {
                clock.set(&mut state);
            }
            state
        }
    }

    /// Evaluates the polynomials at 0 < θ < 1.
    fn within(&self, theta: f64) -> State<Sys> {
        let mut sum = Sums::<Sys> {
            u: self.system.zero_chart(),
            dxi: self.system.zero_velocities(),
        };
        let mut outwards = (3 + D) % 2 == 1;
        for term in self.further.iter().rev().chain(self.hermite.iter().rev()) {
            let factor = if outwards { theta } else { 1.0 - theta };
            outwards = !outwards;
            add(sum.u.as_mut(), term.u.as_ref());
            add(sum.dxi.as_mut(), term.dxi.as_ref());
            scale(sum.u.as_mut(), factor);
            scale(sum.dxi.as_mut(), factor);
        }
        let (mut x, xi) = sum.point(self.system, self.start);
        manifold::normalise(self.system.blocks(), x.as_mut());
        let t = self.start.t + theta * self.h;
        State { t, x, xi }
    }

    /// Creates the step over which the stages were evaluated; `change` is the sum of the stages, u and Δξ.
    pub(crate) fn new<'s, const M: usize>(
        system: &'s Sys,
        start: &'s State<Sys>,
        end: State<Sys>,
        h: f64,
        stages: &Stages<Sys, M>,
        pair: &Pair<M, D>,
        change: Sums<Sys>,
    ) -> Step<'s, Sys, D> {
        let mut rise = slope(system, stages, 0, h);
        add_scaled(rise.u.as_mut(), -1.0, change.u.as_ref());
        add_scaled(rise.dxi.as_mut(), -1.0, change.dxi.as_ref());
        let mut fall = slope(system, stages, pair.end, -h);
        for (sign, other) in [(1.0, &change), (-1.0, &rise)] {
            add_scaled(fall.u.as_mut(), sign, other.u.as_ref());
            add_scaled(fall.dxi.as_mut(), sign, other.dxi.as_ref());
        }
        Step {
            system,
            start,
            end,
            h,
            clock: None,
            hermite: [change, rise, fall],
            further: pair.dense.map(|weights| stages.sums(system, h, weights)),
        }
    }
}

/// Returns h k and h f of one stage.
fn slope<Sys: System + ?Sized, const M: usize>(
    system: &Sys,
    stages: &Stages<Sys, M>,
    index: usize,
    h: f64,
) -> Sums<Sys> {
    let mut slope = Sums::<Sys> {
        u: system.zero_chart(),
        dxi: system.zero_velocities(),
    };
    if let (Some(k), Some(f)) = (stages.k.get(index), stages.f.get(index)) {
        add_scaled(slope.u.as_mut(), h, k.as_ref());
        add_scaled(slope.dxi.as_mut(), h, f.as_ref());
    }
    slope
}

impl<Sys: System + ?Sized, const D: usize> fmt::Debug for Step<'_, Sys, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Step")
            .field("start", self.start)
            .field("end", &self.end)
            .finish_non_exhaustive()
    }
}
