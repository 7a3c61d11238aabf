//! Constraints B(x, t) ξ = 0 on the velocities of a frame.

use crate::algebra::graph::{Edge, Graph};
use crate::syntax::ast::Span;

/// Origin of a row of B.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A velocity of an adapted frame that is zero.
    Inactive,
    /// A nonholonomic constraint, linear in ξ.
    Nonholonomic,
    /// The time derivative of a loop equation φ = 0: ∂ᵢφ.
    Loop,
    /// A prescribed velocity, or the velocity of a prescribed coordinate; the latter has a residual.
    Drive {
        /// Whether it is a coordinate that is prescribed.
        position: bool,
    },
}

/// One row of B ξ = 0.
#[derive(Clone, Debug)]
pub struct Pfaffian {
    /// Origin of the row.
    pub kind: Kind,
    /// Row of B, n entries.
    pub row: Vec<Edge>,
    /// Term b of B ξ + b = 0 after substituting ξ⁰ = 1; 0 in the full frame.
    pub shift: Edge,
    /// φ(x) of a holonomic constraint, in units of the description; 0 otherwise.
    pub residual: Edge,
    /// Rate λ (1/s) at which a violation decays: d/dt (B ξ) = −λ B ξ, or −2 λ B ξ − λ² φ for a loop. `None` adds no
    /// stabilization.
    pub stabilized: Option<Edge>,
    /// Equation that the row belongs to, as it was written.
    pub written: String,
    /// Entry of that equation, such as `[3]` or `[1, 2]`; empty if there is only one.
    pub entry: String,
    /// Whether the row follows from the others everywhere, so that it adds nothing and has no multiplier.
    pub redundant: bool,
    /// Where it was written.
    pub span: Span,
}

impl Pfaffian {
    /// Returns the equation with the entry, as a label of the row.
    pub fn label(&self) -> String {
        match self.entry.as_str() {
            "" => self.written.clone(),
            entry => format!("{}, entry {entry}", self.written),
        }
    }

    /// Returns B ξ + b.
    pub fn speed(&self, graph: &mut Graph, xi: &[Edge]) -> Edge {
        let moved = graph.dot(&self.row, xi);
        graph.add(moved, self.shift)
    }

    /// Returns whether the row is the rate of an equation between coordinates, φ(x) = 0.
    pub fn is_holonomic(&self) -> bool {
        matches!(self.kind, Kind::Loop | Kind::Drive { position: true })
    }
}
