//! Building expressions in Rust code: numbers, arrays, operators and the functions of the language.

use crate::syntax::ast::{BinaryOp, Choice, Comparison, Expr, ExprKind, Ident, Literal, Span};
use crate::syntax::{number_value, path};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Signed;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Name that stands for a NaN in an expression. No valid description can contain it, so that it is found and reported.
pub const NO_NUMBER: &str = "((0 / 0))";

/// Name that stands for an infinite `f64` in an expression. No valid description can contain it, so that it is found and
/// reported.
pub const INFINITE: &str = "((1 / 0))";

/// Creates an identifier that has no place in a source text.
pub fn ident(name: &str) -> Ident {
    Ident {
        name: path::spelling(name),
        span: Span::NOWHERE,
    }
}

fn expr(kind: ExprKind) -> Expr {
    Expr {
        kind,
        span: Span::NOWHERE,
    }
}

/// Returns the placeholder for a value that is not finite, negated for negative values.
fn not_finite(value: f64) -> Expr {
    let name = if value.is_nan() { NO_NUMBER } else { INFINITE };
    let inner = expr(ExprKind::Name(name.to_string()));
    if value < 0.0 { -inner } else { inner }
}

fn number(number: BigRational) -> Expr {
    let size = expr(ExprKind::Number(number.abs().into()));
    if number.is_negative() { -size } else { size }
}

/// Returns a name as it stands, also one that the parser would not read as one word.
pub fn named(name: &str) -> Expr {
    expr(ExprKind::Name(name.to_string()))
}

/// Returns a decimal that is printed with the digits given: `1.50` and not `1.5`. Returns `None` for a text that is no
/// number of the language, with or without a minus sign.
///
/// ```
/// use hamel_language::expression::spelled;
/// assert_eq!(spelled("-1.50").map(|number| number.to_string()).as_deref(), Some("-1.50"));
/// assert_eq!(spelled("1.50 m"), None);
/// ```
pub fn spelled(text: &str) -> Option<Expr> {
    let digits = text.strip_prefix('-').unwrap_or(text);
    let value = number_value(digits)?;
    let spelling = Some(digits.into());
    let size = expr(ExprKind::Number(Literal { value, spelling }));
    Some(if digits.len() < text.len() {
        -size
    } else {
        size
    })
}

/// Calls a function of the language, such as `sin`, `norm` or `axis_angle`. The reference of the language lists all
/// functions.
///
/// ```
/// use hamel_language::expression::call;
/// use hamel_language::syntax::ast::Expr;
/// let r = Expr::name("r");
/// assert_eq!(call("dot", [r.clone(), r]).to_string(), "dot(r, r)");
/// ```
pub fn call(function: &str, arguments: impl IntoIterator<Item = Expr>) -> Expr {
    let arguments = arguments.into_iter().collect();
    expr(ExprKind::Call(ident(function), arguments))
}

/// Expresses the motion of a frame in the axes of another: `velocity(f, p) in g`. The `motion` is a [`call`].
///
/// ```
/// use hamel_language::expression::{call, in_axes};
/// use hamel_language::syntax::ast::Expr;
/// let hull = Expr::name("hull");
/// let spin = in_axes(call("angular_velocity", [hull]), "hull");
/// assert_eq!(spin.to_string(), "angular_velocity(hull) in hull");
/// ```
pub fn in_axes(motion: Expr, frame: &str) -> Expr {
    expr(ExprKind::InAxes(
        Box::new(motion),
        Box::new(Expr::name(frame)),
    ))
}

/// Builds `if a < b { then } else { otherwise }`. Both values must have the same shape.
///
/// ```
/// use hamel_language::expression::if_less;
/// use hamel_language::syntax::ast::Expr;
/// let z = Expr::name("z");
/// let push = if_less(&z, 0.0, -&z, 0.0);
/// assert_eq!(push.to_string(), "if z < 0 { -z } else { 0 }");
/// ```
pub fn if_less(
    a: impl Into<Expr>,
    b: impl Into<Expr>,
    then: impl Into<Expr>,
    otherwise: impl Into<Expr>,
) -> Expr {
    choice(a, Comparison::Less, b, then, otherwise)
}

/// Builds `if a >= b { then } else { otherwise }` with any comparison. Both values must have the same shape.
pub fn choice(
    a: impl Into<Expr>,
    comparison: Comparison,
    b: impl Into<Expr>,
    then: impl Into<Expr>,
    otherwise: impl Into<Expr>,
) -> Expr {
    expr(ExprKind::If(Box::new(Choice {
        left: a.into(),
        comparison,
        right: b.into(),
        then: then.into(),
        otherwise: otherwise.into(),
    })))
}

/// Builds the expression `sin(a)`, a in rad.
pub fn sin(angle: impl Into<Expr>) -> Expr {
    call("sin", [angle.into()])
}

/// Builds the expression `cos(a)`, a in rad.
pub fn cos(angle: impl Into<Expr>) -> Expr {
    call("cos", [angle.into()])
}

/// Builds the expression `sqrt(a)`, √a.
pub fn sqrt(value: impl Into<Expr>) -> Expr {
    call("sqrt", [value.into()])
}

/// Builds a pose from a rotation matrix, whose columns are the axes, and an origin (m).
pub fn pose(axes: impl Into<Expr>, origin: impl Into<Expr>) -> Expr {
    call("pose", [axes.into(), origin.into()])
}

/// Builds a pose without rotation at `origin` (m).
pub fn shifted(origin: impl Into<Expr>) -> Expr {
    pose(call("identity", [3.into()]), origin)
}

/// Builds the diagonal matrix with these three entries.
pub fn diagonal(entries: [impl Into<Expr>; 3]) -> Expr {
    call("diag", entries.map(Into::into))
}

impl Expr {
    /// Refers to a parameter, a coordinate, a velocity, an input or a frame by name. Indices and parts are allowed, as
    /// in `leg[i + 1].knee`.
    pub fn name(name: &str) -> Expr {
        path::expression(name).unwrap_or_else(|| expr(ExprKind::Name(name.to_string())))
    }

    /// Returns a part: `c` and `s` of a circle, `R` and `p` of a pose, `T` of a matrix.
    pub fn part(&self, name: &str) -> Expr {
        expr(ExprKind::Field(Box::new(self.clone()), ident(name)))
    }

    /// Returns an entry of a vector. Indices start at 1, as in the paper.
    pub fn entry(&self, index: impl Into<Expr>) -> Expr {
        let index = vec![index.into()];
        expr(ExprKind::Index(Box::new(self.clone()), index))
    }

    /// Returns an entry of a matrix by row and column, both counted from 1.
    pub fn element(&self, row: impl Into<Expr>, column: impl Into<Expr>) -> Expr {
        let indices = vec![row.into(), column.into()];
        expr(ExprKind::Index(Box::new(self.clone()), indices))
    }

    /// Returns a power. The exponent is a whole number or a quotient of two.
    pub fn pow(&self, exponent: impl Into<Expr>) -> Expr {
        binary(BinaryOp::Pow, self.clone(), exponent.into())
    }
}

/// Prints the expression in the syntax of the language.
impl std::fmt::Display for Expr {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&crate::syntax::written::written(self))
    }
}

impl From<&Expr> for Expr {
    fn from(expr: &Expr) -> Expr {
        expr.clone()
    }
}

/// Converts a number to exactly the decimal that `{}` prints: 0.1 becomes 1/10. A number that is not finite becomes a
/// name that no text can contain, so that a scene with it is refused when it is built.
impl From<f64> for Expr {
    fn from(value: f64) -> Expr {
        if !value.is_finite() {
            return not_finite(value);
        }
        number(decimal(value).unwrap_or_else(|| BigRational::from_integer(0.into())))
    }
}

/// Returns the shortest decimal that rounds to a finite number.
fn decimal(value: f64) -> Option<BigRational> {
    let text = format!("{value:e}");
    let (mantissa, exponent) = text.split_once('e')?;
    let exponent: i32 = exponent.parse().ok()?;
    let (whole, places) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: BigInt = format!("{whole}{places}").parse().ok()?;
    let power = exponent - places.len() as i32;
    let scale = BigInt::from(10).pow(power.unsigned_abs());
    Some(if power < 0 {
        BigRational::new(digits, scale)
    } else {
        BigRational::from_integer(digits * scale)
    })
}

impl From<i32> for Expr {
    fn from(value: i32) -> Expr {
        number(BigRational::from_integer(value.into()))
    }
}

/// A vector, or a matrix by rows.
impl<T: Into<Expr>, const N: usize> From<[T; N]> for Expr {
    fn from(entries: [T; N]) -> Expr {
        expr(ExprKind::Array(entries.map(Into::into).into()))
    }
}

/// A vector, or a matrix by rows.
impl<T: Into<Expr>> From<Vec<T>> for Expr {
    fn from(entries: Vec<T>) -> Expr {
        let entries = entries.into_iter().map(Into::into);
        expr(ExprKind::Array(entries.collect()))
    }
}

fn binary(op: BinaryOp, left: Expr, right: Expr) -> Expr {
    expr(ExprKind::Binary(op, Box::new(left), Box::new(right)))
}

macro_rules! operators {
    ($($operator:ident $method:ident $op:ident),*) => {$(
        impl<R: Into<Expr>> $operator<R> for Expr {
            type Output = Expr;
            fn $method(self, right: R) -> Expr {
                binary(BinaryOp::$op, self, right.into())
            }
        }

        impl<R: Into<Expr>> $operator<R> for &Expr {
            type Output = Expr;
            fn $method(self, right: R) -> Expr {
                binary(BinaryOp::$op, self.clone(), right.into())
            }
        }

        operators!(@left $operator $method $op f64 i32);
    )*};
    (@left $operator:ident $method:ident $op:ident $($number:ty)*) => {$(
        impl $operator<Expr> for $number {
            type Output = Expr;
            fn $method(self, right: Expr) -> Expr {
                binary(BinaryOp::$op, self.into(), right)
            }
        }

        impl $operator<&Expr> for $number {
            type Output = Expr;
            fn $method(self, right: &Expr) -> Expr {
                binary(BinaryOp::$op, self.into(), right.clone())
            }
        }
    )*};
}

operators!(Add add Add, Sub sub Sub, Mul mul Mul, Div div Div);

impl Neg for Expr {
    type Output = Expr;
    fn neg(self) -> Expr {
        expr(ExprKind::Neg(Box::new(self)))
    }
}

impl Neg for &Expr {
    type Output = Expr;
    fn neg(self) -> Expr {
        -self.clone()
    }
}
