//! The generated type: parameters, constants kept for them, accessors, defaults.

use super::function::zeros;
use super::print::check;
use super::{Emitter, docs, number};
use crate::model::Group;
use crate::program::Shape;
use crate::program::schedule::is_hoisted;
use crate::syntax::ast::ShapeKind;

/// Lints that generated functions cannot obey in general.
pub const ALLOW: &str = r#"#[rustfmt::skip]
#[allow(dead_code, unreachable_pub, reason = "a program may use a part of what is generated")]
#[allow(unused_qualifications, reason = "full paths are right whatever is imported")]
#[allow(
    clippy::approx_constant, clippy::let_and_return, clippy::too_many_arguments,
    clippy::type_complexity, clippy::wrong_self_convention,
    reason = "numbers, names and shapes are those of the description"
)]
"#;

/// Lints that generated implementations of traits cannot obey in general.
pub const ALLOW_TRAIT: &str = r#"#[rustfmt::skip]
#[allow(unused_qualifications, clippy::approx_constant, reason = "full paths are right whatever is imported")]
"#;

const RESULT: &str = "::core::result::Result<(), ::hamel::Singular>";

/// The type of a group, as Rust.
fn group_type(shape: ShapeKind) -> String {
    match shape {
        ShapeKind::Scalar => "S".into(),
        ShapeKind::Vector(n) => format!("[S; {n}]"),
        ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => format!("[[S; {n}]; {n}]"),
    }
}

/// The indices of the entries of a group, in the order of its symbols.
fn indices(shape: ShapeKind) -> Vec<String> {
    let matrix = |n: usize, first: fn(usize) -> usize| {
        let rows = (0..n).flat_map(move |i| (first(i)..n).map(move |j| format!("[{i}][{j}]")));
        rows.collect()
    };
    match shape {
        ShapeKind::Scalar => vec![String::new()],
        ShapeKind::Vector(n) => (0..n).map(|i| format!("[{i}]")).collect(),
        ShapeKind::Matrix(n) => matrix(n, |_| 0),
        ShapeKind::Symmetric(n) => matrix(n, |i| i),
    }
}

/// All parameters as expressions, in the order of their symbols.
pub fn expressions(emitter: &Emitter, owner: &str) -> Vec<String> {
    let groups = emitter.program.params.iter().zip(&emitter.names.fields);
    let of = |(group, field): (&Group, &String)| -> Vec<String> {
        let indices = indices(group.shape).into_iter();
        indices.map(|index| format!("{owner}.{field}{index}")).collect()
    };
    groups.flat_map(of).collect()
}

/// A value in the shape of a group, its entries given by row and column.
fn shaped(shape: ShapeKind, entry: impl Fn(usize, usize) -> String) -> String {
    let row = |i: usize, n: usize| (0..n).map(|j| entry(i, j)).collect::<Vec<_>>().join(", ");
    match shape {
        ShapeKind::Scalar => entry(0, 0),
        ShapeKind::Vector(n) => format!("[{}]", row(0, n)),
        ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => {
            let rows: Vec<String> = (0..n).map(|i| format!("[{}]", row(i, n))).collect();
            format!("[{}]", rows.join(", "))
        }
    }
}

/// What is kept of a given value: a symmetric matrix is read above its diagonal.
fn kept_value(group: &Group, name: &str) -> String {
    match group.shape {
        ShapeKind::Symmetric(_) => {
            shaped(group.shape, |i, j| format!("{name}[{}][{}]", i.min(j), i.max(j)))
        }
        _ => name.into(),
    }
}

/// Whether there is a field of constants: the type has at least one field.
fn has_kept(emitter: &Emitter) -> bool {
    !emitter.kept.is_empty() || emitter.program.params.is_empty()
}

fn zero_constants(emitter: &Emitter) -> String {
    zeros(Shape::Vector(emitter.kept.len()))
}

/// `struct Name<S> { … }`
pub fn structure(emitter: &Emitter) -> String {
    let program = emitter.program;
    let mut lines = program.docs.clone();
    if lines.is_empty() {
        lines.push(format!("Equations of motion of `{}`.", program.name));
    }
    let mut fields = String::new();
    for (group, field) in program.params.iter().zip(&emitter.names.fields) {
        fields.push_str(&format!("/// Parameter `{}`.\n{field}: {},\n", group.name, group_type(group.shape)));
    }
    if has_kept(emitter) {
        let (kept, n) = (&emitter.names.kept, emitter.kept.len());
        fields.push_str(&format!("/// What depends on parameters alone.\n{kept}: [S; {n}],\n"));
    }
    let public = if program.public { "pub " } else { "" };
    format!(
        "{}#[rustfmt::skip]\n#[allow(dead_code, non_camel_case_types, unreachable_pub, reason = \"the description's names and uses\")]\n#[derive(Clone, Debug)]\n{public}struct {}<S> {{\n{fields}}}\n\n",
        docs::comment(&lines),
        emitter.names.type_name
    )
}

/// Sizes and `new`.
pub fn sizes(emitter: &Emitter) -> String {
    let program = emitter.program;
    let params: usize = program.params.iter().map(|group| group.len).sum();
    let first = 1 + params;
    let sizes = [
        ("COORDINATES", "ν, the number of coordinates x.", first, program.nu),
        ("VELOCITIES", "n, the number of velocities ξ.", first + program.nu, program.n),
        ("INPUTS", "The number of inputs u.", first + program.nu + program.n, program.m),
        ("PARAMETERS", "The number of parameters, entry by entry.", 1, params),
    ];
    let mut text = String::new();
    for (name, what, first, size) in sizes {
        let lines = docs::comment(&docs::entries(program, what, first, size));
        text.push_str(&format!("{lines}pub const {name}: usize = {size};\n\n"));
    }
    text + &constructor(emitter)
}

fn constructor(emitter: &Emitter) -> String {
    let groups = || emitter.program.params.iter().zip(&emitter.names.fields);
    let arguments: Vec<String> =
        groups().map(|(group, field)| format!("{field}: {}", group_type(group.shape))).collect();
    let mut lines = vec!["The system with given parameters.".to_string(), String::new()];
    for (group, field) in groups() {
        lines.push(format!("- `{field}`: `{}`, {}", group.name, docs::shape(group.shape)));
    }
    if groups().any(|(group, _)| matches!(group.shape, ShapeKind::Symmetric(_))) {
        lines.extend([String::new(), "Symmetric matrices are read above their diagonal.".into()]);
    }
    lines.extend(errors());
    let values = groups().map(|(group, field)| match kept_value(group, field) {
        value if value == *field => value,
        value => format!("{field}: {value}"),
    });
    let (mutable, update) = match needs_update(emitter) {
        true => ("mut ", format!("system.{}()?;\n", emitter.names.update)),
        false => ("", String::new()),
    };
    format!(
        "{}pub fn new({}) -> ::core::result::Result<Self, ::hamel::Singular> {{\nlet {mutable}system = {};\n{update}Ok(system)\n}}\n\n",
        docs::comment(&lines),
        arguments.join(", "),
        literal(emitter, values.collect())
    )
}

/// `Self { … }` with constants not yet computed.
fn literal(emitter: &Emitter, mut fields: Vec<String>) -> String {
    if has_kept(emitter) {
        fields.push(format!("{}: {}", emitter.names.kept, zero_constants(emitter)));
    }
    format!("Self {{ {} }}", fields.join(", "))
}

fn errors() -> Vec<String> {
    let text = "`Singular` where a constant pivot of the mass matrix is not positive and finite.";
    vec![String::new(), "# Errors".into(), text.into()]
}

fn needs_update(emitter: &Emitter) -> bool {
    !emitter.kept.is_empty() || !emitter.program.constant_guards.is_empty()
}

/// Accessors of all parameters, and the function that keeps constants in step with them.
pub fn accessors(emitter: &Emitter) -> String {
    let groups = 0..emitter.program.params.len();
    groups.map(|index| accessor(emitter, index)).collect::<String>() + &update(emitter)
}

fn accessor(emitter: &Emitter, index: usize) -> String {
    let group = &emitter.program.params[index];
    let (field, name) = (&emitter.names.fields[index], &emitter.names.accessors[index]);
    let (written, shape) = (&group.name, docs::shape(group.shape));
    let of = group_type(group.shape);
    let value = kept_value(group, "value");
    let mut lines = vec![format!("Sets parameter `{written}`; on an error nothing changes.")];
    lines.extend(errors());
    let body = match needs_update(emitter) {
        true => format!(
            "let mut next = self.clone();\nnext.{field} = {value};\nnext.{}()?;\n*self = next;\n",
            emitter.names.update
        ),
        false => format!("self.{field} = {value};\n"),
    };
    format!(
        "/// Parameter `{written}`, {shape}.\n#[must_use]\npub fn {name}(&self) -> {of} {{\nself.{field}\n}}\n\n{}pub fn set_{name}(&mut self, value: {of}) -> {RESULT} {{\n{body}Ok(())\n}}\n\n",
        docs::comment(&lines)
    )
}

/// Computes the constants and checks the pivots among them.
fn update(emitter: &Emitter) -> String {
    if !needs_update(emitter) {
        return String::new();
    }
    let names = &emitter.names;
    let mut body = String::new();
    if !emitter.kept.is_empty() {
        body.push_str(&format!("self.{} = self.{}();\n", names.kept, names.constants));
    }
    let graph = &emitter.program.graph;
    let parameters = expressions(emitter, "self");
    for (pivot, guard) in emitter.program.constant_guards.iter().enumerate() {
        let node = guard.node();
        let value = match is_hoisted(graph, node) {
            true => emitter.kept.iter().position(|edge| edge.node() == node).map(|i| format!("self.{}[{i}]", names.kept)),
            false => emitter.places.parameter(node).map(|index| parameters[index].clone()),
        };
        let value = value.unwrap_or_else(|| number::of(graph, node));
        let value = if guard.is_negative() { format!("(-{value})") } else { value };
        body.push_str(&check(&value, pivot));
    }
    format!(
        "/// Brings the kept constants in step with the parameters.\nfn {}(&mut self) -> {RESULT} {{\n{body}Ok(())\n}}\n\n",
        names.update
    )
}

/// `impl Default`
pub fn default(emitter: &Emitter) -> String {
    let program = emitter.program;
    let entry = |index: usize| number::scalar(program.defaults.get(index).copied().unwrap_or_default());
    let groups = program.params.iter().zip(&emitter.names.fields);
    let fields = groups.map(|(group, field)| {
        let columns = match group.shape {
            ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => n,
            _ => 0,
        };
        let value = shaped(group.shape, |i, j| match group.shape {
            ShapeKind::Symmetric(n) => entry(group.offset + upper(n, i.min(j), i.max(j))),
            _ => entry(group.offset + i * columns + j),
        });
        format!("{field}: {value}")
    });
    let value = literal(emitter, fields.collect());
    let names = &emitter.names;
    let body = match emitter.kept.is_empty() {
        true => value,
        false => format!("let mut system = {value};\nsystem.{} = system.{}();\nsystem", names.kept, names.constants),
    };
    format!(
        "{ALLOW_TRAIT}impl<S: ::hamel::Scalar> ::core::default::Default for {}<S> {{\n/// The parameters of the description.\nfn default() -> Self {{\n{body}\n}}\n}}\n\n",
        names.type_name
    )
}

/// The place of entry (i, j), i ≤ j, among those on and above the diagonal, by rows.
fn upper(n: usize, i: usize, j: usize) -> usize {
    i * n - i * (i + 1) / 2 + j
}
