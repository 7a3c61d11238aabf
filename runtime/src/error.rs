//! What can go wrong in a run.

use core::error::Error;
use core::fmt;

/// The mass matrix cannot be factored: a pivot is zero, negative or not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular {
    /// Index of the failing pivot, from 0: the velocity coordinate whose inertia, with those before
    /// it eliminated, is not positive.
    pub pivot: usize,
}

impl fmt::Display for Singular {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "mass matrix not positive definite at pivot {}",
            self.pivot
        )
    }
}

impl Error for Singular {}

/// Why a step was not taken. Times are those of the state from which the step started, which is the
/// last valid one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StepError {
    /// The mass matrix cannot be factored at one of the points that the step visits.
    Singular {
        /// Where the factorisation failed.
        cause: Singular,
        /// Time at the start of the step.
        time: f64,
    },
    /// The state, or the input, became infinite or NaN.
    NonFinite {
        /// Time at the start of the step.
        time: f64,
    },
    /// A list has another length than the blocks of the system or its zero lists say.
    Shape {
        /// Which list: `coordinates`, `velocities` or `chart`.
        part: &'static str,
        /// The length that the system asks for.
        expected: usize,
        /// The length of the list.
        found: usize,
    },
    /// The step is zero or not finite, or so small that the time would not advance.
    InvalidStep {
        /// The step asked for.
        step: f64,
        /// The time to be covered by such steps.
        span: f64,
    },
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Singular { cause, time } => write!(f, "{cause}, in the step from t = {time}"),
            Self::NonFinite { time } => {
                write!(f, "state not finite, in the step from t = {time}")
            }
            Self::Shape {
                part,
                expected,
                found,
            } => write!(f, "{part}: {expected} entries expected, {found} found"),
            Self::InvalidStep { step, span } => {
                write!(f, "a time of {span} cannot be covered by steps of {step}")
            }
        }
    }
}

impl Error for StepError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Singular { cause, .. } => Some(cause),
            _ => None,
        }
    }
}
