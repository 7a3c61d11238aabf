//! Plan of a run: the method, its steps, and the samples.

use super::cancellation::CancellationToken;
use super::inputs::Inputs;
use crate::mechanism::Instance;
use crate::method::ChosenMethod;
use hamel_files::number::short;
use std::fmt;

/// Default number of samples.
const DEFAULT_SAMPLES: u64 = 1000;
/// Number of points of a plot.
pub const PLOT_POINTS: u64 = 4000;

/// Interval of samples as requested: a time or a number of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// Number of steps between samples.
    Steps(u64),
    /// At multiples of this time.
    Time(f64),
}

/// Method, steps, tolerance and sample times of a run.
#[derive(Clone, Debug)]
pub struct SteppingPlan {
    /// The method.
    pub method: ChosenMethod,
    /// Length of the run.
    pub until: f64,
    /// Length of equal steps.
    pub step: f64,
    /// Expected number of steps.
    pub steps: u64,
    /// Number of steps between samples, if samples are at ends of steps.
    pub every: u64,
    /// Whether that was chosen by the plan, which may then take fewer samples.
    pub chosen: bool,
    /// Permitted error per step, if steps are chosen by it.
    pub tolerance: Option<f64>,
    /// Samples that are not at ends of steps.
    pub spacing: Spacing,
    /// Least number of points at which steps chosen by their error are shown.
    pub points: u64,
    /// Whether the ends of steps are not observed.
    pub quiet: bool,
    /// Cancellation of the run, if steps are observed.
    pub stop: Option<CancellationToken>,
}

/// Error in the requested samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SamplingProblem {
    /// A time is outside of the run.
    Outside {
        /// The time.
        time: f64,
        /// The length of the run.
        until: f64,
    },
    /// A time is not after the one before it.
    Order {
        /// The time.
        time: f64,
        /// The one before it.
        before: f64,
    },
    /// There are no times.
    NoTimes,
    /// There are more samples than are kept.
    TooMany {
        /// Requested number.
        samples: f64,
        /// Largest number.
        most: f64,
    },
}

impl fmt::Display for SamplingProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SamplingProblem::Outside { time, until } => write!(
                f,
                "t = {time} is outside the run, which is from 0 to {until}"
            ),
            SamplingProblem::Order { time, before } => {
                write!(f, "times have to increase: {time} is not after {before}")
            }
            SamplingProblem::NoTimes => f.write_str("there are no times for samples"),
            SamplingProblem::TooMany { samples, most } => write!(
                f,
                "there would be {} samples, but at most {} are kept: take them less often",
                short(*samples),
                short(*most)
            ),
        }
    }
}

impl std::error::Error for SamplingProblem {}

/// Times of samples.
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
    /// Takes samples at these times of a run of length `until`.
    ///
    /// # Errors
    /// The times do not increase, or are outside of the run.
    pub fn at(times: Vec<f64>, until: f64) -> Result<Self, SamplingProblem> {
        let outside = times.iter().find(|time| !(0.0..=until).contains(*time));
        let falling = times.windows(2).find(|pair| pair[0] >= pair[1]);
        match (outside, falling) {
            (Some(&time), _) => Err(SamplingProblem::Outside { time, until }),
            (None, Some(pair)) => Err(SamplingProblem::Order {
                time: pair[1],
                before: pair[0],
            }),
            (None, None) if times.is_empty() => Err(SamplingProblem::NoTimes),
            (None, None) => Ok(Spacing::Times(times)),
        }
    }

    /// Returns the times of samples in a step.
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

impl SteppingPlan {
    /// Returns whether the energy of a run is monitored. Without observed steps the work of loads is unknown, and an
    /// external controller is called only by the method.
    pub fn monitors_energy(&self, system: &Instance) -> bool {
        let is_law = system.varying_inputs().is_some_and(Inputs::is_law);
        self.tolerance.is_some() || !self.quiet && !is_law
    }

    /// Returns whether the run is cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.stop
            .as_ref()
            .is_some_and(|CancellationToken(asked)| asked())
    }

    /// Returns whether samples are at multiples of a time.
    pub fn has_multiples(&self) -> bool {
        matches!(self.spacing, Spacing::Every(_))
    }

    /// Plans a run of length `until` in steps of `step`, or by `tolerance`, with samples at the interval `every`; without
    /// it, about a thousand samples. Equal steps are shortened so that samples
    /// fall on their ends: for multiples of a time, a whole number of steps leads from one to the next.
    pub fn new(
        method: ChosenMethod,
        until: f64,
        mut step: f64,
        every: Option<Every>,
        tolerance: Option<f64>,
    ) -> Self {
        let (every, spacing) = match (every, tolerance) {
            (None, _) => (None, Spacing::Steps),
            (Some(Every::Steps(steps)), _) => (Some(steps), Spacing::Steps),
            (Some(Every::Time(time)), Some(_)) => (Some(1), Spacing::Every(time)),
            // The number of equal steps needed from one sample to the next.
            (Some(Every::Time(time)), None) => {
                if time < until {
                    step = time / (time / step * (1.0 - 1e-9)).ceil().max(1.0);
                }
                (Some(1), Spacing::Every(time))
            }
        };
        // Like the integrator: a ratio that is whole up to rounding counts as whole.
        let steps = ((until / step) * (1.0 - 1e-9)).ceil().max(1.0) as u64;
        let default = match tolerance {
            // The number of steps is not known in advance.
            Some(_) => 1,
            None => (steps / DEFAULT_SAMPLES).max(1),
        };
        SteppingPlan {
            method,
            until,
            step,
            steps,
            every: every.unwrap_or(default),
            chosen: every.is_none(),
            tolerance,
            spacing,
            points: PLOT_POINTS,
            quiet: false,
            stop: None,
        }
    }
}
