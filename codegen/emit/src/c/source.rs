//! The source file `name.c`: definitions of the functions that the header declares.

use super::body::{self, indent_lines};
use super::header::{function_prototype, setup_prototypes};
use super::language::ArrayOrigins;
use super::{CLanguage, Texts, helpers, with_prepared};
use crate::function::print_statements;
use crate::parameters;
use hamel_language::syntax::ast::ShapeKind;

/// Returns the text of the C source without the comment and the `#include` at its top.
pub fn print_source(texts: &Texts) -> String {
    let names = &texts.names;
    let [default, set, start] = setup_prototypes(texts);
    let mut functions = format!(
        "{default}\n{{\n{}}}\n\n{}{set}\n{{\n{}}}\n\n{start}\n{{\n{}}}\n",
        indent_lines(&defaults(texts)),
        constants(texts),
        indent_lines(&setting(texts)),
        indent_lines(&beginning(texts)),
    );
    let language = language(texts);
    let read = expressions(texts, "system->parameters.");
    for (spec, name) in texts.functions() {
        let prototype = function_prototype(texts, &spec, name);
        let mut parts = String::new();
        let body = with_prepared(&texts.emitter, &spec, &language, &read, |drawing| {
            if drawing.plan.parts.len() <= 1 {
                return body::print_whole_body(texts, drawing);
            }
            let body;
            (parts, body) = body::print_parts_and_body(texts, drawing);
            body
        });
        functions.push_str(&format!(
            "{parts}\n{prototype}\n{{\n{}}}\n",
            indent_lines(&body)
        ));
    }
    let [before, after] = helpers::helpers_around(&functions, names, texts.precision);
    let everything = format!("{before}{functions}");
    let headers: String = [
        ("float.h", ["FLT_RADIX", "FLT_EVAL"].as_slice()),
        ("math.h", &["("]),
        ("stdint.h", &["uint32_t", "uint64_t"]),
        ("string.h", &["memcpy"]),
    ]
    .iter()
    .filter(|(_, words)| words.iter().any(|word| everything.contains(word)))
    .map(|(header, _)| format!("#include <{header}>\n"))
    .collect();
    format!("{headers}\n{everything}{after}")
}

fn language<'a>(texts: &'a Texts) -> CLanguage<'a> {
    CLanguage {
        names: &texts.names,
        precision: texts.precision,
        origins: ArrayOrigins::default(),
    }
}

/// Returns all parameters as expressions; `owner` is the prefix of the field names.
fn expressions(texts: &Texts, owner: &str) -> Vec<String> {
    parameters::parameter_expressions(texts.program(), &texts.names.fields, owner)
}

/// Prints the body of `default_parameters`: `parameters->m = 1.3;` and so on.
fn defaults(texts: &Texts) -> String {
    let program = texts.program();
    let groups = program.params.iter().zip(&texts.names.fields);
    let mut text = String::new();
    for (group, field) in groups {
        let mut set = |index: String, place: usize| {
            let value = program.defaults.get(group.offset + place);
            let value = texts.precision.literal(value.copied().unwrap_or_default());
            let value = value.trim_start_matches('(').trim_end_matches(')');
            text.push_str(&format!("parameters->{field}{index} = {value};\n"));
        };
        match group.shape {
            // Sets all entries, so that no entry is uninitialized when it is read.
            ShapeKind::Symmetric(n) => {
                let upper = |i: usize, j: usize| i * n - i * (i + 1) / 2 + j;
                for i in 0..n {
                    for j in 0..n {
                        set(format!("[{i}][{j}]"), upper(i.min(j), i.max(j)));
                    }
                }
            }
            shape => {
                for (place, index) in parameters::index_expressions(shape).into_iter().enumerate() {
                    set(index, place);
                }
            }
        }
    }
    if program.params.is_empty() {
        text.push_str(&format!(
            "parameters->none = {};\n",
            texts.precision.literal(0.0)
        ));
    }
    text
}

/// Prints the function that computes everything that depends on parameters alone; empty if there is nothing.
fn constants(texts: &Texts) -> String {
    if texts.emitter.kept.is_empty() {
        return String::new();
    }
    let spec = texts.emitter.constants();
    let read = expressions(texts, "parameters->");
    let language = language(texts);
    let body = with_prepared(&texts.emitter, &spec, &language, &read, |drawing| {
        let mut printer = drawing.printer();
        let mut text = String::new();
        for part in &drawing.plan.parts {
            text.push_str(&print_statements(
                &mut printer,
                drawing.body,
                part,
                |_, _| String::new(),
            ));
        }
        for (index, &edge) in drawing.body.outputs.iter().enumerate() {
            let value = printer.signed_value(edge);
            text.push_str(&format!("k[{index}] = {value};\n"));
        }
        match text.contains("parameters->") {
            true => text,
            false => format!("(void)parameters;\n{text}"),
        }
    });
    format!(
        "/* What depends on parameters alone. */\nstatic void {}(const {} *parameters, {} *k)\n{{\n{}}}\n\n",
        texts.names.identifier(&texts.emitter.names.constants),
        texts.names.identifier("parameters"),
        texts.names.real(),
        indent_lines(&body)
    )
}

/// Prints the body of `set_parameters`: computes the constants in a copy, and keeps it if all pivots are positive.
fn setting(texts: &Texts) -> String {
    let emitter = &texts.emitter;
    let names = &texts.names;
    let mut text = format!(
        "{} next;\nnext.parameters = *parameters;\n",
        names.identifier("system")
    );
    if !emitter.kept.is_empty() {
        let constants = names.identifier(&emitter.names.constants);
        text.push_str(&format!("{constants}(parameters, next.k);\n"));
    }
    let read = expressions(texts, "next.parameters.");
    text.push_str(&parameters::print_pivot_checks(
        emitter,
        &language(texts),
        "next.k",
        &read,
    ));
    text + &format!("*system = next;\nreturn {};\n", names.success_code())
}

/// Prints the body of `start`: the initial x and ξ.
fn beginning(texts: &Texts) -> String {
    let program = texts.program();
    let mut text = String::new();
    for (array, values) in [("x", &program.start_x), ("xi", &program.start_xi)] {
        if values.is_empty() {
            text.push_str(&format!("(void){array};\n"));
        }
        for (index, &value) in values.iter().enumerate() {
            let value = texts.precision.literal(value);
            let value = value.trim_start_matches('(').trim_end_matches(')');
            text.push_str(&format!("{array}[{index}] = {value};\n"));
        }
    }
    text
}
