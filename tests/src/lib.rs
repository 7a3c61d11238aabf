//! Generated systems of `models/`, by the build script, and what the tests share.

#![deny(warnings)]

pub mod chain;

pub use hamel_cases::reference;

include!(concat!(env!("OUT_DIR"), "/models.rs"));
