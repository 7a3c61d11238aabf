//! Shapes of sums, products, quotients and powers, and their values if both operands are known.

use super::infer::Inference;
use super::shape::{Shape, Shaped};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{BinaryOp, Expr, Span};
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};

/// Largest number of multiplications of one matrix product.
pub const LARGEST_PRODUCT: usize = 40 * 40 * 40;
/// Largest number of bits of a known value. Larger values are not computed here; they are reported on evaluation.
const LARGEST_NUMBER: u64 = 20_000;

impl<'a> Inference<'a> {
    /// Returns the shape of a binary operation.
    pub fn binary(
        &mut self,
        op: BinaryOp,
        a: &Shaped,
        b: &Shaped,
        (left, right): (&Expr, &Expr),
        span: Span,
    ) -> Option<Shaped> {
        let found = match op {
            BinaryOp::Add | BinaryOp::Sub => self.sum(op, a, b, span)?,
            BinaryOp::Mul => self.product(a, b, span)?,
            BinaryOp::Div => self.quotient(a, b, left, right)?,
            BinaryOp::Pow => self.power(a, b, left, right)?,
        };
        let size = |number: &BigRational| number.numer().bits().max(number.denom().bits());
        let mut numbers = found.numbers.iter().flatten();
        let fits = numbers.all(|number| size(number) <= LARGEST_NUMBER);
        fits.then_some(found)
    }

    fn sum(&mut self, op: BinaryOp, a: &Shaped, b: &Shaped, span: Span) -> Option<Shaped> {
        if (a.shape, b.shape) == (Shape::Pose, Shape::Pose) {
            return self.error(
                Diagnostic::new(span, "poses cannot be added or subtracted")
                    .help("write `P * Q` to compose poses; positions are `.p`"),
            );
        }
        if a.shape != b.shape {
            let (first, second) = (a.shape.describe(), b.shape.describe());
            let message = match op {
                BinaryOp::Add => format!("cannot add {first} and {second}"),
                _ => format!("cannot subtract {second} from {first}"),
            };
            return self
                .error(Diagnostic::new(span, message).help("both sides need the same shape"));
        }
        let numbers = a.numbers.as_ref().zip(b.numbers.as_ref()).map(|(a, b)| {
            let pairs = a.iter().zip(b);
            pairs
                .map(|(a, b)| if op == BinaryOp::Add { a + b } else { a - b })
                .collect()
        });
        let shape = a.shape;
        Some(Shaped { shape, numbers })
    }

    fn product(&mut self, a: &Shaped, b: &Shaped, span: Span) -> Option<Shaped> {
        use Shape::{Matrix, Pose, Scalar, Vector};
        let scaled = |value: &Shaped, by: &Shaped| match by.as_number() {
            Some(factor) => value.map(|number| number * factor),
            None => Shaped::of(value.shape),
        };
        let shape = match (a.shape, b.shape) {
            (Scalar, Scalar | Vector(_) | Matrix(..)) => return Some(scaled(b, a)),
            (Vector(_) | Matrix(..), Scalar) => return Some(scaled(a, b)),
            (Matrix(rows, columns), Vector(n)) if columns == n => Vector(rows),
            (Matrix(rows, inner), Matrix(n, columns)) if inner == n => {
                if rows * n * columns > LARGEST_PRODUCT {
                    return self.error(
                        Diagnostic::new(span, "this product of matrices is too large to unroll")
                            .help("use smaller matrices, or write out the entries that matter"),
                    );
                }
                Matrix(rows, columns)
            }
            (Pose, Pose) => Pose,
            (Pose, Vector(3)) => Vector(3),
            (first, second) => {
                let help = match (first, second) {
                    (Vector(_), Vector(_)) => "write `dot(a, b)`, `cross(a, b)` or `outer(a, b)`",
                    (Vector(_), Matrix(..)) => "write the matrix first, transposed: `M.T * v`",
                    (Pose, _) | (_, Pose) => {
                        "a pose is multiplied by a pose or, on its right, by a vector of 3"
                    }
                    _ => "the left factor needs as many columns as the right factor has rows",
                };
                let (first, second) = (first.describe(), second.describe());
                let message = format!("cannot multiply {first} by {second}");
                return self.error(Diagnostic::new(span, message).help(help));
            }
        };
        Some(Shaped::of(shape))
    }

    fn quotient(&mut self, a: &Shaped, b: &Shaped, left: &Expr, right: &Expr) -> Option<Shaped> {
        if b.shape != Shape::Scalar {
            let message = format!("cannot divide by {}", b.shape.describe());
            let error = Diagnostic::new(right.span, message);
            return self.error(error.help("divide by a scalar"));
        }
        if a.shape == Shape::Pose {
            let error = Diagnostic::new(left.span, "cannot divide a pose");
            return self.error(error.help("its parts are `.R` and `.p`"));
        }
        match b.as_number() {
            // Division by zero is reported on evaluation.
            Some(divisor) if divisor.is_zero() => None,
            Some(divisor) => Some(a.map(|number| number / divisor)),
            None => Some(Shaped::of(a.shape)),
        }
    }

    fn power(&mut self, a: &Shaped, b: &Shaped, left: &Expr, right: &Expr) -> Option<Shaped> {
        if a.shape != Shape::Scalar {
            let message = format!("cannot raise {} to a power", a.shape.describe());
            let error = Diagnostic::new(left.span, message);
            return self
                .error(error.help("only scalars have powers; write `dot(v, v)` or `M * M`"));
        }
        if b.shape != Shape::Scalar {
            return self.wrong(right.span, "an exponent", "a scalar", b.shape);
        }
        let numbers = a.as_number().zip(b.as_number());
        let found = numbers.and_then(|(base, exponent)| whole_power(base, exponent));
        Some(found.map_or(Shaped::of(Shape::Scalar), Shaped::number))
    }
}

/// Returns a power with a whole exponent, or `None` if the exponent is not whole, the result is too large, or 0 is
/// raised to a negative power.
fn whole_power(base: &BigRational, exponent: &BigRational) -> Option<BigRational> {
    let exponent = Some(exponent).filter(|exponent| exponent.is_integer())?;
    let exponent = exponent.to_integer().to_i32()?;
    let bits = base.numer().bits().max(base.denom().bits());
    let fits = bits.saturating_mul(exponent.unsigned_abs().into()) <= LARGEST_NUMBER;
    if !fits || exponent < 0 && base.is_zero() {
        return None;
    }
    Some(base.pow(exponent))
}
