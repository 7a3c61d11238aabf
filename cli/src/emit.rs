//! `hamel emit`: the generated Rust.

use crate::failure::{Failure, print, update};
use crate::robot::RobotOptions;
use crate::source::Source;
use clap::Args;
use hamel_codegen::builder;
use std::path::PathBuf;

/// Writes the generated Rust.
///
/// The text is the same, byte for byte, as that of a build script.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel emit heavy_top.eom                          to the terminal
  hamel emit heavy_top.eom -o src/heavy_top.rs      to a file
  hamel emit heavy_top.eom -o src/heavy_top.rs --check    in CI: is the file up to date?")]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Where to write; default standard output.
    #[arg(short, long, value_name = "OUT")]
    out: Option<PathBuf>,
    /// Write nothing; status 1 where OUT is not what would be written.
    #[arg(long, requires = "out")]
    check: bool,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Emits, or compares.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let source = Source::open(&arguments.file, &arguments.robot)?;
    let name = arguments
        .file
        .file_name()
        .map_or_else(|| "-".into(), PathBuf::from);
    // A robot's description is written by `hamel import`, as its first lines say.
    let name = match source.robot {
        Some(_) => name.with_extension("eom"),
        None => name,
    };
    let name = name.to_string_lossy();
    let generated = source.derive()?;
    let code = builder::written(&generated, &name).map_err(|errors| source.refused(&errors))?;
    let Some(out) = &arguments.out else {
        return print(&code);
    };
    if !arguments.check {
        return update(out, &code);
    }
    match hamel_files::holds(out, &code) {
        Ok(true) => Ok(()),
        Ok(false) => Err(Failure::failed(format!(
            "{} is stale; write it again with `hamel emit {} -o {}`",
            out.display(),
            arguments.file.display(),
            out.display()
        ))),
        Err(error) => Err(Failure::usage(format!(
            "cannot read {}: {error}",
            out.display()
        ))),
    }
}
