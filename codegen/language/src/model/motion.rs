//! Motions of frames that expressions use.

use crate::algebra::linear::{Mat3, Vec3};

/// A motion that an expression uses, recorded so that it can be checked by an independent derivation.
#[derive(Clone, Debug)]
pub struct Observed {
    /// Quantity that the expression asks for.
    pub quantity: Quantity,
    /// Rotation of the frame relative to the other frame, or to the world.
    pub rotation: Mat3,
    /// Origin of the frame; for a rate, three expressions.
    pub position: Vec3,
    /// Position of the point in frame axes.
    pub point: Vec3,
    /// Value of the expression.
    pub value: Vec3,
}

/// A quantity of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Position of a point, r + R p.
    Position,
    /// Velocity of a point, ṙ + Ṙ p.
    Velocity,
    /// Acceleration of a point, r̈ + R̈ p.
    Acceleration,
    /// Angular velocity ω.
    AngularVelocity,
    /// Angular acceleration ω̇.
    AngularAcceleration,
    /// Time derivative d/dt of expressions.
    Rate,
}

impl Quantity {
    /// Returns the quantity that a function of the language computes.
    pub fn named(function: &str) -> Option<Self> {
        Some(match function {
            "position" => Quantity::Position,
            "velocity" => Quantity::Velocity,
            "acceleration" => Quantity::Acceleration,
            "angular_velocity" => Quantity::AngularVelocity,
            "angular_acceleration" => Quantity::AngularAcceleration,
            _ => return None,
        })
    }
}
