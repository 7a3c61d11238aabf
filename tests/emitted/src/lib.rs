//! Random descriptions, compiled: each with a function that evaluates all that was generated.
#![allow(
    clippy::self_named_constructors,
    reason = "one of the types is called `new`"
)]

use hamel::wide::{f32x8, f64x4};
use hamel::{Lanes, Scalar, Singular};

/// The value of an entry of an argument in a lane, by the numbers of the lane, the argument (x, ξ, ξ̇, p, u)
/// and the entry.
pub type At<'a> = dyn Fn(usize, usize, usize) -> f64 + 'a;

/// The functions of a system by their names in the description; one that has no value has none in any lane.
pub type Values<L> = Result<Vec<(&'static str, Option<Vec<L>>)>, Singular>;

/// A description and what was generated for it.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// The description.
    pub text: &'static str,
    /// All functions on one number.
    pub double: fn(&At) -> Values<f64>,
    /// All functions on one number of half the size.
    pub single: fn(&At) -> Values<f32>,
    /// All functions on lanes.
    pub doubles: fn(&At) -> Values<f64x4>,
    /// All functions on lanes of half the size.
    pub singles: fn(&At) -> Values<f32x8>,
}

/// An argument, a state in each lane.
fn gather<const N: usize, L: Lanes>(at: &At, argument: usize) -> [L; N] {
    std::array::from_fn(|entry| {
        L::from_lanes(|lane| L::Element::from_f64(at(lane, argument, entry)))
    })
}

include!(concat!(env!("OUT_DIR"), "/cases.rs"));
