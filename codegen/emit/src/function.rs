//! Text of one generated function.

use super::chunk::{BodyPartition, Part, plan};
use super::docs;
use super::language::{Array, Language, Rust};
use super::locals::Locals;
use super::print::{Headings, Printer, Used, Written};
use super::{Emitter, constants, names};
use hamel_algebra::graph::{Edge, NodeId};
use hamel_program::origins::origins;
use hamel_program::places::Time;
use hamel_program::provenance::Origin;
use hamel_program::statements::{Body, Operation};
use hamel_program::{Argument, Cause, Function, Program, Shape, tape};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// Argument to which slopes are written in addition to the result.
pub const SLOPES: &str = Array::Slopes.name();

/// Specification of a generated function.
pub struct Spec<'a> {
    /// Name.
    pub name: String,
    /// Whether it is `pub`.
    pub public: bool,
    /// Lines of its documentation.
    pub docs: Vec<String>,
    /// Arguments.
    pub arguments: &'a [Argument],
    /// Shape of the result.
    pub shape: Shape,
    /// Shape of the output argument `slopes`, if it has one.
    pub beside: Option<Shape>,
    /// Functions of the program to which the entries of the result belong, one after another; none for constants.
    pub functions: Vec<&'a Function>,
    /// Entries of the result, followed by those written to `slopes`.
    pub outputs: Vec<Edge>,
    /// Pivots that must be positive.
    pub guards: Vec<Edge>,
    /// Whether it returns a `Result`.
    pub fallible: bool,
    /// Nodes that it computes; children come first.
    pub nodes: Vec<NodeId>,
    /// When it runs.
    pub time: Time,
}

impl Spec<'_> {
    /// Returns the array that holds an output, its shape, and the index of the output there.
    pub fn place(&self, result: usize) -> (Array, Shape, usize) {
        let entries = self.shape.entries();
        match self.beside.filter(|_| result >= entries) {
            Some(shape) => (Array::Slopes, shape, result - entries),
            None => (Array::Out, self.shape, result),
        }
    }
}

/// Lowers a function to statements, and names the values that the user has named.
pub fn lower(emitter: &Emitter, spec: &Spec) -> (Locals, Body) {
    let locals = Locals::new(&emitter.words, &emitter.program.names, &spec.nodes);
    let named = tape::named(emitter.program, &spec.nodes);
    let places = &emitter.places;
    let guards = spec.guards.iter();
    let guards: Vec<(Edge, Cause)> = guards
        .map(|&guard| (guard, emitter.program.cause(guard)))
        .collect();
    let body = hamel_program::statements::statements(
        places,
        spec.time,
        &spec.nodes,
        &spec.outputs,
        &guards,
        &named,
    );
    (locals, body)
}

/// Prints the function as Rust, preceded by its parts.
pub fn print_function(emitter: &Emitter, spec: &Spec) -> String {
    let parameters =
        super::parameters::expressions(emitter.program, &emitter.names.fields, "self.");
    draw(emitter, spec, &Rust, &parameters, |drawing| {
        if drawing.plan.whole {
            drawing.whole()
        } else {
            drawing.split()
        }
    })
}

/// Lowers, names and splits a function, and passes it to `text`, which prints it in a language.
pub fn draw<T>(
    emitter: &Emitter,
    spec: &Spec,
    language: &dyn Language,
    parameters: &[String],
    text: impl FnOnce(&Drawing) -> T,
) -> T {
    let (mut locals, body) = lower(emitter, spec);
    let read = body
        .statements
        .iter()
        .flat_map(|statement| statement.operation.operands());
    let numbers = read.chain(body.outputs.iter().copied()).map(Edge::node);
    locals.fill(&body.statements, numbers, &emitter.places);
    let when = language.when(spec.shape, spec.fallible);
    let plan = plan(&body, &emitter.places, spec.time, emitter.chunk, when);
    let places = plan.results.iter();
    let written = places.map(|(&node, &place)| {
        let written = Written {
            place: spec.place(place),
            negative: body.outputs[place].is_negative(),
        };
        (node, written)
    });
    text(&Drawing {
        emitter,
        spec,
        language,
        locals: &locals,
        body: &body,
        plan: &plan,
        headings: &headings(emitter, spec, language, &body),
        written: &written.collect(),
        parameters,
    })
}

/// Returns the headings of the statements of a function: the quantity that each serves, and its equation.
fn headings(emitter: &Emitter, spec: &Spec, language: &dyn Language, body: &Body) -> Headings {
    if !emitter.headings {
        return Headings::default();
    }
    let constants = spec.functions.is_empty();
    let origins = match constants {
        true => constants::origins(emitter, body),
        false => origins(emitter.program, &spec.functions, body),
    };
    let mut texts: FxHashMap<*const Origin, Rc<str>> = FxHashMap::default();
    let heading = |(node, origin): (NodeId, Rc<Origin>)| {
        let text = || match constants {
            true => language.heading(&origin.quantity).into(),
            false => {
                let text = format!("{} ({})", origin.quantity, origin.equation);
                language.heading(&text).into()
            }
        };
        let text = texts.entry(Rc::as_ptr(&origin)).or_insert_with(text);
        (node, text.clone())
    };
    origins.into_iter().map(heading).collect()
}

/// Returns the Rust type of a result or an argument.
pub fn shape_type(shape: Shape) -> String {
    match shape {
        Shape::Scalar => "S".into(),
        Shape::Vector(n) => format!("[S; {n}]"),
        Shape::Matrix(rows, columns) => format!("[[S; {columns}]; {rows}]"),
    }
}

/// A function with everything that is needed to print it.
pub struct Drawing<'a> {
    /// The program.
    pub emitter: &'a Emitter<'a>,
    /// The function.
    pub spec: &'a Spec<'a>,
    /// Target language.
    pub language: &'a dyn Language,
    /// Names of its values.
    pub locals: &'a Locals,
    /// Its statements.
    pub body: &'a Body,
    /// Its division into parts.
    pub plan: &'a BodyPartition,
    /// Headings of its statements.
    pub headings: &'a Headings,
    /// Results that are read from the array to which they were written.
    pub written: &'a FxHashMap<NodeId, Written>,
    /// The parameters as expressions.
    pub parameters: &'a [String],
}

impl Drawing<'_> {
    /// Returns a printer that has printed nothing yet.
    pub fn printer(&self) -> Printer<'_> {
        Printer {
            language: self.language,
            program: self.emitter.program,
            places: &self.emitter.places,
            time: self.spec.time,
            arguments: self.spec.arguments,
            locals: self.locals,
            parameters: self.parameters,
            externals: &self.emitter.names.externals,
            slots: &self.plan.slots,
            written: self.written,
            headings: self.headings,
            heading: "",
            here: FxHashSet::default(),
            used: Used::default(),
        }
    }

    /// Prints the function as a single body.
    fn whole(&self) -> String {
        let mut printer = self.printer();
        let mut text = String::new();
        for part in &self.plan.parts {
            text.push_str(&statements(&mut printer, self.body, part, |_, _| {
                String::new()
            }));
        }
        let results: Vec<String> = self
            .body
            .outputs
            .iter()
            .map(|&edge| printer.signed(edge))
            .collect();
        let (results, besides) = results.split_at(self.spec.shape.entries());
        if let Some(shape) = self.spec.beside {
            text.push_str(&format!("*{SLOPES} = {};\n", shaped(shape, besides)));
        }
        let value = shaped(self.spec.shape, results);
        let kept = self.bind_kept(&printer.used);
        let body = format!("{kept}{text}{}", self.value(&value));
        self.head(&body)
    }

    /// Binds the array of kept constants to `k`, if it is used.
    pub fn bind_kept(&self, used: &Used) -> String {
        match used.kept {
            true => format!("let k = &self.{};\n", self.emitter.names.kept),
            false => String::new(),
        }
    }

    /// Returns the final expression of the function.
    pub fn value(&self, value: &str) -> String {
        if self.spec.fallible {
            format!("::core::result::Result::Ok({value})\n")
        } else {
            format!("{value}\n")
        }
    }

    /// Wraps a body in the signature of the function.
    pub fn head(&self, body: &str) -> String {
        head(self.emitter.program, self.spec, body)
    }
}

/// Returns the entries as an expression of a shape.
fn shaped(shape: Shape, entries: &[String]) -> String {
    let list = |entries: &[String]| format!("[{}]", entries.join(", "));
    match shape {
        Shape::Scalar => entries.join(""),
        Shape::Vector(_) => list(entries),
        Shape::Matrix(_, 0) => zeros(shape),
        Shape::Matrix(_, columns) => {
            let rows: Vec<String> = entries.chunks(columns).map(list).collect();
            list(&rows)
        }
    }
}

/// Wraps a body in the signature of a function.
pub fn head(program: &Program, spec: &Spec, body: &str) -> String {
    let mut arguments = vec!["&self".to_string()];
    arguments.extend(spec.arguments.iter().map(|&argument| {
        let (name, length) = (names::argument(argument), program.length(argument));
        format!("{name}: &[S; {length}]")
    }));
    if let Some(shape) = spec.beside {
        arguments.push(format!("{SLOPES}: &mut {}", shape_type(shape)));
    }
    let result = shape_type(spec.shape);
    let result = match spec.fallible {
        true => format!("::core::result::Result<{result}, ::hamel::Singular>"),
        false => result,
    };
    let attributes = match spec.public && !spec.fallible {
        true => "#[must_use]\n",
        false => "",
    };
    let public = if spec.public { "pub " } else { "" };
    format!(
        "{}{attributes}{public}fn {}({}) -> {result} {{\n{body}}}\n\n",
        docs::comment(&spec.docs),
        spec.name,
        arguments.join(", ")
    )
}

/// Prints the statements of a part; `after` returns the text that follows each value.
pub fn statements(
    printer: &mut Printer,
    body: &Body,
    part: &Part,
    mut after: impl FnMut(&mut Printer, NodeId) -> String,
) -> String {
    let numbers = part.numbers.iter().map(|&node| printer.number(node));
    let mut text: String = numbers.collect();
    if !text.is_empty() && !printer.headings.is_empty() {
        text.insert_str(0, &printer.language.heading("numbers"));
    }
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

/// Returns the zero of a shape.
pub fn zeros(shape: Shape) -> String {
    match shape {
        Shape::Scalar => "S::default()".into(),
        Shape::Vector(0) | Shape::Matrix(0, _) => "[]".into(),
        Shape::Matrix(rows, 0) => format!("[[]; {rows}]"),
        Shape::Vector(n) => format!("[S::default(); {n}]"),
        Shape::Matrix(rows, columns) => format!("[[S::default(); {columns}]; {rows}]"),
    }
}
