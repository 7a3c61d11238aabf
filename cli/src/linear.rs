//! Linear systems as `hamel lqr`, `step` and `bode` open them: a description linearised at a state.

use crate::failure::{Failure, write};
use crate::json::Json;
use crate::parse::positive;
use crate::robot::RobotOptions;
use crate::{outputs, source};
use clap::Args;
use hamel_codegen::generate::Generated;
use hamel_engine::linear::{Channel, LinearSystem, Matrix};
use hamel_engine::linearize::{Linearization, linearize};
use hamel_engine::{State, names};
use hamel_files::number::{exact, short};
use hamel_report::plot::{Figure, Panel, Picture, PlotError};
use nalgebra::Complex;
use std::path::PathBuf;

/// Largest acceleration that counts as a rounding error of zero.
const REST_TOLERANCE: f64 = 1e-9;

/// Description, state and period.
#[derive(Args)]
pub struct LinearArguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// State, by coordinates or by joints; see `hamel eval --help`.
    #[arg(long, value_name = "STATE.json")]
    pub at: Option<PathBuf>,
    /// Take the system in steps of this length, between which inputs are held: x⁺ = A x + B u with
    /// [A B; 0 I] = exp([A B; 0 0] H), exact for the linear system.
    #[arg(long, value_name = "H", value_parser = positive, allow_negative_numbers = true)]
    pub step: Option<f64>,
    #[command(flatten)]
    robot: RobotOptions,
}

impl LinearArguments {
    /// Linearises at the state, with all displacements if `full`.
    pub fn open(&self, full: bool) -> Result<(Linearization, LinearSystem), Failure> {
        let (linear, system, _) = self.open_with_law(full)?;
        Ok((linear, system))
    }

    /// Returns also the operating point, for controllers in terms of coordinates and velocities.
    pub fn open_with_law(
        &self,
        full: bool,
    ) -> Result<(Linearization, LinearSystem, OperatingPoint), Failure> {
        let source = source::open(&self.file, &self.robot)?.for_evaluation();
        let generated = source.derive_linearized()?;
        let state = State::read(&source, &generated, self.at.as_deref())?;
        let linear = linearize(&generated, &state, source.shown(), full)?;
        let system = LinearSystem::from(&linear);
        let stepped = self.step.map(|h| system.discretized(h)).transpose();
        let stepped = stepped.map_err(hamel_engine::Error::from)?;
        let point = OperatingPoint::new(&generated, &state, &linear.states);
        Ok((linear, stepped.unwrap_or(system), point))
    }
}

/// Values about which a system is linear.
pub struct OperatingPoint {
    /// u₀.
    pub inputs: Vec<f64>,
    /// The states as expressions, as in `(q - 0.5)` or `v`; `None` if some displacement is not that of a coordinate.
    pub states: Option<Vec<String>>,
}

impl OperatingPoint {
    fn new(generated: &Generated, state: &State, states: &[String]) -> Self {
        let away = |name: &str, value: f64| match value == 0.0 {
            true => name.to_string(),
            false if value < 0.0 => format!("({name} + {})", exact(-value)),
            false => format!("({name} - {})", exact(value)),
        };
        let value = |names: Vec<String>, values: &[f64], name: &str| {
            let place = names.iter().position(|known| known == name)?;
            Some(away(name, *values.get(place)?))
        };
        let rates = names::rates(&generated.model);
        let expression = |name: &String| {
            let (kind, velocity) = name.strip_suffix(')')?.split_once('(')?;
            if kind == "d" {
                let known = names::velocities_and_states(&generated.active);
                return value(known, &state.xi, velocity);
            }
            let (coordinate, _) = rates.iter().find(|(_, rate)| rate == velocity)?;
            value(names::coordinates(&generated.model), &state.x, coordinate)
        };
        OperatingPoint {
            inputs: state.u.clone(),
            states: states.iter().map(expression).collect(),
        }
    }
}

/// Returns a sentence if the state is not at rest nor in steady motion.
pub fn unsteady(linear: &Linearization) -> String {
    let largest = linear.xi_dot.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    match largest > REST_TOLERANCE {
        true => format!(
            "\nthe velocities change here, max |xi_dot| = {}: the matrices hold for this instant\n",
            short(largest)
        ),
        false => String::new(),
    }
}

/// One input, one output, and the files of a response.
#[derive(Args)]
pub struct ChannelArguments {
    #[command(flatten)]
    pub linear: LinearArguments,
    /// Input; the only one by default.
    #[arg(long, value_name = "INPUT")]
    from: Option<String>,
    /// Output, or a state as in `h(v)`; the only output by default.
    #[arg(long, value_name = "OUTPUT")]
    to: Option<String>,
    /// Write the response as CSV.
    #[arg(long, value_name = "F.csv")]
    pub out: Option<PathBuf>,
    /// Plot the response.
    #[arg(long, value_name = "F.svg")]
    pub plot: Option<PathBuf>,
}

impl ChannelArguments {
    /// Opens the system, and returns the channel with its title.
    pub fn open(&self) -> Result<(Linearization, Channel, String), Failure> {
        outputs::svg("--plot", self.plot.as_deref())?;
        outputs::apart(
            [
                ("--out", self.out.as_deref()),
                ("--plot", self.plot.as_deref()),
            ],
            [Some(self.linear.file.as_path()), self.linear.at.as_deref()],
        )?;
        let (linear, system) = self.linear.open(false)?;
        // Without a name the only one is meant; the error of an empty name lists those that there are.
        let only = |given: &Option<String>, names: &[String]| match (given, names) {
            (None, [only]) => only.clone(),
            _ => given.clone().unwrap_or_default(),
        };
        let (from, to) = (
            only(&self.from, &system.inputs),
            only(&self.to, &system.outputs),
        );
        let missing = match (from.is_empty(), to.is_empty()) {
            (true, _) if !system.inputs.is_empty() => Some(("--from", &system.inputs)),
            (false, true) if !system.outputs.is_empty() => Some(("--to", &system.outputs)),
            (false, true) => Some(("--to", &system.states)),
            _ => None,
        };
        if let Some((option, names)) = missing {
            return Err(Failure::usage(format!(
                "{option} is needed: one of {}",
                names.join(", ")
            )));
        }
        let channel = system
            .channel(&from, &to)
            .map_err(hamel_engine::Error::from)?;
        let title = format!("{}: {to} by {from}", linear.system);
        Ok((linear, channel, title))
    }

    /// Writes the files that are asked for, and returns lines about them.
    pub fn write(
        &self,
        columns: &[(&str, &[f64])],
        title: String,
        panels: Vec<Panel>,
        draw: fn(&Picture) -> Result<Figure, PlotError>,
    ) -> Result<String, Failure> {
        let mut written = String::new();
        if let Some(path) = &self.out {
            let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
            let mut text = names.join(",") + "\n";
            for row in 0..columns[0].1.len() {
                let values: Vec<String> = columns
                    .iter()
                    .map(|(_, values)| exact(values[row]))
                    .collect();
                text += &(values.join(",") + "\n");
            }
            write(path, &text)?;
            written += &format!("wrote {}\n", path.display());
        }
        if let Some(path) = &self.plot {
            let picture = Picture {
                title,
                subtitle: String::new(),
                time: columns[0].1.to_vec(),
                panels,
                path: None,
                poinsot: None,
            };
            let figure = draw(&picture).map_err(|error| Failure::failed(error.to_string()))?;
            write(path, &figure.standalone())?;
            written += &format!("wrote {}\n", path.display());
        }
        Ok(written)
    }
}

/// Returns the rows of a matrix.
pub fn rows(matrix: &Matrix) -> Vec<Vec<f64>> {
    let rows = matrix.row_iter();
    rows.map(|row| row.iter().copied().collect()).collect()
}

/// Returns complex numbers as pairs.
pub fn pairs(values: &[Complex<f64>]) -> Json {
    let pair = |value: &Complex<f64>| Json::vector(&[value.re, value.im]);
    Json::List(values.iter().map(pair).collect())
}
