//! Force-free motion in closed form, without time steps.
//!
//! If no force acts, the state at any time follows from the initial state: rotors by the flows of
//! [`flows`](crate::flows), everything else by uniform motion. Errors do not accumulate.

use crate::error::StepError;
use crate::flows::Flow;
use crate::methods::Method;
use crate::methods::phase::Phase;
use crate::split::Split;
use crate::state::State;

/// Exact for steps of any length; for systems of [`Split`] without forces.
///
/// To get many states from one initial state, use [`at`], which accumulates no rounding errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Free;

/// Returns the state at the time `t`, before or after that of `start`.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// # hamel::rigid_eom! {
/// #     system Body {
/// #         param Theta: sym3 = [[2.1, 0.1, 0], [0.1, 1.7, 0], [0, 0, 1.2]];
/// #         coord R: SO3;
/// #         velocity w: vec3;
/// #         rate R = R * hat(w);
/// #         frame hull = pose(R, [0, 0, 0]);
/// #         body on hull { mass 1; inertia Theta about origin; }
/// #         start w = [0.01, 2, 0.01];
/// #     }
/// # }
///
/// use hamel::{State, methods::free};
///
/// let body = Body::<f64>::default();
/// let start = State::start(&body);
/// // A thousand time units ahead, and back again.
/// let later = free::at(&body, &start, 1000.0)?;
/// let back = free::at(&body, &later, 0.0)?;
/// assert!(back.xi.iter().zip(start.xi).all(|(a, b)| (a - b).abs() < 1e-9));
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
///
/// # Errors
/// [`StepError::Forces`] if forces may act; [`StepError::NonFinite`], [`StepError::Shape`].
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
    /// Returns 0: the method is exact and has no order.
    fn order(&self) -> u32 {
        0
    }

    #[inline]
    fn preserves_constraints(&self) -> bool {
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
