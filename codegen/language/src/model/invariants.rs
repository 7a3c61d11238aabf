//! Claims that something is constant along the motion.

use super::value::Value;
use crate::algebra::graph::Edge;
use crate::algebra::linear::Vec3;
use crate::syntax::ast::Span;

/// What is claimed to be constant.
#[derive(Clone, Debug)]
pub enum Quantity {
    /// T + V (J).
    Energy,
    /// Σ m v over the bodies of a frame, or over everything (kg m/s), world axes.
    LinearMomentum {
        /// Index of the frame.
        of: Option<usize>,
        /// Direction, world axes.
        along: Option<Vec3>,
    },
    /// Σ m (r − p) × v and the bodies' spin (kg m²/s), world axes.
    AngularMomentum {
        /// Index of the frame.
        of: Option<usize>,
        /// The point p, world axes (m).
        about: Vec3,
        /// Direction, world axes.
        along: Option<Vec3>,
    },
    /// An expression of coordinates, velocities and parameters.
    Value(Value),
}

/// A claim that a quantity is constant along the motion.
#[derive(Clone, Debug)]
pub struct Invariant {
    /// Name of the function that watches it.
    pub name: String,
    /// Where it was claimed.
    pub span: Span,
    /// What is constant.
    pub quantity: Quantity,
    /// Symbols of parameters and inputs that the claim sets, and their values.
    pub set: Vec<(usize, Edge)>,
    /// The conditions as written; empty where there are none.
    pub when: String,
}
