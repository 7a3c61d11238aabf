//! Finished runs: executes a plan and keeps its results.

use super::advance::advance;
use super::early_end::EarlyEnd;
use super::energy_balance::EnergyBalance;
use super::events::Events;
use super::plan::{Spacing, SteppingPlan};
use super::recorder::{Recorded, Recorder};
use super::sample::Sample;
use crate::error::Error;
use crate::mechanism::{Instance, Output};
use crate::names::{self, Time};
use crate::reporter::Reporter;
use hamel::{Monitor, State};
use hamel_codegen::generate::Generated;
use std::cell::Cell;
use std::sync::Arc;

/// Finished run with its samples.
pub struct Run {
    /// The derived equations.
    pub generated: Arc<Generated>,
    /// The system that was run.
    pub system: Instance,
    /// The plan by which it was run.
    pub plan: SteppingPlan,
    /// The column of the time.
    pub time: Time,
    /// Names of the entries of x.
    pub coordinate_names: Vec<String>,
    /// Names of the entries of ξ and of the states of first order.
    pub velocity_names: Vec<String>,
    /// Names of the entries of all outputs.
    pub output_names: Vec<String>,
    /// Names of the entries of all invariants but the energy.
    pub invariant_names: Vec<String>,
    /// In order of time, including the first and the last state.
    pub samples: Vec<Sample>,
    /// A finer list of samples for plots.
    pub track: Vec<Sample>,
    /// Energies and constraints on the way.
    pub monitor: Monitor<f64>,
    /// Number of steps.
    pub steps: u64,
    /// Number of evaluations of accelerations, forces or rates of momenta.
    pub evaluations: u64,
    /// Reason of an early end.
    pub failure: Option<EarlyEnd>,
    /// Events with their occurrences.
    pub events: Events,
}

impl Run {
    /// Integrates by a plan; a numerical failure is part of the run. Expressions of events are outputs of the system.
    ///
    /// # Errors
    /// The plan is invalid.
    pub fn new(
        generated: &Arc<Generated>,
        system: Instance,
        plan: SteppingPlan,
        mut events: Events,
        reporter: &dyn Reporter,
    ) -> Result<Self, Error> {
        let mut state = State::start(&system);
        let balance = Cell::new(EnergyBalance::new(&system, &state));
        let mut recorder = Recorder::new(&system, &plan, &balance, reporter);
        let watched = (&balance, &mut events);
        let outcome = advance(&system, &plan, &mut state, watched, &mut recorder);
        let Recorded {
            mut samples,
            mut track,
            monitor,
            steps,
        } = recorder.finish();
        let failure = match events.undefined() {
            Some(name) => Some(EarlyEnd::Undefined {
                time: state.t,
                event: name.into(),
            }),
            None => EarlyEnd::explain(&system, &plan, outcome, &state, balance.get())?,
        };
        let listed = matches!(plan.spacing, Spacing::Times(_));
        let lists = [(&mut samples, listed), (&mut track, false)];
        for (list, complete) in lists {
            if complete && !list.is_empty() {
                continue;
            }
            if list.last().is_none_or(|last| last.t != state.t) {
                list.push(Sample::of(&system, &state));
            }
        }
        let entries = |list: &[Output]| -> Vec<String> {
            list.iter()
                .flat_map(|output| names::entries(&output.name, output.shape))
                .collect()
        };
        let coordinate_names = names::coordinates(&generated.model);
        let velocity_names = names::velocities_and_states(&generated.active);
        let output_names = entries(system.outputs());
        let taken = [&coordinate_names[..], &velocity_names, &output_names];
        Ok(Run {
            generated: Arc::clone(generated),
            plan,
            time: Time::of(&generated.model, &taken),
            coordinate_names,
            velocity_names,
            output_names,
            invariant_names: entries(system.invariants()),
            samples,
            track,
            monitor,
            steps: steps.saturating_sub(1),
            evaluations: system.evaluations(),
            failure,
            events,
            system,
        })
    }
}
