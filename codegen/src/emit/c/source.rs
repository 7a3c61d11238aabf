//! `name.c`: what the header declares.

use super::header::{prototype, prototypes};
use super::{C, Texts, comment, draw, helpers, returns_number};
use crate::algebra::graph::{Edge, NodeId};
use crate::emit::function::{Drawing, Spec, statements};
use crate::emit::names::argument;
use crate::emit::parameters;
use crate::emit::print::{Access, Printer, Used};
use crate::program::statements::Body;
use crate::syntax::ast::ShapeKind;
use rustc_hash::FxHashMap;

/// The source without its header.
pub fn text(texts: &Texts) -> String {
    let names = &texts.names;
    let [default, set, start] = prototypes(texts);
    let mut functions = format!(
        "{default}\n{{\n{}}}\n\n{}{set}\n{{\n{}}}\n\n{start}\n{{\n{}}}\n",
        indented(&defaults(texts)),
        constants(texts),
        indented(&setting(texts)),
        indented(&beginning(texts)),
    );
    let language = language(texts);
    let read = expressions(texts, "system->parameters.");
    for (spec, name) in texts.functions() {
        let prototype = prototype(texts, &spec, name);
        let mut parts = String::new();
        let body = draw(&texts.emitter, &spec, &language, &read, |drawing| {
            if drawing.plan.parts.len() <= 1 {
                return body(texts, drawing, &spec);
            }
            let body;
            (parts, body) = split(texts, drawing, &spec);
            body
        });
        functions.push_str(&format!(
            "{parts}\n{prototype}\n{{\n{}}}\n",
            indented(&body)
        ));
    }
    let [before, after] = helpers::around(&functions, names, texts.precision);
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

fn language<'a>(texts: &'a Texts) -> C<'a> {
    C {
        names: &texts.names,
        precision: texts.precision,
    }
}

/// The parameters, whose names stand behind `owner`.
fn expressions(texts: &Texts, owner: &str) -> Vec<String> {
    parameters::expressions(texts.program(), &texts.names.fields, owner)
}

/// Lines set in.
fn indented(text: &str) -> String {
    let lines = text.lines();
    lines.map(|line| format!("    {line}\n")).collect()
}

/// The statements of a function.
fn body(texts: &Texts, drawing: &Drawing, spec: &Spec) -> String {
    let mut printer = drawing.printer();
    let mut text = String::new();
    // Pivots are looked at last: gcc keeps fewer values in memory where no function ends in its middle.
    let (values, checks): (Vec<_>, Vec<_>) =
        (drawing.body.statements.iter().cloned()).partition(|statement| statement.is_let());
    let body = Body {
        statements: [values, checks].concat(),
        outputs: drawing.body.outputs.clone(),
    };
    for part in &drawing.plan.parts {
        text.push_str(&statements(&mut printer, &body, part, |_, _| String::new()));
    }
    let all = results(texts, &mut printer, drawing, spec, |_| true);
    around(texts, &printer.used, spec, false, &format!("{text}{all}"))
}

/// What returns the results, or writes those of some places.
fn results(
    texts: &Texts,
    printer: &mut Printer,
    drawing: &Drawing,
    spec: &Spec,
    of: impl Fn(usize) -> bool,
) -> String {
    let mut results = String::new();
    let number = returns_number(spec.shape, spec.fallible);
    let outputs = drawing.body.outputs.iter().enumerate();
    for (index, &edge) in outputs.filter(|&(index, _)| of(index)) {
        let value = printer.signed(edge);
        results.push_str(&match number {
            true => format!("return {value};\n"),
            false => format!("out[{index}] = {value};\n"),
        });
    }
    if spec.fallible {
        results.push_str(&format!("return {};\n", texts.names.done()));
    }
    results
}

/// A body with what it begins with; it may pass the system on.
fn around(texts: &Texts, used: &Used, spec: &Spec, passes: bool, all: &str) -> String {
    let number = returns_number(spec.shape, spec.fallible);
    let mut unused = Vec::new();
    if !used.kept && !passes && !all.contains("system->") {
        unused.push("system");
    }
    let arguments = spec.arguments.iter();
    let missing = arguments.filter(|given| !used.arguments.contains(given));
    unused.extend(missing.map(|&given| argument(given)));
    if !number && spec.outputs.is_empty() {
        unused.push("out");
    }
    let unused: String = unused
        .iter()
        .map(|name| format!("(void){name};\n"))
        .collect();
    format!("{}{unused}{all}", bind_kept(texts, used))
}

/// The name of the kept constants, where it is used.
fn bind_kept(texts: &Texts, used: &Used) -> String {
    match used.kept {
        true => format!("const {} *const k = system->k;\n", texts.names.real()),
        false => String::new(),
    }
}

/// The parts of a function in short parts, each a function, and the statements of the one that calls them.
fn split(texts: &Texts, drawing: &Drawing, spec: &Spec) -> (String, String) {
    let names = &texts.names;
    let (real, status, done) = (names.real(), names.own("status"), names.done());
    let restrict = format!("{}_RESTRICT", names.capitals);
    let mut targets: FxHashMap<NodeId, Vec<usize>> = FxHashMap::default();
    let written = |edge: &Edge| drawing.plan.results.contains_key(&edge.node());
    for (index, edge) in drawing.body.outputs.iter().enumerate() {
        if written(edge) {
            targets.entry(edge.node()).or_default().push(index);
        }
    }
    let mut main = drawing.printer();
    let (mut parts, mut calls) = (String::new(), String::new());
    let (mut checks, mut passes) = (false, false);
    for (index, part) in drawing.plan.parts.iter().enumerate() {
        let mut printer = drawing.printer();
        let mut writes = String::new();
        let (mut values, mut pivots) = (String::new(), String::new());
        for statement in &drawing.body.statements[part.statements.clone()] {
            let text = printer.statement(statement);
            match statement.is_let() {
                true => values.push_str(&text),
                false => pivots.push_str(&text),
            }
            for node in statement.defined() {
                for &place in targets.get(&node).into_iter().flatten() {
                    let value = printer.signed(drawing.body.outputs[place]);
                    writes.push_str(&format!("out[{place}] = {value};\n"));
                    printer.used.out = Access::Written;
                }
            }
        }
        let used = printer.used;
        main.used.arguments.extend(&used.arguments);
        main.used.reads |= used.reads || used.writes;
        let text = format!("{}{values}{pivots}{writes}", bind_kept(texts, &used));
        let mut given: Vec<&str> = Vec::new();
        let mut taken = Vec::new();
        if text.contains("system->") {
            passes = true;
            given.push("system");
            taken.push(format!("const {} *{restrict} system", names.own("system")));
        }
        for &read in spec.arguments.iter().filter(|a| used.arguments.contains(a)) {
            given.push(argument(read));
            taken.push(format!("const {real} *{restrict} {}", argument(read)));
        }
        let arrays = [
            ("slots", used.reads || used.writes, used.writes),
            ("out", used.out > Access::None, used.out == Access::Written),
        ];
        for (name, _, is_written) in arrays.into_iter().filter(|(_, is_used, _)| *is_used) {
            let constant = if is_written { "" } else { "const " };
            given.push(name);
            taken.push(format!("{constant}{real} *{restrict} {name}"));
        }
        let name = names.own(&texts.emitter.names.part(&spec.name, index + 1));
        let call = format!("{name}({})", given.join(", "));
        let (returned, end) = match used.checks {
            true => {
                checks = true;
                calls.push_str(&format!(
                    "status = {call};\nif (status != {done}) {{\n    return status;\n}}\n"
                ));
                (status.as_str(), format!("return {done};\n"))
            }
            false => {
                calls.push_str(&format!("{call};\n"));
                ("void", String::new())
            }
        };
        let what = comment::line(
            &format!(
                "Part {} of {} of `{}`.",
                index + 1,
                drawing.plan.parts.len(),
                spec.name
            ),
            0,
        );
        let taken = taken.join(",\n    ");
        parts.push_str(&format!(
            "\n{what}PART {returned} {name}(\n    {taken})\n{{\n{}}}\n",
            indented(&format!("{text}{end}"))
        ));
    }
    let mut text = String::new();
    if main.used.reads {
        text.push_str(&format!("{real} slots[{}];\n", drawing.plan.size));
    }
    if checks {
        text.push_str(&format!("{status} status;\n"));
    }
    let outputs = &drawing.body.outputs;
    let rest = results(texts, &mut main, drawing, spec, |index| {
        !written(&outputs[index])
    });
    let all = format!("{text}{calls}{rest}");
    (parts, around(texts, &main.used, spec, passes, &all))
}

/// `parameters->m = 1.3;` and so on.
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
            // All entries, so that nobody reads what was not written.
            ShapeKind::Symmetric(n) => {
                let upper = |i: usize, j: usize| i * n - i * (i + 1) / 2 + j;
                for i in 0..n {
                    for j in 0..n {
                        set(format!("[{i}][{j}]"), upper(i.min(j), i.max(j)));
                    }
                }
            }
            shape => {
                for (place, index) in parameters::indices(shape).into_iter().enumerate() {
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

/// The function that computes what depends on parameters alone; nothing where there is nothing.
fn constants(texts: &Texts) -> String {
    if texts.emitter.kept.is_empty() {
        return String::new();
    }
    let spec = texts.emitter.constants();
    let read = expressions(texts, "parameters->");
    let language = language(texts);
    let body = draw(&texts.emitter, &spec, &language, &read, |drawing| {
        let mut printer = drawing.printer();
        let mut text = String::new();
        for part in &drawing.plan.parts {
            text.push_str(&statements(&mut printer, drawing.body, part, |_, _| {
                String::new()
            }));
        }
        for (index, &edge) in drawing.body.outputs.iter().enumerate() {
            let value = printer.signed(edge);
            text.push_str(&format!("k[{index}] = {value};\n"));
        }
        match text.contains("parameters->") {
            true => text,
            false => format!("(void)parameters;\n{text}"),
        }
    });
    format!(
        "/* What depends on parameters alone. */\nstatic void {}(const {} *parameters, {} *k)\n{{\n{}}}\n\n",
        texts.names.own(&texts.emitter.names.constants),
        texts.names.own("parameters"),
        texts.names.real(),
        indented(&body)
    )
}

/// Computes constants apart, and keeps them where all pivots are positive.
fn setting(texts: &Texts) -> String {
    let emitter = &texts.emitter;
    let names = &texts.names;
    let mut text = format!(
        "{} next;\nnext.parameters = *parameters;\n",
        names.own("system")
    );
    if !emitter.kept.is_empty() {
        let constants = names.own(&emitter.names.constants);
        text.push_str(&format!("{constants}(parameters, next.k);\n"));
    }
    let read = expressions(texts, "next.parameters.");
    text.push_str(&parameters::checks(
        emitter,
        &language(texts),
        "next.k",
        &read,
    ));
    text + &format!("*system = next;\nreturn {};\n", names.done())
}

/// x and ξ at the start.
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
