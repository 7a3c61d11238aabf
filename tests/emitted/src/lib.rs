//! Random descriptions, compiled: each with a function that evaluates all generated functions.
#![allow(
    clippy::self_named_constructors,
    reason = "one of the types is called `new`"
)]

use hamel::wide::{f32x8, f64x4};
use hamel::{Lanes, Scalar, Singular};

/// The value of an entry in a lane, by the index of the lane, the argument (x, ξ, ξ̇, p, u) and the entry.
pub type At<'a> = dyn Fn(usize, usize, usize) -> f64 + 'a;

/// The results of all functions by name; a function that fails has no value in any lane.
pub type Values<L> = Result<Vec<(&'static str, Option<Vec<L>>)>, Singular>;

/// A description with its generated functions.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// The description.
    pub text: &'static str,
    /// Evaluates all functions in double precision.
    pub double: fn(&At) -> Values<f64>,
    /// Evaluates all functions in single precision.
    pub single: fn(&At) -> Values<f32>,
    /// Evaluates all functions in lanes of double precision.
    pub doubles: fn(&At) -> Values<f64x4>,
    /// Evaluates all functions in lanes of single precision.
    pub singles: fn(&At) -> Values<f32x8>,
}

/// Collects an argument, with a state in each lane.
fn gather<const N: usize, L: Lanes>(at: &At, argument: usize) -> [L; N] {
    std::array::from_fn(|entry| {
        L::from_lanes(|lane| L::Element::from_f64(at(lane, argument, entry)))
    })
}

include!(concat!(env!("OUT_DIR"), "/cases.rs"));
