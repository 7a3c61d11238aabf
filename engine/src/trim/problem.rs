//! Options of a trim, and the reasons for which it fails.

use hamel_codegen::syntax::suggest::closest;
use hamel_files::number::short;
use std::fmt;

/// Largest number of conditions that a message names.
const MAX_NAMED: usize = 6;

/// Options of a trim. By default it finds an equilibrium with the inputs of the start.
#[derive(Clone, Debug, Default)]
pub struct TrimOptions {
    /// Whether velocities are free, and a steady motion is asked for.
    pub steady: bool,
    /// Names of inputs, and of velocities, that may change, whole or single entries.
    pub free: Vec<String>,
    /// Equations `EXPR = EXPR` that have to hold.
    pub fix: Vec<String>,
    /// Entries of ξ and z, each with the value of its rate instead of 0.
    pub rates: Vec<(String, f64)>,
}

/// Condition that is not met.
#[derive(Clone, Debug, PartialEq)]
pub struct Unmet {
    /// Quantity that has to vanish.
    pub condition: String,
    /// Its residual.
    pub residual: f64,
}

/// Reason why there is no trim.
#[derive(Clone, Debug, PartialEq)]
pub enum TrimProblem {
    /// A name is not one of those that an option takes.
    UnknownName {
        /// The option.
        option: &'static str,
        /// The name.
        name: String,
        /// The names that there are.
        known: Vec<String>,
    },
    /// Steady motion is asked of a system that depends on time, which has this name.
    TimeDependent(String),
    /// The start has no accelerations, or its loops cannot be closed.
    NoStart,
    /// The residuals have a least-squares minimum that is not 0.
    NoSolution {
        /// Number of steps.
        steps: usize,
        /// Conditions with the largest residuals.
        unmet: Vec<Unmet>,
    },
    /// The residuals still decreased when the number of steps was reached.
    OutOfSteps {
        /// Number of steps.
        steps: usize,
        /// Conditions with the largest residuals.
        unmet: Vec<Unmet>,
    },
    /// Steps lead to states where something has no value.
    LeavesDomain {
        /// Number of steps before that.
        steps: usize,
    },
    /// The conditions are met, but their rank drops at the solution, so that it is not determined in a direction along
    /// which they are not met, as at a bifurcation.
    Singular {
        /// The entries of that direction.
        direction: String,
        /// Largest residual.
        residual: f64,
    },
    /// The search ends at a singular configuration of loops, where slopes are not finite.
    SingularConfiguration {
        /// Largest residual.
        residual: f64,
    },
    /// Conditions hold at the instant, but not along the motion.
    NotSteady(Unmet),
}

impl TrimProblem {
    /// Creates the error for an unknown name.
    pub fn unknown<'a>(
        option: &'static str,
        name: &str,
        groups: impl Iterator<Item = &'a str>,
        entries: &[String],
    ) -> Self {
        let mut known: Vec<String> = groups.map(String::from).collect();
        let more = entries.iter().filter(|entry| !known.contains(entry));
        let more: Vec<String> = more.cloned().collect();
        known.extend(more);
        TrimProblem::UnknownName {
            option,
            name: name.into(),
            known,
        }
    }

    /// Returns whether the request is wrong.
    pub fn is_misuse(&self) -> bool {
        use TrimProblem::{TimeDependent, UnknownName};
        matches!(self, UnknownName { .. } | TimeDependent(_))
    }
}

impl fmt::Display for TrimProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |unmet: &[Unmet]| -> String {
            let all = unmet.iter().take(MAX_NAMED).map(ToString::to_string);
            all.collect::<Vec<_>>().join(", ")
        };
        match self {
            TrimProblem::UnknownName { option, name, known } => {
                write!(f, "{option}: `{name}` is unknown")?;
                match closest(name, known.iter().map(String::as_str)) {
                    Some(close) => write!(f, "; did you mean `{close}`?"),
                    None if known.is_empty() => f.write_str("; the description has none"),
                    None => write!(f, "; there are {}", known.join(", ")),
                }
            }
            TrimProblem::TimeDependent(time) => write!(
                f,
                "--steady: the system depends on the time `{time}`, so that no state stays steady; without --steady \
                 the accelerations vanish at this time"
            ),
            TrimProblem::NoStart => f.write_str(
                "no search can begin at this state: accelerations or conditions have no value there; \
                 choose another one by --at",
            ),
            TrimProblem::NoSolution { steps, unmet } => write!(
                f,
                "no solution near this start: after {steps} steps no small change reduces what is left, {}; \
                 free more unknowns by --free or --steady, or start elsewhere by --at",
                list(unmet)
            ),
            TrimProblem::OutOfSteps { steps, unmet } => write!(
                f,
                "no solution found in {steps} steps, which leave {}; a solution may be far away or at infinity",
                list(unmet)
            ),
            TrimProblem::LeavesDomain { steps } => write!(
                f,
                "after {steps} steps the search leaves the states at which accelerations and conditions have values; \
                 start elsewhere by --at"
            ),
            TrimProblem::Singular { direction, residual } => write!(
                f,
                "the conditions are met to {residual:.0e}, but they are singular there: along {direction} they \
                 change to higher order only, as at a bifurcation, so that the solution is not determined to \
                 full precision; change a parameter, or --fix this direction"
            ),
            TrimProblem::SingularConfiguration { residual } => write!(
                f,
                "the search ends near a singular configuration, where the slopes of accelerations are not finite, with \
                 a residual of {residual:.0e}; start elsewhere by --at"
            ),
            TrimProblem::NotSteady(unmet) => write!(
                f,
                "the conditions hold at an instant, but not along the motion, where they leave {unmet}; \
                 start elsewhere by --at"
            ),
        }
    }
}

impl fmt::Display for Unmet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.condition, short(self.residual))
    }
}

impl std::error::Error for TrimProblem {}
