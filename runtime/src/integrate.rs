//! Single steps, and runs of equal steps from one time to another.

use crate::clock::Clock;
use crate::error::StepError;
use crate::manifold;
use crate::methods::Method;
use crate::state::State;
use crate::store::is_finite;
use crate::system::System;
use core::ops::ControlFlow;

/// Advances `state` by one step of length `h`, which may be negative or zero.
///
/// The result is projected onto the constraints that no chart preserves: those among the coordinates, and those that
/// multipliers enforce. `inputs(t, x, ξ)` returns u.
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
/// use hamel::{State, methods::Rkmk4, step};
///
/// let pendulum = Pendulum::<f64>::default();
/// let mut state = State::start(&pendulum);
/// // One step of 10 ms, braked in proportion to the speed.
/// step(&pendulum, Rkmk4, &mut state, 0.01, &|_, _, xi| [-0.1 * xi[0]])?;
/// assert_eq!(state.t, 0.01);
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
///
/// # Errors
/// [`StepError`]; `state` is then unchanged.
#[inline]
pub fn step<Sys, M, U>(
    system: &Sys,
    method: M,
    state: &mut State<Sys>,
    h: f64,
    inputs: &U,
) -> Result<(), StepError>
where
    Sys: System + ?Sized,
    M: Method<Sys>,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    let mut next = method.step(system, state, h, inputs)?;
    if !method.preserves_constraints() {
        project_coordinates(system, &mut next);
    }
    project(system, &mut next)?;
    *state = next;
    Ok(())
}

/// Corrects x by one Newton step towards the part of φ(x) = 0 that no chart preserves; returns whether there is such a
/// constraint.
#[inline]
pub(crate) fn project_coordinates<Sys>(system: &Sys, state: &mut State<Sys>) -> bool
where
    Sys: System + ?Sized,
{
    let Some(step) = system.project_coordinates(&state.x) else {
        return false;
    };
    for (entry, &towards) in state.x.as_mut().iter_mut().zip(step.as_ref()) {
        *entry += towards;
    }
    true
}

/// Projects a state onto the constraints that multipliers enforce: closes loops by one Newton step, and projects
/// velocities orthogonally in the kinetic-energy metric. Returns whether anything was projected; without such
/// constraints nothing is done. Works in place, because states in dual numbers are large.
#[inline]
pub(crate) fn project<Sys>(system: &Sys, state: &mut State<Sys>) -> Result<bool, StepError>
where
    Sys: System + ?Sized,
{
    let time = state.t;
    let mut moved = false;
    let singular = |cause| StepError::Singular { cause, time };
    if let Some(step) = system.project_position(&state.x).map_err(singular)? {
        // Subtracts the part of the rate without ξ (nonzero where time is a coordinate), which leaves A times the step
        // alone.
        let mut chart = system.chart_rate(&state.x, &step);
        let still = system.chart_rate(&state.x, &system.zero_velocities());
        for (entry, &drift) in chart.as_mut().iter_mut().zip(still.as_ref()) {
            *entry -= drift;
        }
        manifold::retract(system.blocks(), state.x.as_mut(), chart.as_ref());
        moved = true;
    }
    if let Some(xi) = system
        .project_velocity(&state.x, &state.xi)
        .map_err(singular)?
    {
        state.xi = xi;
        moved = true;
    }
    if state.is_finite() {
        Ok(moved)
    } else {
        Err(StepError::NonFinite { time })
    }
}

/// Integrates `state` to the time `until`, forwards or backwards, in equal steps no longer than `length`.
///
/// The number of steps is |until − t| / |length| rounded up, where a ratio within 1e-9 of a whole number counts as that
/// number. All steps are therefore equal, the method keeps its order, and the last state is at `until` exactly.
/// `inputs(t, x, ξ)` returns u and is called at every point that the method visits; `observe` is called with the first
/// state and after every step. A method that evaluates the forces both at the end of a step and at the start of the
/// next evaluates them only once ([`Method::step_reusing_force`]).
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
/// use hamel::{State, integrate, methods::Rkmk4};
///
/// let pendulum = Pendulum::<f64>::default();
/// let mut state = State::start(&pendulum);
/// let mut lowest: f64 = 1.0;
/// let inputs = |_, _: &_, _: &_| [0.0];
/// integrate(&pendulum, Rkmk4, &mut state, 0.01, 10.0, inputs, |state| {
///     lowest = lowest.min(state.x[0]);
/// })?;
/// assert!((lowest + 1.0).abs() < 1e-4);
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
///
/// # Errors
/// [`StepError`]; `state` is then the last valid one, with which `observe` was called last.
#[inline]
pub fn integrate<Sys, M, U, O>(
    system: &Sys,
    method: M,
    state: &mut State<Sys>,
    length: f64,
    until: f64,
    inputs: U,
    mut observe: O,
) -> Result<(), StepError>
where
    Sys: System + ?Sized,
    M: Method<Sys>,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    O: FnMut(&State<Sys>),
{
    let observe = |state: &State<Sys>| {
        observe(state);
        ControlFlow::Continue(())
    };
    integrate_while(system, method, state, length, until, inputs, observe)
}

/// Integrates like [`integrate`] until `observe` breaks: a run that is stopped ends in the state that `observe` saw
/// last.
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
/// use core::ops::ControlFlow;
/// use hamel::{State, integrate_while, methods::Rkmk4};
///
/// let pendulum = Pendulum::<f64>::default();
/// let mut state = State::start(&pendulum);
/// let inputs = |_, _: &_, _: &_| [0.0];
/// integrate_while(&pendulum, Rkmk4, &mut state, 0.01, 10.0, inputs, |state| {
///     if state.x[0] < 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
/// })?;
/// assert!(state.x[0] < 0.0 && state.t < 2.0);
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
///
/// # Errors
/// [`StepError`]; `state` is then the last valid one, with which `observe` was called last.
#[inline]
pub fn integrate_while<Sys, M, U, O>(
    system: &Sys,
    method: M,
    state: &mut State<Sys>,
    length: f64,
    until: f64,
    inputs: U,
    mut observe: O,
) -> Result<(), StepError>
where
    Sys: System + ?Sized,
    M: Method<Sys>,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
    O: FnMut(&State<Sys>) -> ControlFlow<()>,
{
    state.check_shape(system)?;
    if !state.is_finite() {
        return Err(StepError::NonFinite { time: state.t });
    }
    let grid = Grid::new(state.t, until, length)?;
    if observe(state).is_break() {
        return Ok(());
    }
    let clock = Clock::new(system, state);
    let mut force = None;
    for index in 1..=grid.count {
        let mut next =
            method.step_reusing_force(system, state, grid.step(), &inputs, &mut force)?;
        next.t = grid.time(index);
        if let Some(clock) = &clock {
            clock.set(&mut next);
        }
        let corrected = !method.preserves_constraints() && project_coordinates(system, &mut next);
        if project(system, &mut next)? || corrected {
            force = None;
        }
        *state = next;
        if observe(state).is_break() {
            break;
        }
    }
    Ok(())
}

/// Equal steps that [`integrate`] takes from one time to another.
///
/// ```
/// let grid = hamel::Grid::new(0.0, 1.0, 0.3)?;
/// assert_eq!((grid.count(), grid.step(), grid.time(2)), (4, 0.25, 0.5));
/// # Ok::<(), hamel::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    from: f64,
    until: f64,
    pub(crate) count: u64,
}

impl Grid {
    /// Creates the smallest number of equal steps no longer than `length`; no steps if both times are equal.
    ///
    /// # Errors
    /// [`StepError::InvalidStep`] if a length or a time is not finite, the length is zero, or there are too many steps
    /// to distinguish their times.
    pub fn new(from: f64, until: f64, length: f64) -> Result<Self, StepError> {
        let count = count_steps(until - from, length)?;
        Ok(Self { from, until, count })
    }

    /// Returns the number of steps.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the length of a step, negative for runs backwards in time; NaN if there are no steps.
    #[inline]
    #[must_use]
    pub fn step(&self) -> f64 {
        (self.until - self.from) / self.count as f64
    }

    /// Returns the time after `index` steps, exactly `until` after the last.
    #[inline]
    #[must_use]
    pub fn time(&self, index: u64) -> f64 {
        if index == self.count {
            self.until
        } else {
            self.from + (self.until - self.from) * (index as f64 / self.count as f64)
        }
    }
}

/// Returns the smallest number of equal steps, no longer than `step`, that cover `span`.
fn count_steps(span: f64, step: f64) -> Result<u64, StepError> {
    /// Largest number of steps; beyond it, rounding hardly distinguishes the times of neighbouring steps.
    const MAX_STEPS: f64 = (1_u64 << 52) as f64;
    let ratio = (span / step).abs();
    if span == 0.0 {
        Ok(0)
    } else if !span.is_finite() || !step.is_finite() || step == 0.0 || ratio > MAX_STEPS {
        Err(StepError::InvalidStep { step, span })
    } else {
        let nearest = (ratio + 0.5) as u64;
        let count = if (ratio - nearest as f64).abs() > 1e-9 * ratio.max(1.0) {
            ratio as u64 + 1
        } else {
            nearest
        };
        Ok(count.max(1))
    }
}

/// Returns ξ̇ at a point of the step that starts at `time`, with the inputs at `time + offset`.
///
/// A singular pivot is reported as [`StepError::NonFinite`] if the state itself is not finite.
#[inline]
pub(crate) fn acceleration<Sys, U>(
    system: &Sys,
    time: f64,
    offset: f64,
    x: &Sys::Coordinates,
    xi: &Sys::Velocities,
    inputs: &U,
) -> Result<Sys::Velocities, StepError>
where
    Sys: System + ?Sized,
    U: Fn(f64, &Sys::Coordinates, &Sys::Velocities) -> Sys::Inputs,
{
    let u = inputs(time + offset, x, xi);
    system.forward_dynamics(x, xi, &u).map_err(|cause| {
        if is_finite(x.as_ref()) && is_finite(xi.as_ref()) {
            StepError::Singular { cause, time }
        } else {
            StepError::NonFinite { time }
        }
    })
}
