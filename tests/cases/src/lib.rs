//! The hard cases of rigid body motion: a generated system, its start, its loads, and reference states at listed times,
//! computed in 240-bit arithmetic by two independent methods.
//!
//! Each function of [`bodies`] and [`mechanisms`] is one case, used by tests and by the report of speed against error.

pub mod bodies;
/// Systems written by hand, which the tests of the runtime share.
#[path = "../../../runtime/tests/suite/common/mod.rs"]
#[allow(missing_docs)]
pub mod by_hand;
pub mod case;
pub mod mechanisms;
pub mod reference;

pub use case::{Case, Field, Measure};

/// Generated systems, and the generator's choices for them.
pub mod models {
    include!(concat!(env!("OUT_DIR"), "/models.rs"));
}
