//! Choice of the length of the first step.

use crate::adaptive::{Adaptive, power};
use crate::error::StepError;
use crate::integrate::acceleration;
use crate::methods::tableau::{Stages, Sums};
use crate::scalar::Scalar;
use crate::state::State;
use crate::store::{add_scaled, scale};
use crate::system::System;

impl<const M: usize, const D: usize> Adaptive<M, D> {
    /// Returns a length, at most `longest`, whose error is likely below the tolerance. It is derived from the sizes of
    /// the state, of its rates, and of the change of the rates over a trial step of Euler's method.
    ///
    /// Source: E. Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I* (1993),
    /// II.4. The size of an orientation is taken as 1 rad.
    pub(super) fn first_step<Sys, U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        inputs: &U,
        stages: &Stages<Sys, M>,
        direction: f64,
        longest: f64,
    ) -> Result<f64, StepError>
    where
        Sys: System + ?Sized,
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let (Some(k), Some(f)) = (stages.k.first(), stages.f.first()) else {
            return Ok(longest);
        };
        let weigh = |change: (&Sys::Chart, &Sys::Velocities)| {
            let at = (&state.x, &state.xi);
            self.tolerance
                .weigh::<Sys::Scalar>(system.blocks(), change, at)
        };
        let mut unit = system.zero_chart();
        for entry in unit.as_mut() {
            *entry = Sys::Scalar::from_f64(1.0);
        }
        let size = weigh((&unit, &state.xi));
        let rate = weigh((k, f));
        let smallest = 1e-6 * longest;
        let trial = (0.01 * size / rate).clamp(smallest, longest);
        let trial = if rate > 1e-5 { trial } else { smallest };

        let h = direction * trial;
        let mut euler = Sums::<Sys> {
            u: k.clone(),
            dxi: f.clone(),
        };
        scale(euler.u.as_mut(), h);
        scale(euler.dxi.as_mut(), h);
        let (x, xi) = euler.point(system, state);
        let mut k_change = system.chart_rate(&x, &xi);
        let Ok(mut f_change) = acceleration(system, state.t, direction * trial, &x, &xi, inputs)
        else {
            return Ok(smallest);
        };
        add_scaled(k_change.as_mut(), -1.0, k.as_ref());
        add_scaled(f_change.as_mut(), -1.0, f.as_ref());
        let bend = weigh((&k_change, &f_change)) / trial;

        let most = rate.max(bend);
        let length = if most > 1e-15 {
            power(0.01 / most, 1.0 / f64::from(self.pair.order + 1))
        } else {
            1e-3 * trial
        };
        Ok(length.min(100.0 * trial).clamp(smallest, longest))
    }
}
