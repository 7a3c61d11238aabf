//! Parameters: their shapes, their accessors, and the constants computed from them.

use super::language::{Language, Operand, Rust};
use super::{Emitter, docs};
use hamel_algebra::graph::Edge;
use hamel_language::model::Group;
use hamel_language::syntax::ast::ShapeKind;
use hamel_program::Program;
use hamel_program::schedule::is_hoisted;

const RESULT: &str = "::core::result::Result<(), ::hamel::Singular>";

/// Returns the Rust type of a parameter group.
pub fn group_type(shape: ShapeKind) -> String {
    match shape {
        ShapeKind::Scalar => "S".into(),
        ShapeKind::Vector(n) => format!("[S; {n}]"),
        ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => format!("[[S; {n}]; {n}]"),
    }
}

/// Returns the Rust index expressions of the entries of a parameter group, such as `[0][1]`, in the order of its
/// symbols.
pub fn index_expressions(shape: ShapeKind) -> Vec<String> {
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

/// Returns all parameters as expressions, in the order of their symbols; `owner` is the prefix of the field names.
pub fn parameter_expressions(program: &Program, fields: &[String], owner: &str) -> Vec<String> {
    let groups = program.params.iter().zip(fields);
    let of = |(group, field): (&Group, &String)| -> Vec<String> {
        let indices = index_expressions(group.shape).into_iter();
        indices
            .map(|index| format!("{owner}{field}{index}"))
            .collect()
    };
    groups.flat_map(of).collect()
}

/// Returns a Rust expression in the shape of a parameter group, with entries given by row and column.
pub fn shaped_expression(shape: ShapeKind, entry: impl Fn(usize, usize) -> String) -> String {
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

/// Returns the Rust expression of the value to store for a given parameter: only the upper triangle of a symmetric
/// matrix is read.
pub fn value_to_store(group: &Group, name: &str) -> String {
    match group.shape {
        ShapeKind::Symmetric(_) => shaped_expression(group.shape, |i, j| {
            format!("{name}[{}][{}]", i.min(j), i.max(j))
        }),
        _ => name.into(),
    }
}

/// Returns the `# Errors` section of the documentation of a function that sets parameters.
pub fn setter_error_section(program: &Program) -> [String; 3] {
    docs::error_section(program, &program.constant_guards, "the parameters")
}

/// Whether setting parameters requires constants to be computed or pivots to be checked.
pub fn needs_update(emitter: &Emitter) -> bool {
    !emitter.kept.is_empty() || !emitter.program.constant_guards.is_empty()
}

/// Prints the accessors of all parameters, and the function that updates the kept constants.
pub fn print_accessors(emitter: &Emitter) -> String {
    let groups = 0..emitter.program.params.len();
    groups
        .map(|index| accessor(emitter, index))
        .collect::<String>()
        + &update(emitter)
}

fn accessor(emitter: &Emitter, index: usize) -> String {
    let group = &emitter.program.params[index];
    let (field, name) = (
        &emitter.names.fields[index],
        &emitter.names.accessors[index],
    );
    let (written, shape) = (group.quoted(), docs::shape_in_words(group.shape));
    let of = group_type(group.shape);
    let value = value_to_store(group, "value");
    let mut lines = vec![format!(
        "Sets parameter {written}; on an error nothing changes."
    )];
    lines.extend(setter_error_section(emitter.program));
    let body = match needs_update(emitter) {
        true => format!(
            "let mut next = self.clone();\nnext.{field} = {value};\nnext.{}()?;\n*self = next;\n",
            emitter.names.update
        ),
        false => format!("self.{field} = {value};\n"),
    };
    format!(
        "/// Parameter {written}, {shape}.\n#[must_use]\npub fn {name}(&self) -> {of} {{\nself.{field}\n}}\n\n{}pub fn set_{name}(&mut self, value: {of}) -> {RESULT} {{\n{body}::core::result::Result::Ok(())\n}}\n\n",
        docs::doc_comment(&lines)
    )
}

/// Prints the function that computes the constants and checks the pivots among them.
fn update(emitter: &Emitter) -> String {
    if !needs_update(emitter) {
        return String::new();
    }
    let names = &emitter.names;
    let mut body = String::new();
    if !emitter.kept.is_empty() {
        body.push_str(&format!(
            "self.{} = self.{}();\n",
            names.kept, names.constants
        ));
    }
    let kept = format!("self.{}", names.kept);
    body.push_str(&print_pivot_checks(
        emitter,
        &Rust,
        &kept,
        &parameter_expressions(emitter.program, &names.fields, "self."),
    ));
    format!(
        "/// Brings the kept constants in step with the parameters.\nfn {}(&mut self) -> {RESULT} {{\n{body}::core::result::Result::Ok(())\n}}\n\n",
        names.update
    )
}

/// Prints the checks of the pivots that depend on parameters alone, in the order of their numbers.
pub fn print_pivot_checks(
    emitter: &Emitter,
    language: &dyn Language,
    kept: &str,
    parameters: &[String],
) -> String {
    let program = emitter.program;
    let graph = &program.graph;
    let check = |guard: &Edge| {
        let node = guard.node();
        let value = match is_hoisted(graph, node) {
            true => {
                let place = emitter.kept.iter().position(|edge| edge.node() == node);
                place.map(|index| format!("{kept}[{index}]"))
            }
            false => {
                let index = emitter.places.parameter(node);
                index.map(|index| parameters[index].clone())
            }
        };
        let operand = Operand {
            value: value.unwrap_or_else(|| language.literal(graph, node)),
            negative: guard.is_negative(),
        };
        language.check(&operand, program.cause(*guard), program)
    };
    program.constant_guards.iter().map(check).collect()
}
