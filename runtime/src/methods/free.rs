//! The closed form of torque-free motion: no steps at all.
//!
//! Where no force acts, the state at any time follows from the start: rotors by the flows of
//! [`flows`](crate::flows), everything else uniformly. Errors do not accumulate.

use crate::error::StepError;
use crate::flows::Flow;
use crate::methods::Method;
use crate::methods::phase::Phase;
use crate::split::Split;
use crate::state::State;

/// Exact, whatever the step; for systems of [`Split`] without forces.
///
/// From one start to many times use [`at`], which accumulates no rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Free;

/// The state at the time `t`, before or after that of `start`.
///
/// # Errors
/// [`StepError::Forces`] where forces may act; [`StepError::NonFinite`], [`StepError::Shape`].
pub fn at<Sys: Split + ?Sized>(
    system: &Sys,
    start: &State<Sys>,
    t: f64,
) -> Result<State<Sys>, StepError> {
    let mut state = after(system, start, t - start.t)?;
    state.t = t;
    Ok(state)
}

#[inline]
fn after<Sys: Split + ?Sized>(
    system: &Sys,
    start: &State<Sys>,
    h: f64,
) -> Result<State<Sys>, StepError> {
    if !Sys::FREE {
        return Err(StepError::Forces { time: start.t });
    }
    let mut phase = Phase::new(system, start)?;
    phase.drift(h, &Flow::Exact);
    phase.arrive();
    phase.state(h)
}

impl<Sys: Split + ?Sized> Method<Sys> for Free {
    /// Of no order: 0, since there is no error to be of one.
    fn order(&self) -> u32 {
        0
    }

    #[inline]
    fn stays_near(&self) -> bool {
        true
    }

    #[inline]
    fn step<U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        _: &U,
    ) -> Result<State<Sys>, StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        after(system, state, h)
    }
}
