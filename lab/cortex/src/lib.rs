//! A predictive controller for a drone on a microcontroller: iterative linear-quadratic regulators over twenty steps,
//! with generated code, `hamel::step_slopes_into` and arrays of fixed sizes.
//!
//! `run.sh` performs the whole test: it writes the model with `hamel emit`, builds the controller for a Cortex-M4F and
//! a Cortex-M7, checks that the programs lack certain symbols, runs them in QEMU, and compares their numbers by
//! `bin/report.rs` with those of the same controller on this machine.

#![no_std]
#![deny(unsafe_code)]
#![deny(missing_docs)]

#[cfg(feature = "board")]
pub mod board;
pub mod control;
mod matrix;
/// The output of `hamel emit` for `drone.eom`. The macro `rigid_eom!` generates the same bodies, but needs a compiler
/// for the machine that builds.
pub mod model {
    include!("../target/drone.rs");
}
