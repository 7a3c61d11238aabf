//! Function bodies in C: a plain sequence of statements, or calls of parts that are functions of their own.

use super::language::{ArrayOrigins, CLanguage};
use super::nearest::best_origin;
use super::{Texts, comment, helpers, returns_number};
use crate::chunk::Part;
use crate::function::{FunctionSpec, PreparedFunction, print_statements};
use crate::language::{Language, SharedArray};
use crate::names::argument_name;
use crate::print::{ArrayAccess, Printer, UsedNames};
use hamel_algebra::graph::NodeId;
use hamel_program::statements::Body;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// Distance from a pointer in bytes, before and behind it, within which accesses have short instructions.
const NEAR: usize = 128;

/// Indents all lines of a text by one step.
pub fn indent_lines(text: &str) -> String {
    let lines = text.lines();
    lines.map(|line| format!("    {line}\n")).collect()
}

/// Prints the body of a C function that is not split into parts.
pub fn print_whole_body(texts: &Texts, drawing: &PreparedFunction) -> String {
    let mut printer = drawing.printer();
    let mut text = String::new();
    // Pivots are checked last: gcc keeps fewer values in memory if a function has no return in its middle.
    let (values, checks): (Vec<_>, Vec<_>) =
        (drawing.body.statements.iter().cloned()).partition(|statement| statement.is_let());
    let body = Body {
        statements: [values, checks].concat(),
        outputs: drawing.body.outputs.clone(),
        partial: drawing.body.partial.clone(),
    };
    for part in &drawing.plan.parts {
        text.push_str(&print_statements(&mut printer, &body, part, |_, _| {
            String::new()
        }));
    }
    let all = results(texts, &mut printer, drawing, |_| true);
    around(
        texts,
        &printer.used,
        drawing.spec,
        false,
        &format!("{text}{all}"),
    )
}

/// Prints the statements that return the result, or that write the results whose indices satisfy `of`.
fn results(
    texts: &Texts,
    printer: &mut Printer,
    drawing: &PreparedFunction,
    of: impl Fn(usize) -> bool,
) -> String {
    let mut results = String::new();
    let spec = drawing.spec;
    let number = returns_number(spec.shape, spec.fallible);
    let outputs = &drawing.body.outputs;
    let zero = texts.program().graph.zero();
    let mut index = 0;
    while index < outputs.len() {
        let following = outputs[index..].iter().enumerate().take(helpers::MAX_ZEROS);
        let zeros = following.take_while(|&(more, &edge)| edge == zero && of(index + more));
        let zeros = zeros.count();
        if !number && zeros > 1 {
            let array = SharedArray::Out.name();
            results.push_str(&format!(
                "memcpy({array} + {index}, {}, {zeros} * sizeof *{array});\n",
                texts.names.identifier(helpers::ZEROS_NAME)
            ));
            index += zeros;
            continue;
        }
        if of(index) {
            let value = printer.signed_value(outputs[index]);
            results.push_str(&match number {
                true => format!("return {value};\n"),
                false => format!("out[{index}] = {value};\n"),
            });
        }
        index += 1;
    }
    if spec.fallible {
        results.push_str(&format!("return {};\n", texts.names.success_code()));
    }
    results
}

/// Prepends to a body the declarations that it needs, and marks unused arguments. `passes` tells whether the body
/// passes the system on to parts.
fn around(texts: &Texts, used: &UsedNames, spec: &FunctionSpec, passes: bool, all: &str) -> String {
    let number = returns_number(spec.shape, spec.fallible);
    let mut unused = Vec::new();
    if !used.kept && !passes && !all.contains("system->") {
        unused.push("system");
    }
    let arguments = spec.arguments.iter();
    let missing = arguments.filter(|given| !used.arguments.contains(given));
    unused.extend(missing.map(|&given| argument_name(given)));
    if !number && spec.outputs.is_empty() {
        unused.push("out");
    }
    let unused: String = unused
        .iter()
        .map(|name| format!("(void){name};\n"))
        .collect();
    format!("{}{unused}{all}", bind_kept(texts, used))
}

/// Binds the array of kept constants to `k`, if it is used.
fn bind_kept(texts: &Texts, used: &UsedNames) -> String {
    match used.kept {
        true => format!("const {} *const k = system->k;\n", texts.names.real()),
        false => String::new(),
    }
}

/// Prints the parts of a long C function, each a function of its own, and the body of the function that calls them.
pub fn print_parts_and_body(texts: &Texts, drawing: &PreparedFunction) -> (String, String) {
    let names = &texts.names;
    let (status, done) = (names.identifier("status"), names.success_code());
    let results_in_parts = InParts::new(drawing);
    let mut main = drawing.printer();
    let (mut parts, mut calls) = (String::new(), String::new());
    let (mut crossing, mut checks, mut passes) = (false, false, false);
    for (index, part) in drawing.plan.parts.iter().enumerate() {
        let name = names.identifier(&texts.emitter.names.part_name(&drawing.spec.name, index + 1));
        let printed = Printed::new(texts, drawing, part, &results_in_parts);
        main.used.arguments.extend(&printed.used.arguments);
        crossing |= printed.used.access(SharedArray::Slots) > ArrayAccess::None;
        let Passed { given, taken } = printed.passed(texts, drawing);
        passes |= printed.reads_system();
        let call = format!("{name}({})", given.join(", "));
        let (returned, end) = match printed.used.checks {
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
        let number = format!("Part {} of {}", index + 1, drawing.plan.parts.len());
        let what = comment::doc_comment_line(&format!("{number} of `{}`.", drawing.spec.name), 0);
        let taken = taken.join(",\n    ");
        parts.push_str(&format!(
            "\n{what}PART {returned} {name}(\n    {taken})\n{{\n{}}}\n",
            indent_lines(&format!("{}{end}", printed.text))
        ));
    }
    let mut text = String::new();
    if crossing {
        let real = names.real();
        text.push_str(&format!("{real} slots[{}];\n", drawing.plan.size));
    }
    if checks {
        text.push_str(&format!("{status} status;\n"));
    }
    let rest = results(texts, &mut main, drawing, |index| {
        !results_in_parts.written.contains(&index)
    });
    let all = format!("{text}{calls}{rest}");
    (parts, around(texts, &main.used, drawing.spec, passes, &all))
}

/// Results that are written by parts.
struct InParts {
    /// Indices of the results that have a value, by its node.
    places: FxHashMap<NodeId, Vec<usize>>,
    /// All these indices.
    written: BTreeSet<usize>,
}

impl InParts {
    fn new(drawing: &PreparedFunction) -> Self {
        let mut places: FxHashMap<NodeId, Vec<usize>> = FxHashMap::default();
        let mut written = BTreeSet::new();
        for (index, edge) in drawing.body.outputs.iter().enumerate() {
            if drawing.plan.results.contains_key(&edge.node()) {
                places.entry(edge.node()).or_default().push(index);
                written.insert(index);
            }
        }
        InParts { places, written }
    }
}

/// A part as printed.
struct Printed {
    text: String,
    used: UsedNames,
    origins: ArrayOrigins,
}

/// Arguments of a part's call, and its parameters.
struct Passed {
    given: Vec<String>,
    taken: Vec<String>,
}

impl Printed {
    /// Prints a part. Its arrays are passed as pointers to the places near which it reads and writes most.
    fn new(texts: &Texts, drawing: &PreparedFunction, part: &Part, results: &InParts) -> Self {
        let first = Printed::from(texts, drawing, part, results, ArrayOrigins::default());
        let near = NEAR / texts.precision.bytes();
        let origin = |array: SharedArray| {
            let length = match array {
                SharedArray::Slots => drawing.plan.size,
                SharedArray::Out | SharedArray::Slopes => drawing.body.outputs.len(),
            };
            let places = first.used.entries.iter();
            let places = places.filter(|(of, _)| *of == array);
            best_origin(places.map(|&(_, place)| place), near, length)
        };
        let origins = ArrayOrigins {
            slots: origin(SharedArray::Slots),
            out: origin(SharedArray::Out),
        };
        Printed::from(texts, drawing, part, results, origins)
    }

    fn from(
        texts: &Texts,
        drawing: &PreparedFunction,
        part: &Part,
        results: &InParts,
        origins: ArrayOrigins,
    ) -> Self {
        let language = CLanguage {
            names: &texts.names,
            precision: texts.precision,
            origins,
        };
        let mut printer = Printer {
            language: &language,
            ..drawing.printer()
        };
        let [mut values, mut pivots, mut writes] = [const { String::new() }; 3];
        for statement in &drawing.body.statements[part.statements.clone()] {
            let text = printer.statement(statement);
            match statement.is_let() {
                true => values.push_str(&text),
                false => pivots.push_str(&text),
            }
            for node in statement.defined() {
                for &place in results.places.get(&node).into_iter().flatten() {
                    printer.used.record_shared_access(
                        SharedArray::Out,
                        place,
                        ArrayAccess::Written,
                    );
                    let value = printer.signed_value(drawing.body.outputs[place]);
                    let entry = language.entry(SharedArray::Out, drawing.spec.shape, place);
                    writes.push_str(&format!("{entry} = {value};\n"));
                }
            }
        }
        let used = printer.used;
        let text = format!("{}{values}{pivots}{writes}", bind_kept(texts, &used));
        Printed {
            text,
            used,
            origins,
        }
    }

    fn reads_system(&self) -> bool {
        self.text.contains("system->")
    }

    fn passed(&self, texts: &Texts, drawing: &PreparedFunction) -> Passed {
        let (names, used) = (&texts.names, &self.used);
        let (real, restrict) = (names.real(), format!("{}_RESTRICT", names.capitals));
        let (mut given, mut taken) = (Vec::new(), Vec::new());
        if self.reads_system() {
            given.push("system".into());
            taken.push(format!(
                "const {} *{restrict} system",
                names.identifier("system")
            ));
        }
        let arguments = drawing.spec.arguments.iter();
        for &read in arguments.filter(|read| used.arguments.contains(read)) {
            given.push(argument_name(read).into());
            taken.push(format!("const {real} *{restrict} {}", argument_name(read)));
        }
        for array in [SharedArray::Slots, SharedArray::Out] {
            let constant = match used.access(array) {
                ArrayAccess::None => continue,
                ArrayAccess::Read => "const ",
                ArrayAccess::Written => "",
            };
            let name = array.name();
            given.push(match self.origins.offset_of(array) {
                0 => name.into(),
                origin => format!("{name} + {origin}"),
            });
            taken.push(format!("{constant}{real} *{restrict} {name}"));
        }
        Passed { given, taken }
    }
}
