//! `hamel trim`: finds an equilibrium or a steady motion.

use crate::columns::aligned;
use crate::failure::{Failure, print, write};
use crate::json::Json;
use crate::linearize::spectrum;
use crate::outputs::apart;
use crate::parse::assignment;
use crate::robot::RobotOptions;
use crate::source;
use clap::{Args, ValueEnum};
use hamel_codegen::generate::Generated;
use hamel_engine::option_text::Piece;
use hamel_engine::trim::{Spectrum, Stability, derive, trim};
use hamel_engine::{State, Trim, TrimOptions, names};
use hamel_files::number::{error, short};
use nalgebra::Complex;
use std::path::PathBuf;

/// Finds an equilibrium, or a steady motion, near a state.
///
/// In an equilibrium all velocities are 0, and remain 0: ξ̇ = 0, and ż = 0 for states of first order. Unknown are the
/// coordinates, on their manifold and with closed loops, the states of first order, and the inputs that `--free` names;
/// other inputs keep the values of STATE.json, 0 by default.
///
/// In a steady motion, with `--steady`, velocities are unknown, too, and remain constant: ξ̇ = 0, and d/dt ξ̇ = 0 along
/// the motion, as in the coordinated turn of an aircraft or in the circle of a bicycle; velocities that constraints
/// determine follow. A short run confirms it. Velocities have to be those of axes in which the motion looks steady.
///
/// The search is Newton's, damped, with steps of least norm, and leads to a solution near the start; another start may
/// lead to another one. If it leads to none, it begins again at a few neighbours of the start. Where there are many solutions, the directions that remain free are named; `--fix` chooses among
/// them. The eigenvalues are those of the linearisation, apart from displacements along which the motion does not change,
/// such as place and heading.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel trim pendulum.eom --at upright.json
  hamel trim arm.eom --free tau --fix \"hand.p[1] = 0.5\" -o held.json
  hamel trim aircraft.eom --steady --free elevator,throttle --fix \"norm(v) = 50\" --fix \"w[3] = 0\"")]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// State at which the search starts, by coordinates or by joints; see `hamel eval --help`.
    #[arg(long, value_name = "STATE.json")]
    at: Option<PathBuf>,
    /// Find a steady motion: velocities are free, and remain constant.
    #[arg(long)]
    steady: bool,
    /// Inputs, and without --steady velocities, that are unknown: names or entries, separated by commas.
    #[arg(long, value_name = "NAMES")]
    free: Vec<String>,
    /// Demand an equation in coordinates, velocities, inputs, parameters, outputs; once for each. An input or a velocity
    /// alone on the left is free.
    #[arg(long, value_name = "EXPR = EXPR")]
    fix: Vec<String>,
    /// Give the rate of a velocity or of a state of first order a value instead of 0; once for each entry.
    #[arg(long, value_name = "NAME = VALUE", value_parser = assignment)]
    rate: Vec<(String, f64)>,
    /// Write the state, with all digits, for `--at` of any command.
    #[arg(short, long, value_name = "STATE.json")]
    out: Option<PathBuf>,
    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Largest acceleration that counts as a rounding error of zero.
const REST_TOLERANCE: f64 = 1e-8;
/// Numbers below this are printed as 0.
const ROUNDING: f64 = 1e-14;

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// Finds the trim, and prints and writes it.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (at, out) = (arguments.at.as_deref(), arguments.out.as_deref());
    apart([("-o", out)], [Some(arguments.file.as_path()), at])?;
    let source = source::open(&arguments.file, &arguments.robot)?.for_evaluation();
    let names = |text: &String| {
        let names = Piece { text, start: 0 }.split(',').into_iter();
        names.map(|name| name.text.to_string()).collect::<Vec<_>>()
    };
    let options = TrimOptions {
        steady: arguments.steady,
        free: arguments.free.iter().flat_map(names).collect(),
        fix: arguments.fix.clone(),
        rates: arguments.rate.clone(),
    };
    let generated = derive(&source, &options)?;
    let state = State::read(&source, &generated, at)?;
    let found = trim(&generated, &state, &options, source.shown())?;
    let state = Json::from(&found.state.to_json(&generated, &found.full));
    if let Some(out) = out {
        write(out, &state.pretty())?;
    }
    let from = match at {
        Some(path) => path.display().to_string(),
        None => "the start of the description".into(),
    };
    print(&match arguments.format {
        Format::Text => text(&found, &generated, arguments.steady, &from),
        Format::Json => json(found, state, &generated.model.name).pretty(),
    })
}

fn text(found: &Trim, generated: &Generated, steady: bool, from: &str) -> String {
    let near = if found.neighbour > 0 {
        "a neighbour of "
    } else {
        ""
    };
    let what = if steady {
        "steady motion"
    } else {
        "equilibrium"
    };
    let mut text = format!(
        "\x1b[1m{}\x1b[0m  {what} from {near}{from}, in {} steps; largest residual {}\n\n",
        generated.model.name,
        found.steps,
        error(found.residual)
    );
    let (full, active) = (&generated.model, &generated.active);
    let states = active
        .states
        .iter()
        .flat_map(names::group)
        .zip(&found.state.xi[active.n()..]);
    let coordinates = names::coordinates(full).into_iter().zip(&found.state.x);
    let velocities = names::velocities(full).into_iter().zip(&found.full);
    let inputs = active
        .inputs
        .iter()
        .flat_map(names::group)
        .zip(&found.state.u);
    let all = coordinates.chain(velocities).chain(states).chain(inputs);
    // Rounding errors of zero.
    let shown = |value: f64| short(if value.abs() < ROUNDING { 0.0 } else { value });
    let lines: Vec<Vec<String>> = all.map(|(name, value)| vec![name, shown(*value)]).collect();
    text.push_str(&aligned(&lines, "  "));
    text.push_str(&format!(
        "\n\x1b[1muniqueness\x1b[0m\n  {} unknowns, {} conditions of rank {}\n",
        found.unknowns, found.conditions, found.rank
    ));
    for direction in &found.undetermined {
        text.push_str(&format!("  undetermined: {direction}\n"));
    }
    let change = found
        .xi_dot
        .iter()
        .fold(0.0, |most: f64, rate| most.max(rate.abs()));
    if change > found.residual.max(REST_TOLERANCE) {
        text.push_str(&format!(
            "  velocities that are given, or that constraints determine, change here: max |xi_dot| = {}\n",
            short(change)
        ));
    }
    text.push_str("\n\x1b[1mstability\x1b[0m\n");
    let Some(Spectrum {
        values,
        size,
        stability,
    }) = &found.spectrum
    else {
        return text + "  eigenvalues were not found\n";
    };
    text.push_str(match stability {
        Stability::Asymptotic => "  stable: all deviations decay\n",
        Stability::Neutral => "  neutral: no deviation grows exponentially, but not all decay\n",
        Stability::Unstable => "  unstable: deviations grow\n",
    });
    let values: Vec<_> = values
        .iter()
        .map(|&(re, im)| Complex::new(re, im))
        .collect();
    text + &spectrum(&values, *size)
}

fn json(found: Trim, state: Json, system: &str) -> Json {
    let direction = |entries: &Vec<(String, f64)>| {
        let entries = entries.iter();
        Json::object(entries.map(|(name, part)| (name.as_str(), Json::Number(*part))))
    };
    let directions = found.undetermined.iter().map(|found| direction(&found.0));
    let spectrum = found.spectrum.as_ref();
    let verdict = spectrum.map_or(Json::Null, |found| Json::Text(found.stability.to_string()));
    let pair = |&(re, im): &(f64, f64)| Json::vector(&[re, im]);
    let values = spectrum.map_or(Json::Null, |found| {
        Json::List(found.values.iter().map(pair).collect())
    });
    Json::object([
        ("system", Json::Text(system.into())),
        ("state", state),
        ("xi_dot", Json::vector(&found.xi_dot)),
        ("residual", Json::Number(found.residual)),
        ("steps", Json::Count(found.steps as u128)),
        ("neighbour", Json::Count(found.neighbour as u128)),
        ("unknowns", Json::Count(found.unknowns as u128)),
        ("conditions", Json::Count(found.conditions as u128)),
        ("rank", Json::Count(found.rank as u128)),
        ("undetermined", Json::List(directions.collect())),
        ("stability", verdict),
        ("eigenvalues", values),
    ])
}
