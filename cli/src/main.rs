//! `hamel`: equations of motion from a description, on the command line.
//!
//! | file | owns |
//! |---|---|
//! | `tables`, `regressor`, `check`, `ops`, `emit`, `eval`, `linearize`, `simulate`, `sweep`, `compare`, `import` | one subcommand each |
//! | `eigenvalues` | eigenvalues of a general matrix |
//! | `source` | reading and deriving a description |
//! | `robot` | robots in URDF as descriptions, and the options for them |
//! | `state` | reading the numbers of a state |
//! | `mechanism` | a described system that the integrators can run |
//! | `singular` | which velocity has no inertia where a run or an evaluation fails |
//! | `method` | the methods by their names, and which systems they are for |
//! | `json`, `names`, `columns` | how results are written; pictures and numbers are those of `hamel-report` |
//! | `progress` | what long work shows |
//! | `failure` | errors and exit statuses |

mod check;
mod columns;
mod compare;
mod constants;
mod eigenvalues;
mod emit;
mod eval;
mod failure;
mod import;
mod json;
mod linearize;
mod mechanism;
mod method;
mod names;
mod ops;
mod progress;
mod regressor;
mod robot;
mod simulate;
mod singular;
mod source;
mod state;
mod sweep;
mod tables;

use clap::{Parser, Subcommand};
use failure::Failure;
use hamel_report::number;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  hamel check heavy_top.eom                     prove the identities behind the equations
  hamel tables heavy_top.eom --of gamma,M       what stands in the paper
  hamel regressor arm.urdf                      which inertias forces depend on
  hamel linearize heavy_top.eom                 the linearisation, with eigenvalues
  hamel simulate heavy_top.eom --until 10       a first run
  hamel sweep heavy_top.eom --vary … --out runs  many runs, with parameters and starts that differ
  hamel compare heavy_top.eom --until 10        error of methods against what they cost
  hamel emit heavy_top.eom -o heavy_top.rs      Rust without interpretation
  hamel import arm.urdf -o arm.eom              a robot in URDF as a description

FILE may be a robot in URDF, and `-`: it is then read from standard input.
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
    Simulate(simulate::Arguments),
    Sweep(sweep::Arguments),
    Compare(compare::Arguments),
    Import(import::Arguments),
}

fn main() -> ExitCode {
    let line = match Line::try_parse() {
        Ok(line) => line,
        Err(said) => return failure::said(&said),
    };
    let result = match line.command {
        Command::Tables(arguments) => tables::run(&arguments),
        Command::Regressor(arguments) => regressor::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Ops(arguments) => ops::run(&arguments),
        Command::Emit(arguments) => emit::run(&arguments),
        Command::Eval(arguments) => eval::run(&arguments),
        Command::Linearize(arguments) => linearize::run(&arguments),
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Sweep(arguments) => sweep::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Import(arguments) => import::run(&arguments),
    };
    result.map_or_else(Failure::report, |()| ExitCode::SUCCESS)
}
