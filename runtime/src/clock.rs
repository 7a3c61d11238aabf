//! Time as a coordinate, kept exact along a run.

use crate::scalar::Scalar;
use crate::state::State;
use crate::system::System;

/// Keeps the time coordinate of a description equal to its initial value plus the time since the start of the run.
///
/// Without a clock, each step would add its length to this coordinate, and rounding errors would accumulate.
///
/// [`integrate`](crate::integrate()) and the other runs of this crate use a clock themselves. Create one only for a
/// loop of your own over [`step`](crate::step()).
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use hamel::{Clock, State, methods::Rkmk4, step};
///
/// hamel::rigid_eom! {
///     /// A mass that is pushed in time with a motor.
///     system Shaker {
///         time t;
///         coord q;
///         velocity v;
///         rate q = v;
///         kinetic v^2 / 2;
///         generalized force v = sin(t);
///     }
/// }
///
/// let shaker = Shaker::<f64>::default();
/// let mut state = State::start(&shaker);
/// let clock = Clock::new(&shaker, &state).expect("the description declares time");
/// for index in 1..=1000 {
///     step(&shaker, Rkmk4, &mut state, 0.01, &|_, _, _| [])?;
///     state.t = 0.01 * f64::from(index);
///     clock.set(&mut state);
/// }
/// assert_eq!(ShakerState::from(&state).t, 10.0);
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock<S> {
    place: usize,
    begin: S,
    from: f64,
}

impl<S: Scalar> Clock<S> {
    /// Creates the clock of a run from this state; `None` if the description declares no time.
    #[inline]
    pub fn new<Sys>(system: &Sys, start: &State<Sys>) -> Option<Self>
    where
        Sys: System<Scalar = S> + ?Sized,
    {
        let place = system.clock()?;
        Some(Self {
            place,
            begin: *start.x.as_ref().get(place)?,
            from: start.t,
        })
    }

    /// Returns the value of the time coordinate at the time t of the run.
    #[inline]
    pub fn at(&self, t: f64) -> S {
        self.begin + S::from_f64(t - self.from)
    }

    /// Sets the time coordinate in x according to the time `state.t` of the run.
    #[inline]
    pub fn set<Sys>(&self, state: &mut State<Sys>)
    where
        Sys: System<Scalar = S> + ?Sized,
    {
        let now = self.at(state.t);
        if let Some(entry) = state.x.as_mut().get_mut(self.place) {
            *entry = now;
        }
    }
}
