//! The time among the coordinates, along a run.

use crate::scalar::Scalar;
use crate::state::State;
use crate::system::System;

/// Keeps the time that a description declares beside the time of a run: at every t it is what it was at the start of the
/// run, and what has passed since. Steps alone would add up their lengths, and what rounding does to each of these sums.
///
/// [`integrate`](crate::integrate()) and the other runs of this crate keep it so; it is for those who call
/// [`step`](crate::step()) again and again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock<S> {
    place: usize,
    begin: S,
    from: f64,
}

impl<S: Scalar> Clock<S> {
    /// That of a run from this state; `None` where the description declares no time.
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

    /// The time of the description at a time of the run.
    #[inline]
    pub fn at(&self, t: f64) -> S {
        self.begin + S::from_f64(t - self.from)
    }

    /// Sets the time of the description in a state to that of the run.
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
