//! `hamel`: equations of motion from a description, on the command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(hamel_cli::command(std::env::args_os()))
}
