//! What was completed of A, Y and Φ, and what that divides by.

use crate::algebra::graph::Edge;

/// Y as it was given, the rows of Φ, and what [Y; Φ]⁻¹ divides by.
#[derive(Clone, Debug, Default)]
pub struct Completion {
    /// For every ξⁱ its row of Y, where the description defines it.
    pub y: Vec<Option<Vec<Edge>>>,
    /// The independent rows of φ: those of Φ.
    pub independent: Vec<usize>,
    /// Pivots that vary with x, positive at the start: where one is not, A has no value.
    pub pivots: Vec<Edge>,
    /// Squares of pivots that are made of parameters, which have to be positive.
    pub constants: Vec<Edge>,
}
