//! Sums, products, quotients and powers of shaped values.

use super::expression::Evaluator;
use super::functions;
use crate::algebra::graph::{Edge, Function, Node};
use crate::algebra::linear::{add3, apply3, multiply, multiply3};
use crate::diagnostics::Diagnostic;
use crate::model::value::Value;
use crate::shapes::LARGEST_PRODUCT;
use crate::syntax::ast::{BinaryOp, Expr, Span};
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// Largest size in bits of an exact number.
const LARGEST_NUMBER: u64 = 20_000;
/// Largest power of two of a number, so that floating point can hold it.
const LARGEST_POWER: u64 = 1023;
/// Largest size of an exponent.
const LARGEST_EXPONENT: u64 = 1000;

impl Evaluator<'_> {
    pub(super) fn binary(
        &mut self,
        op: BinaryOp,
        a: Value,
        b: Value,
        left: &Expr,
        right: &Expr,
        span: Span,
    ) -> Option<Value> {
        let result = match op {
            BinaryOp::Add | BinaryOp::Sub => self.sum(op, &a, &b)?,
            BinaryOp::Mul => self.product(&a, &b)?,
            BinaryOp::Div => {
                let divisor = b.as_scalar()?;
                if matches!(a, Value::Pose(..)) {
                    return None;
                }
                let graph = &mut *self.graph;
                let mut whole = divisor != graph.zero();
                let quotient = a.map(|edge| {
                    graph.div(edge, divisor).unwrap_or_else(|| {
                        whole = false;
                        edge
                    })
                });
                if !whole {
                    return self.zero_divisor(right.span);
                }
                quotient
            }
            BinaryOp::Pow => self.power(a, b, left, right)?,
        };
        self.bounded(result, span)
    }

    fn zero_divisor<T>(&mut self, span: Span) -> Option<T> {
        self.error(
            Diagnostic::new(span, "division by an expression that is identically zero")
                .help("this is 0 for every configuration that satisfies the constraints"),
        )
    }

    fn sum(&mut self, op: BinaryOp, a: &Value, b: &Value) -> Option<Value> {
        if !a.same_shape(b) || matches!(a, Value::Pose(..)) {
            return None;
        }
        let graph = &mut *self.graph;
        Some(if op == BinaryOp::Add {
            a.zip(b, |x, y| graph.add(x, y))
        } else {
            a.zip(b, |x, y| graph.sub(x, y))
        })
    }

    /// Returns the value, unless one of its numbers has become too large or too long.
    pub(super) fn bounded(&mut self, value: Value, span: Span) -> Option<Value> {
        for edge in value.entries() {
            let Some(number) = self.graph.as_rational(edge) else {
                continue;
            };
            let (n, d) = (number.numer().bits(), number.denom().bits());
            if n > d + LARGEST_POWER {
                return self.error(
                    Diagnostic::new(span, "this number is too large for floating point")
                        .help("choose other units"),
                );
            }
            if n.max(d) > LARGEST_NUMBER {
                return self.error(
                    Diagnostic::new(span, "this number has too many digits")
                        .help("round the numbers that it is made of"),
                );
            }
        }
        Some(value)
    }

    fn product(&mut self, a: &Value, b: &Value) -> Option<Value> {
        let graph = &mut *self.graph;
        let columns = |m: &[Vec<Edge>]| m.first().map_or(0, Vec::len);
        Some(match (a, b) {
            (Value::Scalar(k), Value::Scalar(_) | Value::Vector(_) | Value::Matrix(_)) => {
                b.map(|edge| graph.mul(*k, edge))
            }
            (Value::Vector(_) | Value::Matrix(_), Value::Scalar(k)) => {
                a.map(|edge| graph.mul(edge, *k))
            }
            (Value::Matrix(m), Value::Vector(v)) if columns(m) == v.len() => {
                Value::Vector(m.iter().map(|row| graph.dot(row, v)).collect())
            }
            (Value::Matrix(m), Value::Matrix(n)) if columns(m) == n.len() => {
                if m.len() * n.len() * columns(n) > LARGEST_PRODUCT {
                    return None;
                }
                Value::Matrix(multiply(graph, m, n))
            }
            (Value::Pose(r, p), Value::Pose(r2, p2)) => {
                let moved = apply3(graph, r, *p2);
                Value::Pose(multiply3(graph, r, r2), add3(graph, *p, moved))
            }
            (Value::Pose(r, p), Value::Vector(_)) if b.as_vec3().is_some() => {
                let moved = apply3(graph, r, b.as_vec3()?);
                Value::Vector(add3(graph, *p, moved).to_vec())
            }
            _ => return None,
        })
    }

    /// Returns aʳ for an r that is not an integer: aᵏ √a, or aᵏ exp(f log a) with 0 < f < 1, so that as many
    /// derivatives as possible are finite at a = 0. For a choice between an expression and a number, such as
    /// max(a, 0), it takes the power of each branch. Returns `None` on division by 0.
    fn fractional_power(&mut self, base: Edge, exponent: &BigRational) -> Option<Edge> {
        let graph = &mut *self.graph;
        if base == graph.one() {
            return Some(base);
        }
        if let Node::Select(c, a, b) = graph.node(base.node()) {
            let [a, b] = [a, b].map(|branch| branch.signed(base.is_negative()));
            let is_base = |number: &BigRational| {
                number.is_positive() || number.is_zero() && exponent.is_positive()
            };
            let numbers = [a, b].map(|branch| graph.as_rational(branch));
            if numbers.iter().flatten().count() == 1 && numbers.iter().flatten().all(is_base) {
                let a = self.fractional_power(a, exponent)?;
                let b = self.fractional_power(b, exponent)?;
                return Some(self.graph.select(c, a, b));
            }
        }
        if base == graph.zero() {
            return Some(base);
        }
        let twice = exponent + exponent;
        if twice.is_integer() {
            let root = functions::root(graph, base);
            return graph.powi(root, twice.to_integer().to_i64()?);
        }
        // A power of a norm is written as a power of its square.
        let half = exponent / BigRational::from_integer(2.into());
        if let (Node::Apply(Function::Sqrt | Function::Norm, square), false, true) = (
            graph.node(base.node()),
            base.is_negative(),
            half > BigRational::one(),
        ) {
            return self.fractional_power(square, &half);
        }
        let below = match exponent.is_negative() {
            true => BigRational::zero(),
            false => exponent.floor(),
        };
        let factor = graph.rational(&(exponent - &below));
        let log = graph.apply(Function::Log, base);
        let product = graph.mul(factor, log);
        let rest = graph.apply(Function::Exp, product);
        let power = graph.powi(base, below.to_integer().to_i64()?)?;
        Some(graph.mul(power, rest))
    }

    fn power(&mut self, a: Value, b: Value, left: &Expr, right: &Expr) -> Option<Value> {
        let (base, exponent) = (a.as_scalar()?, b.as_scalar()?);
        let Some(exponent) = self.graph.as_rational(exponent) else {
            return self.error(
                Diagnostic::new(
                    right.span,
                    "an exponent has to be a rational number known at build time",
                )
                .help("for other powers write `exp(b * log(a))`"),
            );
        };
        let limit = BigRational::from_integer(LARGEST_EXPONENT.into());
        if exponent.abs() > limit {
            return self.error(
                Diagnostic::new(right.span, "this exponent is too large")
                    .help(format!("the largest exponent is {LARGEST_EXPONENT}")),
            );
        }
        if base == self.graph.zero() {
            if exponent.is_negative() {
                return self.error(
                    Diagnostic::new(
                        left.span,
                        "division by an expression that is identically zero",
                    )
                    .help("a negative power of 0 has no value"),
                );
            }
            let zero = !exponent.is_zero();
            return Some(Value::Scalar(if zero { base } else { self.graph.one() }));
        }
        let whole = |n: &BigRational| n.is_integer().then(|| n.to_integer().to_i64()).flatten();
        let number = self.graph.as_rational(base);
        if number.as_ref().is_some_and(Signed::is_negative) && !exponent.is_integer() {
            return self.error(
                Diagnostic::new(left.span, "a fractional power of a negative number")
                    .help("check the sign of the base, and put parentheses: `-(a^b)`"),
            );
        }
        let result = if let Some(n) = whole(&exponent) {
            let bits = number.map_or(0, |n| n.numer().bits().max(n.denom().bits()));
            if bits.saturating_mul(n.unsigned_abs()) > 2 * LARGEST_NUMBER {
                let error = Diagnostic::new(left.span, "this power has too many digits");
                return self.error(error.help("round the numbers that it is made of"));
            }
            self.graph.powi(base, n)
        } else {
            self.fractional_power(base, &exponent)
        };
        match result {
            Some(result) => Some(Value::Scalar(result)),
            None => self.zero_divisor(left.span),
        }
    }
}
