//! What is wrong with a state, with its place.

use std::fmt;

/// Something that is wrong with a state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StateProblem {
    /// Where it is in the file, as `coord.q[1]`; empty where it is about all of it.
    pub place: String,
    /// The message.
    pub message: String,
}

impl StateProblem {
    /// A problem at a place.
    pub fn new(place: impl Into<String>, message: impl Into<String>) -> Self {
        StateProblem {
            place: place.into(),
            message: message.into(),
        }
    }
}

impl fmt::Display for StateProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place.as_str() {
            "" => f.write_str(&self.message),
            place => write!(f, "{place}: {}", self.message),
        }
    }
}

impl std::error::Error for StateProblem {}
