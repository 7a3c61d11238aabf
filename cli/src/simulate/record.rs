//! The run itself, and what is kept of it.

use super::advance::advance;
use super::balance::Balance;
use super::events::Events;
use super::recorder::{Recorded, Recorder};
use crate::failure::Failure;
use crate::mechanism::{Instance, Output};
use crate::method::Chosen;
use crate::names;
use crate::number::short;
use hamel::{Monitor, State, StepError, System};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Program;
use std::cell::Cell;

/// Samples where nothing else is asked for.
const SAMPLES: u64 = 1000;
/// Points of a plot.
pub const POINTS: u64 = 4000;

/// How often samples are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// Every so many steps.
    Steps(u64),
    /// At multiples of this time.
    Time(f64),
}

/// What is to be run.
#[derive(Clone, Debug)]
pub struct Plan {
    pub method: Chosen,
    pub until: f64,
    pub step: f64,
    /// Expected number of steps.
    pub steps: u64,
    /// A sample every so many steps.
    pub every: u64,
    /// Whether that was left to the plan, which may then take fewer.
    pub chosen: bool,
    /// The error that a step may make, where steps are chosen by it.
    pub tolerance: Option<f64>,
    /// Where samples are that are not at the ends of steps.
    pub spacing: Spacing,
    /// Steps chosen by their error are shown at no fewer points than that.
    pub points: u64,
    /// Whether nobody looks at the ends of steps.
    pub quiet: bool,
}

/// Where samples are.
#[derive(Clone, Debug, PartialEq)]
pub enum Spacing {
    /// At ends of steps.
    Steps,
    /// At multiples of a time.
    Every(f64),
    /// At these times.
    Times(Vec<f64>),
}

impl Spacing {
    /// The times of samples in a step.
    pub fn within(&self, from: f64, to: f64) -> Vec<f64> {
        match self {
            Spacing::Steps => Vec::new(),
            Spacing::Every(time) => {
                let first = (from / time).floor() + 1.0;
                let numbers = std::iter::successors(Some(first), |number| Some(number + 1.0));
                let times = numbers.map(|number| number * time);
                times.take_while(|t| *t <= to).collect()
            }
            Spacing::Times(times) => {
                let first = times.partition_point(|t| *t <= from);
                let last = times.partition_point(|t| *t <= to);
                times[first..last].to_vec()
            }
        }
    }
}

impl Plan {
    /// A plan with about a thousand samples, or as many as are asked for. Equal steps are shortened so that samples are
    /// at their ends.
    pub fn new(
        method: Chosen,
        until: f64,
        mut step: f64,
        every: Option<Every>,
        tolerance: Option<f64>,
    ) -> Self {
        let (every, spacing) = match (every, tolerance) {
            (None, _) => (None, Spacing::Steps),
            (Some(Every::Steps(steps)), _) => (Some(steps), Spacing::Steps),
            (Some(Every::Time(time)), Some(_)) => (Some(1), Spacing::Every(time)),
            (Some(Every::Time(time)), None) => {
                let parts = (time / step * (1.0 - 1e-9)).ceil().max(1.0);
                step = time / parts;
                (Some(parts as u64), Spacing::Steps)
            }
        };
        // As the integrator counts: a ratio that is whole but for rounding is whole.
        let steps = ((until / step) * (1.0 - 1e-9)).ceil().max(1.0) as u64;
        let default = match tolerance {
            // How many steps there will be is not known.
            Some(_) => 1,
            None => (steps / SAMPLES).max(1),
        };
        Plan {
            method,
            until,
            step,
            steps,
            every: every.unwrap_or(default),
            chosen: every.is_none(),
            tolerance,
            spacing,
            points: POINTS,
            quiet: false,
        }
    }
}

/// The state at one time, and what follows from it.
#[derive(Clone, Debug)]
pub struct Sample {
    pub t: f64,
    pub x: Vec<f64>,
    pub xi: Vec<f64>,
    /// Entries of all outputs, one after the other.
    pub outputs: Vec<f64>,
    /// Entries of all invariants but the energy.
    pub invariants: Vec<f64>,
    pub momentum: Vec<f64>,
    pub energy: f64,
}

impl Sample {
    /// That of a state.
    pub fn of(system: &Instance, state: &State<Instance>) -> Self {
        let (x, xi) = (&state.x, &state.xi);
        let values = |list: &[Output]| -> Vec<f64> {
            let values = list
                .iter()
                .map(|output| system.output(output, state.t, x, xi));
            values.flat_map(|value| value.to_vec()).collect()
        };
        Sample {
            t: state.t,
            outputs: values(system.outputs()),
            invariants: values(system.invariants()),
            momentum: system.momentum(x, xi).to_vec(),
            energy: system.kinetic_energy(x, xi) + system.potential_energy(x),
            x: x.to_vec(),
            xi: xi.to_vec(),
        }
    }
}

/// A run that is over.
pub struct Run<'a> {
    pub program: &'a Program,
    pub plan: Plan,
    pub coordinate_names: Vec<String>,
    pub velocity_names: Vec<String>,
    pub output_names: Vec<String>,
    pub invariant_names: Vec<String>,
    /// In order of time; the first and the last state among them.
    pub samples: Vec<Sample>,
    /// A finer list for plots.
    pub track: Vec<Sample>,
    pub monitor: Monitor<f64>,
    pub steps: u64,
    pub evaluations: u64,
    /// Why it ended early.
    pub failure: Option<String>,
    /// What of the events has happened.
    pub events: Events,
}

impl<'a> Run<'a> {
    /// Integrates; a numerical failure is part of the run, an impossible plan an error.
    pub fn new(generated: &'a Generated, system: &Instance, plan: Plan) -> Result<Self, Failure> {
        Run::watched(generated, system, plan, Events::default())
    }

    /// The same with events, whose expressions are outputs of the system.
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
        Ok(Run {
            program: &generated.program,
            plan,
            coordinate_names: names::coordinates(&generated.model),
            velocity_names: names::moving(&generated.active),
            output_names: entries(system.outputs()),
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

/// Why a run ended before its time.
#[derive(Clone, Debug)]
pub struct Early {
    /// What happened, in a word or two.
    pub kind: &'static str,
    /// The same in a sentence.
    pub why: String,
}

/// What became of a run that has come to a state; an impossible plan is an error.
pub fn ended(
    system: &Instance,
    plan: &Plan,
    outcome: Result<(), StepError>,
    state: &State<Instance>,
    balance: Balance,
) -> Result<Option<Early>, Failure> {
    let (kind, why) = match outcome {
        Ok(()) => {
            let lost = plan.tolerance.and_then(|tolerance| {
                let change = balance.after(system, state).lost(tolerance)?;
                Some((change, tolerance))
            });
            let Some((change, tolerance)) = lost else {
                return Ok(None);
            };
            let why = format!(
                "the run has lost the motion at t = {}: its energy has changed by {}, for which no load accounts; there may be a singularity on the way: try a smaller --tol than {}",
                short(state.t),
                short(change),
                short(tolerance)
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
                "the run ends at t = {}: the motion is stiff, a rate of {} per unit of time keeps explicit steps at {}, {} of them ahead; try `--method backward-euler` with a --step of your choice, or a stiff solver through `hamel::adapter`",
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
