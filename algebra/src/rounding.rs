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
use super::dual::{Duals, Partial, Slopes};
use super::function::Function;
use super::graph::{Edge, Graph};
use super::numbers::{Form, Numbers, evaluate, operators};
use num_rational::BigRational;

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

/// Numbers of twice the length, with the values of all symbols but π; those that have none count as 0.
struct Doubles<'a>(&'a [f64]);

impl Numbers for Doubles<'_> {
    operators!(Double);

    fn whole(&mut self, value: i32) -> Double {
        Double::new(value.into())
    }

    fn constant(&mut self, value: &BigRational) -> Option<Double> {
        Some(Double::of_rational(value))
    }

    fn symbol(&mut self, index: usize) -> Option<Double> {
        Some(match index {
            0 => Double::PI,
            _ => Double::new(self.0.get(index).copied().unwrap_or(0.0)),
        })
    }

    fn div(&mut self, a: &Double, b: &Double) -> Option<Double> {
        Some(*a / *b)
    }

    fn apply(
        &mut self,
        function: Function,
        a: &Double,
        _: &dyn Fn() -> Form<Double>,
    ) -> Option<Double> {
        Some((function.row().double)(*a))
    }

    fn atan2(&mut self, y: &Double, x: &Double) -> Option<Double> {
        Some(y.atan2(*x))
    }
}

/// Both kinds at once. Functions in `f64` are the nearest numbers to their values: the same on every
/// machine.
struct Both<'a>(Doubles<'a>);

impl Both<'_> {
    fn of(rounded: f64, exact: Double) -> Rounded {
        Rounded { rounded, exact }
    }

    fn nearest(exact: Double) -> Rounded {
        Both::of(exact.to_f64(), exact)
    }
}

impl Numbers for Both<'_> {
    type Number = Rounded;

    fn whole(&mut self, value: i32) -> Rounded {
        Both::nearest(self.0.whole(value))
    }

    fn constant(&mut self, value: &BigRational) -> Option<Rounded> {
        self.0.constant(value).map(Both::nearest)
    }

    fn symbol(&mut self, index: usize) -> Option<Rounded> {
        self.0.symbol(index).map(Both::nearest)
    }

    fn neg(&mut self, a: &Rounded) -> Rounded {
        Both::of(-a.rounded, -a.exact)
    }

    fn add(&mut self, a: &Rounded, b: &Rounded) -> Rounded {
        Both::of(a.rounded + b.rounded, a.exact + b.exact)
    }

    fn mul(&mut self, a: &Rounded, b: &Rounded) -> Rounded {
        Both::of(a.rounded * b.rounded, a.exact * b.exact)
    }

    fn div(&mut self, a: &Rounded, b: &Rounded) -> Option<Rounded> {
        Some(Both::of(a.rounded / b.rounded, a.exact / b.exact))
    }

    fn apply(
        &mut self,
        function: Function,
        a: &Rounded,
        _: &dyn Fn() -> Form<Rounded>,
    ) -> Option<Rounded> {
        let of = function.row().double;
        Some(Both::of(of(Double::new(a.rounded)).to_f64(), of(a.exact)))
    }

    fn atan2(&mut self, y: &Rounded, x: &Rounded) -> Option<Rounded> {
        let angle = Double::new(y.rounded).atan2(Double::new(x.rounded));
        Some(Both::of(angle.to_f64(), y.exact.atan2(x.exact)))
    }
}

/// The expressions in `f64` and in twice the length, given the value of every symbol but π.
pub fn rounded(graph: &Graph, roots: &[Edge], symbols: &[f64]) -> Vec<Rounded> {
    evaluate(graph, roots, &mut Both(Doubles(symbols))).unwrap_or_default()
}

/// A value with a bound of what rounding in `f64` makes of it.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    /// The value.
    pub value: f64,
    /// How far a program in `f64` may be off.
    pub error: f64,
}

/// Bounds of errors in the place of slopes: Σ |∂f/∂a| eₐ, and u |f| where f itself is rounded.
struct Errors;

impl Slopes<Doubles<'_>> for Errors {
    type Slope = f64;

    fn symbol(&mut self, numbers: &mut Doubles, _: usize, value: &Double) -> f64 {
        self.combine(numbers, value, &[])
    }

    fn combine(
        &mut self,
        _: &mut Doubles,
        value: &Double,
        parts: &[(Partial<Double>, &f64)],
    ) -> f64 {
        let size = |value: Double| value.abs().to_f64();
        let part = |(partial, error): &(Partial<Double>, &f64)| match partial {
            Partial::One | Partial::MinusOne => **error,
            Partial::By(factor) => size(*factor) * **error,
        };
        let inherited: f64 = parts.iter().map(part).sum();
        if inherited == 0.0 && *value == Double::new(value.to_f64()) {
            return 0.0;
        }
        inherited + UNIT * size(*value)
    }

    fn neg(&mut self, _: &mut Doubles, error: &f64) -> f64 {
        *error
    }

    fn moves(&self, _: &Doubles, error: &f64) -> bool {
        *error != 0.0
    }
}

/// The expressions with bounds of their rounding, given the value of every symbol; symbols that have
/// none count as 0.
pub fn bounded(graph: &Graph, roots: &[Edge], symbols: &[f64]) -> Vec<Bounded> {
    let mut numbers = Duals {
        numbers: Doubles(symbols),
        slopes: Errors,
    };
    let values = evaluate(graph, roots, &mut numbers).unwrap_or_default();
    let bounded = |(value, error): (Double, f64)| Bounded {
        value: value.to_f64(),
        error,
    };
    values.into_iter().map(bounded).collect()
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
