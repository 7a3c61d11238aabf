//! `hamel tables`: the symbols of the formalism, as people read them.

use crate::failure::{Failure, print};
use crate::robot::RobotOptions;
use crate::source;
use clap::{Args, ValueEnum};
use hamel_codegen::tables::{self, Table, Tables};
use std::path::PathBuf;

/// Prints the tables of a description: φ, A, Y, γ, M, Γ, and what follows from them.
///
/// Entries are simplified modulo the constraint; entries of one value share a row, and those that are
/// not shown are zero. Indices count from 1, as in KR18.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel tables heavy_top.eom
  hamel tables heavy_top.eom --of gamma,M,accel
  hamel tables heavy_top.eom --format latex > tables.tex
  hamel tables heavy_top.eom --format json | jq .

Tables: phi, A, Y, gamma, M, Gamma (the default), Phi, Psi, accel, bias, potential_force,
generalized_force, states, outputs, geometry.")]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Which tables, a list with commas.
    #[arg(long, value_name = "A,Y,…", value_delimiter = ',', value_parser = Table::parse)]
    of: Vec<Table>,
    /// How to write them.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Every entry on a row of its own, zeros too.
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    robot: RobotOptions,
}

/// How tables are written.
#[derive(Clone, Copy, ValueEnum)]
pub enum Format {
    /// Aligned columns.
    Text,
    /// For documents and notebooks.
    Markdown,
    /// For papers.
    Latex,
    /// For programs.
    Json,
}

/// Derives and prints.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let source = source::open(&arguments.file, &arguments.robot)?;
    let generated = source.derive_available(&[])?;
    let tables = generated
        .tables(&arguments.of)
        .map_err(|why| Failure::failed(format!("{}: {why}", source.path)))?;
    print(&written(&tables, arguments.format, arguments.all))
}

/// Tables as a text.
pub fn written(tables: &Tables, format: Format, all: bool) -> String {
    match format {
        Format::Text => tables::text(tables, all),
        Format::Markdown => tables::markdown(tables, all),
        Format::Latex => tables::latex(tables, all),
        Format::Json => format!("{:#}\n", tables::json(tables, all)),
    }
}
