//! The syntax of statements: everything that Rust and C spell differently.

use super::chunk::ResultWriting;
use super::{layout, number};
use hamel_algebra::graph::{Function, Graph, NodeId};
use hamel_program::{Cause, Program, Shape};

/// Text of an operand of an operation, with its sign apart.
pub struct Operand {
    /// The value without its sign.
    pub value: String,
    /// Whether it is negated.
    pub negative: bool,
}

impl Operand {
    /// Returns the operand's text with its sign, as an argument or a term of a sum.
    pub fn with_sign(&self) -> String {
        let sign = if self.negative { "-" } else { "" };
        format!("{sign}{}", self.value)
    }

    /// The operand with its sign, as the receiver of a method: a negative one in parentheses.
    fn receiver(&self) -> String {
        match self.negative {
            true => format!("(-{})", self.value),
            false => self.value.clone(),
        }
    }
}

/// An array that is shared by the parts of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SharedArray {
    /// Intermediate values that later parts read.
    Slots,
    /// Results.
    Out,
    /// Slopes [A B], written to an argument in addition to the result.
    Slopes,
}

impl SharedArray {
    /// Returns the name of the array in the generated text.
    pub const fn name(self) -> &'static str {
        match self {
            SharedArray::Slots => "slots",
            SharedArray::Out => "out",
            SharedArray::Slopes => "slopes",
        }
    }
}

/// Syntax of the statements of functions in a target language.
pub trait Language {
    /// Tells when the parts of a function write its result, given its shape and whether the function can fail.
    fn when(&self, shape: Shape, fallible: bool) -> ResultWriting;
    /// Entry of a shared array of this shape, by its index, as a part refers to it.
    fn entry(&self, array: SharedArray, shape: Shape, place: usize) -> String;
    /// A number as a literal.
    fn literal(&self, graph: &Graph, node: NodeId) -> String;
    /// A number as an operand; `name` is the name of its binding.
    fn number(&self, graph: &Graph, node: NodeId, name: &str) -> String;
    /// The statement that binds a number to its name; empty in languages that write literals in place.
    fn number_binding(&self, graph: &Graph, node: NodeId, name: &str) -> String;
    /// The comment above statements that serve one quantity.
    fn heading(&self, text: &str) -> String;
    /// The number 0.
    fn zero(&self) -> String;
    /// The statement that binds a value to a name.
    fn binding(&self, name: &str, value: &str) -> String;
    /// The statement that binds the sine and the cosine of an angle to names; `None` for one that is not used.
    fn pair(&self, names: [Option<&str>; 2], angle: &Operand) -> String;
    /// The fused product and sum a b + c.
    fn fused(&self, operands: &[Operand; 3]) -> String;
    /// atan2(y, x), the angle of the vector (x, y); the operands are y, x.
    fn atan2(&self, operands: &[Operand; 2]) -> String;
    /// a if c > 0, otherwise b; the operands are c, a, b.
    fn select(&self, operands: &[Operand; 3]) -> String;
    /// The function call f(a).
    fn function(&self, function: Function, operand: &Operand) -> String;
    /// The statement that returns an error unless a pivot is positive. `cause` says which pivot: that of [Y; Φ] by its
    /// number, or that of the mass matrix by its place among the pivots.
    fn check(&self, pivot: &Operand, cause: Cause, program: &Program) -> String;
}

/// Rust, generic over the scalar `S`.
pub struct Rust;

impl Language for Rust {
    fn when(&self, _: Shape, _: bool) -> ResultWriting {
        ResultWriting::AtOnce
    }

    fn entry(&self, array: SharedArray, shape: Shape, place: usize) -> String {
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
        number::constant_expression(graph, node)
    }

    fn number(&self, _: &Graph, _: NodeId, name: &str) -> String {
        name.into()
    }

    fn number_binding(&self, graph: &Graph, node: NodeId, name: &str) -> String {
        self.binding(name, &self.literal(graph, node))
    }

    fn heading(&self, text: &str) -> String {
        layout::heading_marker(text)
    }

    fn zero(&self) -> String {
        number::scalar_expression(0.0)
    }

    fn binding(&self, name: &str, value: &str) -> String {
        format!("let {name} = {value};\n")
    }

    fn pair(&self, names: [Option<&str>; 2], angle: &Operand) -> String {
        let [sine, cosine] = names.map(|name| name.unwrap_or("_"));
        format!("let ({sine}, {cosine}) = {}.sin_cos();\n", angle.receiver())
    }

    fn fused(&self, [a, b, c]: &[Operand; 3]) -> String {
        format!(
            "{}.mul_add({}, {})",
            a.receiver(),
            b.with_sign(),
            c.with_sign()
        )
    }

    fn atan2(&self, [y, x]: &[Operand; 2]) -> String {
        format!("{}.atan2({})", y.receiver(), x.with_sign())
    }

    fn select(&self, [c, a, b]: &[Operand; 3]) -> String {
        let method = Function::Select.row().rust;
        format!(
            "{}.{method}({}, {})",
            c.receiver(),
            a.with_sign(),
            b.with_sign()
        )
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
