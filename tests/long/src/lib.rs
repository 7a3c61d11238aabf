//! Orders, long runs and times of the methods on systems written by hand.
//!
//! A million steps unoptimised would take minutes; this crate is optimised in the dev profile as well.

/// The systems of the runtime's own tests.
#[path = "../../../runtime/tests/suite/common/mod.rs"]
#[allow(missing_docs)]
pub mod common;
