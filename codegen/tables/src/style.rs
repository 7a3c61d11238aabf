//! How expressions are cut into named values.

/// When a value is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Tables: polynomials where they are short enough, temporaries in what is left.
    Table,
    /// The emitted route: sums and products as they are computed, parameter-only values named.
    Route,
}

impl Style {
    /// The least weight of a value that is named because it is read twice.
    pub fn shared(self) -> usize {
        match self {
            Style::Table => 4,
            Style::Route => 2,
        }
    }

    /// The most weight of a value that is read once.
    pub fn longest(self) -> usize {
        match self {
            Style::Table => 40,
            Style::Route => 12,
        }
    }
}
