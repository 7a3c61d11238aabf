//! The hard cases of rigid body motion, ready to run: a generated system, its start, its loads, and
//! the states at listed times, computed in 240-bit arithmetic by two unrelated methods.
//!
//! Each function of [`bodies`] and [`mechanisms`] is one case. Tests and the report of speed against
//! error run the same ones.

pub mod bodies;
/// Systems written by hand, which the tests of the runtime share.
#[path = "../../../runtime/tests/suite/common/mod.rs"]
#[allow(missing_docs)]
pub mod by_hand;
pub mod case;
pub mod mechanisms;
pub mod reference;

pub use case::{Case, Field, Measure};

/// Generated systems, and what the generator says of them.
pub mod models {
    include!(concat!(env!("OUT_DIR"), "/models.rs"));
}
