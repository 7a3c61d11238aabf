//! The header `name.h`: sizes, indices of entries by name, types, and documented prototypes.

use super::{Texts, comment, returns_number};
use crate::function::FunctionSpec;
use crate::names::{UniqueNames, argument_name};
use crate::views::{NamedRange, input_fields, state_fields};
use crate::{docs, limits};
use hamel_language::syntax::ast::ShapeKind;
use hamel_program::{Cause, Program};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Returns the text of the C header of a program, without the comment that says how it was generated.
pub fn print_header(texts: &Texts) -> String {
    let capitals = &texts.names.capitals;
    let mut declared = String::new();
    for (spec, name) in texts.functions() {
        let docs = comment::doc_comment(&spec.docs, 0);
        declared.push_str(&format!(
            "\n{docs}{};\n",
            function_prototype(texts, &spec, name)
        ));
    }
    let limits = limit_macros(texts);
    let infinite = ["HUGE_VAL", "NAN"].iter().any(|word| limits.contains(word));
    let headers = if infinite {
        "\n#include <math.h>\n"
    } else {
        ""
    };
    format!(
        "#ifndef {capitals}_H\n#define {capitals}_H\n\n{}{headers}{}{}{limits}{}{}{declared}\n#ifdef __cplusplus\n}}\n#endif\n\n#endif\n",
        about(texts),
        opening(capitals),
        sizes(texts),
        types(texts),
        setting(texts),
    )
}

/// Prints the documentation of the system and of how to call its functions.
fn about(texts: &Texts) -> String {
    let (program, names) = (texts.program(), &texts.names);
    let mut lines = program.docs.clone();
    if lines.is_empty() {
        lines.push(format!("Equations of motion of `{}`.", program.name));
    }
    let fill = format!(
        "Fill a `{}` by `{}` and pass it to the other functions,",
        names.identifier("system"),
        names.identifier("set_parameters")
    );
    lines.extend([String::new(), fill]);
    lines.extend(
        [
            "which do nothing but to read their arguments and to write their result: nothing is allocated,",
            "nothing is kept between calls. Results must not overlap arguments. Vectors are arrays, matrices",
            "arrays of their rows, one behind the other; what has no entries is not read and may be null.",
        ]
        .map(String::from),
    );
    comment::doc_comment(&lines, 0)
}

fn opening(capitals: &str) -> String {
    format!(
        "\n#ifdef __cplusplus\n#define {capitals}_RESTRICT __restrict\nextern \"C\" {{\n#else\n#define {capitals}_RESTRICT restrict\n#endif\n\n"
    )
}

/// Prints the sizes of all arrays, and the index of each named entry.
fn sizes(texts: &Texts) -> String {
    let program = texts.program();
    let capitals = &texts.names.capitals;
    let mut text = "/** Sizes, and places of entries by name. */\nenum {\n".to_string();
    let entry = |text: &mut String, docs: String, name: String, value: usize| {
        text.push_str(&format!("{docs}    {capitals}_{name} = {value},\n"));
    };
    for (name, what, first, size) in docs::size_constants(program) {
        let docs = comment::doc_comment(&docs::entry_lines(program, what, first, size), 4);
        entry(&mut text, docs, name.into(), size);
    }
    let mut taken = UniqueNames::default();
    for NamedRange {
        name,
        docs,
        shape,
        array,
        offset,
    } in state_fields(program)
        .into_iter()
        .chain(input_fields(program))
    {
        let wanted = format!("{array}_{name}").to_ascii_uppercase();
        let name = taken.claim(wanted.trim_end_matches('_'));
        let what = format!("{} In `{array}`, {}.", docs, entries(shape));
        entry(&mut text, comment::doc_comment_line(&what, 4), name, offset);
    }
    // C99 allows a trailing comma here, but C++ before 2011 does not.
    if let Some(end) = text.rfind(",\n") {
        text.truncate(end);
    }
    text + "\n};\n\n"
}

fn entries(shape: ShapeKind) -> String {
    match shape {
        ShapeKind::Scalar => "one entry".into(),
        ShapeKind::Vector(n) => format!("{n} entries from here"),
        ShapeKind::Matrix(n) => format!("{} entries from here", n * n),
        ShapeKind::Symmetric(n) => format!("{} entries from here", n * (n + 1) / 2),
    }
}

/// Prints the joint limits as macros; no function uses them.
fn limit_macros(texts: &Texts) -> String {
    let capitals = &texts.names.capitals;
    let mut text = String::new();
    for limit in limits::joint_limits(texts.program()) {
        text.push_str(&comment::doc_comment_line(&limit.title, 0));
        let endings: &[&str] = match limit.values.len() {
            2 => &["_LOWER", "_UPPER"],
            _ => &[""],
        };
        for (value, ending) in limit.values.iter().zip(endings) {
            let (name, value) = (&limit.name, texts.precision.literal(*value));
            text.push_str(&format!(
                "#define {capitals}_JOINT_{name}{ending} {value}\n"
            ));
        }
        text.push('\n');
    }
    text
}

/// Prints the types of numbers, status, parameters and system.
fn types(texts: &Texts) -> String {
    let (program, names) = (texts.program(), &texts.names);
    let real = names.real();
    let mut text = format!(
        "/** The numbers of all functions. */\ntypedef {} {real};\n\n{}",
        texts.precision,
        status(texts)
    );
    let parameters = names.identifier("parameters");
    let mut lines = vec!["The parameters, by name.".to_string()];
    let symmetric = |shape| matches!(shape, ShapeKind::Symmetric(_));
    if program.params.iter().any(|group| symmetric(group.shape)) {
        lines.push("Of symmetric matrices only the upper triangle is read.".into());
    }
    text.push_str(&comment::doc_comment(&lines, 0));
    text.push_str(&format!("typedef struct {parameters} {{\n"));
    for (group, field) in program.params.iter().zip(&names.fields) {
        let what = format!(
            "Parameter {}, {}.",
            group.quoted(),
            docs::shape_in_words(group.shape)
        );
        let size = match group.shape {
            ShapeKind::Scalar => String::new(),
            ShapeKind::Vector(n) => format!("[{n}]"),
            ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => format!("[{n}][{n}]"),
        };
        let what = comment::doc_comment_line(&what, 4);
        text.push_str(&format!("{what}    {real} {field}{size};\n"));
    }
    if program.params.is_empty() {
        let what =
            comment::doc_comment_line("There are no parameters, and C has no empty structures.", 4);
        text.push_str(&format!("{what}    {real} none;\n"));
    }
    let system = names.identifier("system");
    text.push_str(&format!(
        "}} {parameters};\n\n/** What the functions read: parameters, and constants that were computed from them. */\ntypedef struct {system} {{\n    /** The parameters; to change them, call `{}` anew. */\n    {parameters} parameters;\n",
        names.identifier("set_parameters")
    ));
    if !texts.emitter.kept.is_empty() {
        text.push_str(&format!(
            "    /** What depends on parameters alone. */\n    {real} k[{}];\n",
            texts.emitter.kept.len()
        ));
    }
    text + &format!("}} {system};\n\n")
}

/// Prints the status codes, with all reasons for which a function can fail.
fn status(texts: &Texts) -> String {
    let names = &texts.names;
    let program = texts.program();
    let mut text = format!(
        "/** Whether there is a value, and else why there is none. Velocities, rows and pivots are counted from 0. */\ntypedef enum {} {{\n    /** There is one. */\n    {} = 0",
        names.identifier("status"),
        names.success_code()
    );
    for (number, cause) in causes(program).into_iter().enumerate() {
        let meaning = match cause {
            Cause::Velocity(place) => format!(
                "The mass matrix is not positive definite: the velocity `{}` has no inertia.",
                program.velocity(place)
            ),
            Cause::Mass => "The mass matrix is not positive definite.".into(),
            Cause::Constraint(row) => {
                format!("The constraint of row {row} depends on the others.")
            }
            Cause::Kinematics(pivot) => format!(
                "The mechanism is at a kinematic singularity: pivot {pivot} of [Y; Φ] has changed sign."
            ),
        };
        let _ = write!(
            text,
            ",\n    /** {meaning} */\n    {} = {}",
            names.status_code(cause),
            number + 1
        );
    }
    text + &format!("\n}} {};\n\n", names.identifier("status"))
}

/// Returns the causes of failure of all functions, including `set_parameters`.
fn causes(program: &Program) -> BTreeSet<Cause> {
    let functions = program.functions.iter().filter(|f| f.fallible);
    let guards = functions.flat_map(|function| &function.guards);
    let guards = guards.chain(&program.constant_guards);
    guards.map(|&guard| program.cause(guard)).collect()
}

/// Prints the prototypes that every header has, in addition to the functions of the description.
fn setting(texts: &Texts) -> String {
    let names = &texts.names;
    let [default, set, start] = setup_prototypes(texts);
    format!(
        "/** The parameters of the description. */\n{default};\n\n/**\n * Computes what depends on parameters alone.\n *\n * Returns a status other than `{}`, and leaves `system` alone, where a constant pivot is not positive and finite.\n */\n{set};\n\n/** The start of the description: x, and ξ with the states behind it. */\n{start};\n",
        names.success_code()
    )
}

/// Returns the prototypes of `default_parameters`, `set_parameters` and `start`.
pub fn setup_prototypes(texts: &Texts) -> [String; 3] {
    let names = &texts.names;
    let restrict = format!("{}_RESTRICT", names.capitals);
    let [real, status, system, parameters] =
        ["real", "status", "system", "parameters"].map(|name| names.identifier(name));
    [
        format!(
            "void {}({parameters} *parameters)",
            names.identifier("default_parameters")
        ),
        format!(
            "{status} {}({system} *{restrict} system, const {parameters} *{restrict} parameters)",
            names.identifier("set_parameters")
        ),
        format!(
            "void {}({real} *{restrict} x, {real} *{restrict} xi)",
            names.identifier("start")
        ),
    ]
}

/// Returns the C prototype of a function under this name.
pub fn function_prototype(texts: &Texts, spec: &FunctionSpec, name: &str) -> String {
    let names = &texts.names;
    let real = names.real();
    let restrict = format!("{}_RESTRICT", names.capitals);
    let number = returns_number(spec.shape, spec.fallible);
    let returned = match (spec.fallible, number) {
        (true, _) => names.identifier("status"),
        (false, true) => real.clone(),
        (false, false) => "void".into(),
    };
    let mut arguments = vec![format!(
        "const {} *{restrict} system",
        names.identifier("system")
    )];
    let given = spec.arguments.iter().map(|&given| argument_name(given));
    arguments.extend(given.map(|given| format!("const {real} *{restrict} {given}")));
    if !number {
        arguments.push(format!("{real} *{restrict} out"));
    }
    format!("{returned} {name}(\n    {})", arguments.join(",\n    "))
}
