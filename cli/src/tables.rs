//! `hamel tables`: prints the symbols of the formalism.

use crate::failure::{Failure, print};
use crate::robot::RobotOptions;
use crate::source;
use clap::{Args, ValueEnum};
use hamel_codegen::tables::{self, Table, Tables};
use std::path::PathBuf;

/// Prints the tables of a description: φ, A, Y, γ, M, Γ, and quantities derived from them.
///
/// Entries are simplified modulo the constraint; entries of equal value share a row, and entries not shown are zero.
/// Indices count from 1, as in KR18.
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
    /// Tables to print, separated by commas.
    #[arg(long, value_name = "A,Y,…", value_delimiter = ',', value_parser = Table::parse)]
    of: Vec<Table>,
    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Print every entry on a separate row, including zeros.
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Output format of tables.
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

/// Derives and prints the tables.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let source = source::open(&arguments.file, &arguments.robot)?;
    let generated = source.derive_available(&[])?;
    let tables = generated
        .tables(&arguments.of)
        .map_err(|why| Failure::failed(format!("{}: {why}", source.path)))?;
    print(&written(&tables, arguments.format, arguments.all))
}

/// Returns the tables as a text.
pub fn written(tables: &Tables, format: Format, all: bool) -> String {
    match format {
        Format::Text => tables::text(tables, all),
        Format::Markdown => tables::markdown(tables, all),
        Format::Latex => tables::latex(tables, all),
        Format::Json => format!("{:#}\n", tables::json(tables, all)),
    }
}
