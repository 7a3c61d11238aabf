//! `hamel simulate`: a run in time, interpreted.

mod balance;
pub mod inputs;
mod panels;
mod picture;
mod record;
mod rotor;
mod summary;
mod write;

use crate::failure::{Failure, print};
use crate::interpreted::Interpreted;
use crate::method::{self, AUTO, Chosen, Stepper};
use crate::robot::RobotOptions;
use crate::source::Source;
use crate::state::State;
use clap::Args;
use clap::builder::PossibleValuesParser;
use hamel::methods::General;
use hamel_codegen::generate::Generated;
use hamel_codegen::tables::{self, Table};
use hamel_report::plot;
use record::{Every, Plan, Run, Spacing};
use std::path::PathBuf;
use write::Format;

/// Steps where --step is left out: a thousandth, but no fewer than 1000 and no more than a million.
const STEP: f64 = 1e-3;
const FEWEST: f64 = 1e3;
const MOST: f64 = 1e6;
/// λ where --lambda is left out.
const LAMBDA: f64 = 10.0;
/// The tolerance where `auto` takes a method that chooses its steps.
const TOLERANCE: f64 = 1e-9;
/// What `auto` takes where a tolerance is given and the method that fits has equal steps.
const BY_TOLERANCE: &str = "rkmk8";

/// Integrates the equations of motion from a start.
///
/// The equations are interpreted: good for a look at a system, and some ten times slower than the
/// generated code. Inputs keep the value that STATE.json gives them, or zero, where no --inputs and no --input says what
/// they are.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel simulate dzhanibekov.eom --until 100 --plot flip.svg
  hamel simulate heavy_top.eom --until 10 --step 1e-3 --out run.csv --every 10
  hamel simulate heavy_top.eom --until 10 --method gauss6 --tables
  hamel simulate heavy_top.eom --until 10 --method rkmk8 --tol 1e-10
  hamel simulate heavy_top.eom --until 10 --method rk4 --lambda 5
  hamel simulate heavy_top.eom --until 10 --at state.json
  hamel simulate cart_pole.eom --until 10 --input \"F = 2 * sin(3 * t) - 4 * v\"
  hamel simulate cart_pole.eom --until 10 --inputs forces.csv --times times.csv --out run.csv", after_long_help = method::described())]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Length of the run, in the unit of time of the description (s).
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    until: f64,
    /// Length of a step; default 0.001, adjusted so that a run takes 10³ to 10⁶ steps.
    #[arg(long, value_name = "H", value_parser = positive, allow_negative_numbers = true)]
    step: Option<f64>,
    /// How to step; `auto` takes what fits the system and says why, a method that chooses its steps where
    /// --tol is given. --help tells them apart.
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(method::names()), default_value = AUTO)]
    method: String,
    /// Error that a step may make, for rkmk54 and rkmk8, which then choose their steps themselves.
    #[arg(long, value_name = "E", value_parser = positive, allow_negative_numbers = true, conflicts_with = "step")]
    tol: Option<f64>,
    /// Rate at which rk4 leads back to the constraint (1/s); default 10.
    #[arg(long, value_name = "L", value_parser = rate, allow_negative_numbers = true)]
    lambda: Option<f64>,
    /// Start, by coordinates with parameters and inputs, or by joints; see `hamel eval --help`.
    #[arg(long, value_name = "STATE.json")]
    at: Option<PathBuf>,
    /// Samples as .csv or .json, or a plot as .svg.
    #[arg(long, value_name = "F")]
    out: Option<PathBuf>,
    /// Print γ, M and Γ before the run.
    #[arg(long)]
    tables: bool,
    /// A sample every N steps, or with an `s`, as in 0.01s, at multiples of that time; by default about 1000
    /// samples.
    #[arg(long, value_name = "N", value_parser = every, allow_negative_numbers = true)]
    every: Option<Every>,
    /// Samples at the times in the column `t` of this file, and nowhere else.
    #[arg(long, value_name = "F.csv", conflicts_with = "every")]
    times: Option<PathBuf>,
    /// Inputs over time: a column `t` and columns with names of inputs, as in `t,F,tau[2]`; between two rows on a
    /// straight line. Inputs without a column keep their values.
    #[arg(long, value_name = "F.csv")]
    inputs: Option<PathBuf>,
    /// Values of --inputs hold until the next row, and behind the last.
    #[arg(long, requires = "inputs")]
    hold: bool,
    /// An input as an expression of `t`, parameters, coordinates, velocities and states.
    #[arg(long, value_name = "NAME = EXPR")]
    input: Vec<String>,
    /// Plot of coordinates, velocities, outputs and what is conserved over time, with the path of a body
    /// axis where there is one attitude, and with Poinsot's construction of a body that is nearly free.
    #[arg(long, value_name = "F.svg")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Runs and reports.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.lambda.is_some() && arguments.method != "rk4" {
        return Err(Failure::usage(
            "--lambda goes with --method rk4 alone: the other methods keep the constraint by themselves",
        ));
    }
    let format = arguments.out.as_deref().map(Format::of).transpose()?;
    let source = Source::open(&arguments.file, &arguments.robot)?.in_numbers();
    let generated = source.derive_all()?;
    let state = State::read(&source, &generated, arguments.at.as_deref())?;
    let asked = inputs::Asked {
        file: arguments.inputs.as_ref(),
        hold: arguments.hold,
        expressions: &arguments.input,
        until: arguments.until,
    };
    let given = inputs::Inputs::new(asked, &generated, &state)?;
    let system = Interpreted::new(&generated, &state, source.shown())?.with(given);
    system.check_parameters(&state.x)?;
    let until = arguments.until;
    let step = arguments
        .step
        .unwrap_or_else(|| STEP.clamp(until / MOST, until / FEWEST));
    let steps = (until / step).ceil() as u64;
    let method = chosen(arguments, &generated, &system, steps)?;
    let tolerance = tolerance(arguments, &method)?;
    let mut plan = Plan::new(method, until, step, arguments.every, tolerance);
    if let Some(path) = &arguments.times {
        plan.spacing = Spacing::Times(inputs::times(path, until)?);
    }
    let run = Run::new(&generated, &system, plan)?;

    let mut written = String::new();
    for (path, format) in [
        (&arguments.out, format),
        (&arguments.plot, Some(Format::Svg)),
    ] {
        let (Some(path), Some(format)) = (path, format) else {
            continue;
        };
        let text = match format {
            Format::Csv => write::csv(&run),
            Format::Json => write::json(&run),
            Format::Svg => drawn(&run.picture(&system))?,
        };
        crate::failure::write(path, &text)?;
        written.push_str(&format!("wrote {}\n", path.display()));
    }
    if arguments.tables {
        print(&coefficients(&generated))?;
    }
    if arguments.out.is_none() {
        print(&summary::table(&run))?;
    }
    print(&summary::text(&run, arguments.step.is_none()))?;
    print(&written)?;
    match run.failure {
        Some(why) => Err(Failure::failed(why)),
        None => Ok(()),
    }
}

/// The SVG text of a picture.
fn drawn(picture: &plot::Picture) -> Result<String, Failure> {
    let figure = plot::run(picture).map_err(|error| Failure::failed(error.to_string()))?;
    Ok(figure.standalone())
}

/// γ, M and Γ; empty where A has dependent columns.
fn coefficients(generated: &Generated) -> String {
    let of = [Table::Gamma, Table::Mass, Table::Connection];
    match tables::tables(generated, &of) {
        Ok(tables) => tables::text(&tables, false) + "\n",
        Err(_) => String::new(),
    }
}

/// The method that is asked for, or that fits; checked against the structure of the system.
fn chosen(
    arguments: &Arguments,
    generated: &Generated,
    system: &Interpreted,
    steps: u64,
) -> Result<Chosen, Failure> {
    let structure = system.structure(&generated.program);
    let mut chosen = Chosen::new(&arguments.method, system, &structure, steps)?;
    if arguments.method == AUTO && arguments.tol.is_some() && !adapts(&chosen) {
        chosen = Chosen::new(BY_TOLERANCE, system, &structure, steps)?;
        chosen.reason = Some("a tolerance was given");
    }
    if let Stepper::General(General::Rk4 { lambda }) = &mut chosen.stepper {
        *lambda = arguments.lambda.unwrap_or(LAMBDA);
    }
    Ok(chosen)
}

/// Whether a method can choose its steps.
fn adapts(chosen: &Chosen) -> bool {
    matches!(
        chosen.stepper,
        Stepper::General(General::Rkmk54 | General::Rkmk8)
    )
}

/// The tolerance of a run that chooses its steps; `None` for equal steps.
fn tolerance(arguments: &Arguments, chosen: &Chosen) -> Result<Option<f64>, Failure> {
    match arguments.tol {
        Some(_) if !adapts(chosen) => Err(Failure::usage(format!(
            "--tol goes with --method rkmk54 and rkmk8, which choose their steps; {} takes --step",
            chosen.name
        ))),
        None if adapts(chosen) && chosen.reason.is_some() && arguments.step.is_none() => {
            Ok(Some(TOLERANCE))
        }
        tol => Ok(tol),
    }
}

/// A number greater than zero.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("a number greater than zero is needed".into()),
    }
}

/// `10`: steps; `0.01s`: a time.
fn every(text: &str) -> Result<Every, String> {
    match text.strip_suffix('s') {
        Some(time) => positive(time).map(Every::Time),
        None => match text.parse::<u64>() {
            Ok(steps) if steps > 0 => Ok(Every::Steps(steps)),
            _ => Err("a number of steps, 1 or greater, or a time as in 0.01s is needed".into()),
        },
    }
}

fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err("a number, zero or greater, is needed".into()),
    }
}
