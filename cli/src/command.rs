//! The command line: its subcommands and their dispatch.

#[cfg(not(feature = "sweep"))]
use crate::absent as sweep;
use crate::failure::{self, Failure};
#[cfg(feature = "sweep")]
use crate::sweep;
use crate::{
    bode, check, compare, draw, emit, eval, import, linearize, lqr, ops, regressor, report,
    simulate, step, tables, trim,
};
use clap::{Parser, Subcommand};
use hamel_engine::CancellationToken;
use std::ffi::OsString;

const EXAMPLES: &str = "\
Examples:
  hamel check heavy_top.eom                     prove the identities behind the equations
  hamel tables heavy_top.eom --of gamma,M       the symbols of the equations
  hamel regressor arm.urdf                      the inertial parameters that matter
  hamel report heavy_top.eom -o top.html        the derivation as a document
  hamel linearize heavy_top.eom                 the linearisation, with eigenvalues
  hamel lqr furuta.eom --at upright.json        a regulator; `hamel step`, `hamel bode`: responses
  hamel trim heavy_top.eom                      an equilibrium, or a steady motion
  hamel simulate heavy_top.eom --until 10       a first run
  hamel draw heavy_top.eom --out top.svg        a picture of the mechanism
  hamel sweep heavy_top.eom --vary … --out runs  many runs with varied parameters and starts
  hamel compare heavy_top.eom --until 10        error of methods against their cost
  hamel emit heavy_top.eom -o heavy_top.rs      Rust source code
  hamel import arm.urdf -o arm.eom              a robot in URDF as a description

FILE is a description (.eom) or a robot (.urdf); `-` reads standard input.
Exit status: 0 done, 1 a description or a check failed, 2 wrong usage or unreadable files.";

/// Generates equations of motion in redundant coordinates and quasi-velocities.
#[derive(Parser)]
#[command(name = "hamel", version, about, after_help = EXAMPLES)]
struct Line {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Tables(tables::Arguments),
    Regressor(regressor::Arguments),
    Check(check::Arguments),
    Ops(ops::Arguments),
    Emit(emit::Arguments),
    Eval(eval::Arguments),
    Linearize(linearize::Arguments),
    Lqr(lqr::Arguments),
    Step(step::Arguments),
    Bode(bode::Arguments),
    Trim(trim::Arguments),
    Report(report::Arguments),
    Simulate(simulate::Arguments),
    Draw(draw::Arguments),
    Sweep(sweep::Arguments),
    Compare(compare::Arguments),
    Import(import::Arguments),
}

/// Returns the subcommands and options of the command line, from which its reference is generated.
pub fn described() -> clap::Command {
    <Line as clap::CommandFactory>::command()
}

/// Runs a command, whose words begin with the name of the program, prints its messages and returns the exit status.
pub fn command(words: impl IntoIterator<Item = OsString>) -> u8 {
    let line = match Line::try_parse_from(words) {
        Ok(line) => line,
        Err(said) => return failure::print_clap(&said),
    };
    line.command.run().map_or_else(Failure::report, |()| 0)
}

/// Runs a command for a program, to which errors are returned instead of being printed. A sweep can be cancelled by
/// `stop`.
///
/// # Errors
/// Errors in the words, or the failure of the command.
pub fn asked(
    words: impl IntoIterator<Item = OsString>,
    stop: Option<&CancellationToken>,
) -> Result<(), Failure> {
    let line = Line::try_parse_from(words);
    let line = line.map_err(|said| Failure::Usage(said.render().to_string()))?;
    match line.command {
        Command::Sweep(arguments) => sweep::run(&arguments, stop),
        other => other.run(),
    }
}

impl Command {
    fn run(&self) -> Result<(), Failure> {
        match self {
            Command::Tables(arguments) => tables::run(arguments),
            Command::Regressor(arguments) => regressor::run(arguments),
            Command::Check(arguments) => check::run(arguments),
            Command::Ops(arguments) => ops::run(arguments),
            Command::Emit(arguments) => emit::run(arguments),
            Command::Eval(arguments) => eval::run(arguments),
            Command::Linearize(arguments) => linearize::run(arguments),
            Command::Lqr(arguments) => lqr::run(arguments),
            Command::Step(arguments) => step::run(arguments),
            Command::Bode(arguments) => bode::run(arguments),
            Command::Trim(arguments) => trim::run(arguments),
            Command::Report(arguments) => report::run(arguments),
            Command::Simulate(arguments) => simulate::run(arguments),
            Command::Draw(arguments) => draw::run(arguments),
            Command::Sweep(arguments) => sweep::run(arguments, None),
            Command::Compare(arguments) => compare::run(arguments),
            Command::Import(arguments) => import::run(arguments),
        }
    }
}
