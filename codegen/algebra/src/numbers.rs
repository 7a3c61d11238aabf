//! Arithmetic in numbers of any kind, in which `walk::evaluate` computes the values of nodes.
//!
//! A kind of numbers is an implementation of [`Arithmetic`], which knows the values of the symbols at a point:
//!
//! | numbers | implementation |
//! |---|---|
//! | `f64` | `numeric::Floats` |
//! | F_p(i) × F_q(i) | `field_point::FieldPoint` |
//! | with slopes along one direction or many, or with a record for reverse mode | `dual::Duals` over others |
//! | double-double with or without `f64`, with bounds of rounding errors | `rounding` |
//! | real samples, certified bounds | `real_enclosure` |

use super::external::Component;
use super::function::{Function, Slope};
use super::node::{Edge, Node};
use super::residue_pair::ResiduePair;
use num_rational::BigRational;
use std::borrow::Cow;

/// Linear form Σ coefficient · atom of `Graph::form`, with the values of its atoms.
pub type Form<N> = Vec<(N, BigRational)>;

/// Function that computes a form on demand.
pub type LazyForm<'a, N> = &'a dyn Fn() -> Form<N>;

/// An operation on numbers.
pub enum Step<'a, N> {
    /// A small whole number.
    Whole(i32),
    /// A rational.
    Constant(&'a BigRational),
    /// The value of a symbol.
    Symbol(usize),
    /// −a.
    Neg(&'a N),
    /// a + b.
    Add(&'a N, &'a N),
    /// a − b.
    Sub(&'a N, &'a N),
    /// a b.
    Mul(&'a N, &'a N),
    /// a / b.
    Div(&'a N, &'a N),
    /// A function of one argument.
    Apply(Function, &'a N, LazyForm<'a, N>),
    /// The angle of (x, y), arguments (y, x).
    Atan2(&'a N, &'a N),
    /// (c, a, b): a where c > 0, else b.
    Select(&'a N, &'a N, &'a N),
    /// Number that stands for a list, from that of the earlier entries, and the last entry.
    Listed(&'a N, &'a N),
    /// A component of an external function, applied to a list. In place of a form, it has the numbers in
    /// the list, each with its sign.
    External(Component, &'a N, LazyForm<'a, N>),
}

/// Arithmetic at a point.
pub trait Arithmetic {
    /// Type of the numbers.
    type Number: Clone;

    /// Executes a step; `None` if there is no such number.
    fn make(&mut self, step: Step<Self::Number>) -> Option<Self::Number>;

    /// Whether a number is certainly 0.
    fn is_zero(&self, _: &Self::Number) -> bool {
        false
    }

    /// Whether a number is positive; `None` if that is not known.
    fn is_positive(&self, _: &Self::Number) -> Option<bool> {
        None
    }

    /// Returns a/b and its derivatives by a and b: 1/b and −(a/b)/b.
    fn quotient(&mut self, a: &Self::Number, b: &Self::Number) -> Option<[Self::Number; 3]> {
        let one = self.make(Step::Whole(1))?;
        let (quotient, by_a) = (self.make(Step::Div(a, b))?, self.make(Step::Div(&one, b))?);
        let minus = self.make(Step::Neg(&quotient))?;
        let by_b = self.make(Step::Div(&minus, b))?;
        Some([quotient, by_a, by_b])
    }

    /// Returns the derivative f′(a) of a function, given a and f(a).
    fn slope(
        &mut self,
        function: Function,
        (a, value): (&Self::Number, &Self::Number),
        form: LazyForm<Self::Number>,
    ) -> Option<Self::Number> {
        match function.row().slope {
            Slope::FunctionOfArgument(other) => self.make(Step::Apply(other, a, form)),
            Slope::MinusFunctionOfArgument(other) => {
                let value = self.make(Step::Apply(other, a, form))?;
                self.make(Step::Neg(&value))
            }
            Slope::OwnValue => Some(value.clone()),
            Slope::InversePolynomial(coefficients) => {
                let mut divisor = self.make(Step::Whole(0))?;
                for &coefficient in coefficients.iter().rev() {
                    let product = self.make(Step::Mul(&divisor, a))?;
                    let coefficient = self.make(Step::Whole(coefficient))?;
                    divisor = self.make(Step::Add(&product, &coefficient))?;
                }
                let one = self.make(Step::Whole(1))?;
                self.make(Step::Div(&one, &divisor))
            }
            Slope::HalfInverseOfValue => {
                let (one, twice) = (
                    self.make(Step::Whole(1))?,
                    self.make(Step::Add(value, value))?,
                );
                self.make(Step::Div(&one, &twice))
            }
            Slope::HalfFunctionOfValue(other) => {
                let twice = self.make(Step::Whole(2))?;
                let inverse = self.make(Step::Apply(other, value, form))?;
                self.make(Step::Div(&inverse, &twice))
            }
            Slope::MinusSquareOfValue => {
                let square = self.make(Step::Mul(value, value))?;
                self.make(Step::Neg(&square))
            }
            Slope::OneMinusSquareOfValue => {
                let (one, square) = (
                    self.make(Step::Whole(1))?,
                    self.make(Step::Mul(value, value))?,
                );
                self.make(Step::Sub(&one, &square))
            }
            Slope::ValueAtOne => {
                let one = self.make(Step::Whole(1))?;
                self.make(Step::Apply(function, &one, form))
            }
            Slope::Zero => self.make(Step::Whole(0)),
            Slope::SeveralArguments => None,
        }
    }

    /// Applies the sign of an edge to a number.
    fn signed<'a>(&mut self, value: &'a Self::Number, edge: Edge) -> Option<Cow<'a, Self::Number>> {
        Some(match edge.is_negative() {
            true => Cow::Owned(self.make(Step::Neg(value))?),
            false => Cow::Borrowed(value),
        })
    }

    /// Returns the values of edges, given those of all nodes.
    fn read(&mut self, values: &[Self::Number], edges: &[Edge]) -> Option<Vec<Self::Number>> {
        let value = |&edge: &Edge| self.signed(values.get(edge.node() as usize)?, edge);
        let all = edges.iter().map(value);
        all.map(|value| Some(value?.into_owned())).collect()
    }

    /// Computes the value of a node that is not a number from those of its children.
    #[inline]
    fn node<'a>(
        &mut self,
        node: Node,
        at: impl Fn(Edge) -> Option<&'a Self::Number>,
        form: LazyForm<Self::Number>,
    ) -> Option<Self::Number>
    where
        Self::Number: 'a,
    {
        let mut read = |edge: Edge| self.signed(at(edge)?, edge);
        match node {
            Node::Constant(_) => None,
            Node::Symbol(index) => self.make(Step::Symbol(index as usize)),
            Node::Add(a, b) if !b.is_negative() && a.is_negative() => {
                self.make(Step::Sub(at(b)?, at(a)?))
            }
            Node::Add(a, b) => {
                let x = read(a)?;
                match b.is_negative() {
                    true => self.make(Step::Sub(&x, at(b)?)),
                    false => self.make(Step::Add(&x, at(b)?)),
                }
            }
            Node::Mul(a, b) => {
                let (a, b) = (read(a)?, read(b)?);
                self.make(Step::Mul(&a, &b))
            }
            Node::Div(a, b) => {
                let (a, b) = (read(a)?, read(b)?);
                self.make(Step::Div(&a, &b))
            }
            Node::Apply(function, a) => {
                let a = read(a)?;
                self.make(Step::Apply(function, &a, form))
            }
            Node::Atan2(y, x) => {
                let (y, x) = (read(y)?, read(x)?);
                self.make(Step::Atan2(&y, &x))
            }
            Node::Select(c, a, b) => {
                let (c, a, b) = (read(c)?, read(a)?, read(b)?);
                self.make(Step::Select(&c, &a, &b))
            }
            Node::Listed(rest, a) => {
                let a = read(a)?;
                self.make(Step::Listed(at(rest)?, &a))
            }
            Node::External(component, list) => {
                self.make(Step::External(component, at(list)?, form))
            }
        }
    }
}

/// Numbers that include the elements of the two fields.
pub trait Modular: Arithmetic {
    /// Converts an element of the fields.
    fn residue(&mut self, value: ResiduePair) -> Option<Self::Number>;
}
