//! Values of expressions with their slopes along many directions, in floating point. No derivative is ever
//! written as an expression, so the cost is that of the values times the number of directions.

use super::dual::{Duals, VectorForwardMode};
use super::graph::{Edge, Graph};
use super::numeric::Floats;
use super::walk::evaluate;

/// A value with its slope along every direction; the list of slopes is empty if all are 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ValueWithSlopes {
    /// The value.
    pub value: f64,
    /// Slopes along the directions.
    pub along: Vec<f64>,
}

impl ValueWithSlopes {
    /// The slope along a direction.
    pub fn slope(&self, direction: usize) -> f64 {
        self.along.get(direction).copied().unwrap_or(0.0)
    }
}

/// Evaluates the expressions with their slopes along directions, given the value of every symbol. A
/// direction has one entry for each symbol, 0 beyond its end.
pub fn slopes(
    graph: &Graph,
    roots: &[Edge],
    symbols: &[f64],
    directions: &[Vec<f64>],
) -> Vec<ValueWithSlopes> {
    let of_symbol = |index: usize| -> Vec<f64> {
        let slope = |row: &Vec<f64>| row.get(index).copied().unwrap_or(0.0);
        directions.iter().map(slope).collect()
    };
    let mut duals = Duals {
        numbers: Floats(symbols),
        slopes: VectorForwardMode(of_symbol),
    };
    let values = evaluate(graph, roots, &mut duals).unwrap_or_default();
    let sloped = |(value, along)| ValueWithSlopes { value, along };
    values.into_iter().map(sloped).collect()
}
