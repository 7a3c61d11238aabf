//! Reasons why a model has no regressor.

use std::fmt;

/// Reason why a model has no regressor, or why its base parameters could not be found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegressorError {
    /// The motion is prescribed or depends on the time.
    PrescribedMotion,
    /// Constraints act on the velocities.
    ConstrainedVelocities,
    /// Constraints tie the coordinates.
    ConstrainedCoordinates,
    /// The model has neither bodies nor particles.
    NoBodies,
    /// The inertia is not only that of bodies on frames and of armatures.
    OtherInertia,
    /// The columns of Y have no values modulo p at random states.
    NoValues,
    /// Some coefficients of the relations between parameters are not recognised as exact numbers or expressions.
    InexactRelations,
    /// Fault of the generator: the number of relations does not follow from the rank of Y.
    WrongRank,
    /// Fault of the generator: the relations have no solution for moments.
    UnsolvableRelations,
}

impl fmt::Display for RegressorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            RegressorError::PrescribedMotion => {
                "its motion is prescribed or depends on the time, but base parameters are those of a system that moves freely"
            }
            RegressorError::ConstrainedVelocities => {
                "constraints act on its velocities, so inverse dynamics does not determine their forces: use the tree without loops and constraints"
            }
            RegressorError::ConstrainedCoordinates => {
                "its coordinates are tied by constraints: describe it by joints"
            }
            RegressorError::NoBodies => "it has no bodies, so it has no inertial parameters",
            RegressorError::OtherInertia => {
                "its inertia is not only that of bodies on frames and of armatures: describe it by `body` statements, without `kinetic` and `particle`"
            }
            RegressorError::NoValues => "its expressions have no values modulo p at random states",
            RegressorError::InexactRelations => {
                "it has relations between parameters whose coefficients are neither simple fractions nor built from one or two entries of its poses: write lengths as numbers with few digits, or place frames on one another by joints"
            }
            RegressorError::WrongRank => {
                "internal check failed: its relations do not agree with the rank of the regressor"
            }
            RegressorError::UnsolvableRelations => {
                "internal check failed: its relations cannot be solved for moments"
            }
        })
    }
}

impl std::error::Error for RegressorError {}
