//! `hamel regressor`: finds the base parameters, the combinations of inertial parameters on which forces depend, and
//! bodies with identified ones.

mod bodies;
mod identified;

use crate::failure::{Failure, print};
use crate::robot::RobotOptions;
use crate::source;
use crate::tables::Format;
use clap::Args;
use hamel_codegen::tables::regressor::{json, latex, markdown, text};
use hamel_engine::session::base_parameters;
use std::path::PathBuf;

/// Prints the base parameters: the inertial parameters, or combinations of them, that forces can identify.
///
/// Inverse dynamics is linear in m, h = m s and Theta (about the frame's origin) of every link, and in armatures,
/// damping and stiffness of joints: F = Y(x, xi, xi_dot) beta. A link comprises all parts that move rigidly together,
/// in the frame that its joint carries. The factors are exact: fractions, or expressions in run-time parameters.
///
/// --identified does the reverse: among all masses, centres of mass and inertias that have the base parameters of a
/// file and that rigid bodies can have (with positive definite pseudo-inertias), it prints those nearest to the
/// description.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel regressor arm.eom
  hamel regressor robot.urdf --floating
  hamel regressor arm.eom --format json | jq '.base[].kept'
  hamel regressor arm.eom --format latex > base.tex
  hamel regressor arm.eom --identified beta.json          masses and inertias from measured ones")]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Identified base parameters, as JSON (`-` for standard input): a list, or an object by the names of the base
    /// parameters; those missing from the object are as in the description.
    #[arg(long, value_name = "FILE")]
    identified: Option<PathBuf>,
    /// Output format of the parameters.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Derives and prints the parameters.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let source = source::open(&arguments.file, &arguments.robot)?;
    let all = base_parameters(&source)?;
    if let Some(file) = &arguments.identified {
        return identified::print_bodies(&all, &source, file, arguments.format);
    }
    print(&match arguments.format {
        Format::Text => text(&all),
        Format::Markdown => markdown(&all),
        Format::Latex => latex(&all),
        Format::Json => format!("{:#}\n", json(&all)),
    })
}
