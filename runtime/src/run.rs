//! Runs that are built by chained calls.

use core::fmt;
use core::ops::ControlFlow;

use crate::adaptive::{Adaptive, Event, Outcome, Report, Step};
use crate::error::StepError;
use crate::integrate::integrate_while;
use crate::methods::Method;
use crate::state::State;
use crate::system::System;
use crate::zero_order_hold::ZeroOrderHold;

/// A run of a system, built by chained calls; `until` starts it and returns the state at its end.
///
/// | call | what it sets | without it |
/// |---|---|---|
/// | [`from`](Self::from) | the first state | [`System::start`] |
/// | [`method`](Self::method) and [`step`](Self::step) | a method in equal steps | one of the two is required |
/// | [`adaptive`](Self::adaptive) | a method with error control | |
/// | [`inputs`](Self::inputs) | u as a function of t, x and ξ | u = 0 |
/// | [`zero_order_hold`](Self::zero_order_hold) | a digital controller with a period of its own | |
/// | [`observe`](Self::observe) | a function that sees the first state and the state after every step | |
/// | [`stop_when`](Self::stop_when) | a condition that ends the run after a step | |
/// | [`events`](Self::events), [`report`](Self::report) | located events and dense output, with error control | |
///
/// Nothing is allocated. [`integrate`](crate::integrate()) and [`Adaptive`] are the plain functions beneath; they advance
/// a state in place, and after an error leave it at the last valid one. A run that fails returns the error alone; its
/// observers have seen all valid states.
///
/// ```
/// use hamel::{Block, Run, Singular, System, methods::Rkmk4};
///
/// /// A cart of mass 1 with a force: q̈ = u.
/// struct Cart;
///
/// impl System for Cart {
/// #   type Scalar = f64;
/// #   type Coordinates = [f64; 1];
/// #   type Velocities = [f64; 1];
/// #   type Chart = [f64; 1];
/// #   type Inputs = [f64; 1];
///     // ... as generated
/// #   fn blocks(&self) -> &[Block] { &[Block::Flat(1)] }
/// #   fn chart_rate(&self, _: &[f64; 1], xi: &[f64; 1]) -> [f64; 1] { *xi }
/// #   fn forward_dynamics(&self, _: &[f64; 1], _: &[f64; 1], u: &[f64; 1]) -> Result<[f64; 1], Singular> {
/// #       Ok(*u)
/// #   }
/// }
///
/// # fn main() -> Result<(), hamel::StepError> {
/// // A spring of stiffness 4 pulls the cart, which starts at rest at the origin, to the place 1.
/// let mut farthest: f64 = 0.0;
/// let end = Run::new(&Cart)
///     .method(Rkmk4)
///     .step(1e-3)
///     .inputs(|_, x, _| [4.0 * (1.0 - x[0])])
///     .observe(|state| farthest = farthest.max(state.x[0]))
///     .until(10.0)?;
/// assert_eq!(end.t, 10.0);
/// assert!((end.x[0] - (1.0 - 20.0_f64.cos())).abs() < 1e-9);
/// assert!((farthest - 2.0).abs() < 1e-5);
/// # Ok(())
/// # }
/// ```
#[must_use = "a run starts when `until` is called"]
pub struct Run<'s, Sys: System + ?Sized, M = (), U = (), O = Observer<Sys>> {
    system: &'s Sys,
    state: State<Sys>,
    method: M,
    inputs: U,
    observe: O,
}

/// A method in equal steps, as [`Run::step`] sets it.
#[derive(Clone, Copy, Debug)]
pub struct FixedStep<M> {
    method: M,
    length: f64,
}

/// A method with error control, events and reports, as [`Run::adaptive`] sets it.
pub struct ErrorControl<'e, Sys: System + ?Sized, R, const M: usize, const D: usize> {
    method: Adaptive<M, D>,
    events: &'e [Event<'e, Sys>],
    report: R,
    /// Whether anybody needs the dense output.
    dense: bool,
}

/// A function u(t, x, ξ); every closure of this form is one.
pub trait InputFunction<Sys: System + ?Sized>:
    Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs
{
}

impl<Sys, F> InputFunction<Sys> for F
where
    Sys: System + ?Sized,
    F: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
}

/// An observer that lets a run go on.
type Observer<Sys> = fn(&State<Sys>) -> ControlFlow<()>;

/// A report that is not read.
type Unread<Sys, const D: usize> = fn(Report<'_, Sys, D>);

impl<'s, Sys: System + ?Sized> Run<'s, Sys> {
    /// Creates a run from the initial state of the system, with u = 0.
    pub fn new(system: &'s Sys) -> Run<'s, Sys, (), impl InputFunction<Sys>> {
        Run {
            system,
            state: State::start(system),
            method: (),
            inputs: |_: f64, _: &Sys::Coordinates, _: &Sys::Velocities| system.zero_inputs(),
            observe: |_| ControlFlow::Continue(()),
        }
    }
}

impl<'s, Sys: System + ?Sized, M, U, O> Run<'s, Sys, M, U, O> {
    /// Sets the first state: a [`State`], or the state by names that comes with a generated system.
    pub fn from(mut self, state: impl Into<State<Sys>>) -> Self {
        self.state = state.into();
        self
    }

    /// Sets the inputs u = `inputs(t, x, ξ)`, which are evaluated at every point that the method visits.
    pub fn inputs<F>(self, inputs: F) -> Run<'s, Sys, M, F, O>
    where
        F: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    {
        Run {
            system: self.system,
            state: self.state,
            method: self.method,
            inputs,
            observe: self.observe,
        }
    }

    /// Sets a digital controller, which is called for u at the start and at every multiple of `period` after that; u is
    /// constant in between. Calls come in order of time, so the controller may have a state of its own. The run is
    /// forwards in time.
    pub fn zero_order_hold<C>(
        self,
        period: f64,
        controller: C,
    ) -> Run<'s, Sys, M, ZeroOrderHold<C>, O>
    where
        C: FnMut(&State<Sys>) -> Sys::Inputs,
    {
        Run {
            system: self.system,
            state: self.state,
            method: self.method,
            inputs: ZeroOrderHold::new(period, controller),
            observe: self.observe,
        }
    }

    /// Adds an observer of the first state and of the state after every step. Observers are called in the order in which
    /// they were added.
    pub fn observe<F>(
        self,
        mut observe: F,
    ) -> Run<'s, Sys, M, U, impl FnMut(&State<Sys>) -> ControlFlow<()>>
    where
        O: FnMut(&State<Sys>) -> ControlFlow<()>,
        F: FnMut(&State<Sys>),
    {
        let mut before = self.observe;
        Run {
            system: self.system,
            state: self.state,
            method: self.method,
            inputs: self.inputs,
            observe: move |state: &State<Sys>| {
                before(state)?;
                observe(state);
                ControlFlow::Continue(())
            },
        }
    }

    /// Adds a condition, tested at the first state and after every step, that ends the run in the state in which it
    /// holds.
    pub fn stop_when<P>(
        self,
        mut holds: P,
    ) -> Run<'s, Sys, M, U, impl FnMut(&State<Sys>) -> ControlFlow<()>>
    where
        O: FnMut(&State<Sys>) -> ControlFlow<()>,
        P: FnMut(&State<Sys>) -> bool,
    {
        let mut before = self.observe;
        Run {
            system: self.system,
            state: self.state,
            method: self.method,
            inputs: self.inputs,
            observe: move |state: &State<Sys>| {
                before(state)?;
                if holds(state) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        }
    }

    fn with_method<N>(self, method: impl FnOnce(M) -> N) -> Run<'s, Sys, N, U, O> {
        Run {
            system: self.system,
            state: self.state,
            method: method(self.method),
            inputs: self.inputs,
            observe: self.observe,
        }
    }
}

impl<'s, Sys: System + ?Sized, U, O> Run<'s, Sys, (), U, O> {
    /// Sets the method; [`step`](Run::step) has to follow.
    pub fn method<M: Method<Sys>>(self, method: M) -> Run<'s, Sys, M, U, O> {
        self.with_method(|()| method)
    }

    /// Sets a method with error control.
    ///
    /// ```
    /// # use hamel::{Block, Singular, System};
    /// # struct Oscillator;
    /// # impl System for Oscillator {
    /// #   type Scalar = f64;
    /// #   type Coordinates = [f64; 1];
    /// #   type Velocities = [f64; 1];
    /// #   type Chart = [f64; 1];
    /// #   type Inputs = [f64; 0];
    /// #   fn blocks(&self) -> &[Block] { &[Block::Flat(1)] }
    /// #   fn chart_rate(&self, _: &[f64; 1], xi: &[f64; 1]) -> [f64; 1] { *xi }
    /// #   fn forward_dynamics(&self, x: &[f64; 1], _: &[f64; 1], _: &[f64; 0]) -> Result<[f64; 1], Singular> {
    /// #       Ok([-x[0]])
    /// #   }
    /// # }
    /// # fn main() -> Result<(), hamel::StepError> {
    /// use hamel::adaptive::{Adaptive, Event};
    /// use hamel::{Run, State};
    ///
    /// // q̈ = −q, q = cos t: when does it first pass q = 0?
    /// let start = State { t: 0.0, x: [1.0], xi: [0.0] };
    /// let (end, outcome) = Run::new(&Oscillator)
    ///     .from(start)
    ///     .adaptive(Adaptive::rkmk8(1e-10))
    ///     .events(&[Event::new(&|state: &State<Oscillator>| state.x[0]).stopping()])
    ///     .until(10.0)?;
    /// assert_eq!(outcome.stopped_by, Some(0));
    /// assert!((end.t - std::f64::consts::FRAC_PI_2).abs() < 1e-8);
    /// # Ok(())
    /// # }
    /// ```
    pub fn adaptive<const M: usize, const D: usize>(
        self,
        method: Adaptive<M, D>,
    ) -> Run<'s, Sys, ErrorControl<'s, Sys, Unread<Sys, D>, M, D>, U, O> {
        let report: Unread<Sys, D> = |_| {};
        self.with_method(|()| ErrorControl {
            method,
            events: &[],
            report,
            dense: false,
        })
    }
}

impl<'s, Sys: System + ?Sized, M: Method<Sys>, U, O> Run<'s, Sys, M, U, O> {
    /// Sets the longest step. The steps of a run, or of a period of a controller, are equal.
    pub fn step(self, length: f64) -> Run<'s, Sys, FixedStep<M>, U, O> {
        self.with_method(|method| FixedStep { method, length })
    }
}

impl<'s, 'e, Sys, R, const M: usize, const D: usize, U, O>
    Run<'s, Sys, ErrorControl<'e, Sys, R, M, D>, U, O>
where
    Sys: System + ?Sized,
{
    /// Sets the events whose times are located; those that are [stopping](Event::stopping) end the run.
    pub fn events<'f>(
        self,
        events: &'f [Event<'f, Sys>],
    ) -> Run<'s, Sys, ErrorControl<'f, Sys, R, M, D>, U, O> {
        self.with_method(|control| ErrorControl {
            method: control.method,
            events,
            report: control.report,
            dense: true,
        })
    }

    /// Sets a function that is told of every event and of every step, with its dense output.
    pub fn report<F>(self, report: F) -> Run<'s, Sys, ErrorControl<'e, Sys, F, M, D>, U, O>
    where
        F: FnMut(Report<'_, Sys, D>),
    {
        self.with_method(|control| ErrorControl {
            method: control.method,
            events: control.events,
            report,
            dense: true,
        })
    }
}

impl<Sys, R, const M: usize, const D: usize> ErrorControl<'_, Sys, R, M, D>
where
    Sys: System + ?Sized,
    R: FnMut(Report<'_, Sys, D>),
{
    /// Runs to the time `until`; also returns whether an event or `observe` ended the run.
    fn drive<U, O>(
        &mut self,
        system: &Sys,
        state: &mut State<Sys>,
        until: f64,
        inputs: &U,
        observe: &mut O,
    ) -> Result<(Outcome, ControlFlow<()>), StepError>
    where
        U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
        O: FnMut(&State<Sys>) -> ControlFlow<()>,
    {
        let (method, report) = (&self.method, &mut self.report);
        let accept = |step: &mut Step<'_, Sys, D>| method.report(step, self.events, report);
        method.drive(system, state, until, inputs, self.dense, accept, observe)
    }
}

impl<Sys, M, U, O> Run<'_, Sys, FixedStep<M>, U, O>
where
    Sys: System + ?Sized,
    M: Method<Sys>,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    O: FnMut(&State<Sys>) -> ControlFlow<()>,
{
    /// Runs to the time `until`, forwards or backwards, and returns the state there, or where a condition stopped the
    /// run.
    ///
    /// # Errors
    /// Those of [`integrate`](crate::integrate()).
    pub fn until(mut self, until: f64) -> Result<State<Sys>, StepError> {
        let FixedStep { method, length } = self.method;
        integrate_while(
            self.system,
            method,
            &mut self.state,
            length,
            until,
            self.inputs,
            self.observe,
        )?;
        Ok(self.state)
    }
}

impl<Sys, M, C, O> Run<'_, Sys, FixedStep<M>, ZeroOrderHold<C>, O>
where
    Sys: System + ?Sized,
    M: Method<Sys>,
    C: FnMut(&State<Sys>) -> Sys::Inputs,
    O: FnMut(&State<Sys>) -> ControlFlow<()>,
{
    /// Runs to the time `until` and returns the state there, or where a condition stopped the run.
    ///
    /// # Errors
    /// Those of [`ZeroOrderHold::integrate`].
    pub fn until(mut self, until: f64) -> Result<State<Sys>, StepError> {
        let FixedStep { method, length } = self.method;
        self.inputs.integrate_while(
            self.system,
            method,
            &mut self.state,
            length,
            until,
            self.observe,
        )?;
        Ok(self.state)
    }
}

impl<Sys, R, const M: usize, const D: usize, U, O>
    Run<'_, Sys, ErrorControl<'_, Sys, R, M, D>, U, O>
where
    Sys: System + ?Sized,
    R: FnMut(Report<'_, Sys, D>),
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    O: FnMut(&State<Sys>) -> ControlFlow<()>,
{
    /// Runs to the time `until`, forwards or backwards, and returns the state there, or where an event or a condition
    /// stopped the run.
    ///
    /// # Errors
    /// Those of [`Adaptive::integrate`].
    pub fn until(mut self, until: f64) -> Result<(State<Sys>, Outcome), StepError> {
        if (self.observe)(&self.state).is_break() {
            return Ok((self.state, Outcome::default()));
        }
        let (system, state) = (self.system, &mut self.state);
        let (outcome, _) =
            (self.method).drive(system, state, until, &self.inputs, &mut self.observe)?;
        Ok((self.state, outcome))
    }
}

impl<Sys, R, const M: usize, const D: usize, C, O>
    Run<'_, Sys, ErrorControl<'_, Sys, R, M, D>, ZeroOrderHold<C>, O>
where
    Sys: System + ?Sized,
    R: FnMut(Report<'_, Sys, D>),
    C: FnMut(&State<Sys>) -> Sys::Inputs,
    O: FnMut(&State<Sys>) -> ControlFlow<()>,
{
    /// Runs to the time `until` and returns the state there, or where an event or a condition stopped the run.
    ///
    /// # Errors
    /// Those of [`ZeroOrderHold::adapt`].
    pub fn until(mut self, until: f64) -> Result<(State<Sys>, Outcome), StepError> {
        let mut outcome = Outcome::default();
        if (self.observe)(&self.state).is_break() {
            return Ok((self.state, outcome));
        }
        let (system, control, observe) = (self.system, &mut self.method, &mut self.observe);
        self.inputs
            .periods(system, &mut self.state, until, |state, end, u| {
                let inputs = |_: f64, _: &Sys::Coordinates, _: &Sys::Velocities| u.clone();
                let (part, flow) = control.drive(system, state, end, &inputs, observe)?;
                outcome.statistics += part.statistics;
                outcome.stopped_by = part.stopped_by;
                Ok(flow)
            })?;
        Ok((self.state, outcome))
    }
}

impl<Sys: System + ?Sized, M, U, O> fmt::Debug for Run<'_, Sys, M, U, O> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Run")
            .field("from", &self.state)
            .finish_non_exhaustive()
    }
}

impl<Sys: System + ?Sized, R, const M: usize, const D: usize> fmt::Debug
    for ErrorControl<'_, Sys, R, M, D>
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ErrorControl")
            .field("method", &self.method)
            .field("events", &self.events)
            .finish_non_exhaustive()
    }
}
