//! Errors of linear systems.

use super::Mode;
use std::fmt;

/// Something that a linear system does not have, or that was not found.
#[derive(Clone, Debug, PartialEq)]
pub enum LinearError {
    /// The QR algorithm does not converge.
    NoEigenvalues,
    /// The motion grows beyond all numbers.
    Overflow,
    /// Modes that do not decay are not reached by the inputs: nothing can make them decay.
    Unreachable(Vec<Mode>),
    /// Modes that neither decay nor grow have no cost: the least cost leaves them alone.
    NoStateCost(Vec<Mode>),
    /// The weights of the inputs are not positive definite.
    NoInputCost,
    /// The weights of the states are not positive semidefinite.
    NegativeCost,
    /// Riccati's equation was not solved.
    NoConvergence,
    /// A response has no value in the range of frequencies.
    NoResponse,
    /// Nothing passes from the input to the output.
    Unconnected,
    /// No input has this name; the known ones.
    UnknownInput(String, Vec<String>),
    /// No output or state has this name; the known ones.
    UnknownOutput(String, Vec<String>),
}

impl fmt::Display for LinearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |modes: &[Mode]| {
            let groups = modes
                .chunk_by(|a, b| a == b)
                .map(|equal| match equal.len() {
                    1 => equal[0].to_string(),
                    count => format!("{}, {count} times", equal[0]),
                });
            groups.collect::<Vec<_>>().join("; ")
        };
        match self {
            LinearError::NoEigenvalues => f.write_str("the eigenvalues were not found: the QR algorithm does not converge"),
            LinearError::Overflow => f.write_str("the motion grows beyond all numbers in this time; take a shorter one"),
            LinearError::Unreachable(modes) => write!(f, "no regulator makes these modes decay, since the inputs do not reach them: {}", list(modes)),
            LinearError::NoStateCost(modes) => write!(f, "these modes neither decay nor grow, and have no weight, so that the least cost leaves them alone: {}; give a weight to one of their states", list(modes)),
            LinearError::NoInputCost => f.write_str("a regulator needs inputs, and a positive weight of each"),
            LinearError::NegativeCost => f.write_str("the weights of the states must not be negative"),
            LinearError::NoConvergence => f.write_str("Riccati's equation was not solved: some mode that does not decay is hardly reached by the inputs, or the weights differ by too many powers of ten"),
            LinearError::NoResponse => f.write_str("the response has no value in this range of frequencies"),
            LinearError::Unconnected => {
                f.write_str("nothing passes from the input to the output: the response is zero")
            }
            LinearError::UnknownInput(name, known) if known.is_empty() => write!(f, "there is no input `{name}`: the description has none"),
            LinearError::UnknownInput(name, known) => write!(f, "there is no input `{name}`; there are {}", known.join(", ")),
            LinearError::UnknownOutput(name, known) => write!(f, "there is no output or state `{name}`; there are {}", known.join(", ")),
        }
    }
}

impl std::error::Error for LinearError {}
