//! What rounding does to expressions: values in `f64` beside those in twice the length, and bounds.
//!
//! With unit roundoff u = 2^-53 a node computed in `f64` from children that are off by e_a, e_b is off
//! by at most
//!
//! | node | bound |
//! |---|---|
//! | a ± b | e_a + e_b + u \|a ± b\| |
//! | a b | \|a\| e_b + \|b\| e_a + u \|a b\| |
//! | a / b | (e_a + \|a/b\| e_b) / \|b\| + u \|a/b\| |
//! | f(a) | \|f'(a)\| e_a + u \|f(a)\| |
//!
//! but for terms of second order.

use super::double::Double;
use super::graph::{Edge, Function, Graph, Node};

/// Unit roundoff of `f64`.
pub const UNIT: f64 = f64::EPSILON / 2.0;

/// An expression computed in `f64` from start to end, and its value.
#[derive(Clone, Copy, Debug)]
pub struct Rounded {
    /// As a program in `f64` has it.
    pub rounded: f64,
    /// As it is.
    pub exact: Double,
}

impl Rounded {
    /// How far the one is from the other.
    pub fn apart(&self) -> f64 {
        (Double::new(self.rounded) - self.exact).abs().to_f64()
    }
}

/// The expressions in `f64` and in twice the length, given the value of every symbol but π.
pub fn rounded(graph: &Graph, roots: &[Edge], symbols: &[f64]) -> Vec<Rounded> {
    let zero = Rounded {
        rounded: 0.0,
        exact: Double::ZERO,
    };
    let mut values = vec![zero; graph.len()];
    let read = |values: &[Rounded], edge: Edge| {
        let Rounded { rounded, exact } = values[edge.node() as usize];
        let negative = edge.is_negative();
        Rounded {
            rounded: if negative { -rounded } else { rounded },
            exact: exact.signed(negative),
        }
    };
    for id in graph.reachable(roots) {
        let pair = |a: Edge, b: Edge| (read(&values, a), read(&values, b));
        values[id as usize] = match graph.node(id) {
            Node::Constant(index) => nearest(Double::of_rational(graph.constant(index))),
            Node::Symbol(0) => nearest(Double::PI),
            Node::Symbol(index) => nearest(Double::new(
                symbols.get(index as usize).copied().unwrap_or(0.0),
            )),
            Node::Add(a, b) => {
                let (a, b) = pair(a, b);
                Rounded {
                    rounded: a.rounded + b.rounded,
                    exact: a.exact + b.exact,
                }
            }
            Node::Mul(a, b) => {
                let (a, b) = pair(a, b);
                Rounded {
                    rounded: a.rounded * b.rounded,
                    exact: a.exact * b.exact,
                }
            }
            Node::Div(a, b) => {
                let (a, b) = pair(a, b);
                Rounded {
                    rounded: a.rounded / b.rounded,
                    exact: a.exact / b.exact,
                }
            }
            // The nearest number to the function's value: the same on every machine.
            Node::Apply(function, a) => {
                let a = read(&values, a);
                Rounded {
                    rounded: Double::new(a.rounded).apply(function).to_f64(),
                    exact: a.exact.apply(function),
                }
            }
            Node::Atan2(y, x) => {
                let (y, x) = pair(y, x);
                let angle = Double::new(y.rounded).atan2(Double::new(x.rounded));
                Rounded {
                    rounded: angle.to_f64(),
                    exact: y.exact.atan2(x.exact),
                }
            }
        };
    }
    roots.iter().map(|&root| read(&values, root)).collect()
}

fn nearest(exact: Double) -> Rounded {
    Rounded {
        rounded: exact.to_f64(),
        exact,
    }
}

/// A value with a bound of what rounding in `f64` makes of it.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    /// The value.
    pub value: f64,
    /// How far a program in `f64` may be off.
    pub error: f64,
}

/// The expressions with bounds of their rounding, given the value of every symbol; symbols that have
/// none count as 0.
pub fn bounded(graph: &Graph, roots: &[Edge], symbols: &[f64]) -> Vec<Bounded> {
    let mut values = vec![(Double::ZERO, 0.0); graph.len()];
    let read = |values: &[(Double, f64)], edge: Edge| {
        let (value, error) = values[edge.node() as usize];
        (value.signed(edge.is_negative()), error)
    };
    let size = |value: Double| value.abs().to_f64();
    for id in graph.reachable(roots) {
        let pair = |a: Edge, b: Edge| (read(&values, a), read(&values, b));
        // The value, and what it inherits of errors.
        let (value, inherited) = match graph.node(id) {
            Node::Constant(index) => (Double::of_rational(graph.constant(index)), 0.0),
            Node::Symbol(0) => (Double::PI, 0.0),
            Node::Symbol(index) => {
                let value = symbols.get(index as usize).copied().unwrap_or(0.0);
                (Double::new(value), 0.0)
            }
            Node::Add(a, b) => {
                let ((a, e), (b, f)) = pair(a, b);
                (a + b, e + f)
            }
            Node::Mul(a, b) => {
                let ((a, e), (b, f)) = pair(a, b);
                (a * b, size(a) * f + size(b) * e)
            }
            Node::Div(a, b) => {
                let ((a, e), (b, f)) = pair(a, b);
                let quotient = a / b;
                (quotient, (e + size(quotient) * f) / size(b))
            }
            Node::Apply(function, a) => {
                let (a, e) = read(&values, a);
                let value = a.apply(function);
                (value, slope(function, a, value) * e)
            }
            Node::Atan2(y, x) => {
                let ((y, e), (x, f)) = pair(y, x);
                (y.atan2(x), (e + f) / (x * x + y * y).sqrt().to_f64())
            }
        };
        let own = if value == Double::new(value.to_f64()) && inherited == 0.0 {
            0.0
        } else {
            UNIT * size(value)
        };
        values[id as usize] = (value, inherited + own);
    }
    let all = roots.iter().map(|&root| read(&values, root));
    all.map(|(value, error)| Bounded {
        value: value.to_f64(),
        error,
    })
    .collect()
}

/// |f'(a)|, where f(a) is known.
fn slope(function: Function, a: Double, value: Double) -> f64 {
    let slope = match function {
        Function::Sin => a.sin_cos().1,
        Function::Cos => a.sin_cos().0,
        Function::Exp => value,
        Function::Log => Double::ONE / a,
        Function::Sqrt => Double::new(0.5) / value,
        Function::Atan2 => Double::new(f64::NAN),
    };
    slope.abs().to_f64()
}

#[cfg(test)]
mod tests {
    use super::{bounded, rounded};
    use crate::graph::{Function, Graph};
    use num_bigint::BigInt;
    use num_rational::BigRational;

    /// (1 + d) − 1 with d = 1e-9 / 7, which keeps half of its digits.
    #[test]
    fn cancellation_is_seen() {
        let mut graph = Graph::new(1, 1);
        let pi = graph.symbol("pi", 0, crate::fp::Fp::PI);
        let x = graph.symbol("x", 2, crate::fp::Random::new(3).element());
        let small = graph.rational(&BigRational::new(
            BigInt::from(1),
            BigInt::from(7_000_000_000_i64),
        ));
        let product = graph.mul(small, x);
        let angle = graph.add(pi, product);
        let sine = graph.apply(Function::Sin, angle);
        let only = rounded(&graph, &[sine], &[0.0, 1.0])[0];
        let wanted = (1e-9_f64 / 7.0).sin();
        // sin(π + d) = −sin d is recognised; whichever way it is written, the exact value is right.
        assert!((only.exact.to_f64().abs() - wanted).abs() < 1e-24);
        let bound = bounded(&graph, &[angle], &[0.0, 1.0])[0];
        assert!(bound.error > 1e-16 && bound.error < 2e-15);
        assert!(
            (rounded(&graph, &[angle], &[0.0, 1.0])[0].rounded - bound.value).abs() <= bound.error
        );
    }
}
