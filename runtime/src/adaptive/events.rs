//! Events: times at which a function of the state changes its sign.
//!
//! A sign change between the ends of a step is located on the step's dense output by the ITP method, a bracketing
//! method of superlinear order that needs at most one evaluation more than bisection (I. F. D. Oliveira, R. H. C.
//! Takahashi, *An enhancement of the bisection method average performance preserving minmax optimality*, ACM TOMS 47
//! (2020) 5).

use core::fmt;

use crate::adaptive::step::Step;
use crate::error::StepError;
use crate::state::State;
use crate::system::System;

/// Which sign changes count as events, seen in the direction of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// Both.
    #[default]
    Any,
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
}

/// A function g of the state whose sign change is an event.
///
/// g is evaluated at the ends of every step. Two sign changes within one step are not detected, so
/// [`Adaptive::longest`](crate::adaptive::Adaptive::longest) has to be shorter than the time between them. A zero in
/// the first state of a run is not an event: a run may start where another one was stopped.
pub struct Event<'g, Sys: System + ?Sized> {
    pub(crate) function: &'g dyn Fn(&State<Sys>) -> f64,
    pub(crate) direction: Direction,
    pub(crate) stops: bool,
}

impl<'g, Sys: System + ?Sized> Event<'g, Sys> {
    /// Creates an event for sign changes of g in either direction, which does not end the run.
    pub fn new(function: &'g dyn Fn(&State<Sys>) -> f64) -> Self {
        Self {
            function,
            direction: Direction::Any,
            stops: false,
        }
    }

    /// Restricts the event to changes from negative to positive.
    pub fn rising(mut self) -> Self {
        self.direction = Direction::Rising;
        self
    }

    /// Restricts the event to changes from positive to negative.
    pub fn falling(mut self) -> Self {
        self.direction = Direction::Falling;
        self
    }

    /// Makes the run end at the event.
    pub fn stopping(mut self) -> Self {
        self.stops = true;
        self
    }

    fn value(&self, state: &State<Sys>) -> Result<f64, StepError> {
        let value = (self.function)(state);
        if value.is_nan() {
            Err(StepError::NonFinite { time: state.t })
        } else {
            Ok(value)
        }
    }

    /// Returns the time of the event within the step, if there is one: g has changed its sign at that time, and not yet
    /// `precision` earlier.
    pub(crate) fn time<const D: usize>(
        &self,
        step: &Step<'_, Sys, D>,
        precision: f64,
    ) -> Result<Option<f64>, StepError> {
        let (from, to) = (self.value(step.start())?, self.value(step.end())?);
        let rises = from < 0.0 && to >= 0.0 && self.direction != Direction::Falling;
        let falls = from > 0.0 && to <= 0.0 && self.direction != Direction::Rising;
        if !rises && !falls {
            return Ok(None);
        }
        let sign = if rises { 1.0 } else { -1.0 };
        let (a, b) = (step.start().t, step.end().t);
        let root = Bracket {
            a: 0.0,
            b: 1.0,
            below: sign * from,
            above: sign * to,
        };
        let at = |s: f64| if s < 1.0 { a + s * (b - a) } else { b };
        let tolerance = precision / (b - a).abs();
        let end = root.narrow(tolerance, |s| Ok(sign * self.value(&step.at(at(s)))?))?;
        Ok(Some(at(end)))
    }
}

impl<Sys: System + ?Sized> Clone for Event<'_, Sys> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Sys: System + ?Sized> Copy for Event<'_, Sys> {}

impl<Sys: System + ?Sized> fmt::Debug for Event<'_, Sys> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Event")
            .field("direction", &self.direction)
            .field("stops", &self.stops)
            .finish_non_exhaustive()
    }
}

/// An interval that brackets a root: the function is negative at a, and not negative at b > a.
struct Bracket {
    a: f64,
    b: f64,
    below: f64,
    above: f64,
}

impl Bracket {
    /// Shrinks the bracket to at most `tolerance` and returns its upper end.
    fn narrow(
        mut self,
        tolerance: f64,
        mut value: impl FnMut(f64) -> Result<f64, StepError>,
    ) -> Result<f64, StepError> {
        // Parameters in the notation of the paper: κ₁ = 0.2, κ₂ = 2, n₀ = 1; `reach` is ε 2^(n_max − j).
        let mut reach = 0.5 * tolerance;
        while reach < self.b - self.a {
            reach *= 2.0;
        }
        while self.b - self.a > tolerance {
            let middle = 0.5 * (self.a + self.b);
            let width = self.b - self.a;
            if !(self.a < middle && middle < self.b) {
                break;
            }
            let secant = (self.above * self.a - self.below * self.b) / (self.above - self.below);
            let towards = if secant < middle { 1.0 } else { -1.0 };
            let distance = (middle - secant).abs();
            let truncation = 0.2 * width * width;
            let truncated = if truncation <= distance {
                secant + towards * truncation
            } else {
                middle
            };
            let room = (reach - 0.5 * width).max(0.0);
            let projected = if (truncated - middle).abs() <= room {
                truncated
            } else {
                middle - towards * room
            };
            let point = if self.a < projected && projected < self.b {
                projected
            } else {
                middle
            };
            let here = value(point)?;
            if here < 0.0 {
                (self.a, self.below) = (point, here);
            } else {
                (self.b, self.above) = (point, here);
            }
            reach *= 0.5;
        }
        Ok(self.b)
    }
}
