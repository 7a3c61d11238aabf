//! Runs the plan and keeps the results.

use super::advance::advance;
use super::balance::Balance;
use super::events::Events;
use super::plan::{Plan, Spacing};
use super::recorder::{Recorded, Recorder};
use super::sample::Sample;
use crate::failure::Failure;
use crate::mechanism::{Instance, Output};
use crate::names::{self, Time};
use crate::number::short;
use hamel::{Monitor, State, StepError};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Program;
use std::cell::Cell;

/// A finished run.
pub struct Run<'a> {
    pub program: &'a Program,
    pub plan: Plan,
    pub time: Time,
    pub coordinate_names: Vec<String>,
    pub velocity_names: Vec<String>,
    pub output_names: Vec<String>,
    pub invariant_names: Vec<String>,
    /// In order of time, including the first and the last state.
    pub samples: Vec<Sample>,
    /// A finer list of samples for plots.
    pub track: Vec<Sample>,
    pub monitor: Monitor<f64>,
    pub steps: u64,
    pub evaluations: u64,
    /// Reason of an early end.
    pub failure: Option<String>,
    /// Events with their occurrences.
    pub events: Events,
}

impl<'a> Run<'a> {
    /// Integrates; a numerical failure is part of the run, an impossible plan is an error.
    pub fn new(generated: &'a Generated, system: &Instance, plan: Plan) -> Result<Self, Failure> {
        Run::watched(generated, system, plan, Events::default())
    }

    /// Integrates with events, whose expressions are outputs of the system.
    pub fn watched(
        generated: &'a Generated,
        system: &Instance,
        plan: Plan,
        mut events: Events,
    ) -> Result<Self, Failure> {
        let mut state = State::start(system);
        let balance = Cell::new(Balance::new(system, &state));
        let mut recorder = Recorder::new(system, &plan, &balance);
        let watched = (&balance, &mut events);
        let outcome = advance(system, &plan, &mut state, watched, &mut recorder);
        let Recorded {
            mut samples,
            mut track,
            monitor,
            steps,
        } = recorder.finish();
        let failure = match events.undefined() {
            Some(name) => Some(format!(
                "the run ends at t = {}: the event `{name}` has no value there",
                short(state.t)
            )),
            None => {
                let early = ended(system, &plan, outcome, &state, balance.get())?;
                early.map(|early| early.why)
            }
        };
        let listed = matches!(plan.spacing, Spacing::Times(_));
        let lists = [(&mut samples, listed), (&mut track, false)];
        for (list, complete) in lists {
            if complete && !list.is_empty() {
                continue;
            }
            if list.last().is_none_or(|last| last.t != state.t) {
                list.push(Sample::of(system, &state));
            }
        }
        let entries = |list: &[Output]| -> Vec<String> {
            list.iter()
                .flat_map(|output| names::shaped(&output.name, output.shape))
                .collect()
        };
        let coordinate_names = names::coordinates(&generated.model);
        let velocity_names = names::moving(&generated.active);
        let output_names = entries(system.outputs());
        let taken = [&coordinate_names[..], &velocity_names, &output_names];
        Ok(Run {
            program: &generated.program,
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
        })
    }
}

/// Reason why a run ended early.
#[derive(Clone, Debug)]
pub struct Early {
    /// Kind of failure, in a word or two.
    pub kind: &'static str,
    /// Message, in a sentence.
    pub why: String,
}

/// The outcome of a run that has reached a state; an impossible plan is an error.
pub fn ended(
    system: &Instance,
    plan: &Plan,
    outcome: Result<(), StepError>,
    state: &State<Instance>,
    balance: Balance,
) -> Result<Option<Early>, Failure> {
    let (kind, why) = match outcome {
        Ok(()) => {
            if !plan.watches(system) {
                return Ok(None);
            }
            let Some(change) = balance.after(system, state).lost(plan.tolerance) else {
                return Ok(None);
            };
            let advice = match plan.tolerance {
                Some(tolerance) => format!("try a smaller --tol than {}", short(tolerance)),
                None => format!(
                    "try a smaller --step than {}, or steps chosen by their error, `--method rkmk8 --tol 1e-9`",
                    short(plan.step)
                ),
            };
            let why = format!(
                "the run has lost the motion {} t = {}: its energy has changed by {}, which no load accounts for; there may be a singularity on the way: {advice}",
                if plan.tolerance.is_some() { "at" } else { "by" },
                short(state.t),
                short(change),
            );
            ("lost", why)
        }
        Err(
            error @ (StepError::InvalidStep { .. }
            | StepError::Shape { .. }
            | StepError::InvalidTolerance { .. }),
        ) => {
            return Err(Failure::usage(error.to_string()));
        }
        Err(StepError::Stiff { time, step, rate }) => {
            let why = format!(
                "the run ends at t = {}: the motion is stiff, a rate of {} per unit of time limits explicit steps to {}, with {} of them remaining; try `--method backward-euler` with a --step of your choice, or a stiff solver through `hamel::adapter`",
                short(time),
                short(rate),
                short(step),
                short(((plan.until - time) / step).ceil())
            );
            ("stiff", why)
        }
        Err(StepError::Singular { time, cause }) => {
            let cause = system.singular(cause);
            let why = format!("the run ends at t = {}: {cause}", short(time));
            ("singular", why)
        }
        Err(StepError::NonFinite { time }) => {
            let why = format!(
                "the run ends at t = {}: the next state is not finite; try a shorter step than {}",
                short(time),
                short(plan.step)
            );
            ("not finite", why)
        }
        Err(error) => ("other", error.to_string()),
    };
    Ok(Some(Early { kind, why }))
}
