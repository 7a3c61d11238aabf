//! Runs in time: options, plan, steps, events and results.

mod advance;
mod cancellation;
mod early_end;
mod energy_balance;
mod events;
mod fixed_step_run;
mod inputs;
mod plan;
mod record;
mod recorder;
mod run_arrays;
mod sample;
mod segment;
mod stepping;

pub use advance::{ObservationPoint, Observer, advance};
pub use cancellation::CancellationToken;
pub use early_end::EarlyEnd;
pub use energy_balance::EnergyBalance;
pub use events::{Event, EventFunction, EventQuantity, Events, locate_event};
pub use fixed_step_run::FixedStepRun;
pub use inputs::{
    ControlFunction, ControlLaw, ExpressionProblem, InputOptions, InputProblem, Inputs,
    SeriesProblem, TimeSeries, UnknownInput, constant,
};
pub use plan::{Every, SamplingProblem, Spacing, SteppingPlan};
pub use record::Run;
pub use run_arrays::{EventOccurrences, RunArrays};
pub use sample::Sample;
pub use stepping::{Stepping, SteppingProblem};

use crate::error::Error;
use crate::mechanism::Instance;
use crate::reporter::Reporter;
use crate::source::added_outputs;
use crate::state::State;
use hamel_codegen::generate::Generated;
use std::sync::Arc;

/// Options of a run.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// Length, method and steps.
    pub stepping: Stepping,
    /// Times of samples.
    pub samples: Samples,
    /// Inputs.
    pub inputs: InputSource,
    /// Events to look for, which may end the run.
    pub events: Vec<Event>,
    /// Cancellation token, if the run can be cancelled.
    pub stop: Option<CancellationToken>,
}

/// Times of the samples of a run.
#[derive(Clone, Debug)]
pub enum Samples {
    /// About a thousand, at ends of steps.
    Usual,
    /// One every so many steps, or at multiples of a time.
    Every(Every),
    /// At these times from the start of the run on.
    At(Vec<f64>),
    /// At the times in the column `t` of a time series, which are those of the description if it declares a time.
    Of(TimeSeries),
}

/// Source of the inputs of a run.
#[derive(Clone, Debug)]
pub enum InputSource {
    /// Time series and expressions; without them all inputs keep the values of the state.
    Options(InputOptions),
    /// A function of time and state.
    ControlLaw(ControlLaw),
}

impl Simulation {
    /// Options for a run with the usual samples, whose inputs keep their values.
    pub fn new(stepping: Stepping) -> Self {
        Simulation {
            stepping,
            samples: Samples::Usual,
            inputs: InputSource::Options(InputOptions::default()),
            events: Vec::new(),
            stop: None,
        }
    }

    /// Prepares the inputs of a run from a state; `None` if they keep their values.
    ///
    /// # Errors
    /// The inputs have an error.
    pub(crate) fn prepare_inputs(
        &self,
        generated: &Generated,
        state: &State,
    ) -> Result<Option<Inputs>, Error> {
        match &self.inputs {
            InputSource::ControlLaw(law) => Ok(Some(law.clone().into())),
            InputSource::Options(asked) => {
                Ok(Inputs::new(asked, self.stepping.until, generated, state)?)
            }
        }
    }

    /// Runs a system that has the values of `state` and its inputs set; expressions of events are outputs of the
    /// system.
    pub(crate) fn run(
        &self,
        generated: &Arc<Generated>,
        system: Instance,
        state: &State,
        reporter: &dyn Reporter,
    ) -> Result<Run, Error> {
        let until = self.stepping.until;
        let every = match self.samples {
            Samples::Every(every) => Some(every),
            _ => None,
        };
        let mut plan = self.stepping.plan(generated, &system, every)?;
        match &self.samples {
            // All requested samples are kept.
            Samples::At(times) => plan.spacing = Spacing::at(times.clone(), until)?,
            Samples::Of(series) => {
                plan.spacing = Spacing::Times(inputs::times(series, until, generated, state)?);
            }
            Samples::Usual | Samples::Every(_) => {}
        }
        plan.stop = self.stop.clone();
        let events = Events::new(self.events.clone(), &system, added_outputs::name);
        Run::new(generated, system, plan, events, reporter)
    }
}
