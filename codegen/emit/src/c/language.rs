//! The C syntax of statements and numbers.

use super::names::CIdentifiers;
use super::{comment, returns_number};
use crate::chunk::When;
use crate::language::{Array, Language, Operand};
use hamel_algebra::graph::{Function, Graph, Node, NodeId};
use hamel_program::{Cause, Program, Shape};
use num_traits::ToPrimitive;
use std::fmt;
use std::str::FromStr;

/// Floating-point type of generated C.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// `double`
    #[default]
    Double,
    /// `float`
    Float,
}

impl Precision {
    /// Name of the type.
    pub fn name(self) -> &'static str {
        match self {
            Precision::Double => "double",
            Precision::Float => "float",
        }
    }

    /// Size of a number in bytes.
    pub(super) fn bytes(self) -> usize {
        match self {
            Precision::Double => 8,
            Precision::Float => 4,
        }
    }

    /// Suffix of literals and of `<math.h>` functions.
    pub(super) fn suffix(self) -> &'static str {
        match self {
            Precision::Double => "",
            Precision::Float => "f",
        }
    }

    /// Returns the shortest literal that parses to this number.
    pub fn literal(self, value: f64) -> String {
        let (digits, infinity) = match self {
            Precision::Double => (format!("{value:?}"), "HUGE_VAL"),
            #[allow(clippy::cast_possible_truncation, reason = "the nearest is meant")]
            Precision::Float => (format!("{:?}f", value as f32), "HUGE_VALF"),
        };
        let text = match digits.trim_end_matches('f') {
            "NaN" | "-NaN" => "NAN".into(),
            "in" | "inf" => infinity.into(),
            "-in" | "-inf" => format!("-{infinity}"),
            _ => digits,
        };
        match text.strip_prefix('-') {
            Some(_) => format!("({text})"),
            None => text,
        }
    }
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.name())
    }
}

/// Error that no floating-point type of C has this name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownPrecision {
    /// The name that was given.
    pub name: String,
}

impl fmt::Display for UnknownPrecision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` is neither `double` nor `float`", self.name)
    }
}

impl std::error::Error for UnknownPrecision {}

impl FromStr for Precision {
    type Err = UnknownPrecision;

    fn from_str(name: &str) -> Result<Self, UnknownPrecision> {
        match name {
            "double" => Ok(Precision::Double),
            "float" => Ok(Precision::Float),
            _ => Err(UnknownPrecision { name: name.into() }),
        }
    }
}

/// The language C, with the names of one program.
pub struct CLanguage<'a> {
    /// Names of the program.
    pub names: &'a CIdentifiers,
    /// Floating-point type.
    pub precision: Precision,
    /// Origins from which array indices are counted.
    pub origins: Origins,
}

/// Origins of the arrays that are passed to a part: the index of the entry to which the pointer points.
#[derive(Clone, Copy, Debug, Default)]
pub struct Origins {
    /// Origin of the slots.
    pub slots: usize,
    /// Origin of the results.
    pub out: usize,
}

impl Origins {
    /// Returns the origin of an array.
    pub fn of(self, array: Array) -> usize {
        match array {
            Array::Slots => self.slots,
            Array::Out | Array::Slopes => self.out,
        }
    }
}

impl Language for CLanguage<'_> {
    fn when(&self, shape: Shape, fallible: bool) -> When {
        match returns_number(shape, fallible) {
            true => When::AtTheEnd,
            false => When::BehindPivots,
        }
    }

    fn entry(&self, array: Array, _: Shape, place: usize) -> String {
        let (origin, array) = (self.origins.of(array), array.name());
        match place.checked_sub(origin) {
            Some(behind) => format!("{array}[{behind}]"),
            None => format!("{array}[-{}]", origin - place),
        }
    }

    fn literal(&self, graph: &Graph, node: NodeId) -> String {
        let value = match graph.node(node) {
            Node::Constant(index) => graph.constant(index).to_f64().unwrap_or(f64::NAN),
            _ => std::f64::consts::PI,
        };
        self.precision.literal(value)
    }

    fn number(&self, graph: &Graph, node: NodeId, _: &str) -> String {
        self.literal(graph, node)
    }

    fn number_binding(&self, _: &Graph, _: NodeId, _: &str) -> String {
        String::new()
    }

    fn heading(&self, text: &str) -> String {
        comment::print_comment_line(text)
    }

    fn zero(&self) -> String {
        self.precision.literal(0.0)
    }

    fn binding(&self, name: &str, value: &str) -> String {
        format!("const {} {name} = {value};\n", self.names.real())
    }

    fn pair(&self, names: [Option<&str>; 2], angle: &Operand) -> String {
        let (real, angle) = (self.names.real(), angle.signed());
        match names {
            [Some(sine), Some(cosine)] => format!(
                "{real} {sine}, {cosine};\n{}({angle}, &{sine}, &{cosine});\n",
                self.names.own("sin_cos")
            ),
            [Some(sine), None] => {
                self.binding(sine, &format!("{}({angle})", self.names.own("sin")))
            }
            [None, Some(cosine)] => {
                self.binding(cosine, &format!("{}({angle})", self.names.own("cos")))
            }
            [None, None] => String::new(),
        }
    }

    fn fused(&self, [a, b, c]: &[Operand; 3]) -> String {
        format!("FUSED({}, {}, {})", a.signed(), b.signed(), c.signed())
    }

    fn atan2(&self, [y, x]: &[Operand; 2]) -> String {
        let suffix = self.precision.suffix();
        format!("atan2{suffix}({}, {})", y.signed(), x.signed())
    }

    fn select(&self, [c, a, b]: &[Operand; 3]) -> String {
        let select = self.names.own("select");
        format!("{select}({}, {}, {})", c.signed(), a.signed(), b.signed())
    }

    fn function(&self, function: Function, operand: &Operand) -> String {
        let suffix = self.precision.suffix();
        let name = match function.row().c.strip_prefix("@_") {
            Some(helper) => self.names.own(helper),
            None => format!("{}{suffix}", function.row().c),
        };
        format!("{name}({})", operand.signed())
    }

    fn check(&self, pivot: &Operand, cause: Cause, _: &Program) -> String {
        let positive = self.names.own("is_positive");
        let (pivot, status) = (pivot.signed(), self.names.status(cause));
        format!("if (!{positive}({pivot})) {{\n    return {status};\n}}\n")
    }
}
