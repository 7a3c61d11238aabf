//! The Python syntax of statements, numbers and comments.

use crate::chunk::ResultWriting;
use crate::docs::escape_bidi_controls;
use crate::language::{Language, Operand, SharedArray};
use hamel_algebra::graph::{Function, Graph, Node, NodeId};
use hamel_program::{Cause, Program, Shape};
use num_traits::ToPrimitive;

/// Python over the arrays of a module `xp`.
pub struct Python;

impl Language for Python {
    fn when(&self, _: Shape, _: bool) -> ResultWriting {
        ResultWriting::Whole
    }

    fn entry(&self, array: SharedArray, _: Shape, place: usize) -> String {
        format!("{}[{place}]", array.name())
    }

    fn literal(&self, graph: &Graph, node: NodeId) -> String {
        match graph.node(node) {
            Node::Constant(index) => literal(graph.constant(index).to_f64().unwrap_or(f64::NAN)),
            _ => "math.pi".into(),
        }
    }

    fn number(&self, graph: &Graph, node: NodeId, _: &str) -> String {
        self.literal(graph, node)
    }

    fn number_binding(&self, _: &Graph, _: NodeId, _: &str) -> String {
        String::new()
    }

    fn heading(&self, text: &str) -> String {
        comment(text)
    }

    fn zero(&self) -> String {
        literal(0.0)
    }

    fn binding(&self, name: &str, value: &str) -> String {
        format!("{name} = {value}\n")
    }

    fn pair(&self, names: [Option<&str>; 2], angle: &Operand) -> String {
        let both = names.into_iter().zip(["sin", "cos"]);
        let one = |(name, function)| {
            let name: &str = name?;
            Some(self.binding(name, &format!("xp.{function}({})", angle.with_sign())))
        };
        both.filter_map(one).collect()
    }

    fn fused(&self, [a, b, c]: &[Operand; 3]) -> String {
        let sign = if c.negative { "-" } else { "+" };
        format!("{} * {} {sign} {}", a.with_sign(), b.with_sign(), c.value)
    }

    fn atan2(&self, [y, x]: &[Operand; 2]) -> String {
        format!("xp.arctan2({}, {})", y.with_sign(), x.with_sign())
    }

    fn select(&self, [c, a, b]: &[Operand; 3]) -> String {
        format!(
            "_select(xp, {}, {}, {})",
            c.with_sign(),
            a.with_sign(),
            b.with_sign()
        )
    }

    fn function(&self, function: Function, operand: &Operand) -> String {
        let operand = operand.with_sign();
        // Modules of arrays have the names of `<math.h>`.
        match function.row().c.strip_prefix('@') {
            Some(helper) => format!("{helper}(xp, {operand})"),
            None => format!("xp.{}({operand})", function.row().c),
        }
    }

    fn check(&self, pivot: &Operand, _: Cause, _: &Program) -> String {
        format!("valid = valid & _is_positive({})\n", pivot.with_sign())
    }
}

/// Returns the shortest Python literal that parses to this number.
pub fn literal(value: f64) -> String {
    let text = match value {
        value if value.is_nan() => "math.nan".into(),
        value if value.is_infinite() => "math.inf".into(),
        value => format!("{:?}", value.abs()),
    };
    match value.is_sign_negative() && !value.is_nan() {
        true => format!("(-{text})"),
        false => text,
    }
}

/// Prints a line as a Python comment, `# …`.
pub fn comment(line: &str) -> String {
    let line = single_line(line);
    let space = if line.is_empty() { "" } else { " " };
    format!("#{space}{line}\n")
}

/// Returns a text without what would end a line, and without characters that change the direction of writing.
pub fn single_line(line: &str) -> String {
    let line: String = line.chars().filter(|letter| !letter.is_control()).collect();
    escape_bidi_controls(line.trim_end())
}
