//! Coefficients of an embedded explicit Runge-Kutta pair with dense output.

use crate::methods::tableau::{Row, Weights};

/// An explicit tableau of M stages, with an error estimate and D terms of dense output in addition to Hermite's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair<const M: usize, const D: usize> {
    /// The order p.
    pub order: u32,
    /// Index of the stage at the end of the step: its row is b, and it is the first stage of the next step. Later
    /// stages are only for dense output.
    pub end: usize,
    /// Value of h |ρ| at the bound of the stability region, where ρ < 0 is the rate of y′ = ρ y.
    pub stability: f64,
    /// The stages; the first has no weights.
    pub rows: [Row; M],
    /// Error weights e, the difference of two closing formulas: the estimate is h Σ eⱼ kⱼ. If there are two estimates,
    /// of orders p₁ > p₂, they are combined as in DOP853: |e₁|² / √(|e₁|² + 0.01 |e₂|²).
    pub errors: &'static [Weights],
    /// Weights d of the terms of dense output that follow Hermite's three.
    pub dense: [Weights; D],
}
