//! How expressions are divided into named values.

/// The rules by which values are named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Tables: polynomials if they are short enough, otherwise expressions with temporaries.
    Table,
    /// Generated code: sums and products as they are computed; values that depend on parameters alone are named.
    Route,
}

impl Style {
    /// Smallest weight of a value that is named because it is used more than once.
    pub fn shared(self) -> usize {
        match self {
            Style::Table => 4,
            Style::Route => 2,
        }
    }

    /// Largest weight of a value that is used once and not named.
    pub fn longest(self) -> usize {
        match self {
            Style::Table => 40,
            Style::Route => 12,
        }
    }
}
