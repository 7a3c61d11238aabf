//! Values of expressions in numbers of any kind, by one walk over their nodes.
//!
//! A kind of numbers is an implementation of [`Numbers`], which knows the values of symbols at a point:
//!
//! | numbers | implementation |
//! |---|---|
//! | `f64` | `numeric::Floats` |
//! | F_p(i) × F_q(i) | `lane::Lane` |
//! | with slopes along one direction or many, with a record for slopes in all symbols | `dual::Duals` over others |
//! | twice the length, with bounds of rounding, beside `f64` | `rounding` |
//! | real samples, certain bounds | `shadow` |

use super::fp::Fp;
use super::function::{Function, Slope};
use super::graph::Graph;
use super::node::{Edge, Node, NodeId};
use num_rational::BigRational;
use std::borrow::Cow;

/// Σ coefficient · atom, as `Graph::form` has it, with the values of its atoms.
pub type Form<N> = Vec<(N, BigRational)>;

/// Arithmetic at a point.
pub trait Numbers {
    /// One number.
    type Number: Clone;

    /// A small whole number.
    fn whole(&mut self, value: i32) -> Self::Number;
    /// A rational; `None` where it has no image.
    fn constant(&mut self, value: &BigRational) -> Option<Self::Number>;
    /// The value of a symbol.
    fn symbol(&mut self, index: usize) -> Option<Self::Number>;
    /// −a.
    fn neg(&mut self, a: &Self::Number) -> Self::Number;
    /// a + b.
    fn add(&mut self, a: &Self::Number, b: &Self::Number) -> Self::Number;
    /// a − b.
    fn sub(&mut self, a: &Self::Number, b: &Self::Number) -> Self::Number {
        let b = self.neg(b);
        self.add(a, &b)
    }
    /// a b.
    fn mul(&mut self, a: &Self::Number, b: &Self::Number) -> Self::Number;
    /// a / b; `None` where b has no inverse.
    fn div(&mut self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number>;
    /// A function of one argument; who needs its form asks for it.
    fn apply(
        &mut self,
        function: Function,
        a: &Self::Number,
        form: &dyn Fn() -> Form<Self::Number>,
    ) -> Option<Self::Number>;
    /// The angle of (x, y).
    fn atan2(&mut self, y: &Self::Number, x: &Self::Number) -> Option<Self::Number>;

    /// Whether it is 0 for certain.
    fn is_zero(&self, _: &Self::Number) -> bool {
        false
    }

    /// a/b and its derivatives by a and b: 1/b and −(a/b)/b.
    fn quotient(&mut self, a: &Self::Number, b: &Self::Number) -> Option<[Self::Number; 3]> {
        let one = self.whole(1);
        let (quotient, by_a) = (self.div(a, b)?, self.div(&one, b)?);
        let minus = self.neg(&quotient);
        let by_b = self.div(&minus, b)?;
        Some([quotient, by_a, by_b])
    }
}

/// Numbers over the two fields.
pub trait Modular: Numbers {
    /// A number of the fields.
    fn residue(&mut self, value: Fp) -> Self::Number;
}

/// The arithmetic of numbers with the operators of Rust.
macro_rules! operators {
    ($number:ty) => {
        type Number = $number;

        fn neg(&mut self, a: &$number) -> $number {
            -*a
        }

        fn add(&mut self, a: &$number, b: &$number) -> $number {
            *a + *b
        }

        fn sub(&mut self, a: &$number, b: &$number) -> $number {
            *a - *b
        }

        fn mul(&mut self, a: &$number, b: &$number) -> $number {
            *a * *b
        }
    };
}
pub(crate) use operators;

/// f′(a) of a function with its value there.
pub(crate) fn slope<C: Numbers>(
    numbers: &mut C,
    function: Function,
    (a, value): (&C::Number, &C::Number),
    form: &dyn Fn() -> Form<C::Number>,
) -> Option<C::Number> {
    let one = numbers.whole(1);
    match function.row().slope {
        Slope::Is(other) => numbers.apply(other, a, form),
        Slope::IsMinus(other) => {
            let value = numbers.apply(other, a, form)?;
            Some(numbers.neg(&value))
        }
        Slope::Itself => Some(value.clone()),
        Slope::Inverse => numbers.div(&one, a),
        Slope::HalfInverse => {
            let twice = numbers.add(value, value);
            numbers.div(&one, &twice)
        }
        Slope::Two => None,
    }
}

/// A number with the sign of an edge.
pub(crate) fn signed<'a, C: Numbers>(
    numbers: &mut C,
    value: &'a C::Number,
    edge: Edge,
) -> Cow<'a, C::Number> {
    if edge.is_negative() {
        Cow::Owned(numbers.neg(value))
    } else {
        Cow::Borrowed(value)
    }
}

/// The value of a node from those of the nodes that it is made of.
#[inline]
pub fn compute<'a, C: Numbers>(
    numbers: &mut C,
    node: Node,
    constant: impl FnOnce(&mut C, u32) -> Option<C::Number>,
    at: impl Fn(Edge) -> Option<&'a C::Number>,
    form: &dyn Fn() -> Form<C::Number>,
) -> Option<C::Number>
where
    C::Number: 'a,
{
    match node {
        Node::Constant(index) => constant(numbers, index),
        Node::Symbol(index) => numbers.symbol(index as usize),
        Node::Add(a, b) => {
            let (x, y) = (at(a)?, at(b)?);
            Some(match (a.is_negative(), b.is_negative()) {
                (false, false) => numbers.add(x, y),
                (true, false) => numbers.sub(y, x),
                (_, true) => {
                    let x = signed(numbers, x, a);
                    numbers.sub(&x, y)
                }
            })
        }
        Node::Mul(a, b) => {
            let (a, b) = (signed(numbers, at(a)?, a), signed(numbers, at(b)?, b));
            Some(numbers.mul(&a, &b))
        }
        Node::Div(a, b) => {
            let (a, b) = (signed(numbers, at(a)?, a), signed(numbers, at(b)?, b));
            numbers.div(&a, &b)
        }
        Node::Apply(function, a) => {
            let a = signed(numbers, at(a)?, a);
            numbers.apply(function, &a, form)
        }
        Node::Atan2(y, x) => {
            let (y, x) = (signed(numbers, at(y)?, y), signed(numbers, at(x)?, x));
            numbers.atan2(&y, &x)
        }
    }
}

/// The values of expressions; `None` where something has none.
pub fn evaluate<C: Numbers>(
    graph: &Graph,
    roots: &[Edge],
    numbers: &mut C,
) -> Option<Vec<C::Number>> {
    let mut values = vec![numbers.whole(0); graph.len()];
    // The number 1 is the atom of constant angles.
    values[1] = numbers.whole(1);
    for id in graph.reachable(roots) {
        let node = graph.node(id);
        let constant = |numbers: &mut C, index| numbers.constant(graph.constant(index));
        let form = || {
            let Node::Apply(function, a) = node else {
                return Form::new();
            };
            let value = |(atom, c): (NodeId, BigRational)| (values[atom as usize].clone(), c);
            graph.form(function, a).into_iter().map(value).collect()
        };
        let at = |edge: Edge| values.get(edge.node() as usize);
        values[id as usize] = compute(numbers, node, constant, at, &form)?;
    }
    let mut root = |root: &Edge| signed(numbers, &values[root.node() as usize], *root).into_owned();
    Some(roots.iter().map(&mut root).collect())
}
