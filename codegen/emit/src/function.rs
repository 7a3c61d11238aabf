//! Text of one generated function.

use super::chunk::{BodyPartition, Part, partition_body};
use super::docs;
use super::language::{Language, Rust, SharedArray};
use super::locals::Locals;
use super::print::{Headings, Printer, UsedNames, WrittenResult};
use super::{Emitter, constants, names};
use hamel_algebra::graph::{Edge, NodeId};
use hamel_program::origins::origins;
use hamel_program::places::Time;
use hamel_program::provenance::Origin;
use hamel_program::statements::{Body, Operation};
use hamel_program::{Argument, Cause, Function, Program, Shape, tape};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// Name of the argument to which slopes are written in addition to the result, `slopes`.
pub const SLOPES_ARGUMENT: &str = SharedArray::Slopes.name();

/// Description of a generated function before it is lowered: name, arguments, outputs, guards.
pub struct FunctionSpec<'a> {
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

impl FunctionSpec<'_> {
    /// Returns, for an output by its index, the array that holds it, the shape of the array, and the index there.
    pub fn result_place(&self, result: usize) -> (SharedArray, Shape, usize) {
        let entries = self.shape.entries();
        match self.beside.filter(|_| result >= entries) {
            Some(shape) => (SharedArray::Slopes, shape, result - entries),
            None => (SharedArray::Out, self.shape, result),
        }
    }
}

/// Lowers a function to statements, and gives the values that the description names these names.
pub fn lower_function(emitter: &Emitter, spec: &FunctionSpec) -> (Locals, Body) {
    let locals = Locals::with_user_names(&emitter.words, &emitter.program.names, &spec.nodes);
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
pub fn print_function(emitter: &Emitter, spec: &FunctionSpec) -> String {
    let parameters =
        super::parameters::parameter_expressions(emitter.program, &emitter.names.fields, "self.");
    with_prepared(emitter, spec, &Rust, &parameters, |drawing| {
        if drawing.plan.whole {
            drawing.whole()
        } else {
            drawing.print_in_parts()
        }
    })
}

/// Lowers a function to statements, names its values and divides it into parts for a language, and returns what `text`
/// prints of it.
pub fn with_prepared<T>(
    emitter: &Emitter,
    spec: &FunctionSpec,
    language: &dyn Language,
    parameters: &[String],
    text: impl FnOnce(&PreparedFunction) -> T,
) -> T {
    let (mut locals, body) = lower_function(emitter, spec);
    let read = body
        .statements
        .iter()
        .flat_map(|statement| statement.operation.operands());
    let numbers = read.chain(body.outputs.iter().copied()).map(Edge::node);
    locals.fill(&body.statements, numbers, &emitter.places);
    let when = language.when(spec.shape, spec.fallible);
    let plan = partition_body(&body, &emitter.places, spec.time, emitter.chunk, when);
    let places = plan.results.iter();
    let written = places.map(|(&node, &place)| {
        let written = WrittenResult {
            place: spec.result_place(place),
            negative: body.outputs[place].is_negative(),
        };
        (node, written)
    });
    text(&PreparedFunction {
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
fn headings(
    emitter: &Emitter,
    spec: &FunctionSpec,
    language: &dyn Language,
    body: &Body,
) -> Headings {
    if !emitter.headings {
        return Headings::default();
    }
    let constants = spec.functions.is_empty();
    let origins = match constants {
        true => constants::constant_origins(emitter, body),
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

/// A generated function that is ready to be printed: statements, names of values, parts.
pub struct PreparedFunction<'a> {
    /// The program.
    pub emitter: &'a Emitter<'a>,
    /// The function.
    pub spec: &'a FunctionSpec<'a>,
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
    pub written: &'a FxHashMap<NodeId, WrittenResult>,
    /// The parameters as expressions.
    pub parameters: &'a [String],
}

impl PreparedFunction<'_> {
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
            used: UsedNames::default(),
        }
    }

    /// Prints the function as a single body.
    fn whole(&self) -> String {
        let mut printer = self.printer();
        let mut text = String::new();
        for part in &self.plan.parts {
            text.push_str(&print_statements(&mut printer, self.body, part, |_, _| {
                String::new()
            }));
        }
        let results: Vec<String> = self
            .body
            .outputs
            .iter()
            .map(|&edge| printer.signed_value(edge))
            .collect();
        let (results, besides) = results.split_at(self.spec.shape.entries());
        if let Some(shape) = self.spec.beside {
            text.push_str(&format!(
                "*{SLOPES_ARGUMENT} = {};\n",
                shaped(shape, besides)
            ));
        }
        let value = shaped(self.spec.shape, results);
        let kept = self.bind_kept(&printer.used);
        let body = format!("{kept}{text}{}", self.final_expression(&value));
        self.print_with_body(&body)
    }

    /// Binds the array of kept constants to `k`, if it is used.
    pub fn bind_kept(&self, used: &UsedNames) -> String {
        match used.kept {
            true => format!("let k = &self.{};\n", self.emitter.names.kept),
            false => String::new(),
        }
    }

    /// Returns the final expression of the Rust function, such as `Ok(out)`, for this value.
    pub fn final_expression(&self, value: &str) -> String {
        if self.spec.fallible {
            format!("::core::result::Result::Ok({value})\n")
        } else {
            format!("{value}\n")
        }
    }

    /// Puts a body of Rust into the signature of this function, below its documentation.
    pub fn print_with_body(&self, body: &str) -> String {
        wrap_in_signature(self.emitter.program, self.spec, body)
    }
}

/// Returns the entries as an expression of a shape.
fn shaped(shape: Shape, entries: &[String]) -> String {
    let list = |entries: &[String]| format!("[{}]", entries.join(", "));
    match shape {
        Shape::Scalar => entries.join(""),
        Shape::Vector(_) => list(entries),
        Shape::Matrix(_, 0) => zero_of_shape(shape),
        Shape::Matrix(_, columns) => {
            let rows: Vec<String> = entries.chunks(columns).map(list).collect();
            list(&rows)
        }
    }
}

/// Puts a body of Rust into the signature of a function, below its documentation.
pub fn wrap_in_signature(program: &Program, spec: &FunctionSpec, body: &str) -> String {
    let mut arguments = vec!["&self".to_string()];
    arguments.extend(spec.arguments.iter().map(|&argument| {
        let (name, length) = (names::argument_name(argument), program.length(argument));
        format!("{name}: &[S; {length}]")
    }));
    if let Some(shape) = spec.beside {
        arguments.push(format!("{SLOPES_ARGUMENT}: &mut {}", shape_type(shape)));
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
        docs::doc_comment(&spec.docs),
        spec.name,
        arguments.join(", ")
    )
}

/// Prints the statements of a part; `after` returns the text that follows each value.
pub fn print_statements(
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

/// Returns the Rust expression of a result that is all zeros, such as `[S::default(); 3]`.
pub fn zero_of_shape(shape: Shape) -> String {
    match shape {
        Shape::Scalar => "S::default()".into(),
        Shape::Vector(0) | Shape::Matrix(0, _) => "[]".into(),
        Shape::Matrix(rows, 0) => format!("[[]; {rows}]"),
        Shape::Vector(n) => format!("[S::default(); {n}]"),
        Shape::Matrix(rows, columns) => format!("[[S::default(); {columns}]; {rows}]"),
    }
}
