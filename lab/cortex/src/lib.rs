//! A predictive controller for a drone on a microcontroller: iterated linear-quadratic regulators over twenty steps, by
//! generated code, `hamel::step_slopes_into` and arrays of fixed sizes.
//!
//! `run.sh` has the whole of it: it writes the model with `hamel emit`, builds the controller for a Cortex-M4F and a
//! Cortex-M7, looks for what must not be in the programs, runs them in QEMU and compares their numbers with those of
//! the same controller here, which `bin/report.rs` does.

#![no_std]
#![deny(unsafe_code)]
#![deny(missing_docs)]

#[cfg(feature = "board")]
pub mod board;
pub mod control;
mod matrix;
/// What `hamel emit` writes for `drone.eom`: the macro `rigid_eom!` makes the same bodies, and needs a compiler for
/// itself on the machine that builds.
pub mod model {
    include!("../target/drone.rs");
}
