//! Numbers with units in the syntax tree.

use super::{BinaryOp, Expr, ExprKind, Span};
use crate::units::Unit;
use num_bigint::BigInt;
use num_rational::BigRational;

/// `250 [mm]`: a number with its unit, or the value of a declaration with its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// The number as it was written; in a declaration, an expression of numbers.
    pub number: Expr,
    /// The unit.
    pub unit: Unit,
    /// The value in SI.
    pub value: Expr,
}

impl Quantity {
    /// Creates a quantity, and converts its number to SI exactly.
    pub fn of(number: Expr, unit: Unit) -> Self {
        let value = scaled(&number, &unit);
        Quantity {
            number,
            unit,
            value,
        }
    }
}

/// Returns a value of numbers in SI. A power of π in the factor stays an expression, since it has no exact value.
fn scaled(value: &Expr, unit: &Unit) -> Expr {
    let span = value.span;
    let all = |list: &[Expr]| list.iter().map(|entry| scaled(entry, unit)).collect();
    let kind = match &value.kind {
        ExprKind::Number(number) => return times_pi(&number.value * &unit.factor, unit.pi, span),
        ExprKind::Array(list) => ExprKind::Array(all(list)),
        ExprKind::Neg(inner) => ExprKind::Neg(Box::new(scaled(inner, unit))),
        _ => {
            let factor = times_pi(unit.factor.clone(), unit.pi, span);
            ExprKind::Binary(BinaryOp::Mul, Box::new(value.clone()), Box::new(factor))
        }
    };
    Expr { kind, span }
}

/// Returns a number times a power of π.
fn times_pi(number: BigRational, power: i32, span: Span) -> Expr {
    let expr = |kind| Expr { kind, span };
    let number = expr(ExprKind::Number(number.into()));
    if power == 0 {
        return number;
    }
    let exponent = BigRational::from_integer(BigInt::from(power.unsigned_abs()));
    let exponent = Box::new(expr(ExprKind::Number(exponent.into())));
    let pi = Box::new(expr(ExprKind::Name("pi".into())));
    let pi = match power.unsigned_abs() {
        1 => pi,
        _ => Box::new(expr(ExprKind::Binary(BinaryOp::Pow, pi, exponent))),
    };
    let op = if power > 0 {
        BinaryOp::Mul
    } else {
        BinaryOp::Div
    };
    expr(ExprKind::Binary(op, Box::new(number), pi))
}
