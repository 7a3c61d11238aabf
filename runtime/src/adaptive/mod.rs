//! Integration with adaptive step size: error control, dense output, events.
//!
//! The methods are embedded explicit Runge-Kutta pairs in the chart. u and ξ are advanced and their errors estimated as
//! in any Runge-Kutta pair; errors are measured in rad for angles, and relative to the size of the values for the rest
//! ([`Tolerance`]). The state is also available between the ends of a step ([`Step::at`]), and so are the times at
//! which a function of the state changes its sign ([`Event`]).
//!
//! ```
//! # use hamel::{s1, Block, Singular, State, System};
//! # struct Pendulum;
//! # impl System for Pendulum {
//! #     type Scalar = f64;
//! #     type Coordinates = [f64; 2];
//! #     type Velocities = [f64; 1];
//! #     type Chart = [f64; 1];
//! #     type Inputs = [f64; 0];
//! #     fn blocks(&self) -> &[Block] { &[Block::Circle] }
//! #     fn start(&self) -> ([f64; 2], [f64; 1]) { (s1::exp(1.0), [0.0]) }
//! #     fn chart_rate(&self, _: &[f64; 2], xi: &[f64; 1]) -> [f64; 1] { *xi }
//! #     fn forward_dynamics(&self, x: &[f64; 2], _: &[f64; 1], _: &[f64; 0]) -> Result<[f64; 1], Singular> {
//! #         Ok([-9.81 * x[1]])
//! #     }
//! # }
//! # fn main() -> Result<(), hamel::StepError> {
//! use hamel::Run;
//! use hamel::adaptive::{Adaptive, Event, Report};
//!
//! // A pendulum of length 1, x = (cos θ, sin θ), let go at θ = 1: where does it first hang straight?
//! let mut greatest: f64 = 0.0;
//! let (end, outcome) = Run::new(&Pendulum)
//!     .adaptive(Adaptive::rkmk54(1e-9))
//!     .events(&[Event::new(&|state: &State<Pendulum>| state.x[1]).stopping()])
//!     .report(|report| if let Report::Step(step) = report {
//!         // Between the ends of the step, too.
//!         let middle = 0.5 * (step.start().t + step.end().t);
//!         greatest = greatest.max(step.at(middle).xi[0].abs());
//!     })
//!     .until(10.0)?;
//! assert_eq!(outcome.stopped_by, Some(0));
//! assert!(end.x[1].abs() < 1e-8 && end.t < 1.0);
//! # Ok(())
//! # }
//! ```

pub(crate) mod control;
mod events;
pub(crate) mod pair;
mod start;
mod step;
mod stiff;

pub use control::Tolerance;
pub use events::{Direction, Event};
pub use pair::Pair;
pub use step::Step;

use core::ops::{AddAssign, ControlFlow};

use crate::adaptive::control::{Controller, power};
use crate::adaptive::stiff::Stiffness;
use crate::clock::Clock;
use crate::error::StepError;
use crate::integrate::{acceleration, project, project_coordinates};
use crate::methods::tableau::{Stages, Sums};
use crate::methods::{rkmk8, rkmk54};
use crate::scalar::Scalar;
use crate::state::State;
use crate::system::System;

/// An embedded Runge-Kutta pair with the settings of its step-size control.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// # hamel::rigid_eom! {
/// #     system Pendulum {
/// #         coord q;
/// #         velocity w;
/// #         rate q = w;
/// #         kinetic w^2 / 2;
/// #         potential -cos(q);
/// #         input tau;
/// #         generalized force w = tau;
/// #         start q = 1;
/// #     }
/// # }
///
/// use hamel::{State, adaptive::Adaptive};
///
/// let pendulum = Pendulum::<f64>::default();
/// let mut method = Adaptive::rkmk8(1e-10);
/// method.longest = 0.5;
/// let mut state = State::start(&pendulum);
/// let statistics = method.run(&pendulum, &mut state, 10.0, |_, _, _| [0.0])?;
/// assert!(statistics.accepted >= 20);
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Adaptive<const M: usize, const D: usize> {
    pair: &'static Pair<M, D>,
    /// Error allowed in one step.
    pub tolerance: Tolerance,
    /// Length of the first step, in time; `None` for Hairer's rule, which costs one more evaluation of ξ̇.
    pub first: Option<f64>,
    /// Largest step, in time.
    pub longest: f64,
    /// Accuracy of the times of events; never finer than the rounding of t.
    pub precision: f64,
    /// Largest number of remaining steps that a stiff motion may need; beyond it the run ends with
    /// [`StepError::Stiff`]. One million by default.
    pub stiff: f64,
}

impl Adaptive<7, 1> {
    /// Creates the adaptive [`Rkmk54`](crate::methods::Rkmk54): six evaluations of ξ̇ per accepted step, dense output
    /// of order 4; for tolerances of 1e-3 to 1e-8.
    pub const fn rkmk54(tolerance: f64) -> Self {
        Self::new(&rkmk54::PAIR, Tolerance::new(tolerance))
    }
}

impl Adaptive<16, 4> {
    /// Creates the adaptive [`Rkmk8`](crate::methods::Rkmk8): twelve evaluations of ξ̇ per accepted step, three more
    /// for dense output of order 7; for tolerances of 1e-6 to 1e-13.
    pub const fn rkmk8(tolerance: f64) -> Self {
        Self::new(&rkmk8::PAIR, Tolerance::new(tolerance))
    }
}

/// Numbers of steps and evaluations of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Steps taken.
    pub accepted: u64,
    /// Attempts rejected because their error was too large or ξ̇ could not be computed.
    pub rejected: u64,
    /// Evaluations of ξ̇.
    pub evaluations: u64,
}

impl AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        self.accepted += other.accepted;
        self.rejected += other.rejected;
        self.evaluations += other.evaluations;
    }
}

/// Result of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Numbers of steps and evaluations.
    pub statistics: Statistics,
    /// Index of the event that stopped the run; `None` if the run reached its end time.
    pub stopped_by: Option<usize>,
}

/// Report to an observer. Reports come in order of time; the events within a step come before the step.
#[derive(Debug)]
pub enum Report<'r, Sys: System + ?Sized, const D: usize> {
    /// An event happened.
    Event {
        /// Index in the list of events.
        index: usize,
        /// State at the located time of the event, where g has just changed its sign.
        state: &'r State<Sys>,
    },
    /// A step was taken. A step in which an event stops the run ends at that event.
    Step(&'r Step<'r, Sys, D>),
}

impl<const M: usize, const D: usize> Adaptive<M, D> {
    /// Creates a method from an embedded Runge-Kutta pair and a tolerance; steps are not limited, and the first one follows
    /// Hairer's rule.
    pub const fn new(pair: &'static Pair<M, D>, tolerance: Tolerance) -> Self {
        Self {
            pair,
            tolerance,
            first: None,
            longest: f64::INFINITY,
            precision: 0.0,
            stiff: 1e6,
        }
    }

    /// Integrates `state` to the time `until`, forwards or backwards, and projects it onto the constraints that
    /// multipliers enforce after every step. `inputs(t, x, ξ)` returns u.
    ///
    /// # Errors
    /// [`StepError`]; `state` is then the last valid one.
    pub fn run<Sys, U>(
        &self,
        system: &Sys,
        state: &mut State<Sys>,
        until: f64,
        inputs: U,
    ) -> Result<Statistics, StepError>
    where
        Sys: System + ?Sized,
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let nothing = |_: &mut Step<'_, Sys, D>| Ok(None);
        let observe = |_: &State<Sys>| ControlFlow::Continue(());
        let (outcome, _) = self.drive(system, state, until, &inputs, false, nothing, observe)?;
        Ok(outcome.statistics)
    }

    /// Integrates like [`run`](Self::run), with events and an observer of events and steps.
    ///
    /// # Errors
    /// [`StepError`]; `state` is then the last valid one. An event function that returns NaN leads to
    /// [`StepError::NonFinite`].
    pub fn integrate<Sys, U, O>(
        &self,
        system: &Sys,
        state: &mut State<Sys>,
        until: f64,
        inputs: U,
        events: &[Event<'_, Sys>],
        mut observe: O,
    ) -> Result<Outcome, StepError>
    where
        Sys: System + ?Sized,
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
        O: FnMut(Report<'_, Sys, D>),
    {
        let report = |step: &mut Step<'_, Sys, D>| self.report(step, events, &mut observe);
        let observe = |_: &State<Sys>| ControlFlow::Continue(());
        let (outcome, _) = self.drive(system, state, until, &inputs, true, report, observe)?;
        Ok(outcome)
    }

    /// Reports the events of a step and the step itself; returns the index of an event that stops the run.
    pub(crate) fn report<Sys, O>(
        &self,
        step: &mut Step<'_, Sys, D>,
        events: &[Event<'_, Sys>],
        observe: &mut O,
    ) -> Result<Option<usize>, StepError>
    where
        Sys: System + ?Sized,
        O: FnMut(Report<'_, Sys, D>),
    {
        let stopped_by = self.happen(step, events, observe)?;
        observe(Report::Step(step));
        Ok(stopped_by)
    }

    /// Reports the events of a step in order of time. An event that stops the run becomes the end of the step; its
    /// index is returned.
    fn happen<Sys, O>(
        &self,
        step: &mut Step<'_, Sys, D>,
        events: &[Event<'_, Sys>],
        observe: &mut O,
    ) -> Result<Option<usize>, StepError>
    where
        Sys: System + ?Sized,
        O: FnMut(Report<'_, Sys, D>),
    {
        let (from, to) = (step.start().t, step.end().t);
        let resolution = 2.0 * f64::EPSILON * from.abs().max(to.abs());
        let precision = self.precision.max(resolution);
        // Elapsed time and index of the last reported event. Later events are searched for anew, so no list is stored.
        let mut last = None;
        loop {
            let mut next: Option<(f64, usize, f64)> = None;
            for (index, event) in events.iter().enumerate() {
                if let Some(time) = event.time(step, precision)? {
                    let elapsed = (time - from).abs();
                    let is_new = last.is_none_or(|last| (elapsed, index) > last);
                    if is_new && next.is_none_or(|(best, ..)| elapsed < best) {
                        next = Some((elapsed, index, time));
                    }
                }
            }
            let Some((elapsed, index, time)) = next else {
                return Ok(None);
            };
            let mut state = step.at(time);
            project_coordinates(step.system, &mut state);
            project(step.system, &mut state)?;
            observe(Report::Event {
                index,
                state: &state,
            });
            if events.get(index).is_some_and(|event| event.stops) {
                step.end = state;
                return Ok(Some(index));
            }
            last = Some((elapsed, index));
        }
    }

    /// Runs the loop over attempted steps. If `dense`, `accept` sees every accepted step together with its dense
    /// output, and may shorten the step and end the run. `observe` sees the state after every step. Also returns whether
    /// either of them ended the run.
    pub(crate) fn drive<Sys, U>(
        &self,
        system: &Sys,
        state: &mut State<Sys>,
        until: f64,
        inputs: &U,
        dense: bool,
        mut accept: impl FnMut(&mut Step<'_, Sys, D>) -> Result<Option<usize>, StepError>,
        mut observe: impl FnMut(&State<Sys>) -> ControlFlow<()>,
    ) -> Result<(Outcome, ControlFlow<()>), StepError>
    where
        Sys: System + ?Sized,
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        state.check_shape(system)?;
        self.tolerance.check::<Sys::Scalar>()?;
        if !state.is_finite() {
            return Err(StepError::NonFinite { time: state.t });
        }
        let span = until - state.t;
        let longest = self.longest.min(span.abs());
        let first = self.first.unwrap_or(longest);
        let advances = self.longest > 0.0 && (first > 0.0 || span == 0.0);
        if !span.is_finite() || !advances {
            let step = first.min(self.longest);
            return Err(StepError::InvalidStep { step, span });
        }
        let mut outcome = Outcome::default();
        if span == 0.0 {
            return Ok((outcome, ControlFlow::Continue(())));
        }
        let statistics = &mut outcome.statistics;
        let mut stages: Stages<Sys, M> = Stages::start(system, state, inputs)?;
        statistics.evaluations += 1;
        let clock = Clock::new(system, state);
        let direction = if span < 0.0 { -1.0 } else { 1.0 };
        let mut length = match self.first {
            Some(first) => first.min(longest),
            None => {
                statistics.evaluations += 1;
                self.first_step(system, state, inputs, &stages, direction, longest)?
            }
        };
        let mut controller = Controller::new(self.pair.order);
        let mut stiffness = Stiffness::default();
        while state.t != until {
            let left = (until - state.t).abs();
            let is_last = 1.01 * length >= left;
            let h = if is_last {
                until - state.t
            } else {
                direction * length
            };
            let attempt = self.attempt(system, state, h, inputs, dense, &mut stages, statistics);
            let (mut end, change, q) = match attempt {
                Ok(attempt) if attempt.2 <= 1.0 => attempt,
                attempt => {
                    statistics.rejected += 1;
                    length =
                        h.abs() * controller.refuse(attempt.as_ref().map_or(f64::NAN, |a| a.2));
                    // The step may have been so long that it hit a point where ξ̇ does not exist; if even the shortest
                    // steps fail there, that singularity is the error to report.
                    if length < 16.0 * f64::EPSILON * state.t.abs().max(until.abs()) {
                        let (time, step) = (state.t, direction * length);
                        return Err(match attempt {
                            Err(cause) => cause,
                            Ok(_) => StepError::StepTooSmall { time, step },
                        });
                    }
                    continue;
                }
            };
            if is_last {
                end.t = until;
            }
            if let Some(clock) = &clock {
                clock.set(&mut end);
            }
            let corrected = project_coordinates(system, &mut end);
            let moved = project(system, &mut end)? || corrected;
            let mut stopped_by = None;
            if dense {
                let mut step = Step::new(system, state, end, h, &stages, self.pair, change);
                step.clock = clock;
                stopped_by = accept(&mut step)?;
                end = step.end;
            }
            *state = end;
            statistics.accepted += 1;
            let observed = observe(state);
            if left > self.stiff * h.abs()
                && let Some(rate) = stiffness.after(system, &stages, self.pair, h)
            {
                let (time, step) = (state.t, h);
                return Err(StepError::Stiff { time, step, rate });
            }
            if stopped_by.is_some() || observed.is_break() {
                outcome.stopped_by = stopped_by;
                return Ok((outcome, ControlFlow::Break(())));
            }
            length = (h.abs() * controller.accept(q)).min(longest);

            // The last stage of the pair is the first stage of the next step (FSAL), unless the state was projected
            // since.
            let mut f = stages.f.get(self.pair.end).cloned();
            if moved {
                statistics.evaluations += 1;
                f = Some(acceleration(
                    system, state.t, 0.0, &state.x, &state.xi, inputs,
                )?);
            }
            if let Some(f) = f {
                stages.set(0, system.chart_rate(&state.x, &state.xi), f);
            }
        }
        Ok((outcome, ControlFlow::Continue(())))
    }

    /// Evaluates the stages of one step; returns its end, its change, and its estimated error divided by the tolerance.
    #[inline]
    fn attempt<Sys, U>(
        &self,
        system: &Sys,
        state: &State<Sys>,
        h: f64,
        inputs: &U,
        dense: bool,
        stages: &mut Stages<Sys, M>,
        statistics: &mut Statistics,
    ) -> Result<(State<Sys>, Sums<Sys>, f64), StepError>
    where
        Sys: System + ?Sized,
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        let mut change = stages.sums(system, h, &[]);
        for (index, row) in self.pair.rows.iter().enumerate().skip(1) {
            if index > self.pair.end && !dense {
                break;
            }
            statistics.evaluations += 1;
            let sums = stages.evaluate(system, state, h, inputs, index, row)?;
            if index == self.pair.end {
                change = sums;
            }
        }
        let end = change.end(system, state, h)?;
        let q = self.error(system, stages, h, &end);
        Ok((end, change, q))
    }

    /// Returns the estimated error divided by the tolerance.
    fn error<Sys: System + ?Sized>(
        &self,
        system: &Sys,
        stages: &Stages<Sys, M>,
        h: f64,
        end: &State<Sys>,
    ) -> f64 {
        let mut sizes = self.pair.errors.iter().map(|weights| {
            let Sums { u, dxi } = stages.sums(system, h, weights);
            let at = (&end.x, &end.xi);
            self.tolerance
                .weigh::<Sys::Scalar>(system.blocks(), (&u, &dxi), at)
        });
        let first = sizes.next().unwrap_or(f64::NAN);
        match sizes.next() {
            None => first,
            Some(_) if first == 0.0 => first,
            Some(second) => {
                let ratio = second / first;
                first / Scalar::sqrt(1.0 + 0.01 * ratio * ratio)
            }
        }
    }
}
