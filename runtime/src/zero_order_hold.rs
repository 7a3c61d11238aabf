//! Digital controllers, which are called at a fixed period and hold their output in between.

use core::ops::ControlFlow;

use crate::adaptive::{Adaptive, Statistics};
use crate::clock::Clock;
use crate::error::StepError;
use crate::integrate::integrate_while;
use crate::methods::Method;
use crate::state::State;
use crate::system::System;

/// A digital controller with zero-order hold.
///
/// The controller is called for u at the start of a run and at every multiple of its period after that, and u is
/// constant in between. Calls come in order of time, so a controller may have a state of its own.
///
/// Steps end where u jumps. Every method therefore keeps its order, and error control never meets a jump within a step.
///
/// ```
/// # use hamel::{Block, Singular, State, System};
/// # use hamel::methods::Rkmk4;
/// # struct Cart;
/// # impl System for Cart {
/// #     type Scalar = f64; type Coordinates = [f64; 1]; type Velocities = [f64; 1]; type Chart = [f64; 1];
/// #     type Inputs = [f64; 1];
/// #     fn blocks(&self) -> &[Block] { &[Block::Flat(1)] }
/// #     fn chart_rate(&self, _: &[f64; 1], xi: &[f64; 1]) -> [f64; 1] { *xi }
/// #     fn forward_dynamics(&self, _: &[f64; 1], _: &[f64; 1], u: &[f64; 1]) -> Result<[f64; 1], Singular> { Ok(*u) }
/// # }
/// # fn main() -> Result<(), hamel::StepError> {
/// // A controller with integral action, called every 10 ms, holds a cart of mass 1 at the position 1.
/// let cart = Cart;
/// let mut state = State::start(&cart);
/// let mut integral = 0.0;
/// let mut controller = hamel::ZeroOrderHold::new(0.01, |state: &State<Cart>| {
///     integral += 0.01 * (1.0 - state.x[0]);
///     [3.0 * (1.0 - state.x[0]) + 1.0 * integral - 3.0 * state.xi[0]]
/// });
/// controller.integrate(&cart, Rkmk4, &mut state, 1e-3, 30.0, |_| {})?;
/// assert!((state.x[0] - 1.0).abs() < 1e-3);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ZeroOrderHold<C> {
    period: f64,
    controller: C,
}

impl<C> ZeroOrderHold<C> {
    /// Creates a controller that is called once per `period`, in the time unit of the description.
    pub const fn new(period: f64, controller: C) -> Self {
        Self { period, controller }
    }

    /// Integrates `state` to the time `until`, in steps no longer than `length`, as [`integrate`](crate::integrate()) does;
    /// the steps within a period are equal. `observe` is called with the first state and after every step.
    ///
    /// # Errors
    /// [`StepError`]; `state` is then the last valid one. [`StepError::InvalidStep`] if the period is not positive and
    /// finite, or if `until` lies in the past.
    pub fn integrate<Sys, M, O>(
        &mut self,
        system: &Sys,
        method: M,
        state: &mut State<Sys>,
        length: f64,
        until: f64,
        mut observe: O,
    ) -> Result<(), StepError>
    where
        Sys: System + ?Sized,
        M: Method<Sys>,
        C: FnMut(&State<Sys>) -> Sys::Inputs,
        O: FnMut(&State<Sys>),
    {
        let observe = |state: &State<Sys>| {
            observe(state);
            ControlFlow::Continue(())
        };
        self.integrate_while(system, method, state, length, until, observe)
    }

    /// Integrates like [`integrate`](Self::integrate) until `observe` breaks.
    pub(crate) fn integrate_while<Sys, M, O>(
        &mut self,
        system: &Sys,
        method: M,
        state: &mut State<Sys>,
        length: f64,
        until: f64,
        mut observe: O,
    ) -> Result<(), StepError>
    where
        Sys: System + ?Sized,
        M: Method<Sys>,
        C: FnMut(&State<Sys>) -> Sys::Inputs,
        O: FnMut(&State<Sys>) -> ControlFlow<()>,
    {
        if observe(state).is_break() {
            return Ok(());
        }
        self.periods(system, state, until, |state, end, u| {
            let from = state.t;
            let inputs = |_: f64, _: &Sys::Coordinates, _: &Sys::Velocities| u.clone();
            let mut flow = ControlFlow::Continue(());
            // `observe` has already seen the first state of this period, at the end of the previous one.
            let observe = |state: &State<Sys>| {
                if state.t != from {
                    flow = observe(state);
                }
                flow
            };
            integrate_while(system, &method, state, length, end, inputs, observe)?;
            Ok(flow)
        })
    }

    /// Integrates like [`integrate`](Self::integrate), but with error control; `observe` is called with the first state
    /// and at the end of every period.
    ///
    /// # Errors
    /// Those of [`integrate`](Self::integrate).
    pub fn adapt<Sys, O, const M: usize, const D: usize>(
        &mut self,
        system: &Sys,
        method: &Adaptive<M, D>,
        state: &mut State<Sys>,
        until: f64,
        mut observe: O,
    ) -> Result<Statistics, StepError>
    where
        Sys: System + ?Sized,
        C: FnMut(&State<Sys>) -> Sys::Inputs,
        O: FnMut(&State<Sys>),
    {
        observe(state);
        let mut all = Statistics::default();
        self.periods(system, state, until, |state, end, u| {
            let inputs = |_: f64, _: &Sys::Coordinates, _: &Sys::Velocities| u.clone();
            all += method.run(system, state, end, inputs)?;
            observe(state);
            Ok(ControlFlow::Continue(()))
        })?;
        Ok(all)
    }

    /// Loops over the periods until `run` breaks: calls the controller, and moves the state to the end of the period.
    pub(crate) fn periods<Sys>(
        &mut self,
        system: &Sys,
        state: &mut State<Sys>,
        until: f64,
        mut run: impl FnMut(&mut State<Sys>, f64, &Sys::Inputs) -> Result<ControlFlow<()>, StepError>,
    ) -> Result<(), StepError>
    where
        Sys: System + ?Sized,
        C: FnMut(&State<Sys>) -> Sys::Inputs,
    {
        let from = state.t;
        let (step, span) = (self.period, until - from);
        let count = span / step;
        // Beyond this count rounding hardly distinguishes neighbouring times. The test also fails if the count is NaN.
        let few = count < (1_u64 << 52) as f64;
        if !(step > 0.0 && step.is_finite() && span >= 0.0 && few) {
            return Err(StepError::InvalidStep { step, span });
        }
        // A ratio within rounding of a whole number counts as that number.
        let whole = count as u64;
        let last = whole + u64::from(count - whole as f64 > 1e-9 * count.max(1.0));
        // A span below that rounding is still a span.
        let last = last.max(u64::from(span > 0.0));
        let clock = Clock::new(system, state);
        for index in 1..=last {
            let u = (self.controller)(state);
            let end = match index == last {
                true => until,
                false => from + index as f64 * step,
            };
            let flow = run(state, end, &u)?;
            if let Some(clock) = &clock {
                clock.set(state);
            }
            if flow.is_break() {
                break;
            }
        }
        Ok(())
    }
}
