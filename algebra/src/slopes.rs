//! Numbers of expressions with their slopes along many directions, in floating point: no derivative is
//! ever written as an expression, so that the cost is that of the values times the directions.

use super::dual::{Across, Duals};
use super::graph::{Edge, Graph};
use super::numeric::Floats;
use super::walk::evaluate;

/// A value with its slope along every direction; nothing of it moves where there are no slopes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sloped {
    /// The value.
    pub value: f64,
    /// The slopes.
    pub along: Vec<f64>,
}

impl Sloped {
    /// The slope along a direction.
    pub fn slope(&self, direction: usize) -> f64 {
        self.along.get(direction).copied().unwrap_or(0.0)
    }
}

/// The expressions, given the value of every symbol, with their slopes along directions: one entry for
/// each symbol, 0 beyond the end.
pub fn slopes(
    graph: &Graph,
    roots: &[Edge],
    symbols: &[f64],
    directions: &[Vec<f64>],
) -> Vec<Sloped> {
    let of_symbol = |index: usize| -> Vec<f64> {
        let slope = |row: &Vec<f64>| row.get(index).copied().unwrap_or(0.0);
        directions.iter().map(slope).collect()
    };
    let mut duals = Duals {
        numbers: Floats(symbols),
        slopes: Across(of_symbol),
    };
    let values = evaluate(graph, roots, &mut duals).unwrap_or_default();
    let sloped = |(value, along)| Sloped { value, along };
    values.into_iter().map(sloped).collect()
}

#[cfg(test)]
mod tests {
    use super::slopes;
    use crate::derivation::Derivation;
    use crate::fp::Random;
    use crate::graph::Graph;
    use crate::numeric::evaluate;
    use crate::tests::quotients;

    #[test]
    fn slopes_are_the_numbers_of_symbolic_derivatives() {
        let mut random = Random::new(7);
        let mut graph = Graph::new(1, 0);
        let mut symbol = |graph: &mut Graph, name: &str| {
            let value = random.element();
            graph.symbol(name, 2, value)
        };
        let (a, b) = (symbol(&mut graph, "a"), symbol(&mut graph, "b"));
        let product = graph.mul(a, b);
        let sum = graph.sub(product, b);
        let mut roots = vec![-product];
        roots.extend(quotients(&mut graph, sum, a));
        roots.push(graph.atan2(sum, b));
        // Along (1, 2) and (0, 1).
        let (one, two) = (graph.one(), graph.ratio(2, 1));
        let mut first = Derivation::new([(a.node(), one), (b.node(), two)]);
        let mut second = Derivation::new([(b.node(), one)]);
        let expected = [
            first.all(&mut graph, &roots),
            second.all(&mut graph, &roots),
        ];
        let before = graph.symbols().len() - 2;
        let row = |own: [f64; 2]| [vec![0.0; before], own.to_vec()].concat();
        let symbols = row([1.7, 0.6]);
        let found = slopes(
            &graph,
            &roots,
            &symbols,
            &[row([1.0, 2.0]), row([0.0, 1.0])],
        );
        for (direction, expected) in expected.iter().enumerate() {
            let expected = evaluate(&graph, expected, &symbols);
            for (found, expected) in found.iter().zip(expected) {
                let error = (found.slope(direction) - expected).abs();
                assert!(
                    error <= 1e-14 * expected.abs().max(1.0),
                    "{found:?} {expected}"
                );
            }
        }
    }
}
