//! `hamel simulate`: runs a system over time.

mod options;
mod panels;
mod picture;
mod rotor;
mod summary;
mod write;

use crate::absent::warn_of_interpretation;
use crate::failure::{Failure, print};
use crate::outputs;
use crate::parse::{Expected, positive};
use crate::robot::RobotOptions;
use crate::series::read_series;
use crate::source;
use clap::Args;
use hamel_codegen::generate::Generated;
use hamel_codegen::tables::{self, Table};
use hamel_engine::run::Every;
use hamel_engine::{InputSource, Samples, Session, Simulation, Stepping, method};
pub use options::{InputArguments, SteppingArguments};
use picture::picture;
use std::path::PathBuf;
use write::Format;

/// Integrates the equations of motion from a start.
///
/// The functions of the description are compiled to machine code in memory, and so are whole steps of explicit methods
/// if inputs are constant: a run takes about as long as generated Rust. Inputs keep the value that STATE.json gives
/// them, or zero, unless --inputs or --input sets them.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel simulate dzhanibekov.eom --until 100 --plot flip.svg
  hamel simulate heavy_top.eom --until 10 --step 1e-3 --out run.csv --every 10
  hamel simulate heavy_top.eom --until 10 --method gauss6 --tables
  hamel simulate heavy_top.eom --until 10 --method rkmk8 --tol 1e-10
  hamel simulate heavy_top.eom --until 10 --method rk4 --lambda 5
  hamel simulate heavy_top.eom --until 10 --at state.json
  hamel simulate cart_pole.eom --until 10 --input \"F = 2 * sin(3 * t) - 4 * v\"
  hamel simulate cart_pole.eom --until 10 --inputs forces.csv --times times.csv --out run.csv", after_long_help = method::descriptions())]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    stepping: SteppingArguments,
    /// Start, by coordinates with parameters and inputs, or by joints; see `hamel eval --help`.
    #[arg(long, value_name = "STATE.json")]
    at: Option<PathBuf>,
    /// Write samples as .csv or .json, or a plot as .svg. Column names are unique: `t` is the time of a description
    /// that declares `time t;`, and otherwise the time since the start of the run; it is `t_run` if something else is
    /// called `t`.
    #[arg(long, value_name = "F")]
    out: Option<PathBuf>,
    /// Print γ, M and Γ before the run.
    #[arg(long)]
    tables: bool,
    /// Take a sample every N steps, or, with an `s` as in 0.01s, at multiples of that time; default: about 1000
    /// samples.
    #[arg(long, value_name = "N", value_parser = every, allow_negative_numbers = true)]
    every: Option<Every>,
    /// Take samples only at the times in the column `t` of this file; if the description declares a time,
    /// at these values of it.
    #[arg(long, value_name = "F.csv", conflicts_with = "every")]
    times: Option<PathBuf>,
    #[command(flatten)]
    inputs: InputArguments,
    /// Plot coordinates, velocities, outputs and conserved quantities over time, with the path of a body
    /// axis if there is exactly one attitude, and with Poinsot's construction of a body that is nearly free.
    #[arg(long, value_name = "F.svg")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Simulates, writes the files that are asked for, and prints a summary.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let stepping = Stepping::from(&arguments.stepping);
    stepping.check().map_err(hamel_engine::Error::from)?;
    let format = arguments.out.as_deref().map(Format::of).transpose()?;
    let (out, plot) = (arguments.out.as_deref(), arguments.plot.as_deref());
    outputs::svg("--plot", plot)?;
    outputs::apart(
        [("--out", out), ("--plot", plot)],
        [
            Some(arguments.file.as_path()),
            arguments.at.as_deref(),
            arguments.times.as_deref(),
            arguments.inputs.inputs.as_deref(),
        ],
    )?;
    let session =
        Session::with_default_functions(source::open(&arguments.file, &arguments.robot)?)?;
    let state = session.read_state(arguments.at.as_deref())?;
    let step_is_chosen = stepping.step.is_none();
    let run = session.simulate(&state, &arguments.simulation(stepping)?)?;
    warn_of_interpretation(run.evaluations);

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
            Format::Svg => drawn(&picture(&run))?,
        };
        crate::failure::write(path, &text)?;
        written.push_str(&format!("wrote {}\n", path.display()));
    }
    if arguments.tables {
        print(&coefficients(&run.generated))?;
    }
    if arguments.out.is_none() {
        print(&summary::table(&run))?;
    }
    print(&summary::text(&run, step_is_chosen))?;
    print(&written)?;
    match run.failure {
        Some(early) => Err(Failure::failed(early.to_string())),
        None => Ok(()),
    }
}

impl Arguments {
    /// Reads the files of the run, and collects its options.
    fn simulation(&self, stepping: Stepping) -> Result<Simulation, Failure> {
        let inputs = InputSource::Options(self.inputs.read()?);
        Ok(Simulation {
            samples: match (&self.times, self.every) {
                (Some(path), _) => Samples::Of(read_series(path)?),
                (None, Some(every)) => Samples::Every(every),
                (None, None) => Samples::Usual,
            },
            inputs,
            ..Simulation::new(stepping)
        })
    }
}

/// Returns the SVG of a picture.
fn drawn(picture: &hamel_report::plot::Picture) -> Result<String, Failure> {
    let figure =
        hamel_report::plot::run(picture).map_err(|error| Failure::failed(error.to_string()))?;
    Ok(figure.standalone())
}

/// γ, M and Γ as text; empty if A has dependent columns.
fn coefficients(generated: &Generated) -> String {
    let of = [Table::Gamma, Table::Mass, Table::Connection];
    match generated.tables(&of) {
        Ok(tables) => tables::text(&tables, false) + "\n",
        Err(_) => String::new(),
    }
}

/// Parses `10` as steps and `0.01s` as a time.
fn every(text: &str) -> Result<Every, Expected> {
    match text.strip_suffix('s') {
        Some(time) => positive(time).map(Every::Time),
        None => match text.parse::<u64>() {
            Ok(steps) if steps > 0 => Ok(Every::Steps(steps)),
            _ => Err(Expected::Interval),
        },
    }
}
