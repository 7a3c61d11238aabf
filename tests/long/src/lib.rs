//! Orders, long runs and times of the methods on hand-written systems.
//!
//! A million steps would take minutes without optimisation, so this crate is also optimised in the dev profile.

/// The systems that the runtime's tests use.
#[path = "../../../runtime/tests/suite/common/mod.rs"]
#[allow(missing_docs)]
pub mod common;
