//! Runs in time: what is asked for, the plan, the steps, and what is recorded.

mod advance;
mod balance;
mod early;
mod events;
mod inputs;
mod motion;
mod plan;
mod record;
mod recorder;
mod sample;
mod steady;
mod stepping;
mod stop;
mod stretch;

pub use advance::{Observer, Place, advance};
pub use balance::Balance;
pub use early::EarlyEnd;
pub use events::{Event, Events, Gauge, Watched, first};
pub use inputs::{
    Control, ExpressionProblem, InputOptions, InputProblem, Inputs, Law, SeriesProblem, TimeSeries,
    UnknownInput, constant,
};
pub use motion::{Happened, Motion};
pub use plan::{Every, Plan, SamplingProblem, Spacing};
pub use record::Run;
pub use sample::Sample;
pub use steady::Steady;
pub use stepping::{Stepping, SteppingProblem};
pub use stop::Stop;

use crate::error::Error;
use crate::mechanism::Instance;
use crate::reporter::Reporter;
use crate::source::added;
use crate::state::State;
use hamel_codegen::generate::Generated;
use std::sync::Arc;

/// A run that is asked for.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// Its length, the method, and its steps.
    pub stepping: Stepping,
    /// Times of samples.
    pub samples: Samples,
    /// What acts from outside.
    pub drive: Drive,
    /// What is looked for on the way, and may end the run.
    pub events: Vec<Event>,
    /// Cancellation, if possible.
    pub stop: Option<Stop>,
}

/// Where the samples of a run are.
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

/// What sets the inputs of a run.
#[derive(Clone, Debug)]
pub enum Drive {
    /// Time series and expressions; without them all inputs keep the values of the state.
    Options(InputOptions),
    /// A function of time and state.
    Law(Law),
}

impl Simulation {
    /// A run with the usual samples, whose inputs keep their values.
    pub fn new(stepping: Stepping) -> Self {
        Simulation {
            stepping,
            samples: Samples::Usual,
            drive: Drive::Options(InputOptions::default()),
            events: Vec::new(),
            stop: None,
        }
    }

    /// What sets the inputs of a run from a state, where they do not keep their values.
    ///
    /// # Errors
    /// Inputs that cannot be what is asked for.
    pub(crate) fn inputs(
        &self,
        generated: &Generated,
        state: &State,
    ) -> Result<Option<Inputs>, Error> {
        match &self.drive {
            Drive::Law(law) => Ok(Some(law.clone().into())),
            Drive::Options(asked) => Ok(Inputs::new(asked, self.stepping.until, generated, state)?),
        }
    }

    /// Runs a system, which has the numbers of a state and these inputs, and whose outputs are all that events watch.
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
        let events = Events::new(self.events.clone(), &system, added::name);
        Run::new(generated, system, plan, events, reporter)
    }
}
