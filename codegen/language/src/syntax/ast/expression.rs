//! Expressions of the syntax tree.

use super::{Ident, Quantity, Span};
use num_rational::BigRational;

/// An expression with its source position.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// Form of the expression, with its operands.
    pub kind: ExprKind,
    /// Position in the source.
    pub span: Span,
}

/// A number of a description.
///
/// Literals are equal if their values are.
#[derive(Clone, Debug)]
pub struct Literal {
    /// The exact value.
    pub value: BigRational,
    /// Digits to print, where those of another file are to be kept: `1.50` and not `1.5`.
    pub spelling: Option<Box<str>>,
}

impl From<BigRational> for Literal {
    fn from(value: BigRational) -> Literal {
        let spelling = None;
        Literal { value, spelling }
    }
}

impl PartialEq for Literal {
    fn eq(&self, other: &Literal) -> bool {
        self.value == other.value
    }
}

/// The forms of an expression.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// A decimal literal, exact.
    Number(Literal),
    /// `250 [mm]`
    Quantity(Box<Quantity>),
    /// A name.
    Name(String),
    /// `q.c`, `X.R`, `M.T`.
    Field(Box<Expr>, Ident),
    /// `v[i]`, `M[i, j]`; indices start at 1, as in the paper.
    Index(Box<Expr>, Vec<Expr>),
    /// `f(a, b)`.
    Call(Ident, Vec<Expr>),
    /// `velocity(f, p) in g`: the result of a call, expressed in the axes of a frame.
    InAxes(Box<Expr>, Box<Expr>),
    /// `-a`.
    Neg(Box<Expr>),
    /// `a op b`.
    Binary(BinaryOp, Box<Expr>, Box<Expr>),
    /// `if a < b { c } else { d }`
    If(Box<Choice>),
    /// `[a, b, c]`; an array of arrays is a matrix by rows.
    Array(Vec<Expr>),
}

/// Binary operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOp {
    /// `+`
    Add,
    /// `-`
    Sub,
    /// `*`
    Mul,
    /// `/`
    Div,
    /// `^`, integer or rational exponent
    Pow,
}

/// `if left < right { then } else { otherwise }`
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Left side of the comparison.
    pub left: Expr,
    /// Comparison operator.
    pub comparison: Comparison,
    /// Right side of the comparison.
    pub right: Expr,
    /// Value if the comparison holds.
    pub then: Expr,
    /// Value otherwise.
    pub otherwise: Expr,
}

/// Comparisons of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// `<`
    Less,
    /// `<=`
    AtMost,
    /// `>`
    Greater,
    /// `>=`
    AtLeast,
}

impl Comparison {
    /// Returns the operator as it is written, such as `<=`.
    pub fn sign(self) -> &'static str {
        match self {
            Comparison::Less => "<",
            Comparison::AtMost => "<=",
            Comparison::Greater => ">",
            Comparison::AtLeast => ">=",
        }
    }
}

impl Expr {
    /// Returns the direct subexpressions, in the order of the text.
    pub fn parts(&self) -> Vec<&Expr> {
        match &self.kind {
            ExprKind::Number(_) | ExprKind::Name(_) => Vec::new(),
            ExprKind::Quantity(quantity) => vec![&quantity.value],
            ExprKind::Field(base, _) | ExprKind::Neg(base) => vec![base],
            ExprKind::Index(base, list) => [&**base].into_iter().chain(list).collect(),
            ExprKind::Call(_, list) | ExprKind::Array(list) => list.iter().collect(),
            ExprKind::Binary(_, left, right) | ExprKind::InAxes(left, right) => vec![left, right],
            ExprKind::If(choice) => {
                let Choice {
                    left,
                    comparison: _,
                    right,
                    then,
                    otherwise,
                } = &**choice;
                vec![left, right, then, otherwise]
            }
        }
    }
}
