//! Options for stepping a run: its length, the method, the step or the tolerance.

use super::plan::{Every, Plan};
use crate::failure::Failure;
use crate::mechanism::Instance;
use crate::method::{self, AUTO, Chosen, Stepper};
use crate::number::short;
use clap::Args;
use clap::builder::PossibleValuesParser;
use hamel::methods::General;
use hamel_codegen::generate::Generated;

/// Default of --step, adjusted so that a run takes a number of steps between these limits.
const STEP: f64 = 1e-3;
const FEWEST: f64 = 1e3;
const MOST: f64 = 1e6;
/// Largest number of samples: more would be a mistake, and fill the memory.
const SAMPLES: f64 = 1e8;
/// Default of --lambda.
const LAMBDA: f64 = 10.0;
/// Tolerance if `auto` takes a method that chooses its steps.
const TOLERANCE: f64 = 1e-9;
/// Choice of `auto` if a tolerance is given and the best method has equal steps.
const BY_TOLERANCE: &str = "rkmk8";

/// Length, method and steps of a run.
#[derive(Args, Clone, Debug)]
pub struct Stepping {
    /// Length of the run, in the description's unit of time (s).
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    pub until: f64,
    /// Length of a step; default: 0.001, adjusted so that a run takes 10³ to 10⁶ steps.
    #[arg(long, value_name = "H", value_parser = positive, allow_negative_numbers = true)]
    pub step: Option<f64>,
    /// Integrator; `auto` takes the one that fits the system, with --tol one that chooses its steps, and prints the
    /// reason. `--help` describes them all.
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(method::names()), default_value = AUTO)]
    pub method: String,
    /// Permitted error per step, for rkmk54 and rkmk8, which then choose their steps; 1e-9 if `auto`
    /// takes one of them and no --step is given.
    #[arg(long, value_name = "E", value_parser = positive, allow_negative_numbers = true, conflicts_with = "step")]
    pub tol: Option<f64>,
    /// Rate at which rk4 returns to the constraint (1/s); default: 10.
    #[arg(long, value_name = "L", value_parser = rate, allow_negative_numbers = true)]
    pub lambda: Option<f64>,
}

impl Stepping {
    /// Checks the options that do not depend on the system.
    pub fn check(&self) -> Result<(), Failure> {
        let lengths = [
            ("the length of a run", Some(self.until)),
            ("a step", self.step),
            ("a tolerance", self.tol),
        ];
        for (what, length) in lengths {
            if !length.is_none_or(is_positive) {
                return Err(Failure::usage(format!(
                    "{what} has to be a number greater than zero"
                )));
            }
        }
        // Shorter times have too few digits to be divided into steps.
        if !self.until.is_normal() {
            return Err(Failure::usage(format!(
                "the length of a run has to be at least {:e}",
                f64::MIN_POSITIVE
            )));
        }
        if self.step.is_some() && self.tol.is_some() {
            return Err(Failure::usage(
                "give a step or a tolerance, not both: a tolerance chooses the steps",
            ));
        }
        if !self.lambda.is_none_or(is_rate) {
            return Err(Failure::usage(
                "the rate at which rk4 stabilizes the constraint has to be a number, zero or greater",
            ));
        }
        match self.lambda.is_some() && self.method != "rk4" {
            true => Err(Failure::usage(
                "--lambda works only with --method rk4: the other methods keep the constraint without it",
            )),
            false => Ok(()),
        }
    }

    /// The plan of a run of a system, with the requested or the best method.
    pub fn plan(
        &self,
        generated: &Generated,
        system: &Instance,
        every: Option<Every>,
    ) -> Result<Plan, Failure> {
        let step = self
            .step
            .unwrap_or_else(|| STEP.clamp(self.until / MOST, self.until / FEWEST));
        let samples = match every {
            Some(Every::Time(time)) => self.until / time,
            Some(Every::Steps(steps)) => self.until / step / steps as f64,
            None => 0.0,
        };
        if samples > SAMPLES {
            return Err(Failure::usage(format!(
                "there would be {} samples, but at most {} are kept: take them less often",
                short(samples),
                short(SAMPLES)
            )));
        }
        let steps = (self.until / step).ceil() as u64;
        let method = self.chosen(generated, system, steps)?;
        let tolerance = self.tolerance(&method)?;
        Ok(Plan::new(method, self.until, step, every, tolerance))
    }

    /// The requested or the best method, checked against the structure of the system.
    fn chosen(
        &self,
        generated: &Generated,
        system: &Instance,
        steps: u64,
    ) -> Result<Chosen, Failure> {
        let structure = match self.method == AUTO {
            true => system.cautious(&generated.program),
            false => system.structure(&generated.program),
        };
        let mut chosen = Chosen::new(&self.method, system, &structure, steps)?;
        if self.method == AUTO && self.tol.is_some() && !adapts(&chosen) {
            chosen = Chosen::new(BY_TOLERANCE, system, &structure, steps)?;
            chosen.reason = Some("a tolerance was given");
        }
        if let Stepper::General(General::Rk4 { lambda }) = &mut chosen.stepper {
            *lambda = self.lambda.unwrap_or(LAMBDA);
        }
        Ok(chosen)
    }

    /// The tolerance of a run that chooses its steps; `None` for equal steps.
    fn tolerance(&self, chosen: &Chosen) -> Result<Option<f64>, Failure> {
        match self.tol {
            Some(_) if !adapts(chosen) => Err(Failure::usage(format!(
                "--tol works only with --method rkmk54 and rkmk8, which choose their steps; {} takes --step",
                chosen.name
            ))),
            None if adapts(chosen) && chosen.reason.is_some() && self.step.is_none() => {
                Ok(Some(TOLERANCE))
            }
            tol => Ok(tol),
        }
    }
}

/// Whether a method can choose its steps.
fn adapts(chosen: &Chosen) -> bool {
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

/// Parses a number greater than zero.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if is_positive(value) => Ok(value),
        _ => Err("expected a number greater than zero".into()),
    }
}

fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if is_rate(value) => Ok(value),
        _ => Err("expected a number, zero or greater".into()),
    }
}
