//! Tables of values in the syntax tree.

use super::{Expr, Ident, Span};

/// `table thrust = [(0, 0), (0.2, 1.1)] linear extrapolate hold;`
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Name by which the table is called.
    pub name: Ident,
    /// Source of its points.
    pub source: Source,
    /// Interpolation between the points.
    pub between: Between,
    /// Extrapolation beyond the first and the last point.
    pub beyond: Beyond,
}

/// Source of the points of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// `= [(a, b), …]`: the points, and the span of the list.
    Points(Vec<(Expr, Expr)>, Span),
    /// `from "file.csv"`: the file name, and its span.
    File(String, Span),
}

/// Interpolation between two points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// `linear`: a straight line.
    Linear,
    /// `pchip`: cubics with continuous slopes that preserve monotonicity.
    Pchip,
}

impl Between {
    /// All interpolations.
    pub const ALL: [Between; 2] = [Between::Linear, Between::Pchip];

    /// Returns the keyword.
    pub fn word(self) -> &'static str {
        match self {
            Between::Linear => "linear",
            Between::Pchip => "pchip",
        }
    }
}

/// Extrapolation beyond the first and the last point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// `hold`: the value at the end point.
    Hold,
    /// `linear`: a line with the slope at the end point.
    Linear,
    /// `error`: NaN.
    Error,
}

impl Beyond {
    /// All extrapolations.
    pub const ALL: [Beyond; 3] = [Beyond::Hold, Beyond::Linear, Beyond::Error];

    /// Returns the keyword.
    pub fn word(self) -> &'static str {
        match self {
            Beyond::Hold => "hold",
            Beyond::Linear => "linear",
            Beyond::Error => "error",
        }
    }
}
