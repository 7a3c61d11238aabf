//! Choice of the integration method for a system, with the reason in one sentence.

use hamel_program::structure::{Inertia, Reason, RotorForm, Structure, Symmetry};
use std::fmt;

/// Number of steps above which a run is long: errors that grow with time then matter more than the
/// cost of a step.
pub const LONG_RUN_STEPS: u64 = 100_000;

/// Numerical method that is proposed for a system, with the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MethodChoice {
    /// Name of the method on the command line.
    pub method: &'static str,
    /// Reason for the choice.
    pub reason: &'static str,
}

impl fmt::Display for MethodChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.method, self.reason)
    }
}

/// Chooses the numerical method that fits the structure of a system, for a run of `steps` steps, if their number is
/// known.
///
/// The criterion is the measured cost at an error of 1e-9: eleven kicks of order 6 beat six of
/// order 4, and elliptic functions in every drift cost more than the twelve stages of order 8 where
/// torques have to be followed.
pub fn choose_method(structure: &Structure, steps: Option<u64>) -> MethodChoice {
    let long = steps.is_some_and(|steps| steps > LONG_RUN_STEPS);
    let (method, reason) = match &structure.split {
        Ok(splitting) if splitting.free => {
            ("free", "no force acts, so the motion has a closed form")
        }
        Ok(splitting) => {
            let symmetric = |rotor: &RotorForm| {
                matches!(
                    rotor.inertia,
                    Inertia::Principal(Symmetry::Spherical | Symmetry::Axial(_))
                )
            };
            let rotors = &splitting.rotors;
            if rotors.is_empty() {
                (
                    "splitting6",
                    "forces do not depend on velocities and the free motion is uniform",
                )
            } else if rotors.iter().all(symmetric) {
                (
                    "splitting6",
                    "forces do not depend on velocities and the free motion of a symmetric rotor is two turns",
                )
            } else if !long
                && rotors
                    .iter()
                    .any(|rotor| !symmetric(rotor) && rotor.steered)
            {
                (
                    "rkmk8",
                    "the torque on a rotor without symmetry changes with its attitude: its free motion in closed form costs more than following the torque",
                )
            } else {
                (
                    "splitting6",
                    "forces do not depend on velocities and the free motion has a closed form",
                )
            }
        }
        Err(_) if !structure.damped.is_empty() => (
            "rkmk54",
            "forces depend on velocities, so the step should adapt as the motion dies out",
        ),
        Err(_) if structure.multipliers => (
            "rkmk8",
            "multipliers enforce constraints, from which a method of high order drifts least between projections",
        ),
        Err(_) if structure.canonical == Err(Reason::States) => (
            "rkmk54",
            "states of first order add time scales, to which the step should adapt",
        ),
        Err(_) if structure.canonical == Err(Reason::Time) => (
            "rkmk8",
            "the equations depend on the time, so momenta and energy are not conserved",
        ),
        Err(_) if structure.canonical.is_err() => (
            "rkmk8",
            "velocities are constrained, so there are no momenta to kick or to conserve",
        ),
        Err(_) if structure.conservative && long => (
            "gauss6",
            "free motion has no closed form and the run is long: energy must not drift",
        ),
        Err(reasons) => (
            "rkmk8",
            match reasons.first() {
                Some(Reason::Coupled { .. }) => {
                    "rotors exchange momentum with other coordinates without any force, so free motion has no closed form"
                }
                Some(Reason::Tied { .. }) => {
                    "coordinates are tied to one another, so free motion has no closed form"
                }
                _ => "inertia depends on the configuration, so free motion has no closed form",
            },
        ),
    };
    MethodChoice { method, reason }
}
