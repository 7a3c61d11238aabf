//! The run of one part of an ensemble, and the progress that all parts share.

use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use super::group::{Group, gather, scatter};
use super::{Failure, Progress};
use crate::clock::Clock;
use crate::error::{Singular, StepError};
use crate::integrate::{Grid, step};
use crate::lanes::Lanes;
use crate::methods::Method;
use crate::state::State;
use crate::system::System;

/// Steps of a group between two calls of the progress callback.
const STEPS_PER_PROGRESS: u64 = 256;

/// Data shared by all threads: the steps done, and whether the run is cancelled.
pub(super) struct Watch<'a, P> {
    done: AtomicU64,
    total: u64,
    cancelled: AtomicBool,
    progress: &'a P,
}

impl<'a, P: Fn(Progress) -> ControlFlow<()>> Watch<'a, P> {
    /// Creates the shared data for parts whose members all have the same time.
    pub(super) fn new<Single: System>(
        parts: &[(usize, &mut [State<Single>])],
        length: f64,
        until: f64,
        progress: &'a P,
    ) -> Self {
        let steps = |states: &[State<Single>]| {
            let grid = states.first().map(|s| Grid::new(s.t, until, length));
            let count = grid.and_then(Result::ok).map_or(0, |grid| grid.count);
            count.saturating_mul(states.len() as u64)
        };
        Self {
            done: AtomicU64::new(0),
            total: parts
                .iter()
                .fold(0, |sum: u64, (_, states)| sum.saturating_add(steps(states))),
            cancelled: AtomicBool::new(false),
            progress,
        }
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Counts steps of members and reports the progress; returns `false` if the run is cancelled.
    fn advance(&self, steps: u64) -> bool {
        let done = self
            .done
            .fetch_add(steps, Ordering::Relaxed)
            .saturating_add(steps);
        let total = self.total;
        if !self.is_cancelled() && (self.progress)(Progress { done, total }).is_break() {
            self.cancelled.store(true, Ordering::Relaxed);
        }
        !self.is_cancelled()
    }
}

/// Everything that the members of a part have in common.
pub(super) struct Run<'a, Sys, M, U, P> {
    systems: &'a Sys,
    method: &'a M,
    inputs: &'a U,
    watch: &'a Watch<'a, P>,
    /// Index of the first member of the part.
    first: usize,
}

/// How the run of a group ended.
enum End {
    /// The group reached the end time or was cancelled.
    Arrived,
    /// The step that follows this number of steps failed.
    Stopped(u64, StepError),
}

impl<'a, Wide, Sys, M, U, P> Run<'a, Sys, M, U, P>
where
    Wide: System<Scalar: Lanes>,
    Sys: Fn(&Group) -> Result<Wide, Singular>,
    M: Method<Wide>,
    U: Fn(&Group, f64, &Wide::Coordinates, &Wide::Velocities) -> Wide::Inputs,
    P: Fn(Progress) -> ControlFlow<()>,
{
    pub(super) fn new(
        systems: &'a Sys,
        method: &'a M,
        inputs: &'a U,
        watch: &'a Watch<'a, P>,
        first: usize,
    ) -> Self {
        Self {
            systems,
            method,
            inputs,
            watch,
            first,
        }
    }

    /// Runs all members of a part, which have the same time, to the end; returns the failed ones in order.
    pub(super) fn all<Single>(
        &self,
        states: &mut [State<Single>],
        length: f64,
        until: f64,
    ) -> Vec<Failure>
    where
        Single: System<Scalar = <Wide::Scalar as Lanes>::Element>,
    {
        let mut failures = Vec::new();
        let everybody: Vec<usize> = (0..states.len()).collect();
        let Some(time) = states.first().map(|state| state.t) else {
            return failures;
        };
        let grid = match Grid::new(time, until, length) {
            Ok(grid) => grid,
            Err(error) => {
                failures.extend(everybody.iter().map(|local| self.failure(*local, error)));
                return failures;
            }
        };
        let starts = states.to_vec();
        // Groups that still have steps to do, each with the number of steps done.
        let mut open = vec![(everybody, 0)];
        while let Some((chosen, index)) = open.pop() {
            let End::Stopped(index, error) = self.group((&starts, states), &chosen, &grid, index)
            else {
                continue;
            };
            let rest = grid.count - index;
            if let [alone] = chosen[..] {
                failures.push(self.failure(alone, error));
                self.watch.advance(rest);
                continue;
            }
            let (mut well, before) = (Vec::new(), failures.len());
            for local in &chosen {
                match self.one_step(states, *local, &grid, index) {
                    Ok(()) => well.push(*local),
                    Err(error) => failures.push(self.failure(*local, error)),
                }
            }
            self.watch.advance(rest * (failures.len() - before) as u64);
            if well.len() < chosen.len() {
                open.push((well, index));
            } else {
                // Each member succeeds alone, only the group fails (a common iteration, for example): split it up.
                open.extend(well.into_iter().map(|local| (vec![local], index)));
            }
        }
        failures.sort_by_key(|failure| failure.member);
        failures
    }

    fn failure(&self, local: usize, error: StepError) -> Failure {
        Failure {
            member: self.first + local,
            error,
        }
    }

    /// Runs the chosen members from the step `index` on; `starts` are the states of all members at the start of the
    /// run.
    fn group<Single>(
        &self,
        (starts, states): (&[State<Single>], &mut [State<Single>]),
        chosen: &[usize],
        grid: &Grid,
        mut index: u64,
    ) -> End
    where
        Single: System<Scalar = <Wide::Scalar as Lanes>::Element>,
    {
        if chosen.is_empty() || self.watch.is_cancelled() {
            return End::Arrived;
        }
        let group = Group::new(self.first, chosen);
        let (system, mut state) = match self.prepare(&group, states, chosen) {
            Ok(prepared) => prepared,
            Err(error) => return End::Stopped(index, error),
        };
        let started = gather(&system, starts, chosen).ok();
        let clock = started.and_then(|start| Clock::new(&system, &start));
        let inputs = |t: f64, x: &_, xi: &_| (self.inputs)(&group, t, x, xi);
        let members = chosen.len() as u64;
        let mut told = index;
        let mut end = End::Arrived;
        while index < grid.count {
            if let Err(error) = step(&system, self.method, &mut state, grid.step(), &inputs) {
                end = End::Stopped(index, error);
                break;
            }
            index += 1;
            state.t = grid.time(index);
            if let Some(clock) = &clock {
                clock.set(&mut state);
            }
            if index - told == STEPS_PER_PROGRESS {
                told = index;
                if !self.watch.advance(STEPS_PER_PROGRESS * members) {
                    break;
                }
            }
        }
        scatter(&state, states, chosen);
        self.watch.advance((index - told) * members);
        end
    }

    /// Checks whether a member can do the step after `index` alone.
    fn one_step<Single>(
        &self,
        states: &[State<Single>],
        local: usize,
        grid: &Grid,
        index: u64,
    ) -> Result<(), StepError>
    where
        Single: System<Scalar = <Wide::Scalar as Lanes>::Element>,
    {
        let group = Group::new(self.first, &[local]);
        let (system, mut state) = self.prepare(&group, states, &[local])?;
        if index == grid.count {
            return Ok(());
        }
        let inputs = |t: f64, x: &_, xi: &_| (self.inputs)(&group, t, x, xi);
        step(&system, self.method, &mut state, grid.step(), &inputs)
    }

    /// Creates the system and the state of a group.
    fn prepare<Single>(
        &self,
        group: &Group,
        states: &[State<Single>],
        chosen: &[usize],
    ) -> Result<(Wide, State<Wide>), StepError>
    where
        Single: System<Scalar = <Wide::Scalar as Lanes>::Element>,
    {
        let time = chosen
            .first()
            .and_then(|local| states.get(*local))
            .map_or(f64::NAN, |state| state.t);
        let system = (self.systems)(group).map_err(|cause| StepError::Singular { cause, time })?;
        let state = gather(&system, states, chosen)?;
        state.check_shape(&system)?;
        if state.is_finite() {
            Ok((system, state))
        } else {
            Err(StepError::NonFinite { time })
        }
    }
}
