//! Claims that something is constant along the motion.

use super::value::Value;
use crate::algebra::graph::Edge;
use crate::algebra::linear::Vec3;
use crate::syntax::ast::Span;

/// A quantity that is claimed to be constant.
#[derive(Clone, Debug)]
pub enum Quantity {
    /// Total energy T + V (J).
    Energy,
    /// Linear momentum Σ m v of the bodies of a frame, or of the whole system (kg m/s), world axes.
    LinearMomentum {
        /// Index of the frame; `None` for the whole system.
        of: Option<usize>,
        /// Direction of the component, world axes; `None` for all three.
        along: Option<Vec3>,
    },
    /// Angular momentum Σ m (r − p) × v plus the spin of the bodies (kg m²/s), world axes.
    AngularMomentum {
        /// Index of the frame; `None` for the whole system.
        of: Option<usize>,
        /// Reference point p, world axes (m).
        about: Vec3,
        /// Direction of the component, world axes; `None` for all three.
        along: Option<Vec3>,
    },
    /// An expression of coordinates, velocities and parameters.
    Value(Value),
}

/// A claim that a quantity is constant along the motion.
#[derive(Clone, Debug)]
pub struct Invariant {
    /// Name of the function that monitors it.
    pub name: String,
    /// Where it was claimed.
    pub span: Span,
    /// The quantity that is constant.
    pub quantity: Quantity,
    /// Parameters and inputs that the claim sets: index of the symbol, and value.
    pub set: Vec<(usize, Edge)>,
    /// Conditions as written; empty if there are none.
    pub when: String,
}
