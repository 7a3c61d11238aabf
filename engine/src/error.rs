//! Errors of the engine as data, which front ends render.

use crate::linear::LinearError;
use crate::mechanism::SingularState;
use crate::run::{InputProblem, SamplingProblem, SteppingProblem};
use crate::source::{ConstantProblem, UnknownLink};
use crate::state::StateProblem;
use crate::trim::TrimProblem;
use hamel::StepError;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::render::render;
use hamel_codegen::tables::TableError;
use hamel_codegen::urdf::{self, Undecoded};
use std::fmt;

/// Error of reading, deriving or running a description.
///
/// [`Display`](fmt::Display) gives the message in plain text, with underlined sources where there are any.
#[derive(Debug)]
pub enum Error {
    /// A file, or standard input, cannot be read.
    Read {
        /// Its path.
        path: String,
        /// The reason.
        source: std::io::Error,
    },
    /// The bytes of a file are not text.
    Decode {
        /// Its path.
        path: String,
        /// The reason.
        source: Undecoded,
    },
    /// Standard input was given both for the description and for something else.
    StandardInputTwice(&'static str),
    /// A description has errors.
    Description {
        /// Its path.
        path: String,
        /// Text of the file.
        text: String,
        /// The errors, with their places in the text.
        diagnostics: Vec<Diagnostic>,
    },
    /// The description made from a robot has errors.
    Robot {
        /// The path of the robot's file.
        path: String,
        /// The text of that file.
        urdf: String,
        /// The errors, with their places in the text of the file.
        diagnostics: Vec<Diagnostic>,
    },
    /// A robot in URDF has errors.
    Import {
        /// The path of its file.
        path: String,
        /// The text of that file.
        urdf: String,
        /// The errors, with their places in the text.
        problems: Vec<urdf::Problem>,
    },
    /// The text of an option has errors.
    Argument {
        /// Name of the option, as `--keep`.
        option: String,
        /// Text of the file.
        text: String,
        /// The errors, with their places in the text.
        diagnostics: Vec<Diagnostic>,
    },
    /// A constant was given for a robot.
    ConstantOfRobot {
        /// The path of the robot's file.
        path: String,
    },
    /// A constant of a description cannot have a value.
    Constant {
        /// Name.
        name: String,
        /// The value.
        value: String,
        /// The reason.
        problem: ConstantProblem,
    },
    /// Options for robots were given for a description.
    RobotOptions {
        /// The path of the description.
        path: String,
    },
    /// A robot lacks links that were asked for.
    Links {
        /// The path of the robot's file.
        path: String,
        /// The links.
        unknown: Vec<UnknownLink>,
    },
    /// A state does not fit the description.
    State {
        /// Path of its file, or another name for messages.
        path: String,
        /// All errors in it.
        problems: Vec<StateProblem>,
    },
    /// The inputs of a run have an error.
    Input(InputProblem),
    /// No method has this name.
    UnknownMethod {
        /// Name.
        name: String,
    },
    /// A method does not fit the structure of the system.
    Method {
        /// Name.
        name: String,
        /// The unmet requirements.
        obstacles: Vec<String>,
    },
    /// Length, step and tolerance of a run are invalid, or contradict one another.
    Stepping(SteppingProblem),
    /// Times of samples are wrong.
    Sampling(SamplingProblem),
    /// A step cannot be taken.
    Step(StepError),
    /// A step leads to, or starts from, a state where the motion has no value.
    SingularStep {
        /// The reason.
        state: SingularState,
        /// The time at which the step starts.
        time: f64,
    },
    /// The motion has no value for any state with the parameters that were given.
    SingularParameters(SingularState),
    /// A program lacks a function.
    MissingFunction {
        /// The name of the system.
        system: String,
        /// Name of the function.
        name: String,
    },
    /// A function cannot be derived for a system.
    UnavailableFunction {
        /// The name of the system.
        system: String,
        /// Name of the function.
        name: String,
    },
    /// No function has this name.
    UnknownFunction {
        /// The name of the system.
        system: String,
        /// Name.
        name: String,
        /// The known name that is closest to it.
        closest: Option<String>,
    },
    /// A function in Rust, which has no code here, is needed.
    ForeignFunction {
        /// Name.
        name: String,
        /// Missing part: `numbers` or `slopes`.
        missing: &'static str,
    },
    /// The inertia of a rotor does not have the number of entries of its kind.
    RotorInertia,
    /// Steps of a method have no slopes.
    NoStepSlopes {
        /// The method that was asked for.
        method: String,
    },
    /// The motion has no linearisation at a state.
    NoLinearization(SingularState),
    /// A row of the linearisation is not finite.
    LinearizationNotFinite {
        /// The row, counted from 1.
        row: usize,
    },
    /// Something that the linear system does not have.
    Linear(LinearError),
    /// The matrix A has dependent columns.
    NoLeftInverse,
    /// The mass matrix is not finite at a state.
    NoMassMatrix,
    /// A mechanism was pulled at a point that it does not have.
    NoSuchPoint,
    /// A mechanism was pulled in a singular configuration.
    SingularPull,
    /// Nothing of a mechanism can be drawn.
    NotDrawable {
        /// The name of the system.
        system: String,
    },
    /// Forces of a system are not linear in inertial parameters.
    NoRegressor {
        /// The path of the description.
        path: String,
        /// The name of the system.
        system: String,
        /// The reason.
        why: String,
    },
    /// A table is unknown or does not exist for the system.
    Table(TableError),
    /// There is no trim.
    Trim(TrimProblem),
}

impl Error {
    /// Returns whether the request is wrong, not the description.
    pub fn is_misuse(&self) -> bool {
        match self {
            Error::Read { .. }
            | Error::Decode { .. }
            | Error::StandardInputTwice(_)
            | Error::Argument { .. }
            | Error::ConstantOfRobot { .. }
            | Error::Constant { .. }
            | Error::RobotOptions { .. }
            | Error::State { .. }
            | Error::Input(_)
            | Error::UnknownMethod { .. }
            | Error::Method { .. }
            | Error::Stepping(_)
            | Error::Sampling(_)
            | Error::Step(_)
            | Error::UnknownFunction { .. }
            | Error::NoStepSlopes { .. }
            | Error::NoSuchPoint
            | Error::Linear(
                LinearError::UnknownInput(..)
                | LinearError::UnknownOutput(..)
                | LinearError::NoInputCost
                | LinearError::NegativeCost,
            )
            | Error::Table(_) => true,
            Error::Trim(problem) => problem.is_misuse(),
            Error::Description { .. }
            | Error::Robot { .. }
            | Error::Import { .. }
            | Error::Links { .. }
            | Error::SingularStep { .. }
            | Error::SingularParameters(_)
            | Error::MissingFunction { .. }
            | Error::UnavailableFunction { .. }
            | Error::ForeignFunction { .. }
            | Error::RotorInertia
            | Error::NoLinearization(_)
            | Error::LinearizationNotFinite { .. }
            | Error::Linear(_)
            | Error::NoLeftInverse
            | Error::NoMassMatrix
            | Error::SingularPull
            | Error::NotDrawable { .. }
            | Error::NoRegressor { .. } => false,
        }
    }

    /// Returns the errors in a description, with their places in it; empty for other errors.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Error::Description { diagnostics, .. } | Error::Robot { diagnostics, .. } => {
                diagnostics
            }
            _ => &[],
        }
    }

    /// Returns the subject and the messages of an error that has several messages about one subject.
    pub fn list(&self) -> Option<(String, Vec<String>)> {
        match self {
            Error::State { path, problems } => {
                let messages = problems.iter().map(ToString::to_string);
                Some((path.clone(), messages.collect()))
            }
            Error::Method { name, obstacles } => {
                Some((format!("--method {name} does not fit"), obstacles.clone()))
            }
            _ => None,
        }
    }
}

/// Strips the leading `error: ` of a rendered message.
fn bare(shown: &str) -> &str {
    let shown = shown.trim_end();
    shown.strip_prefix("error: ").unwrap_or(shown)
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((about, messages)) = self.list() {
            for (index, message) in messages.iter().enumerate() {
                let gap = if index > 0 { "\nerror: " } else { "" };
                write!(f, "{gap}{about}: {message}")?;
            }
            return match messages.len() {
                0 | 1 => Ok(()),
                count => write!(f, "\n{count} errors"),
            };
        }
        match self {
            Error::Read { path, source } => write!(f, "cannot read {path}: {source}"),
            Error::Decode { path, source } => write!(f, "cannot read {path}: {source}"),
            Error::StandardInputTwice(what) => write!(
                f,
                "description and {what} cannot both be read from standard input"
            ),
            Error::Description {
                path,
                text,
                diagnostics,
            } => f.write_str(bare(&render(diagnostics, path, text, false))),
            Error::Robot {
                path,
                urdf,
                diagnostics,
            } => f.write_str(bare(&urdf::refused(diagnostics, path, urdf, false))),
            Error::Import {
                path,
                urdf,
                problems,
            } => f.write_str(bare(&urdf::errors(problems, path, urdf, false))),
            Error::Argument {
                option,
                text,
                diagnostics,
            } => f.write_str(bare(&render(diagnostics, option, text, false))),
            Error::ConstantOfRobot { path } => {
                write!(f, "{path} is a robot: --const is for descriptions")
            }
            Error::Constant {
                name,
                value,
                problem,
            } => write!(f, "--const {name}={value}: {problem}"),
            Error::RobotOptions { path } => write!(
                f,
                "{path} is a description: --floating, --lock, --params, --mimic, --name and --rounding are for robots in URDF"
            ),
            Error::Links { path, unknown } => {
                let all: Vec<String> = unknown.iter().map(ToString::to_string).collect();
                write!(f, "{path}: {}", all.join("; "))
            }
            // Said above.
            Error::State { .. } | Error::Method { .. } => Ok(()),
            Error::Input(problem) => problem.fmt(f),
            Error::UnknownMethod { name } => write!(
                f,
                "no method is called `{name}`; there are {}",
                crate::method::names().join(", ")
            ),
            Error::Stepping(problem) => problem.fmt(f),
            Error::Sampling(problem) => problem.fmt(f),
            Error::Step(error) => error.fmt(f),
            Error::SingularStep { state, time } => write!(
                f,
                "{state}, in the step from t = {}",
                hamel_files::number::short(*time)
            ),
            Error::SingularParameters(state) => write!(f, "{state} with these parameters"),
            Error::MissingFunction { system, name } => {
                write!(f, "{system} has no function `{name}`")
            }
            Error::UnavailableFunction { system, name } => write!(
                f,
                "{system} has no function `{name}`: the mass matrix has no inverse, or the function would return nothing"
            ),
            Error::UnknownFunction {
                system,
                name,
                closest,
            } => {
                write!(f, "{system} has no function `{name}`")?;
                match closest {
                    Some(close) => write!(f, "; did you mean `{close}`?"),
                    None => Ok(()),
                }
            }
            Error::ForeignFunction { name, missing } => write!(
                f,
                "`{name}` is a function in Rust, of which there are no {missing} here"
            ),
            Error::RotorInertia => f.write_str("an inertia has the wrong number of entries"),
            Error::NoStepSlopes { method } => {
                let known: Vec<&str> = crate::method::with_step_slopes()
                    .map(|one| one.name())
                    .collect();
                write!(
                    f,
                    "steps of `{method}` have no slopes here; use {}",
                    known.join(", ")
                )
            }
            Error::NoLinearization(state) => write!(f, "there is no linearisation: {state}"),
            Error::LinearizationNotFinite { row } => write!(
                f,
                "the linearisation is not finite at this state: row {row} has no value"
            ),
            Error::Linear(error) => error.fmt(f),
            Error::NoLeftInverse => {
                f.write_str("the rates of this description leave A without a left inverse")
            }
            Error::NoMassMatrix => f.write_str("the mass matrix has no value at this state"),
            Error::NoSuchPoint => f.write_str("there is no such point to pull at"),
            Error::SingularPull => {
                f.write_str("the kinematics are singular here: nothing can be pulled")
            }
            Error::NotDrawable { system } => write!(f, "{system} cannot be drawn"),
            Error::NoRegressor { path, system, why } => {
                write!(f, "{path}: `{system}` has no regressor: {why}")
            }
            Error::Table(why) => why.fmt(f),
            Error::Trim(problem) => problem.fmt(f),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Error::Read { source, .. } => Some(source),
            Error::Decode { source, .. } => Some(source),
            Error::Constant { problem, .. } => Some(problem),
            Error::Input(problem) => problem.source(),
            Error::Step(error) => Some(error),
            Error::Linear(error) => Some(error),
            Error::Trim(problem) => Some(problem),
            Error::SingularStep { state, .. }
            | Error::SingularParameters(state)
            | Error::NoLinearization(state) => Some(state),
            _ => None,
        }
    }
}

impl From<LinearError> for Error {
    fn from(error: LinearError) -> Self {
        Error::Linear(error)
    }
}

impl From<InputProblem> for Error {
    fn from(problem: InputProblem) -> Self {
        Error::Input(problem)
    }
}

impl From<SteppingProblem> for Error {
    fn from(problem: SteppingProblem) -> Self {
        Error::Stepping(problem)
    }
}

impl From<SamplingProblem> for Error {
    fn from(problem: SamplingProblem) -> Self {
        Error::Sampling(problem)
    }
}

impl From<TrimProblem> for Error {
    fn from(problem: TrimProblem) -> Self {
        Error::Trim(problem)
    }
}

impl From<StepError> for Error {
    fn from(error: StepError) -> Self {
        Error::Step(error)
    }
}
