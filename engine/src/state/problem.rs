//! Errors in states, with their places.

use std::fmt;

/// Error in a state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StateProblem {
    /// Path in the file, as `coord.q[1]`; empty for an error of the whole file.
    pub place: String,
    /// The message.
    pub message: String,
}

impl StateProblem {
    /// Creates an error at a place.
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
