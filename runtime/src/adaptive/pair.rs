//! Coefficients of an explicit method whose stages also tell its error and its path within a step.

use crate::methods::tableau::{Row, Weights};

/// An explicit tableau of M stages with error estimate and D terms of dense output beyond Hermite's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair<const M: usize, const D: usize> {
    /// The order p.
    pub order: u32,
    /// The stage at the end of the step: its row is b, and it is the first stage of the next step.
    /// Stages after it serve dense output alone.
    pub end: usize,
    /// The stages; the first has no weights.
    pub rows: [Row; M],
    /// e, the difference of two closing formulas: the estimate is h Σ eⱼ kⱼ. Where there are two, of
    /// orders p₁ > p₂, they are combined as in DOP853: |e₁|² / √(|e₁|² + 0.01 |e₂|²).
    pub errors: &'static [Weights],
    /// d of the terms of dense output beyond Hermite's three.
    pub dense: [Weights; D],
}
