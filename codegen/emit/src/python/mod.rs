//! A program as a Python module for arrays of NumPy, JAX or another module with the same functions.
//!
//! | file | owns |
//! |---|---|
//! | `language` | statements and numbers |
//! | `names` | identifiers, and words reserved by Python |
//! | `helpers` | functions that array modules do not have |
//!
//! Functions, their names, statements and order are the same as in Rust and C. A function takes arrays whose last axis
//! has the entries of one state, and broadcasts all axes before it. Pivots are not errors, which arrays cannot have:
//! results are NaN where a pivot is not positive.

mod helpers;
mod language;
mod names;

use super::chunk::BodyPartition;
use super::docs;
use super::function::{FunctionSpec, PreparedFunction, print_statements, with_prepared};
use super::parameters::{parameter_expressions, shaped_expression};
use super::views::{NamedRange, input_fields, state_fields};
use super::{Emitter, limits, names as common};
use common::{UniqueNames, argument_name};
use hamel_algebra::graph::NodeId;
use hamel_language::syntax::ast::ShapeKind;
use hamel_program::{Function, Program, Shape};
use language::{Python, literal};

/// Options of the Python generator: contents of the file header.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Options {
    /// Hash of the description, quoted in the header.
    pub source_hash: u64,
    /// Command that regenerates the file, quoted in the header; none if empty.
    pub command: String,
    /// Text of the description, quoted in the header; none if empty.
    pub description: String,
}

/// Returns the Python module of a program without external functions.
pub fn python_module(program: &Program, options: &Options) -> String {
    let names = names::legal_names(common::ProgramNames::with_reserved_names(
        program,
        names::RESERVED,
    ));
    let emitter = Emitter {
        headings: true,
        ..Emitter::with(
            program,
            usize::MAX,
            names,
            names::reserved_words(),
            documentation,
        )
    };
    let class = Class {
        fields: names::parameter_attributes(&emitter.names),
        emitter: &emitter,
    };
    let mut header = docs::generation_notice(options.source_hash, &options.command);
    header.extend(docs::description_lines(&options.description));
    let header: String = header.iter().map(|line| language::comment(line)).collect();
    let body = class.text();
    let helpers = helpers::helpers_used_by(&body);
    format!("{header}\n{}{helpers}\n\n{body}", class.about())
}

/// The class that holds the parameters of a program and has a method for each function.
struct Class<'a> {
    emitter: &'a Emitter<'a>,
    /// Attributes of the parameter groups, in order.
    fields: Vec<String>,
}

impl Class<'_> {
    fn program(&self) -> &Program {
        self.emitter.program
    }

    /// Prints the documentation of the module and its imports.
    fn about(&self) -> String {
        let mut lines = self.program().docs.clone();
        if lines.is_empty() {
            lines.push(format!("Equations of motion of `{}`.", self.program().name));
        }
        lines.extend(ABOUT.iter().map(|line| line.to_string()));
        format!("{}\nimport math\n\nimport numpy\n", docstring(&lines, 0))
    }

    fn text(&self) -> String {
        let name = &self.emitter.names.type_name;
        let mut text = format!("class {name}:\n");
        let lines = [format!(
            "The system `{}` with its parameters.",
            self.program().name
        )];
        text.push_str(&docstring(&lines, 4));
        text.push_str(&self.constants_of_class());
        text.push_str(&self.constructor());
        for spec in self.emitter.specs() {
            text.push_str(&self.method(&spec));
        }
        text
    }

    /// Prints sizes, the start, places of entries by name, and limits of joints.
    fn constants_of_class(&self) -> String {
        let program = self.program();
        let mut text = String::new();
        let mut constant = |docs: &[String], name: &str, value: &str| {
            let docs: String = docs.iter().map(|line| language::comment(line)).collect();
            text.push_str(&indented(&format!("\n{docs}{name} = {value}\n"), 4));
        };
        for (name, what, first, size) in docs::size_constants(program) {
            constant(
                &docs::entry_lines(program, what, first, size),
                name,
                &size.to_string(),
            );
        }
        for (name, what, values) in [
            (
                "START_X",
                "The coordinates x of the start.",
                &program.start_x,
            ),
            (
                "START_XI",
                "The velocities ξ of the start.",
                &program.start_xi,
            ),
        ] {
            constant(
                &[what.into()],
                name,
                &tuple(values.iter().map(|&value| literal(value))),
            );
        }
        let mut taken = UniqueNames::default();
        let fields = state_fields(program)
            .into_iter()
            .chain(input_fields(program));
        for field in fields {
            let NamedRange {
                name,
                docs,
                array,
                offset,
                ..
            } = &field;
            let wanted = format!("{array}_{name}").to_ascii_uppercase();
            let name = taken.claim(wanted.trim_end_matches('_'));
            let place = match field.shape {
                ShapeKind::Scalar => offset.to_string(),
                _ => format!("slice({offset}, {})", offset + field.length()),
            };
            constant(&[format!("{docs} In `{array}`.")], &name, &place);
        }
        for limit in limits::joint_limits(program) {
            let values = limit.values.iter().map(|&value| literal(value));
            let value = match limit.values.as_slice() {
                [one] => literal(*one),
                _ => tuple(values),
            };
            constant(&[limit.title], &limit.name, &value);
        }
        text
    }

    /// Prints the constructor: the parameters by keyword, and what depends on them alone.
    fn constructor(&self) -> String {
        let program = self.program();
        let mut arguments = vec!["self".to_string(), "*".into()];
        let mut lines = vec![
            "Sets the parameters, of which each entry may be an array, and the module of all arrays.".to_string(),
            String::new(),
        ];
        let mut body = "self._xp = xp\n".to_string();
        for (group, field) in program.params.iter().zip(&self.fields) {
            let place = |i: usize, j: usize| match group.shape {
                ShapeKind::Symmetric(n) => {
                    let (i, j) = (i.min(j), i.max(j));
                    i * n - i * (i + 1) / 2 + j
                }
                ShapeKind::Matrix(n) => i * n + j,
                ShapeKind::Scalar | ShapeKind::Vector(_) => j,
            };
            let value = shaped_expression(group.shape, |i, j| {
                let value = program.defaults.get(group.offset + place(i, j)).copied();
                literal(value.unwrap_or_default())
            });
            arguments.push(format!("{field}={}", immutable(&value)));
            lines.push(format!(
                "- `{field}`: `{}`, {}",
                group.name,
                docs::shape_in_words(group.shape)
            ));
            body.push_str(&format!("self.{field} = {field}\n"));
        }
        arguments.push("xp=numpy".into());
        lines.push(
            "- `xp`: `numpy`, `jax.numpy`, or another module of arrays with the same functions"
                .into(),
        );
        if !self.emitter.kept.is_empty() {
            body.push_str(&format!("self._k = self.{CONSTANTS}()\n"));
        }
        let guards = &program.constant_guards;
        if !guards.is_empty() {
            let why = docs::singular_conditions(program, guards).unwrap_or_default();
            let parameters = parameter_expressions(program, &self.fields, "self.");
            let checks = super::parameters::print_pivot_checks(
                self.emitter,
                &Python,
                "self._k",
                &parameters,
            );
            body.push_str(&format!("valid = True\n{checks}"));
            body.push_str(&format!(
                "if xp is numpy and not numpy.all(valid):\n    raise ValueError({})\n",
                quoted(&format!("parameters with which {why}"))
            ));
        }
        let docs = docstring(&lines, 4);
        let arguments = arguments.join(",\n    ");
        let text = format!(
            "\ndef __init__(\n    {arguments},\n):\n{docs}{}",
            indented(&body, 4)
        );
        indented(&text, 4)
    }

    fn method(&self, spec: &FunctionSpec) -> String {
        let parameters = parameter_expressions(self.program(), &self.fields, "self.");
        let body = with_prepared(self.emitter, spec, &Python, &parameters, |drawing| {
            self.body(drawing)
        });
        let mut arguments = vec!["self".to_string()];
        arguments.extend(
            spec.arguments
                .iter()
                .map(|&given| argument_name(given).to_string()),
        );
        let name = match spec.functions.is_empty() {
            true => CONSTANTS,
            false => &spec.name,
        };
        let text = format!(
            "\ndef {name}({}):\n{}{}",
            arguments.join(", "),
            docstring(&spec.docs, 4),
            indented(&body, 4)
        );
        indented(&text, 4)
    }

    fn body(&self, drawing: &PreparedFunction) -> String {
        let (spec, BodyPartition { parts, .. }) = (drawing.spec, drawing.plan);
        let mut printer = drawing.printer();
        let mut text = String::new();
        for part in parts {
            text.push_str(&print_statements(
                &mut printer,
                drawing.body,
                part,
                |_, _| String::new(),
            ));
        }
        let results = drawing
            .body
            .outputs
            .iter()
            .map(|&edge| printer.signed_value(edge));
        let results: Vec<String> = results.collect();
        let mut before = "xp = self._xp\n".to_string();
        for &given in spec.arguments {
            let (name, length) = (argument_name(given), self.program().length(given));
            before.push_str(&format!(
                "{name} = _entries(xp, {name}, {length}, \"{name}\")\n"
            ));
        }
        if printer.used.kept {
            before.push_str("k = self._k\n");
        }
        if spec.fallible {
            before.push_str("valid = True\n");
        }
        if spec.functions.is_empty() {
            return format!("{before}{text}return {}\n", tuple(results.into_iter()));
        }
        let arguments = spec
            .arguments
            .iter()
            .map(|&given| argument_name(given).to_string());
        let valid = if spec.fallible { "valid" } else { "True" };
        format!(
            "{before}{text}return _shaped(xp, {}, {}, {}, {valid})\n",
            tuple(results.into_iter()),
            shape(spec.shape),
            tuple(arguments),
        )
    }
}

/// Name of the method that computes what depends on parameters alone.
const CONSTANTS: &str = "_constants";

/// The documentation of every module, below that of its system.
const ABOUT: &[&str] = &[
    "",
    "Functions take arrays whose last axis has the entries of one state, such as `x` of shape `(..., COORDINATES)`,",
    "and broadcast all axes before it. They need nothing but NumPy, or the module that is given as `xp`, and are",
    "NaN where a pivot is not positive.",
];

/// Returns the documentation of a function: what it evaluates, its cost, arguments and result.
fn documentation(program: &Program, function: &Function, nodes: &[NodeId]) -> Vec<String> {
    let mut lines = docs::summary_and_arguments(program, function, nodes);
    let axes: Vec<String> = extents(function.shape)
        .iter()
        .map(|n| format!(", {n}"))
        .collect();
    lines.extend([
        String::new(),
        format!("Returns an array of shape `(...{})`.", axes.concat()),
    ]);
    if function.fallible
        && let Some(why) = docs::singular_conditions(program, &function.guards)
    {
        lines.extend([String::new(), format!("NaN where {why}.")]);
    }
    lines
}

fn extents(shape: Shape) -> Vec<usize> {
    match shape {
        Shape::Scalar => Vec::new(),
        Shape::Vector(n) => vec![n],
        Shape::Matrix(rows, columns) => vec![rows, columns],
    }
}

fn shape(shape: Shape) -> String {
    tuple(extents(shape).iter().map(usize::to_string))
}

/// Prints a tuple.
fn tuple(entries: impl Iterator<Item = String>) -> String {
    let entries: Vec<String> = entries.collect();
    match entries.as_slice() {
        [one] => format!("({one},)"),
        all => format!("({})", all.join(", ")),
    }
}

/// Turns lists into tuples, which are safe as defaults of arguments.
fn immutable(value: &str) -> String {
    // A tuple of one entry needs a comma; with more entries a comma at the end is allowed.
    value.replace('[', "(").replace(']', ",)")
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", escaped(text))
}

fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"")
}

/// Prints lines as a docstring, indented.
fn docstring(lines: &[String], indent: usize) -> String {
    let lines = lines.iter().flat_map(|line| line.split(['\n', '\r']));
    let lines: Vec<String> = lines
        .map(|line| escaped(&language::single_line(line)))
        .collect();
    let end = if lines.len() > 1 { "\n" } else { "" };
    indented(&format!("\"\"\"{}{end}\"\"\"\n", lines.join("\n")), indent)
}

/// Indents all lines of a text but empty ones.
fn indented(text: &str, indent: usize) -> String {
    let line = |line: &str| match line.is_empty() {
        true => "\n".to_string(),
        false => format!("{:indent$}{line}\n", ""),
    };
    text.lines().map(line).collect()
}
