//! Tables of values as they are written.

use super::{Expr, Ident, Span};

/// `table thrust = [(0, 0), (0.2, 1.1)] linear extrapolate hold;`
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The name by which it is called.
    pub name: Ident,
    /// Where its points stand.
    pub source: Source,
    /// What is between the points.
    pub between: Between,
    /// What is beyond the first and the last point.
    pub beyond: Beyond,
}

/// Where the points of a table stand.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// `= [(a, b), …]`, all of it at a place.
    Points(Vec<(Expr, Expr)>, Span),
    /// `from "file.csv"`, the name at a place.
    File(String, Span),
}

/// What is between two points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// `linear`: a line.
    Linear,
    /// `pchip`: cubics with continuous slopes that keep what rises rising.
    Pchip,
}

impl Between {
    /// All of them.
    pub const ALL: [Between; 2] = [Between::Linear, Between::Pchip];

    /// As it is written.
    pub fn word(self) -> &'static str {
        match self {
            Between::Linear => "linear",
            Between::Pchip => "pchip",
        }
    }
}

/// What is beyond the first and the last point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// `hold`: the value there.
    Hold,
    /// `linear`: a line with the slope there.
    Linear,
    /// `error`: nothing, NaN.
    Error,
}

impl Beyond {
    /// All of them.
    pub const ALL: [Beyond; 3] = [Beyond::Hold, Beyond::Linear, Beyond::Error];

    /// As it is written.
    pub fn word(self) -> &'static str {
        match self {
            Beyond::Hold => "hold",
            Beyond::Linear => "linear",
            Beyond::Error => "error",
        }
    }
}
