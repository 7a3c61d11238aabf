//! External functions, which the user implements in Rust: the trait that declares them, over which the generated type
//! is generic. A description without external functions has neither the trait nor the type parameter.

use super::structure::TYPE_LINTS;
use super::{Emitter, docs};
use hamel_algebra::external::External;

/// Returns the generics of an `impl` of the generated type: `<S: ::hamel::Scalar>`, plus the bound `F` if there are
/// external functions.
pub fn impl_generics(emitter: &Emitter) -> String {
    match bound(emitter) {
        Some(bound) => format!("<S: ::hamel::Scalar, {bound}>"),
        None => "<S: ::hamel::Scalar>".into(),
    }
}

/// The bound `F: NameFunctions<S>`.
fn bound(emitter: &Emitter) -> Option<String> {
    let names = &emitter.names.externals;
    (!names.methods.is_empty()).then(|| format!("{}: {}<S>", names.parameter, names.of))
}

/// Returns the generated type with its generic arguments: `Name<S>` or `Name<S, F>`.
pub fn type_with_arguments(emitter: &Emitter) -> String {
    let name = &emitter.names.type_name;
    match has_externals(emitter) {
        true => format!("{name}<S, {}>", emitter.names.externals.parameter),
        false => format!("{name}<S>"),
    }
}

/// Returns the generated type as its declaration has it: `Name<S = f64>`, or `Name<S, F>`, where only the last argument
/// could have a default.
pub fn declared_type(emitter: &Emitter) -> String {
    match has_externals(emitter) {
        true => type_with_arguments(emitter),
        false => format!("{}<S = f64>", emitter.names.type_name),
    }
}

/// Whether the description declares external functions, `extern fn`.
pub fn has_externals(emitter: &Emitter) -> bool {
    !emitter.names.externals.methods.is_empty()
}

/// Returns the `where` clause that `impl Default` needs if there are external functions.
pub fn default_where_clause(emitter: &Emitter) -> String {
    match has_externals(emitter) {
        true => format!(
            " where {}: ::core::default::Default",
            emitter.names.externals.parameter
        ),
        false => String::new(),
    }
}

/// Prints the Rust trait that users implement for the external functions, with the formula and the shape of each.
pub fn print_external_trait(emitter: &Emitter) -> String {
    if !has_externals(emitter) {
        return String::new();
    }
    let names = &emitter.names.externals;
    let of = &emitter.names.type_name;
    let mut methods = String::new();
    let externals = emitter.program.graph.externals().iter();
    for ((external, [value, slopes]), arguments) in
        externals.zip(&names.methods).zip(&names.arguments)
    {
        let given: Vec<String> = arguments.iter().map(|name| format!("{name}: S")).collect();
        let given = given.join(", ");
        let (m, n) = (external.components, arguments.len());
        let row = format!("[S; {n}]");
        let (result, matrix) = match m {
            1 => ("S".into(), row),
            _ => (format!("[S; {m}]"), format!("[{row}; {m}]")),
        };
        let [first, second] = documentation(external);
        methods.push_str(&format!(
            "{}fn {value}(&self, {given}) -> {result};\n\n{}fn {slopes}(&self, {given}) -> {matrix};\n\n",
            docs::doc_comment(&first),
            docs::doc_comment(&second),
        ));
    }
    let public = if emitter.program.public { "pub " } else { "" };
    let lines = [
        format!("The functions that the description of `{of}` calls and does not define."),
        String::new(),
        "What they give may depend on their arguments alone. Where one of them jumps, or the matrix".into(),
        "is not that of its slopes, the linearisation is wrong and nothing says so.".into(),
    ];
    format!(
        "{}{TYPE_LINTS}{public}trait {}<S: ::hamel::Scalar>: ::core::clone::Clone {{\n{methods}}}\n\n",
        docs::doc_comment(&lines),
        names.of
    )
}

/// Returns the documentation of the components and of the slopes of a function.
fn documentation(external: &External) -> [Vec<String>; 2] {
    let given = external.arguments.join(", ");
    let (name, m, n) = (
        &external.name,
        external.components,
        external.arguments.len(),
    );
    let call = format!("{name}({given})");
    match m {
        1 => [
            vec![format!("The number f = `{call}`.")],
            vec![format!(
                "Its {n} slopes ∂f/∂aⱼ, in the order of the arguments a = ({given})."
            )],
        ],
        _ => [
            vec![format!(
                "The {m} components fᵢ of `{call}`, of which the description calls the first `{call}[1]`."
            )],
            vec![format!(
                "Their {m} × {n} slopes ∂fᵢ/∂aⱼ: a row for each component, in it the arguments a = ({given}) in order."
            )],
        ],
    }
}

/// Prints the struct print_external_field that holds the external functions.
pub fn field(emitter: &Emitter) -> String {
    let names = &emitter.names.externals;
    match has_externals(emitter) {
        true => format!(
            "/// The functions that the description does not define.\n{}: {},\n",
            names.field, names.parameter
        ),
        false => String::new(),
    }
}
