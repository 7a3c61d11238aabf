//! The generated type: its fields, sizes, constructor and defaults.

use super::function::zero_of_shape;
use super::parameters::{group_type, needs_update, setter_error_section, value_to_store};
use super::{Emitter, docs, externals};
use hamel_program::{FunctionId, Shape};

/// Lint attributes for generated functions, which cannot satisfy these lints in general. A file that is included has no
/// inner attributes, so that each item has its own.
pub const FUNCTION_LINTS: &str = concat!(
    "#[rustfmt::skip]\n",
    "#[allow(dead_code, unreachable_pub, unused_qualifications, unused_variables, clippy::approx_constant, \
     clippy::let_and_return, clippy::nursery, clippy::pedantic, clippy::too_many_arguments, clippy::type_complexity, \
     clippy::wrong_self_convention, reason = \"names, numbers and shapes are those of the description\")]\n",
);

/// Lint attributes for generated types and traits.
pub const TYPE_LINTS: &str = concat!(
    "#[rustfmt::skip]\n",
    "#[allow(dead_code, non_camel_case_types, unreachable_pub, clippy::nursery, clippy::pedantic, \
     clippy::too_many_arguments, reason = \"the description's names and uses\")]\n",
);

/// Lint attributes for generated trait implementations, which cannot satisfy these lints in general.
pub const TRAIT_LINTS: &str = r#"#[rustfmt::skip]
#[allow(unused_qualifications, clippy::approx_constant, clippy::nursery, clippy::pedantic, reason = "full paths are right whatever is imported")]
"#;

/// Whether the generated type has a field of kept constants. There is one even without constants if there are no
/// parameters, so that the type has at least one field.
pub fn has_constants_field(emitter: &Emitter) -> bool {
    !emitter.kept.is_empty() || emitter.program.params.is_empty()
}

fn zero_constants(emitter: &Emitter) -> String {
    zero_of_shape(Shape::Vector(emitter.kept.len()))
}

/// Prints the generated Rust type: `struct Name<S> { … }`.
pub fn print_struct(emitter: &Emitter) -> String {
    let program = emitter.program;
    let mut lines = program.docs.clone();
    if lines.is_empty() {
        lines.push(format!("Equations of motion of `{}`.", program.name));
    }
    if program.function(FunctionId::Accel).is_some() {
        lines.push(String::new());
        lines.extend(program.structure.documentation());
    }
    let mut fields = String::new();
    for (group, field) in program.params.iter().zip(&emitter.names.fields) {
        fields.push_str(&format!(
            "/// Parameter {}.\n{field}: {},\n",
            group.quoted(),
            group_type(group.shape)
        ));
    }
    if has_constants_field(emitter) {
        let (kept, n) = (&emitter.names.kept, emitter.kept.len());
        fields.push_str(&format!(
            "/// What depends on parameters alone.\n{kept}: [S; {n}],\n"
        ));
    }
    fields.push_str(&externals::field(emitter));
    let public = if program.public { "pub " } else { "" };
    format!(
        "{}{TYPE_LINTS}#[derive(Clone, Debug)]\n{public}struct {} {{\n{fields}}}\n\n",
        docs::doc_comment(&lines),
        externals::declared_type(emitter)
    )
}

/// Prints the size constants and the function `new` of the generated Rust type.
pub fn print_sizes_and_new(emitter: &Emitter) -> String {
    let program = emitter.program;
    let [params, x, ..] = program.symbols();
    let mut sizes = docs::size_constants(program);
    let what = "The number of parameters, entry by entry.";
    sizes.push(("PARAMETERS", what, params, x - params));
    let mut text = String::new();
    for (name, what, first, size) in sizes {
        let lines = docs::doc_comment(&docs::entry_lines(program, what, first, size));
        text.push_str(&format!("{lines}pub const {name}: usize = {size};\n\n"));
    }
    text + &constructor(emitter)
}

fn constructor(emitter: &Emitter) -> String {
    let groups = || emitter.program.params.iter().zip(&emitter.names.fields);
    let mut lines = vec!["The system with given parameters.".to_string()];
    lines.extend(setter_error_section(emitter.program));
    let mut arguments = Vec::new();
    if !emitter.program.params.is_empty() {
        arguments.push(format!(
            "parameters: {}Parameters<S>",
            emitter.names.type_name
        ));
    }
    if externals::has_externals(emitter) {
        let names = &emitter.names.externals;
        arguments.push(format!("{}: {}", names.field, names.parameter));
        lines[0] = "The system with given parameters and functions.".into();
    }
    let argument = arguments.join(", ");
    let values = groups().map(|(group, field)| {
        let value = value_to_store(group, &format!("parameters.{field}"));
        format!("{field}: {value}")
    });
    let (mutable, update) = match needs_update(emitter) {
        true => ("mut ", format!("system.{}()?;\n", emitter.names.update)),
        false => ("", String::new()),
    };
    format!(
        "{}pub fn new({argument}) -> ::core::result::Result<Self, ::hamel::Singular> {{\nlet {mutable}system = {};\n{update}::core::result::Result::Ok(system)\n}}\n\n",
        docs::doc_comment(&lines),
        literal(emitter, values.collect(), None)
    )
}

/// Returns `Self { … }` with the constants not yet computed.
fn literal(emitter: &Emitter, mut fields: Vec<String>, functions: Option<&str>) -> String {
    if has_constants_field(emitter) {
        fields.push(format!(
            "{}: {}",
            emitter.names.kept,
            zero_constants(emitter)
        ));
    }
    if externals::has_externals(emitter) {
        let field = &emitter.names.externals.field;
        fields.push(functions.map_or_else(|| field.clone(), |value| format!("{field}: {value}")));
    }
    format!("Self {{ {} }}", fields.join(", "))
}

/// Prints `impl Default` of the generated Rust type, with the default parameters.
pub fn print_default(emitter: &Emitter) -> String {
    let program = emitter.program;
    let fields = emitter.names.fields.iter();
    let fields = fields.map(|field| format!("{field}: parameters.{field}"));
    let functions = format!("{}::default()", emitter.names.externals.parameter);
    let value = literal(emitter, fields.collect(), Some(&functions));
    let names = &emitter.names;
    let given = match program.params.is_empty() {
        true => String::new(),
        false => format!(
            "let parameters = {}Parameters::<S>::default();\n",
            names.type_name
        ),
    };
    let body = match emitter.kept.is_empty() {
        true => format!("{given}{value}"),
        false => format!(
            "{given}let mut system = {value};\nsystem.{} = system.{}();\nsystem",
            names.kept, names.constants
        ),
    };
    format!(
        "{TRAIT_LINTS}impl{} ::core::default::Default for {}{} {{\n/// The parameters of the description.\nfn default() -> Self {{\n{body}\n}}\n}}\n\n",
        externals::impl_generics(emitter),
        externals::type_with_arguments(emitter),
        externals::default_where_clause(emitter)
    )
}
