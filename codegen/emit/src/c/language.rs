//! The C syntax of statements and numbers.

use super::names::CIdentifiers;
use super::{comment, returns_number};
use crate::chunk::ResultWriting;
use crate::language::{Language, Operand, SharedArray};
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
    /// Returns the C name of the type, `double` or `float`.
    pub fn type_name(self) -> &'static str {
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
        write!(f, "{}", self.type_name())
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
    pub origins: ArrayOrigins,
}

/// Offsets of the pointers that are passed to a part of a C function: for each array, the index of the entry to which
/// the pointer points.
#[derive(Clone, Copy, Debug, Default)]
pub struct ArrayOrigins {
    /// Origin of the slots.
    pub slots: usize,
    /// Origin of the results.
    pub out: usize,
}

impl ArrayOrigins {
    /// Returns the offset of the pointer into an array.
    pub fn offset_of(self, array: SharedArray) -> usize {
        match array {
            SharedArray::Slots => self.slots,
            SharedArray::Out | SharedArray::Slopes => self.out,
        }
    }
}

impl Language for CLanguage<'_> {
    fn when(&self, shape: Shape, fallible: bool) -> ResultWriting {
        match returns_number(shape, fallible) {
            true => ResultWriting::AtTheEnd,
            false => ResultWriting::BehindPivots,
        }
    }

    fn entry(&self, array: SharedArray, _: Shape, place: usize) -> String {
        let (origin, array) = (self.origins.offset_of(array), array.name());
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
        comment::plain_comment_line(text)
    }

    fn zero(&self) -> String {
        self.precision.literal(0.0)
    }

    fn binding(&self, name: &str, value: &str) -> String {
        format!("const {} {name} = {value};\n", self.names.real())
    }

    fn pair(&self, names: [Option<&str>; 2], angle: &Operand) -> String {
        let (real, angle) = (self.names.real(), angle.with_sign());
        match names {
            [Some(sine), Some(cosine)] => format!(
                "{real} {sine}, {cosine};\n{}({angle}, &{sine}, &{cosine});\n",
                self.names.identifier("sin_cos")
            ),
            [Some(sine), None] => {
                self.binding(sine, &format!("{}({angle})", self.names.identifier("sin")))
            }
            [None, Some(cosine)] => self.binding(
                cosine,
                &format!("{}({angle})", self.names.identifier("cos")),
            ),
            [None, None] => String::new(),
        }
    }

    fn fused(&self, [a, b, c]: &[Operand; 3]) -> String {
        format!(
            "FUSED({}, {}, {})",
            a.with_sign(),
            b.with_sign(),
            c.with_sign()
        )
    }

    fn atan2(&self, [y, x]: &[Operand; 2]) -> String {
        let suffix = self.precision.suffix();
        format!("atan2{suffix}({}, {})", y.with_sign(), x.with_sign())
    }

    fn select(&self, [c, a, b]: &[Operand; 3]) -> String {
        let select = self.names.identifier("select");
        format!(
            "{select}({}, {}, {})",
            c.with_sign(),
            a.with_sign(),
            b.with_sign()
        )
    }

    fn function(&self, function: Function, operand: &Operand) -> String {
        let suffix = self.precision.suffix();
        let name = match function.row().c.strip_prefix("@_") {
            Some(helper) => self.names.identifier(helper),
            None => format!("{}{suffix}", function.row().c),
        };
        format!("{name}({})", operand.with_sign())
    }

    fn check(&self, pivot: &Operand, cause: Cause, _: &Program) -> String {
        let positive = self.names.identifier("is_positive");
        let (pivot, status) = (pivot.with_sign(), self.names.status_code(cause));
        format!("if (!{positive}({pivot})) {{\n    return {status};\n}}\n")
    }
}
