//! Generated systems of `models/`, made by the build script, and code shared by the tests.

#![deny(warnings)]

pub mod chain;

pub use hamel_cases::reference;

include!(concat!(env!("OUT_DIR"), "/models.rs"));
