//! Identities that a program violates.

use std::fmt;

/// Identity that a program violates at a point of X.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Violation {
    /// Pairs of the three forms of the equations of motion have different left sides.
    Forms(Vec<&'static str>),
    /// An identity of emitted functions, by its equation or its name.
    Identity(&'static str),
    /// An output of the description is not the value of its expression.
    Output(String),
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Violation::Forms(pairs) => f.write_str(&pairs.join(", ")),
            Violation::Identity(equation) => f.write_str(equation),
            Violation::Output(name) => write!(f, "output `{name}`"),
        }
    }
}

impl std::error::Error for Violation {}

/// Fault of the generator that a proof of base parameters has found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RegressorFault {
    /// A link with parameters is not a frame of the description.
    UnknownLink,
    /// The forces of the description have no values modulo p.
    NoForces,
    /// The columns of Y have no values modulo p.
    NoColumns,
    /// The forces have values at too few points to be compared.
    TooFewPoints,
    /// The forces, or the base parameters, are wrong.
    Violation(Violation),
}

impl fmt::Display for RegressorFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("internal check failed: ")?;
        match self {
            RegressorFault::UnknownLink => {
                f.write_str("its links are not those of the description")
            }
            RegressorFault::NoForces => f.write_str("its forces have no numbers"),
            RegressorFault::NoColumns => f.write_str("its columns have no numbers"),
            RegressorFault::TooFewPoints => {
                f.write_str("there are too few points to compare its forces at")
            }
            RegressorFault::Violation(violation) => violation.fmt(f),
        }
    }
}

impl std::error::Error for RegressorFault {}
