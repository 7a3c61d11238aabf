//! Constraints B(x, t) ξ = 0 on the velocities of a frame.

use crate::algebra::graph::{Edge, Graph};
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
    /// A velocity that is given; with a residual, that of a coordinate that is.
    Drive {
        /// Whether it is a coordinate that is given.
        position: bool,
    },
}

/// One row of B ξ = 0.
#[derive(Clone, Debug)]
pub struct Pfaffian {
    /// What it says.
    pub kind: Kind,
    /// B, n entries.
    pub row: Vec<Edge>,
    /// b in B ξ + b = 0 where ξ⁰ = 1 was put in; 0 in the full frame.
    pub shift: Edge,
    /// φ(x) of a loop, in units of the description; 0 otherwise.
    pub residual: Edge,
    /// λ (1/s), at which a violation decays: d/dt (B ξ) = −λ B ξ, or −2 λ B ξ − λ² φ of a loop. Nothing is added where
    /// absent.
    pub stabilized: Option<Edge>,
    /// The equation that it is of, as it was written.
    pub written: String,
    /// Which entry of that equation it is, such as `[3]` or `[1, 2]`; empty where there is a single one.
    pub entry: String,
    /// Whether it follows from the others everywhere, so that it says nothing and has no multiplier.
    pub redundant: bool,
    /// Where it was written.
    pub span: Span,
}

impl Pfaffian {
    /// The row by its equation and its entry.
    pub fn label(&self) -> String {
        match self.entry.as_str() {
            "" => self.written.clone(),
            entry => format!("{}, entry {entry}", self.written),
        }
    }

    /// B ξ + b.
    pub fn speed(&self, graph: &mut Graph, xi: &[Edge]) -> Edge {
        let moved = graph.dot(&self.row, xi);
        graph.add(moved, self.shift)
    }

    /// Whether it is the rate of an equation of coordinates, φ(x) = 0.
    pub fn is_holonomic(&self) -> bool {
        matches!(self.kind, Kind::Loop | Kind::Drive { position: true })
    }
}
