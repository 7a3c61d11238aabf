//! Messages about features that this build was made without, with what to install.

// With sweeps, their replacement is unused.
#![cfg_attr(feature = "sweep", allow(dead_code))]

use crate::failure::{Failure, warn};
use clap::Args;
use hamel_engine::CancellationToken;
use std::ffi::OsString;

const SWEEP: &str =
    "this `hamel` was built without sweeps, whose tables take long to compile; to have them, run
  cargo install --locked --path cli --all-features        in a clone of the repository
  cargo run --release --all-features -- sweep …           in a clone, without installing anything
  cargo install --locked hamel-cli --all-features         anywhere
or use the Python package, which has them: `hamel.sweep`, and the command `hamel` that it installs";

const MACHINE: &str = "note: this `hamel` was built without machine code and interprets functions, which takes tens of times as long;
`cargo install --locked --path cli --all-features` installs one with machine code
";

/// Number of evaluations from which a run is long enough that machine code is worth a note: some seconds for a robot.
const MIN_NOTED_EVALUATIONS: u64 = 1_000_000;

/// Runs a system many times, with parameters, starts and inputs that differ from run to run; needs the feature `sweep`.
#[derive(Args)]
#[command(disable_help_flag = true)]
pub struct Arguments {
    /// All words of the request, which are not read.
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<OsString>,
}

/// Fails with the commands that install sweeps.
pub fn run(_: &Arguments, _: Option<&CancellationToken>) -> Result<(), Failure> {
    Err(Failure::usage(SWEEP))
}

/// Notes that functions are interpreted, if they are and a run had many evaluations.
pub fn warn_of_interpretation(evaluations: u64) {
    if cfg!(not(feature = "machine")) && evaluations >= MIN_NOTED_EVALUATIONS {
        warn(MACHINE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: Arguments,
    }

    /// Every request is answered by the remedy, not by an error of the parser.
    #[test]
    fn every_sweep_is_answered_by_the_remedy() {
        for words in [
            "sweep",
            "sweep --help",
            "sweep --status runs",
            "sweep top.eom --vary m=grid(1,2,3) --out runs",
        ] {
            let line = Line::try_parse_from(words.split(' ')).expect("any words are accepted");
            let failure = run(&line.arguments, None).expect_err("there are no sweeps");
            let shown = failure.render(false);
            assert!(
                shown.starts_with("error: this `hamel` was built without sweeps"),
                "{shown}"
            );
            assert!(
                shown.contains("cargo install --locked --path cli --all-features"),
                "{shown}"
            );
        }
    }
}
