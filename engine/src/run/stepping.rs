//! Options for stepping a run: its length, the method, the step or the tolerance.

use super::plan::{Every, SamplingProblem, SteppingPlan};
use crate::error::Error;
use crate::mechanism::Instance;
use crate::method::{AUTO, ChosenMethod, Stepper};
use hamel::methods::General;
use hamel_codegen::generate::Generated;
use std::fmt;

/// Default of --step (s), adjusted so that a run takes a number of steps between the following limits.
const DEFAULT_STEP: f64 = 1e-3;
const MIN_DEFAULT_STEPS: f64 = 1e3;
const MAX_DEFAULT_STEPS: f64 = 1e6;
/// Largest number of samples: more would be a mistake, and fill the memory.
const MAX_SAMPLES: f64 = 1e8;
/// Default of --lambda.
const DEFAULT_LAMBDA: f64 = 10.0;
/// Tolerance if `auto` takes a method that chooses its steps.
const AUTO_TOLERANCE: f64 = 1e-9;
/// Choice of `auto` if a tolerance is given and the best method has equal steps.
const AUTO_METHOD_BY_TOLERANCE: &str = "rkmk8";

/// Length, method and steps of a run.
#[derive(Clone, Debug)]
pub struct Stepping {
    /// Length of the run, in the description's unit of time (s).
    pub until: f64,
    /// Length of a step; by default 0.001, adjusted so that a run takes 10³ to 10⁶ steps.
    pub step: Option<f64>,
    /// The name of the method; `auto` takes what fits the system, one that chooses its steps where a tolerance is
    /// given.
    pub method: String,
    /// Permitted error per step, for methods that choose their steps.
    pub tol: Option<f64>,
    /// Rate at which `rk4` leads back to the constraint (1/s).
    pub lambda: Option<f64>,
}

/// Error in length, method and steps of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum SteppingProblem {
    /// A length or a tolerance is not a number greater than zero.
    NotPositive(&'static str),
    /// The run is too short to be divided into steps.
    TooShort,
    /// Both a step and a tolerance are given.
    StepAndTolerance,
    /// The rate at which `rk4` leads back is not a number, zero or greater.
    Rate,
    /// The rate at which `rk4` leads back is given for another method.
    RateWithoutRk4,
    /// A tolerance is given for a method that does not choose its steps.
    Tolerance {
        /// The name of the method.
        method: &'static str,
    },
}

impl fmt::Display for SteppingProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SteppingProblem::NotPositive(what) => {
                write!(f, "{what} has to be a number greater than zero")
            }
            SteppingProblem::TooShort => write!(
                f,
                "the length of a run has to be at least {:e}",
                f64::MIN_POSITIVE
            ),
            SteppingProblem::StepAndTolerance => f.write_str(
                "give a step or a tolerance, not both: a tolerance chooses the steps",
            ),
            SteppingProblem::Rate => f.write_str(
                "the rate at which rk4 stabilizes the constraint has to be a number, zero or greater",
            ),
            SteppingProblem::RateWithoutRk4 => f.write_str(
                "--lambda works only with --method rk4: the other methods keep the constraint without it",
            ),
            SteppingProblem::Tolerance { method } => write!(
                f,
                "--tol works only with --method rkmk54 and rkmk8, which choose their steps; {method} takes --step"
            ),
        }
    }
}

impl std::error::Error for SteppingProblem {}

impl Stepping {
    /// Options for a run of this length, by the method that fits the system, in steps of the usual length.
    pub fn until(until: f64) -> Self {
        Stepping {
            until,
            step: None,
            method: AUTO.into(),
            tol: None,
            lambda: None,
        }
    }

    /// Checks everything that does not depend on the system.
    pub fn check(&self) -> Result<(), SteppingProblem> {
        let lengths = [
            ("the length of a run", Some(self.until)),
            ("a step", self.step),
            ("a tolerance", self.tol),
        ];
        for (what, length) in lengths {
            if !length.is_none_or(is_positive) {
                return Err(SteppingProblem::NotPositive(what));
            }
        }
        // Shorter times have too few digits to be divided into steps.
        if !self.until.is_normal() {
            return Err(SteppingProblem::TooShort);
        }
        if self.step.is_some() && self.tol.is_some() {
            return Err(SteppingProblem::StepAndTolerance);
        }
        if !self.lambda.is_none_or(is_rate) {
            return Err(SteppingProblem::Rate);
        }
        match self.lambda.is_some() && self.method != "rk4" {
            true => Err(SteppingProblem::RateWithoutRk4),
            false => Ok(()),
        }
    }

    /// Plans a run of a system, with the requested or the best method.
    pub fn plan(
        &self,
        generated: &Generated,
        system: &Instance,
        every: Option<Every>,
    ) -> Result<SteppingPlan, Error> {
        let step = self.step.unwrap_or_else(|| {
            DEFAULT_STEP.clamp(
                self.until / MAX_DEFAULT_STEPS,
                self.until / MIN_DEFAULT_STEPS,
            )
        });
        let samples = match every {
            Some(Every::Time(time)) => self.until / time,
            Some(Every::Steps(steps)) => self.until / step / steps as f64,
            None => 0.0,
        };
        if samples > MAX_SAMPLES {
            let most = MAX_SAMPLES;
            return Err(SamplingProblem::TooMany { samples, most }.into());
        }
        let steps = (self.until / step).ceil() as u64;
        let method = self.chosen(generated, system, steps)?;
        let tolerance = self.tolerance(&method)?;
        Ok(SteppingPlan::new(
            method, self.until, step, every, tolerance,
        ))
    }

    /// Returns the requested or the best method, checked against the structure of the system.
    fn chosen(
        &self,
        generated: &Generated,
        system: &Instance,
        steps: u64,
    ) -> Result<ChosenMethod, Error> {
        let structure = match self.method == AUTO {
            true => system.structure_for_choice(&generated.program),
            false => system.structure(&generated.program),
        };
        let mut chosen = ChosenMethod::new(&self.method, system, &structure, steps)?;
        if self.method == AUTO && self.tol.is_some() && !adapts(&chosen) {
            chosen = ChosenMethod::new(AUTO_METHOD_BY_TOLERANCE, system, &structure, steps)?;
            chosen.reason = Some("a tolerance was given");
        }
        if let Stepper::General(General::Rk4 { lambda }) = &mut chosen.stepper {
            *lambda = self.lambda.unwrap_or(DEFAULT_LAMBDA);
        }
        Ok(chosen)
    }

    /// Returns the tolerance of a run that chooses its steps; `None` for equal steps.
    fn tolerance(&self, chosen: &ChosenMethod) -> Result<Option<f64>, SteppingProblem> {
        match self.tol {
            Some(_) if !adapts(chosen) => Err(SteppingProblem::Tolerance {
                method: chosen.name,
            }),
            None if adapts(chosen) && chosen.reason.is_some() && self.step.is_none() => {
                Ok(Some(AUTO_TOLERANCE))
            }
            tol => Ok(tol),
        }
    }
}

/// Returns whether a method can choose its steps.
fn adapts(chosen: &ChosenMethod) -> bool {
    matches!(
        chosen.stepper,
        Stepper::General(General::Rkmk54 | General::Rkmk8)
    )
}

fn is_positive(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

fn is_rate(value: f64) -> bool {
    value.is_finite() && value >= 0.0
}
