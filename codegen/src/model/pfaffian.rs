//! Constraints B(x) ξ = 0 on the velocities of a frame.

use crate::algebra::graph::Edge;
use crate::syntax::ast::Span;

/// What a row of B says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A velocity of an adapted frame is zero.
    Inactive,
    /// A constraint that is linear in ξ.
    Nonholonomic,
    /// The rate of a closed loop, ∂ᵢφ.
    Loop,
}

/// One row of B ξ = 0.
#[derive(Clone, Debug)]
pub struct Pfaffian {
    /// What it says.
    pub kind: Kind,
    /// B, n entries.
    pub row: Vec<Edge>,
    /// φ(x) of a loop, in units of the description; 0 otherwise.
    pub residual: Edge,
    /// λ (1/s) in d/dt (B ξ) = −2 λ B ξ − λ² φ; nothing is added where absent.
    pub stabilized: Option<Edge>,
    /// As it was written.
    pub written: String,
    /// Where it was written.
    pub span: Span,
}
