//! One generated function with its parts.

use super::chunk::{Part, Plan, plan};
use super::docs;
use super::locals::Locals;
use super::lower::{Body, Operation};
use super::places::{Place, Time};
use super::print::{Printer, Used};
use super::{Emitter, names};
use crate::algebra::graph::{Edge, NodeId};
use crate::program::{Argument, Program, Shape};
use rustc_hash::{FxHashMap, FxHashSet};

/// Above this number of statements the parts of a function are never inlined: the compiler is then
/// fastest, and the call costs little beside the part.
const INLINE: usize = 2000;

/// What a function is.
pub struct Spec<'a> {
    /// Name.
    pub name: String,
    /// Whether it is `pub`.
    pub public: bool,
    /// Documentation, one string a line.
    pub docs: Vec<String>,
    /// Arguments.
    pub arguments: &'a [Argument],
    /// Shape of the result.
    pub shape: Shape,
    /// Results.
    pub outputs: Vec<Edge>,
    /// Pivots.
    pub guards: Vec<Edge>,
    /// Whether it returns a `Result`.
    pub fallible: bool,
    /// Nodes that it computes, children first.
    pub nodes: Vec<NodeId>,
    /// When it runs.
    pub time: Time,
}

/// The statements of a function, and the names that the user gave to values of it.
pub fn lower(emitter: &Emitter, spec: &Spec) -> (Locals, Body) {
    let locals = Locals::new(&emitter.program.names, &spec.nodes);
    let named = locals.named();
    let places = &emitter.places;
    let body = super::lower::lower(places, spec.time, &spec.nodes, &spec.outputs, &spec.guards, &named);
    (locals, body)
}

/// The function as text, its parts before it.
pub fn text(emitter: &Emitter, spec: &Spec) -> String {
    let (mut locals, body) = lower(emitter, spec);
    let read = body.statements.iter().flat_map(|statement| statement.operation.operands());
    let numbers = read.chain(body.outputs.iter().copied()).map(Edge::node);
    locals.fill(&body.statements, numbers, &emitter.places);
    let plan = plan(&body, &emitter.places, spec.time, emitter.chunk);
    let parameters = super::parameters::expressions(emitter, "self");
    let drawing = Drawing { emitter, spec, locals: &locals, body: &body, plan: &plan, parameters: &parameters };
    if plan.whole { drawing.whole() } else { drawing.split() }
}

/// The type of a result or of an argument.
pub fn shape_type(shape: Shape) -> String {
    match shape {
        Shape::Scalar => "S".into(),
        Shape::Vector(n) => format!("[S; {n}]"),
        Shape::Matrix(rows, columns) => format!("[[S; {columns}]; {rows}]"),
    }
}

/// The length of an argument.
pub fn length(program: &Program, argument: Argument) -> usize {
    match argument {
        Argument::Coordinates => program.nu,
        Argument::Velocities | Argument::Accelerations => program.n,
        Argument::Inputs => program.m,
    }
}

struct Drawing<'a> {
    emitter: &'a Emitter<'a>,
    spec: &'a Spec<'a>,
    locals: &'a Locals,
    body: &'a Body,
    plan: &'a Plan,
    parameters: &'a [String],
}

impl Drawing<'_> {
    fn printer(&self) -> Printer<'_> {
        Printer {
            places: &self.emitter.places,
            time: self.spec.time,
            locals: self.locals,
            parameters: self.parameters,
            slots: &self.plan.slots,
            here: FxHashSet::default(),
            used: Used::default(),
        }
    }

    fn whole(&self) -> String {
        let mut printer = self.printer();
        let mut text = String::new();
        for part in &self.plan.parts {
            text.push_str(&statements(&mut printer, self.body, part, |_, _| String::new()));
        }
        let results: Vec<String> =
            self.body.outputs.iter().map(|&edge| printer.signed(edge)).collect();
        let value = match self.spec.shape {
            Shape::Scalar => results.join(""),
            Shape::Vector(_) => format!("[{}]", results.join(", ")),
            Shape::Matrix(_, columns) => {
                let rows = results.chunks(columns.max(1)).map(|row| format!("[{}]", row.join(", ")));
                format!("[{}]", rows.collect::<Vec<_>>().join(", "))
            }
        };
        let kept = self.bind_kept(&printer.used);
        let body = format!("{kept}{text}{}", self.value(&value));
        self.head(&printer.used, &body)
    }

    fn split(&self) -> String {
        let Spec { name, shape, .. } = self.spec;
        let inline = if self.body.statements.len() > INLINE { "#[inline(never)]\n" } else { "#[inline]\n" };
        let mut targets: FxHashMap<NodeId, Vec<usize>> = FxHashMap::default();
        let mut rest = Vec::new();
        for (index, edge) in self.body.outputs.iter().enumerate() {
            match self.emitter.places.of(edge.node(), self.spec.time) {
                Place::Temporary => targets.entry(edge.node()).or_default().push(index),
                _ => rest.push(index),
            }
        }
        let mut main = self.printer();
        let (mut parts, mut calls) = (String::new(), String::new());
        for (index, part) in self.plan.parts.iter().enumerate() {
            let mut printer = self.printer();
            let text = statements(&mut printer, self.body, part, |printer, node| {
                let indices = targets.get(&node).map_or(&[][..], Vec::as_slice);
                printer.used.out |= !indices.is_empty();
                let writes = indices.iter().map(|&index| {
                    let value = printer.signed(self.body.outputs[index]);
                    format!("{} = {value};\n", target(*shape, index, true))
                });
                writes.collect()
            });
            let used = printer.used;
            main.used.arguments.extend(&used.arguments);
            main.used.reads |= used.reads || used.writes;
            let part_name = self.emitter.names.part(name, index + 1);
            let (arguments, values) = self.part_arguments(&used);
            let (result, end) = match used.checks {
                true => ("-> ::core::result::Result<(), ::hamel::Singular> ", "Ok(())\n"),
                false => ("", ""),
            };
            let kept = self.bind_kept(&used);
            parts.push_str(&format!(
                "/// Part {} of {} of `{name}`.\n{inline}fn {part_name}({arguments}) {result}{{\n{kept}{text}{end}}}\n\n",
                index + 1,
                self.plan.parts.len(),
            ));
            let question = if used.checks { "?" } else { "" };
            calls.push_str(&format!("self.{part_name}({values}){question};\n"));
        }
        let mut text = String::new();
        if main.used.reads {
            text.push_str(&format!("let mut slots = [S::default(); {}];\n", self.plan.size));
        }
        text.push_str(&format!("let mut out = {};\n", zeros(*shape)));
        text.push_str(&calls);
        let zero = self.emitter.program.graph.zero();
        for index in rest.into_iter().filter(|&index| self.body.outputs[index] != zero) {
            let value = main.result(self.body.outputs[index]);
            text.push_str(&format!("{} = {value};\n", target(*shape, index, false)));
        }
        let kept = self.bind_kept(&main.used);
        let body = format!("{kept}{text}{}", self.value("out"));
        parts + &self.head(&main.used, &body)
    }

    /// Parameters of a part with their types, and what is given for them.
    fn part_arguments(&self, used: &Used) -> (String, String) {
        let mut arguments = vec!["&self".to_string()];
        let mut values = Vec::new();
        for &argument in self.spec.arguments.iter().filter(|argument| used.arguments.contains(argument)) {
            let name = names::argument(argument);
            arguments.push(format!("{name}: &[S; {}]", length(self.emitter.program, argument)));
            values.push(name.to_string());
        }
        if used.reads || used.writes {
            let mutable = if used.writes { "mut " } else { "" };
            arguments.push(format!("slots: &{mutable}[S; {}]", self.plan.size));
            values.push(format!("&{mutable}slots"));
        }
        if used.out {
            arguments.push(format!("out: &mut {}", shape_type(self.spec.shape)));
            values.push("&mut out".into());
        }
        (arguments.join(", "), values.join(", "))
    }

    fn bind_kept(&self, used: &Used) -> String {
        match used.kept {
            true => format!("let k = &self.{};\n", self.emitter.names.kept),
            false => String::new(),
        }
    }

    fn value(&self, value: &str) -> String {
        if self.spec.fallible { format!("Ok({value})\n") } else { format!("{value}\n") }
    }

    /// The function around its body.
    fn head(&self, used: &Used, body: &str) -> String {
        let spec = self.spec;
        let mut arguments = vec!["&self".to_string()];
        let mut unused = Vec::new();
        for &argument in spec.arguments {
            let name = names::argument(argument);
            arguments.push(format!("{name}: &[S; {}]", length(self.emitter.program, argument)));
            if !used.arguments.contains(&argument) {
                unused.push(name);
            }
        }
        let result = shape_type(spec.shape);
        let result = match spec.fallible {
            true => format!("::core::result::Result<{result}, ::hamel::Singular>"),
            false => result,
        };
        let mut attributes = String::new();
        if !unused.is_empty() {
            let reason = format!("the value does not depend on {}", unused.join(", "));
            attributes.push_str(&format!("#[allow(unused_variables, reason = \"{reason}\")]\n"));
        }
        if spec.public && !spec.fallible {
            attributes.push_str("#[must_use]\n");
        }
        let public = if spec.public { "pub " } else { "" };
        format!(
            "{}{attributes}{public}fn {}({}) -> {result} {{\n{body}}}\n\n",
            docs::comment(&spec.docs),
            spec.name,
            arguments.join(", ")
        )
    }
}

/// The statements of a part; `after` is asked for what follows each value.
fn statements(
    printer: &mut Printer,
    body: &Body,
    part: &Part,
    mut after: impl FnMut(&mut Printer, NodeId) -> String,
) -> String {
    let mut text: String = part.numbers.iter().map(|&node| printer.number(node)).collect();
    for statement in &body.statements[part.statements.clone()] {
        text.push_str(&printer.statement(statement));
        if !matches!(statement.operation, Operation::Check(..)) {
            for node in statement.defined() {
                text.push_str(&after(printer, node));
            }
        }
    }
    text
}

/// The place of a result, behind a reference or not.
fn target(shape: Shape, index: usize, reference: bool) -> String {
    match shape {
        Shape::Scalar if reference => "*out".into(),
        Shape::Scalar => "out".into(),
        Shape::Vector(_) => format!("out[{index}]"),
        Shape::Matrix(_, columns) => {
            let columns = columns.max(1);
            format!("out[{}][{}]", index / columns, index % columns)
        }
    }
}

/// Zeros in a shape.
pub fn zeros(shape: Shape) -> String {
    match shape {
        Shape::Scalar => "S::default()".into(),
        Shape::Vector(n) => format!("[S::default(); {n}]"),
        Shape::Matrix(rows, columns) => format!("[[S::default(); {columns}]; {rows}]"),
    }
}
