//! Options of runs.

use crate::failure::Failure;
use crate::parse::{positive, rate};
use crate::series::read_series;
use clap::Args;
use clap::builder::PossibleValuesParser;
use hamel_engine::method::{self, AUTO};
use hamel_engine::{InputOptions, Stepping};
use std::path::PathBuf;

/// Length, method and steps of a run.
#[derive(Args, Clone, Debug)]
pub struct SteppingArguments {
    /// Length of the run, in the description's unit of time (s).
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    until: f64,
    /// Length of a step; default: 0.001, adjusted so that a run takes 10³ to 10⁶ steps.
    #[arg(long, value_name = "H", value_parser = positive, allow_negative_numbers = true)]
    step: Option<f64>,
    /// Integrator; `auto` takes the one that fits the system, with --tol one that chooses its steps, and prints the
    /// reason. `--help` describes them all.
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(method::names()), default_value = AUTO)]
    method: String,
    /// Permitted error per step, for rkmk54 and rkmk8, which then choose their steps; 1e-9 if `auto`
    /// takes one of them and no --step is given.
    #[arg(long, value_name = "E", value_parser = positive, allow_negative_numbers = true, conflicts_with = "step")]
    tol: Option<f64>,
    /// Rate at which rk4 returns to the constraint (1/s); default: 10.
    #[arg(long, value_name = "L", value_parser = rate, allow_negative_numbers = true)]
    lambda: Option<f64>,
}

impl From<&SteppingArguments> for Stepping {
    fn from(arguments: &SteppingArguments) -> Self {
        Stepping {
            until: arguments.until,
            step: arguments.step,
            method: arguments.method.clone(),
            tol: arguments.tol,
            lambda: arguments.lambda,
        }
    }
}

/// Options for the inputs of a run.
#[derive(Args, Clone, Debug, Default)]
pub struct InputArguments {
    /// Read inputs over time: a column `t` and columns with names of inputs, as in `t,F,tau[2]`; linear between two
    /// rows. Inputs without a column keep their values. If the description declares a time, `t` is that time, as in
    /// --input.
    #[arg(long, value_name = "F.csv")]
    pub inputs: Option<PathBuf>,
    /// Hold the values of --inputs until the next row, and after the last.
    #[arg(long, requires = "inputs")]
    pub hold: bool,
    /// Set an input to an expression in `t`, parameters, coordinates, velocities and states.
    #[arg(long, value_name = "NAME = EXPR")]
    pub input: Vec<String>,
}

impl InputArguments {
    /// Reads the file of `--inputs`, if any, and collects the inputs of a run.
    pub fn read(&self) -> Result<InputOptions, Failure> {
        Ok(InputOptions {
            series: self.inputs.as_deref().map(read_series).transpose()?,
            hold: self.hold,
            expressions: self.input.clone(),
        })
    }
}
