//! Times of functions, states and robots that the comparisons share.

#[cfg(feature = "describe")]
pub mod described;
pub mod input;
pub mod measure;
pub mod robots;
