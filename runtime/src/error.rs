//! Errors of evaluating the equations of motion and of integration steps.

use core::error::Error;
use core::fmt;

/// Reason why ξ̇ cannot be computed: a pivot that has to be positive is zero, negative or not finite.
///
/// Rows and pivots are counted from 0.
///
/// ```
/// use hamel::Singular;
///
/// let error = Singular::Inertia { velocity: "w" };
/// assert_eq!(
///     error.to_string(),
///     "the mass matrix is not positive definite: the velocity `w` has no inertia"
/// );
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Singular {
    /// The mass matrix M is not positive definite: one velocity has no inertia left after some of the other velocities
    /// are eliminated (they move freely) and the remaining ones are held at zero.
    Inertia {
        /// The name of the velocity in the description, such as `q_dot` or `w[2]`.
        velocity: &'static str,
    },
    /// The mass matrix M, or an inertia that follows from the parameters, is not positive definite.
    Mass,
    /// The constraints B ξ = 0 that multipliers enforce are linearly dependent: S = B M⁻¹ Bᵀ is singular.
    Constraints {
        /// The row of B that depends on the others.
        row: usize,
    },
    /// The mechanism is at a kinematic singularity (a linkage is locked, a lever has no length): the definitions
    /// of the velocities and the constraints, [Y; Φ] of KR18 (5), do not determine ẋ.
    Kinematics {
        /// The pivot of [Y; Φ] that no longer has the sign that it had at the start.
        pivot: usize,
    },
}

impl Singular {
    /// Creates [`Inertia`](Self::Inertia); for generated code.
    #[doc(hidden)]
    pub const fn inertia(velocity: &'static str) -> Self {
        Self::Inertia { velocity }
    }

    /// Creates [`Mass`](Self::Mass); for generated code.
    #[doc(hidden)]
    pub const fn mass() -> Self {
        Self::Mass
    }

    /// Creates [`Constraints`](Self::Constraints); for generated code.
    #[doc(hidden)]
    pub const fn constraints(row: usize) -> Self {
        Self::Constraints { row }
    }

    /// Creates [`Kinematics`](Self::Kinematics); for generated code.
    #[doc(hidden)]
    pub const fn kinematics(pivot: usize) -> Self {
        Self::Kinematics { pivot }
    }
}

impl fmt::Display for Singular {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Inertia { velocity } => write!(
                f,
                "the mass matrix is not positive definite: the velocity `{velocity}` has no inertia"
            ),
            Self::Mass => f.write_str("the mass matrix is not positive definite"),
            Self::Constraints { row } => write!(
                f,
                "the constraints depend on one another: row {row} (from 0) follows from the others"
            ),
            Self::Kinematics { pivot } => write!(
                f,
                "the mechanism is at a kinematic singularity: pivot {pivot} (from 0) of [Y; Φ] has changed sign"
            ),
        }
    }
}

impl Error for Singular {}

/// Reason why a step could not be taken. All times are those of the state at the start of the step, which is the last
/// valid one.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// # hamel::rigid_eom! {
/// #     system Pendulum {
/// #         coord q;
/// #         velocity w;
/// #         rate q = w;
/// #         kinetic w^2 / 2;
/// #         potential -cos(q);
/// #         input tau;
/// #         generalized force w = tau;
/// #         start q = 1;
/// #     }
/// # }
///
/// use hamel::{Run, StepError, methods::Rkmk4};
///
/// let pendulum = Pendulum::<f64>::default();
/// let error = Run::new(&pendulum).method(Rkmk4).step(0.0).until(1.0);
/// assert!(matches!(error, Err(StepError::InvalidStep { span: 1.0, .. })));
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StepError {
    /// ξ̇ cannot be computed at one of the points that the step visits.
    Singular {
        /// The evaluation that failed.
        cause: Singular,
        /// Time at the start of the step.
        time: f64,
    },
    /// The state or an input became infinite or NaN.
    NonFinite {
        /// Time at the start of the step.
        time: f64,
    },
    /// A list does not have the length that the blocks of the system, or its zero vectors, require.
    Shape {
        /// Which list: `coordinates`, `velocities`, `chart`, or `coordinates and velocities` for both in one list.
        part: &'static str,
        /// The length that the system requires.
        expected: usize,
        /// The length of the list.
        found: usize,
    },
    /// The step is zero, not finite, or so small that time would not advance.
    InvalidStep {
        /// The step that was asked for.
        step: f64,
        /// The time that steps of this length should cover.
        span: f64,
    },
    /// An iteration did not converge: the step is too long for the method.
    NotConverged {
        /// Time at the start of the step.
        time: f64,
        /// The number of iterations.
        iterations: u32,
    },
    /// The tolerance asks for steps below the resolution of time: it is finer than rounding allows, or the solution has
    /// a singularity ahead.
    StepTooSmall {
        /// Time at the start of the step.
        time: f64,
        /// The step that was refused.
        step: f64,
    },
    /// A tolerance is unusable: finer than rounding, infinite or NaN.
    InvalidTolerance {
        /// The smallest tolerance allowed.
        least: f64,
    },
    /// The motion is stiff: stability, not accuracy, limits the steps of the explicit method, and more steps of this
    /// length remain than [`Adaptive::stiff`](crate::adaptive::Adaptive) allows.
    Stiff {
        /// Time at the start of the step.
        time: f64,
        /// The step length to which stability limits the method.
        step: f64,
        /// The rate ρ, an estimate of the spectral radius of the equations.
        rate: f64,
    },
    /// The method is for force-free motion, but forces may act on this system.
    Forces {
        /// Time at the start of the step.
        time: f64,
    },
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Singular { cause, time } => write!(f, "{cause}, in the step from t = {time}"),
            Self::NonFinite { time } => {
                write!(
                    f,
                    "the state is not finite, in the step from t = {time}: shorten the step, or check inputs and parameters"
                )
            }
            Self::Shape {
                part,
                expected,
                found,
            } => write!(f, "{part}: expected {expected} entries, found {found}"),
            Self::InvalidStep { step, span } => {
                // Numbers are formatted with `Debug`, which never writes long rows of zeros.
                write!(
                    f,
                    "a time of {span:?} cannot be covered by steps of {step:?}: a step has to be finite, have the sign of the time and be long enough to change it"
                )
            }
            Self::NotConverged { time, iterations } => write!(
                f,
                "no convergence in {iterations} iterations, in the step from t = {time}: \
                 shorten the step"
            ),
            Self::StepTooSmall { time, step } => write!(
                f,
                "the tolerance requires a step of {step:e} at t = {time}, which is too short to change \
                 the time: relax it; the motion may be singular here"
            ),
            Self::InvalidTolerance { least } => write!(
                f,
                "a tolerance has to be a number of at least {least:e}: rounding allows no less"
            ),
            Self::Stiff { time, step, rate } => write!(
                f,
                "the motion is stiff at t = {time}: a rate of {rate:.1e} per unit of time limits explicit \
                 steps to {step:.1e}; use an implicit method, or a stiff solver through `hamel::adapter`"
            ),
            Self::Forces { time } => write!(
                f,
                "forces may act, in the step from t = {time}: the closed form holds only for free motion"
            ),
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
