//! Times of functions, states and robots that the comparisons share.

#[cfg(feature = "describe")]
pub mod described;
pub mod input;
pub mod measure;
#[cfg(feature = "describe")]
pub mod pinocchio;
pub mod robots;
#[cfg(feature = "describe")]
pub mod undamped;
