//! What statements are spelled by: what Rust and C write differently.

use super::chunk::When;
use super::number;
use hamel_algebra::graph::{Function, Graph, NodeId};
use hamel_program::{Cause, Program, Shape};

/// A value that an operation reads.
pub struct Operand {
    /// The value without its sign.
    pub value: String,
    /// Whether it is negated.
    pub negative: bool,
}

impl Operand {
    /// With its sign, as an operand.
    pub fn signed(&self) -> String {
        let sign = if self.negative { "-" } else { "" };
        format!("{sign}{}", self.value)
    }

    /// With its sign, as the receiver of a method.
    fn receiver(&self) -> String {
        match self.negative {
            true => format!("(-{})", self.value),
            false => self.value.clone(),
        }
    }
}

/// An array that the parts of a function share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Array {
    /// Values that are read in later parts.
    Slots,
    /// Results.
    Out,
    /// Slopes that are written besides a result.
    Slopes,
}

impl Array {
    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Array::Slots => "slots",
            Array::Out => "out",
            Array::Slopes => "slopes",
        }
    }
}

/// A language that functions are printed in.
pub trait Language {
    /// When parts of a function with such a result write it.
    fn when(&self, shape: Shape, fallible: bool) -> When;
    /// An entry of an array of this shape in a part, by its place.
    fn entry(&self, array: Array, shape: Shape, place: usize) -> String;
    /// A number by its digits.
    fn literal(&self, graph: &Graph, node: NodeId) -> String;
    /// A number where it is read; `name` is that of its binding.
    fn number(&self, graph: &Graph, node: NodeId, name: &str) -> String;
    /// What gives a number its name; nothing where numbers stand where they are read.
    fn number_binding(&self, graph: &Graph, node: NodeId, name: &str) -> String;
    /// The number 0.
    fn zero(&self) -> String;
    /// What gives a value its name.
    fn binding(&self, name: &str, value: &str) -> String;
    /// What gives the sine and the cosine of an angle their names.
    fn pair(&self, names: [Option<&str>; 2], angle: &Operand) -> String;
    /// a b + c
    fn fused(&self, operands: &[Operand; 3]) -> String;
    /// The angle of (x, y), operands y, x.
    fn atan2(&self, operands: &[Operand; 2]) -> String;
    /// a where c > 0, else b; operands c, a, b.
    fn select(&self, operands: &[Operand; 3]) -> String;
    /// f(a)
    fn function(&self, function: Function, operand: &Operand) -> String;
    /// Leaves the function unless a pivot is positive: a pivot of [Y; Φ], by its number among these, or of the
    /// mass matrix, by its number among the pivots.
    fn check(&self, pivot: &Operand, cause: Cause, program: &Program) -> String;
}

/// Rust, generic over the scalar `S`.
pub struct Rust;

impl Language for Rust {
    fn when(&self, _: Shape, _: bool) -> When {
        When::AtOnce
    }

    fn entry(&self, array: Array, shape: Shape, place: usize) -> String {
        let array = array.name();
        match shape {
            Shape::Scalar => format!("(*{array})"),
            Shape::Vector(_) => format!("{array}[{place}]"),
            Shape::Matrix(_, columns) => {
                let columns = columns.max(1);
                format!("{array}[{}][{}]", place / columns, place % columns)
            }
        }
    }

    fn literal(&self, graph: &Graph, node: NodeId) -> String {
        number::of(graph, node)
    }

    fn number(&self, _: &Graph, _: NodeId, name: &str) -> String {
        name.into()
    }

    fn number_binding(&self, graph: &Graph, node: NodeId, name: &str) -> String {
        self.binding(name, &self.literal(graph, node))
    }

    fn zero(&self) -> String {
        number::scalar(0.0)
    }

    fn binding(&self, name: &str, value: &str) -> String {
        format!("let {name} = {value};\n")
    }

    fn pair(&self, names: [Option<&str>; 2], angle: &Operand) -> String {
        let [sine, cosine] = names.map(|name| name.unwrap_or("_"));
        format!("let ({sine}, {cosine}) = {}.sin_cos();\n", angle.receiver())
    }

    fn fused(&self, [a, b, c]: &[Operand; 3]) -> String {
        format!("{}.mul_add({}, {})", a.receiver(), b.signed(), c.signed())
    }

    fn atan2(&self, [y, x]: &[Operand; 2]) -> String {
        format!("{}.atan2({})", y.receiver(), x.signed())
    }

    fn select(&self, [c, a, b]: &[Operand; 3]) -> String {
        let method = Function::Select.row().rust;
        format!("{}.{method}({}, {})", c.receiver(), a.signed(), b.signed())
    }

    fn function(&self, function: Function, operand: &Operand) -> String {
        format!("{}.{}", operand.receiver(), function.row().rust)
    }

    fn check(&self, pivot: &Operand, cause: Cause, program: &Program) -> String {
        let error = match cause {
            Cause::Velocity(place) => {
                format!("::hamel::Singular::inertia({:?})", program.velocity(place))
            }
            Cause::Mass => "::hamel::Singular::mass()".into(),
            Cause::Constraint(row) => format!("::hamel::Singular::constraints({row})"),
            Cause::Kinematics(number) => format!("::hamel::Singular::kinematics({number})"),
        };
        let pivot = pivot.receiver();
        format!("if !{pivot}.is_positive() {{ return ::core::result::Result::Err({error}); }}\n")
    }
}
