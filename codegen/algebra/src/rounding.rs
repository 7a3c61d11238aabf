//! Rounding errors of expressions: values in `f64` with values in double-double precision, and error
//! bounds.
//!
//! With unit roundoff u = 2^-53, a node that is computed in `f64` from children with errors e_a, e_b has,
//! up to terms of second order, an error of at most
//!
//! | node | bound |
//! |---|---|
//! | a ± b | e_a + e_b + u \|a ± b\| |
//! | a b | \|a\| e_b + \|b\| e_a + u \|a b\| |
//! | a / b | (e_a + \|a/b\| e_b) / \|b\| + u \|a/b\| |
//! | f(a) | \|f'(a)\| e_a + u \|f(a)\| |
//! | a where c > 0, else b | e_a or e_b |

use super::double::Double;
use super::dual::{Duals, Partial, Slopes};
use super::external;
use super::graph::{Edge, Graph};
use super::numbers::{Arithmetic, Step};
use super::numeric::Floats;
use super::walk::evaluate;

/// Unit roundoff of `f64`.
pub const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Value of an expression computed in `f64` from start to end, with its accurate value.
#[derive(Clone, Copy, Debug)]
pub struct RoundedValue {
    /// Value that a program in `f64` computes.
    pub rounded: f64,
    /// Value in double-double precision.
    pub exact: Double,
}

impl RoundedValue {
    /// Returns the distance between the two values.
    pub fn rounding_error(&self) -> f64 {
        (Double::new(self.rounded) - self.exact).abs().to_f64()
    }
}

/// Double-double arithmetic, with the values of all symbols except π, which is symbol 0. Symbols without a
/// value count as 0.
struct Doubles<'a>(&'a [f64]);

impl Arithmetic for Doubles<'_> {
    type Number = Double;

    fn make(&mut self, step: Step<Double>) -> Option<Double> {
        Some(match step {
            Step::Whole(value) => Double::new(value.into()),
            Step::Constant(value) => Double::of_rational(value),
            Step::Symbol(0) => Double::PI,
            Step::Symbol(index) => Double::new(self.0.get(index).copied().unwrap_or(0.0)),
            Step::Neg(a) => -*a,
            Step::Add(a, b) => *a + *b,
            Step::Sub(a, b) => *a - *b,
            Step::Mul(a, b) => *a * *b,
            Step::Div(a, b) => *a / *b,
            Step::Apply(function, a, _) => (function.row().double)(*a),
            Step::Atan2(y, x) => y.atan2(*x),
            Step::Select(c, a, b) => match self.is_positive(c) {
                Some(true) => *a,
                Some(false) => *b,
                None => *c,
            },
            // A stand-in for the external function, which is not known; its own rounding errors are not of
            // interest.
            Step::Listed(rest, a) => *rest * Double::new(external::STAND_IN_WEIGHT) + *a,
            Step::External(component, list, _) => {
                let [constant, factor] = component.stand_in().map(Double::new);
                *list * factor + constant
            }
        })
    }

    fn is_positive(&self, a: &Double) -> Option<bool> {
        let value = a.to_f64();
        (!value.is_nan()).then_some(value > 0.0)
    }
}

/// Arithmetic in `f64` and in double-double precision at once. Functions in `f64` are rounded to the
/// nearest number, so that they are the same on every machine.
struct RoundedAndExact<'a>(Doubles<'a>);

impl Arithmetic for RoundedAndExact<'_> {
    type Number = RoundedValue;

    fn make(&mut self, step: Step<RoundedValue>) -> Option<RoundedValue> {
        let long = |a: &RoundedValue| Double::new(a.rounded);
        let nearest = |exact: Double| (exact.to_f64(), exact);
        let (rounded, exact) = match step {
            Step::Whole(value) => (value.into(), Double::new(value.into())),
            Step::Constant(value) => nearest(self.0.make(Step::Constant(value))?),
            Step::Symbol(index) => nearest(self.0.make(Step::Symbol(index))?),
            Step::Neg(a) => (-a.rounded, -a.exact),
            Step::Add(a, b) => (a.rounded + b.rounded, a.exact + b.exact),
            Step::Sub(a, b) => (a.rounded - b.rounded, a.exact - b.exact),
            Step::Mul(a, b) => (a.rounded * b.rounded, a.exact * b.exact),
            Step::Div(a, b) => (a.rounded / b.rounded, a.exact / b.exact),
            Step::Apply(function, a, _) => {
                let of = function.row().double;
                (of(long(a)).to_f64(), of(a.exact))
            }
            Step::Atan2(y, x) => (long(y).atan2(long(x)).to_f64(), y.exact.atan2(x.exact)),
            Step::Select(c, a, b) => {
                let rounded = Step::Select(&c.rounded, &a.rounded, &b.rounded);
                let exact = Step::Select(&c.exact, &a.exact, &b.exact);
                (Floats(&[]).make(rounded)?, self.0.make(exact)?)
            }
            Step::Listed(rest, a) => {
                let of =
                    |rest: Double, a: Double| rest * Double::new(external::STAND_IN_WEIGHT) + a;
                let rounded = of(long(rest), long(a)).to_f64();
                (rounded, of(rest.exact, a.exact))
            }
            Step::External(component, list, _) => {
                let [constant, factor] = component.stand_in().map(Double::new);
                let of = |list: Double| list * factor + constant;
                (of(long(list)).to_f64(), of(list.exact))
            }
        };
        Some(RoundedValue { rounded, exact })
    }
}

/// Evaluates the expressions in `f64` and in double-double precision, given the values of all symbols
/// except π.
pub fn evaluate_rounded(graph: &Graph, roots: &[Edge], symbols: &[f64]) -> Vec<RoundedValue> {
    evaluate(graph, roots, &mut RoundedAndExact(Doubles(symbols))).unwrap_or_default()
}

/// A value with a bound of its rounding error in `f64`.
#[derive(Clone, Copy, Debug)]
pub struct BoundedValue {
    /// The value.
    pub value: f64,
    /// Bound of the error of a program in `f64`.
    pub error: f64,
}

/// Error bounds in place of slopes: Σ |∂f/∂a| eₐ, plus u |f| if f itself is rounded.
struct ErrorBounds;

impl Slopes<Doubles<'_>> for ErrorBounds {
    type Slope = f64;

    /// Values of symbols are exact in `f64`, except that of π.
    fn symbol(&mut self, _: &mut Doubles, index: usize) -> f64 {
        if index == 0 {
            UNIT_ROUNDOFF * Double::PI.to_f64()
        } else {
            0.0
        }
    }

    fn combine(
        &mut self,
        _: &mut Doubles,
        value: &Double,
        parts: &[(Partial<Double>, &f64)],
    ) -> Option<f64> {
        let size = |value: &Double| value.abs().to_f64();
        let part = |(partial, error): &(Partial<Double>, &f64)| match partial {
            Partial::One | Partial::MinusOne => **error,
            Partial::Factor(factor) => size(factor) * **error,
        };
        let inherited: f64 = parts.iter().map(part).sum();
        let is_exact = inherited == 0.0 && *value == Double::new(value.to_f64());
        let is_exact = is_exact || matches!(parts, [(Partial::MinusOne, _)]);
        Some(if is_exact {
            inherited
        } else {
            inherited + UNIT_ROUNDOFF * size(value)
        })
    }

    fn is_nonzero(&self, _: &Doubles, error: &f64) -> bool {
        *error != 0.0
    }
}

/// Evaluates the expressions with bounds of their rounding errors, given the value of every symbol. Symbols
/// without a value count as 0.
pub fn evaluate_with_bounds(graph: &Graph, roots: &[Edge], symbols: &[f64]) -> Vec<BoundedValue> {
    let mut numbers = Duals {
        numbers: Doubles(symbols),
        slopes: ErrorBounds,
    };
    let values = evaluate(graph, roots, &mut numbers).unwrap_or_default();
    let bounded = |(value, error): (Double, f64)| BoundedValue {
        value: value.to_f64(),
        error,
    };
    values.into_iter().map(bounded).collect()
}
