//! Motions of frames that expressions asked for.

use crate::algebra::linear::{Mat3, Vec3};

/// A motion that an expression asked for, to be derived once more on another route.
#[derive(Clone, Debug)]
pub struct Observed {
    /// The function.
    pub quantity: Quantity,
    /// Rotation of the frame as seen from the other, or from the world.
    pub rotation: Mat3,
    /// Its origin; of a rate, three expressions.
    pub position: Vec3,
    /// The point, in the frame's axes.
    pub point: Vec3,
    /// What the expression stands for.
    pub value: Vec3,
}

/// What is asked about a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// r + R p.
    Position,
    /// ṙ + Ṙ p.
    Velocity,
    /// r̈ + R̈ p.
    Acceleration,
    /// ω.
    AngularVelocity,
    /// ω̇.
    AngularAcceleration,
    /// d/dt of expressions.
    Rate,
}

impl Quantity {
    /// The one that a function of the language is about.
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

    /// Whether it is about turning.
    pub fn is_angular(self) -> bool {
        matches!(
            self,
            Quantity::AngularVelocity | Quantity::AngularAcceleration
        )
    }
}
