//! Evaluation of whole numbers that must be known during expansion: ranges and indices.

use super::names::{Context, Expansion, Found};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{BinaryOp, Expr, ExprKind, Span};
use crate::syntax::path::Step;
use crate::units::Unit;
use num_rational::BigRational;
use num_traits::{One, ToPrimitive, Zero};

/// Largest length of a chain of constants that refer to one another.
const MOST_LEVELS: usize = 100;

/// Largest number of bits of a numerator or denominator. Larger numbers are not sensible ranges.
const MOST_BITS: u64 = 4096;

/// Largest magnitude of an exponent.
const MOST_EXPONENT: i32 = 1000;

impl Expansion<'_> {
    /// Evaluates the indices of a name, which must be whole numbers from 0.
    pub fn indices(&self, list: &[Expr], context: &Context) -> Result<Vec<i64>, Diagnostic> {
        let one = |index: &Expr| {
            let value = self.integer(index, context, 0)?;
            match value >= 0 {
                true => Ok(value),
                false => Err(
                    Diagnostic::new(index.span, format!("the index {value} is negative"))
                        .help("indices start at 0 or 1: begin the range of the counter later"),
                ),
            }
        };
        list.iter().map(one).collect()
    }

    /// Evaluates an expression to a whole number. In errors, its places are moved by `by`.
    pub fn integer(&self, expr: &Expr, context: &Context, by: usize) -> Result<i64, Diagnostic> {
        let value = self.number(expr, context, by, 0)?;
        let whole = value.is_integer().then(|| value.to_integer().to_i64());
        whole.flatten().ok_or_else(|| {
            let error = Diagnostic::new(
                expr.span.later(by),
                format!("{value} is not a 64-bit whole number"),
            );
            error.help("ranges and indices are whole numbers")
        })
    }

    fn number(
        &self,
        expr: &Expr,
        context: &Context,
        by: usize,
        level: usize,
    ) -> Result<BigRational, Diagnostic> {
        let span = expr.span.later(by);
        if level > MOST_LEVELS {
            let error = Diagnostic::new(span, "this number depends on too many others");
            return Err(error.help("a constant must not depend on itself"));
        }
        let value = match &expr.kind {
            ExprKind::Number(number) => number.value.clone(),
            ExprKind::Neg(inner) => -self.number(inner, context, by, level)?,
            ExprKind::Binary(op, left, right) => {
                let left = self.number(left, context, by, level)?;
                let right = self.number(right, context, by, level)?;
                computed(*op, left, right).ok_or_else(|| {
                    let error = Diagnostic::new(span, "this has no value");
                    error.help("ranges and indices are whole numbers")
                })?
            }
            ExprKind::Name(name) => self.named(name, span, context, level)?,
            _ => return Err(not_known(span, "this")),
        };
        match value.numer().bits().max(value.denom().bits()) <= MOST_BITS {
            true => Ok(value),
            false => {
                let error =
                    Diagnostic::new(span, "this number is too large for a range or an index");
                Err(error.help("ranges and indices are small whole numbers"))
            }
        }
    }

    fn named(
        &self,
        name: &str,
        span: Span,
        context: &Context,
        level: usize,
    ) -> Result<BigRational, Diagnostic> {
        match self.find(&[Step::Name(name.to_owned())], span, context)? {
            Found::Number(value) => return Ok(BigRational::from_integer(value.into())),
            Found::Parameter(scope, parameter, binding) => {
                self.mention(scope, parameter);
                let (value, context) = (binding.value, &binding.context);
                return self.number(value, context, context.by, level + 1);
            }
            Found::Unknown | Found::Thing(..) => {}
        }
        let scopes = [context.scope, 0].map(|scope| &self.scopes[scope]);
        let constant = scopes
            .iter()
            .find_map(|scope| Some((scope, scope.constants.get(name)?)));
        let Some((scope, (value, context))) = constant else {
            return Err(not_known(span, &format!("`{name}`")));
        };
        let used = format!("{}{name}", scope.prefix);
        self.used.borrow_mut().insert(used);
        self.number(value, context, context.by, level + 1)
    }

    /// Records that a parameter of a component is used.
    pub fn mention(&self, scope: usize, parameter: &str) {
        if let Some((component, _)) = self.scopes[scope].part {
            let name = component.name.name.clone();
            self.parameters
                .borrow_mut()
                .insert((name, parameter.to_owned()));
        }
    }
}

fn not_known(span: Span, what: &str) -> Diagnostic {
    let message = format!("{what} is not a number that is known when the description is read");
    let unit = what.trim_matches('`');
    Diagnostic::new(span, message).help(match Unit::named(unit) {
        Some(_) => {
            format!("an index is a whole number; a unit stands after a colon: `q: [{unit}]`")
        }
        None => {
            "ranges and indices are made of numbers, counters and constants: write `const n = 8;`"
                .into()
        }
    })
}

fn computed(op: BinaryOp, left: BigRational, right: BigRational) -> Option<BigRational> {
    Some(match op {
        BinaryOp::Add => left + right,
        BinaryOp::Sub => left - right,
        BinaryOp::Mul => left * right,
        BinaryOp::Div if right.is_zero() => return None,
        BinaryOp::Div => left / right,
        BinaryOp::Pow => {
            let exponent = right.is_integer().then(|| right.to_integer().to_i32())??;
            let bits = left.numer().bits().max(left.denom().bits());
            let size = bits.checked_mul(exponent.unsigned_abs().into())?;
            if exponent.abs() > MOST_EXPONENT || size > MOST_BITS {
                return None;
            }
            if exponent.is_negative() && left.is_zero() {
                return None;
            }
            (0..exponent.abs())
                .map(|_| match exponent.is_negative() {
                    true => left.recip(),
                    false => left.clone(),
                })
                .fold(BigRational::one(), |product, factor| product * factor)
        }
    })
}
