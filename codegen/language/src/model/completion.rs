//! How A was completed from Y and Φ, and the divisors in it.

use crate::algebra::graph::Edge;

/// How A follows from Y and φ: the rows of Y that were given, the indices of the independent rows of φ, and the pivots
/// of `[Y; Φ]⁻¹`.
#[derive(Clone, Debug, Default)]
pub struct Completion {
    /// Row of Y for each ξⁱ that the description defines.
    pub y: Vec<Option<Vec<Edge>>>,
    /// Indices of the independent rows of φ, which make up Φ.
    pub independent: Vec<usize>,
    /// Pivots that vary with x. They are positive at the start; where one of them is not, A is undefined.
    pub pivots: Vec<Edge>,
    /// Squares of pivots that depend on parameters alone; they have to be positive.
    pub constants: Vec<Edge>,
}
