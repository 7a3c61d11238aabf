//! Many runs of one system at once: members of the ensemble fill SIMD lanes, on all threads of rayon.
//!
//! Members share the method, the step and the end time, and differ in their states; with [`integrate_each`] also in
//! their parameters. Neighbours in the list that start at the same time share the lanes of a vector; unused lanes
//! repeat a member. The result of a member does not depend on the number of threads. It does not depend on the other
//! members either, except with implicit methods, which iterate until all lanes of a group have converged.
//!
//! A member that fails does not stop its group: it is identified by stepping each member alone, and keeps its last
//! valid state; the others continue without it.
//!
//! # Example
//! A thousand pendulums from different angles, ξ = θ̇, θ̈ = −g/l sin θ, in lanes of eight:
//!
//! ```
//! use std::ops::ControlFlow;
//! use hamel::methods::Rkmk4;
//! use hamel::wide::f64x8;
//! use hamel::{ensemble, Block, Scalar, Singular, State, System};
//!
//! #[derive(Clone)]
//! struct Pendulum<S> { rate: S }  // g/l
//!
//! impl<S: Scalar> System for Pendulum<S> {
//!     type Scalar = S;
//!     // ... as generated
//! #   type Coordinates = [S; 1];
//! #   type Velocities = [S; 1];
//! #   type Chart = [S; 1];
//! #   type Inputs = [S; 0];
//! #   fn blocks(&self) -> &[Block] { &[Block::Flat(1)] }
//! #   fn chart_rate(&self, _: &[S; 1], xi: &[S; 1]) -> [S; 1] { *xi }
//! #   fn forward_dynamics(&self, x: &[S; 1], _: &[S; 1], _: &[S; 0]) -> Result<[S; 1], Singular> {
//! #       Ok([-self.rate * x[0].sin_cos().0])
//! #   }
//! }
//!
//! let mut states: Vec<State<Pendulum<f64>>> = (0..1000)
//!     .map(|member| State { t: 0.0, x: [1e-3 * f64::from(member)], xi: [0.0] })
//!     .collect();
//! let system = Pendulum { rate: f64x8::splat(9.81) };
//! let outcome = ensemble::integrate(
//!     &system, &Rkmk4, &mut states, 0.01, 2.0,
//!     |_, _, _, _| [],
//!     |progress| {
//!         eprintln!("{} of {} steps", progress.done, progress.total);
//!         ControlFlow::Continue(())
//!     },
//! );
//! assert!(outcome.failures.is_empty());
//! assert!(states.iter().all(|state| state.t == 2.0));
//!
//! // The same pendulums, each with a length of its own: g/l depends on the member.
//! let outcome = ensemble::integrate_each(
//!     |group| Ok(Pendulum { rate: group.gather::<f64x8>(|member| 9.0 + 1e-3 * member as f64) }),
//!     &Rkmk4, &mut states, 0.01, 4.0, |_, _, _, _| [], ensemble::quietly,
//! );
//! assert!(outcome.failures.is_empty());
//! ```

mod group;
mod run;

use core::ops::ControlFlow;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::error::{Singular, StepError};
use crate::lanes::Lanes;
use crate::methods::Method;
use crate::state::State;
use crate::system::System;

pub use group::Group;
use run::{Run, Watch};

/// Progress of an ensemble, counted in steps of members.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Steps that are done, including those that failed members will not do.
    pub done: u64,
    /// Total number of steps of all members.
    pub total: u64,
}

/// A member that failed before the end time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    /// Index of the member in the list of states.
    pub member: usize,
    /// The error; the state of the member is the last valid one.
    pub error: StepError,
}

/// Result of an ensemble run.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
pub struct Outcome {
    /// The members that failed, in the order of the list.
    pub failures: Vec<Failure>,
    /// Whether the run was cancelled; members may then be at different times, given by their states.
    pub cancelled: bool,
}

/// A progress callback that reports nothing and lets the run continue.
pub fn quietly(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Integrates all states to the time `until`, in equal steps no longer than `length`, as
/// [`integrate`](crate::integrate()) does for one.
///
/// `system` computes in lanes; the states belong to the same system with the element type of the lanes (or to any
/// system with as many coordinates and velocities). `inputs(group, t, x, ξ)` returns u for all lanes. `progress` is
/// called from all threads, every few hundred steps of a group and at its end; `Break` cancels the run. The function
/// runs on the threads of the current rayon pool.
pub fn integrate<Wide, Single, M, U, P>(
    system: &Wide,
    method: &M,
    states: &mut [State<Single>],
    length: f64,
    until: f64,
    inputs: U,
    progress: P,
) -> Outcome
where
    Wide: System<Scalar: Lanes> + Clone + Sync,
    Single: System<Scalar = <Wide::Scalar as Lanes>::Element>,
    State<Single>: Send,
    M: Method<Wide> + Sync,
    U: Fn(&Group, f64, &Wide::Coordinates, &Wide::Velocities) -> Wide::Inputs + Sync,
    P: Fn(Progress) -> ControlFlow<()> + Sync,
{
    let systems = |_: &Group| Ok(system.clone());
    integrate_each(systems, method, states, length, until, inputs, progress)
}

/// Integrates like [`integrate`], with a separate system for each group of members, whose parameters are
/// [gathered](Group::gather) from those of the members. A member whose parameters make the system [`Singular`] has
/// failed.
pub fn integrate_each<Wide, Single, Sys, M, U, P>(
    systems: Sys,
    method: &M,
    states: &mut [State<Single>],
    length: f64,
    until: f64,
    inputs: U,
    progress: P,
) -> Outcome
where
    Wide: System<Scalar: Lanes>,
    Single: System<Scalar = <Wide::Scalar as Lanes>::Element>,
    State<Single>: Send,
    Sys: Fn(&Group) -> Result<Wide, Singular> + Sync,
    M: Method<Wide> + Sync,
    U: Fn(&Group, f64, &Wide::Coordinates, &Wide::Velocities) -> Wide::Inputs + Sync,
    P: Fn(Progress) -> ControlFlow<()> + Sync,
{
    let parts = divide(states, Wide::Scalar::COUNT);
    let watch = Watch::new(&parts, length, until, &progress);
    let failures: Vec<Vec<Failure>> = parts
        .into_par_iter()
        .map(|(first, states)| {
            let run = Run::new(&systems, method, &inputs, &watch, first);
            run.all(states, length, until)
        })
        .collect();
    Outcome {
        failures: failures.into_iter().flatten().collect(),
        cancelled: watch.is_cancelled(),
    }
}

/// Divides the states into parts of at most `count` neighbours with the same time, each with the index of its first
/// member.
fn divide<Single: System>(
    states: &mut [State<Single>],
    count: usize,
) -> Vec<(usize, &mut [State<Single>])> {
    let mut parts = Vec::new();
    let mut first = 0;
    for same in states.chunk_by_mut(|a, b| a.t.to_bits() == b.t.to_bits()) {
        for part in same.chunks_mut(count.max(1)) {
            let members = part.len();
            parts.push((first, part));
            first += members;
        }
    }
    parts
}
