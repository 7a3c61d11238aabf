//! Numbers of expressions with their slopes along many directions, in floating point: no derivative is
//! ever written as an expression, so that the cost is that of the values times the directions.

use super::graph::{Edge, Function, Graph, Node};
use num_traits::ToPrimitive;

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

    fn negated(mut self, negative: bool) -> Self {
        if negative {
            self.value = -self.value;
            self.along.iter_mut().for_each(|slope| *slope = -*slope);
        }
        self
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
    let mut all = vec![Sloped::default(); graph.len()];
    for id in graph.reachable(roots) {
        let made = of_node(graph, graph.node(id), &all, symbols, directions);
        all[id as usize] = made;
    }
    let read = |root: &Edge| {
        all[root.node() as usize]
            .clone()
            .negated(root.is_negative())
    };
    roots.iter().map(read).collect()
}

fn of_node(
    graph: &Graph,
    node: Node,
    all: &[Sloped],
    symbols: &[f64],
    directions: &[Vec<f64>],
) -> Sloped {
    let still = |value: f64| Sloped {
        value,
        along: Vec::new(),
    };
    let value = |edge: Edge| {
        let value = all[edge.node() as usize].value;
        if edge.is_negative() { -value } else { value }
    };
    // Σ factor × slope; what does not move takes no part, also where its factor is infinite.
    let moved = |value: f64, parts: &[(Edge, f64)]| {
        let mut along = Vec::new();
        for &(edge, factor) in parts {
            let slopes = &all[edge.node() as usize].along;
            let factor = if edge.is_negative() { -factor } else { factor };
            along.resize(slopes.len().max(along.len()), 0.0);
            for (sum, &slope) in along.iter_mut().zip(slopes) {
                if slope != 0.0 {
                    *sum += factor * slope;
                }
            }
        }
        Sloped { value, along }
    };
    match node {
        Node::Constant(index) => still(graph.constant(index).to_f64().unwrap_or(f64::NAN)),
        Node::Symbol(index) => {
            let slope = |row: &Vec<f64>| row.get(index as usize).copied().unwrap_or(0.0);
            let along: Vec<f64> = directions.iter().map(slope).collect();
            let value = symbols.get(index as usize).copied().unwrap_or(f64::NAN);
            match along.iter().all(|&slope| slope == 0.0) {
                true => still(value),
                false => Sloped { value, along },
            }
        }
        Node::Add(a, b) => moved(value(a) + value(b), &[(a, 1.0), (b, 1.0)]),
        Node::Mul(a, b) => moved(value(a) * value(b), &[(a, value(b)), (b, value(a))]),
        Node::Div(a, b) => {
            let quotient = value(a) / value(b);
            moved(quotient, &[(a, 1.0 / value(b)), (b, -quotient / value(b))])
        }
        Node::Apply(function, a) => {
            let x = value(a);
            let (value, slope) = match function {
                Function::Sin => (x.sin(), x.cos()),
                Function::Cos => (x.cos(), -x.sin()),
                Function::Exp => (x.exp(), x.exp()),
                Function::Log => (x.ln(), 1.0 / x),
                Function::Sqrt => (x.sqrt(), 0.5 / x.sqrt()),
                // Two arguments: its own node.
                Function::Atan2 => (f64::NAN, f64::NAN),
            };
            moved(value, &[(a, slope)])
        }
        Node::Atan2(y, x) => {
            let square = value(x) * value(x) + value(y) * value(y);
            let parts = [(y, value(x) / square), (x, -value(y) / square)];
            moved(value(y).atan2(value(x)), &parts)
        }
    }
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
