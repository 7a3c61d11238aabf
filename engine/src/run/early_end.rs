//! Reasons for which runs end early.

use super::energy_balance::EnergyBalance;
use super::plan::SteppingPlan;
use crate::error::Error;
use crate::mechanism::{Instance, SingularState};
use hamel::{State, StepError};
use hamel_files::number::short;
use std::fmt;

/// Reason for which a run ended early.
#[derive(Clone, Debug)]
pub enum EarlyEnd {
    /// The energy has changed by more than loads account for: the run does not follow the motion any more.
    Lost {
        /// The last time.
        time: f64,
        /// The change of the energy.
        change: f64,
        /// Permitted error per step, if steps are chosen by it.
        tolerance: Option<f64>,
        /// The length of equal steps.
        step: f64,
    },
    /// The motion is too stiff for explicit steps.
    Stiff {
        /// The last time.
        time: f64,
        /// The rate that keeps steps short.
        rate: f64,
        /// The length of the steps.
        step: f64,
        /// Number of such steps to the end.
        ahead: f64,
    },
    /// The motion has no value.
    Singular {
        /// The last time.
        time: f64,
        /// The reason.
        state: SingularState,
    },
    /// The next state is not finite.
    NotFinite {
        /// The last time.
        time: f64,
        /// The length of a step.
        step: f64,
    },
    /// An event that is watched has no value.
    Undefined {
        /// The last time.
        time: f64,
        /// The name of the event.
        event: String,
    },
    /// Anything else.
    Other(StepError),
}

impl EarlyEnd {
    /// Names the reason in a word or two.
    pub fn kind(&self) -> &'static str {
        match self {
            EarlyEnd::Lost { .. } => "lost",
            EarlyEnd::Stiff { .. } => "stiff",
            EarlyEnd::Singular { .. } => "singular",
            EarlyEnd::NotFinite { .. } => "not finite",
            EarlyEnd::Undefined { .. } => "undefined",
            EarlyEnd::Other(_) => "other",
        }
    }

    /// Explains the outcome of a run that reached `state`; `None` if it reached its end and followed the motion.
    ///
    /// # Errors
    /// The plan is invalid.
    pub fn explain(
        system: &Instance,
        plan: &SteppingPlan,
        outcome: Result<(), StepError>,
        state: &State<Instance>,
        balance: EnergyBalance,
    ) -> Result<Option<Self>, Error> {
        let early = match outcome {
            Ok(()) => {
                if !plan.monitors_energy(system) {
                    return Ok(None);
                }
                let Some(change) = balance.after(system, state).lost(plan.tolerance) else {
                    return Ok(None);
                };
                EarlyEnd::Lost {
                    time: state.t,
                    change,
                    tolerance: plan.tolerance,
                    step: plan.step,
                }
            }
            Err(
                error @ (StepError::InvalidStep { .. }
                | StepError::Shape { .. }
                | StepError::InvalidTolerance { .. }),
            ) => return Err(Error::Step(error)),
            Err(StepError::Stiff { time, step, rate }) => EarlyEnd::Stiff {
                time,
                rate,
                step,
                ahead: ((plan.until - time) / step).ceil(),
            },
            Err(StepError::Singular { time, cause }) => EarlyEnd::Singular {
                time,
                state: system.singular_message(cause),
            },
            Err(StepError::NonFinite { time }) => EarlyEnd::NotFinite {
                time,
                step: plan.step,
            },
            Err(error) => EarlyEnd::Other(error),
        };
        Ok(Some(early))
    }
}

impl fmt::Display for EarlyEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EarlyEnd::Lost {
                time,
                change,
                tolerance,
                step,
            } => {
                let at = if tolerance.is_some() { "at" } else { "by" };
                write!(
                    f,
                    "the run has lost the motion {at} t = {}: its energy has changed by {}, which no load accounts for; there may be a singularity on the way: ",
                    short(*time),
                    short(*change)
                )?;
                match tolerance {
                    Some(tolerance) => write!(f, "try a smaller --tol than {}", short(*tolerance)),
                    None => write!(
                        f,
                        "try a smaller --step than {}, or steps chosen by their error, `--method rkmk8 --tol 1e-9`",
                        short(*step)
                    ),
                }
            }
            EarlyEnd::Stiff {
                time,
                rate,
                step,
                ahead,
            } => write!(
                f,
                "the run ends at t = {}: the motion is stiff, a rate of {} per unit of time limits explicit steps to {}, with {} of them remaining; try `--method backward-euler` with a --step of your choice, or a stiff solver through `hamel::adapter`",
                short(*time),
                short(*rate),
                short(*step),
                short(*ahead)
            ),
            EarlyEnd::Singular { time, state } => {
                write!(f, "the run ends at t = {}: {state}", short(*time))
            }
            EarlyEnd::NotFinite { time, step } => write!(
                f,
                "the run ends at t = {}: the next state is not finite; try a shorter step than {}",
                short(*time),
                short(*step)
            ),
            EarlyEnd::Undefined { time, event } => write!(
                f,
                "the run ends at t = {}: the event `{event}` has no value there",
                short(*time)
            ),
            EarlyEnd::Other(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for EarlyEnd {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            EarlyEnd::Singular { state, .. } => Some(state),
            EarlyEnd::Other(error) => Some(error),
            _ => None,
        }
    }
}
