//! Detection of stiffness: whether stability, not accuracy, keeps the steps short.
//!
//! The last two stages of a step differ little, and mostly along the fastest direction, so the change of the rates
//! divided by the change of the points, ρ, estimates the spectral radius. If h ρ stays at the bound of the stability
//! region, it is stability that limits the step. Source: E. Hairer, G. Wanner, *Solving Ordinary Differential Equations
//! II* (1996), IV.2.

use crate::adaptive::pair::Pair;
use crate::methods::tableau::Stages;
use crate::scalar::Scalar;
use crate::store::add_scaled;
use crate::system::System;

/// Excess of steps at the stability bound over steps within it, at which the motion counts as stiff. A passage near a
/// singularity takes fewer such steps.
const MAX_STEPS_AT_BOUND: u32 = 1000;

/// Counter of steps at the stability bound.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stiffness {
    count: u32,
}

impl Stiffness {
    /// Records one more step; returns the rate ρ if the motion counts as stiff.
    pub(super) fn after<Sys: System + ?Sized, const M: usize, const D: usize>(
        &mut self,
        system: &Sys,
        stages: &Stages<Sys, M>,
        pair: &Pair<M, D>,
        h: f64,
    ) -> Option<f64> {
        let rate = rate(system, stages, pair, h)?;
        if rate * h.abs() < 0.8 * pair.stability {
            self.count = self.count.saturating_sub(1);
            return None;
        }
        self.count += 1;
        (self.count >= MAX_STEPS_AT_BOUND).then_some(rate)
    }
}

/// Returns the norm of the change of the rates between the last two stages of a step, divided by the norm of the change
/// of their points, in the worst lane.
fn rate<Sys: System + ?Sized, const M: usize, const D: usize>(
    system: &Sys,
    stages: &Stages<Sys, M>,
    pair: &Pair<M, D>,
    h: f64,
) -> Option<f64> {
    let before = pair.end.checked_sub(1)?;
    let point = |index: usize| Some(stages.sums(system, h, pair.rows.get(index)?.weights));
    let (mut moved, other) = (point(pair.end)?, point(before)?);
    add_scaled(moved.u.as_mut(), -1.0, other.u.as_ref());
    add_scaled(moved.dxi.as_mut(), -1.0, other.dxi.as_ref());
    let mut k = stages.k.get(pair.end)?.clone();
    let mut f = stages.f.get(pair.end)?.clone();
    add_scaled(k.as_mut(), -1.0, stages.k.get(before)?.as_ref());
    add_scaled(f.as_mut(), -1.0, stages.f.get(before)?.as_ref());
    let square = |sum: Sys::Scalar, entry: &Sys::Scalar| entry.inner_plus(*entry, sum);
    let size = |u: &[Sys::Scalar], v: &[Sys::Scalar]| {
        let sum = u.iter().fold(Sys::Scalar::default(), square);
        v.iter().fold(sum, square).sqrt()
    };
    let ratio = size(k.as_ref(), f.as_ref()) / size(moved.u.as_ref(), moved.dxi.as_ref());
    Some(ratio.largest_lane()).filter(|rate| rate.is_finite())
}
