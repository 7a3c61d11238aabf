//! Inputs by expressions in the language of descriptions: `F = 2 * sin(3 * t) - 4 * q`.
//!
//! They are compiled as outputs of a separate description, whose inputs are the time, the parameters and the state.

use super::{InputProblem, UnknownInput, place};
use crate::names::{self, TIME};
use hamel_codegen::algebra::graph::Node;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::generate::from_text;
use hamel_codegen::model::layout::entry_names;
use hamel_codegen::model::{Group, Model};
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::syntax::ast::{CoordKind, ShapeKind};
use hamel_codegen::syntax::path::plain;
use std::error;
use std::fmt;

/// Error in the expression of an input.
#[derive(Clone, Debug)]
pub enum ExpressionProblem {
    /// There is no name with `=` in front of it.
    NoName,
    /// The description has no such input.
    Unknown(UnknownInput),
    /// The input has an expression already.
    Twice {
        /// Name.
        name: String,
    },
    /// There are several expressions, or none.
    NotOne,
    /// It is not an expression in names of the description.
    Refused(Box<Diagnostic>),
    /// It has another number of entries than the input.
    Entries {
        /// The name of the input.
        name: String,
        /// Entries of the input.
        needed: usize,
        /// Entries of the expression.
        found: usize,
    },
}

impl fmt::Display for ExpressionProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let numbers = |count: usize| match count {
            1 => "a number".into(),
            _ => format!("{count} numbers"),
        };
        match self {
            ExpressionProblem::NoName => f.write_str("an input is written `NAME = EXPRESSION`"),
            ExpressionProblem::Unknown(unknown) => unknown.fmt(f),
            ExpressionProblem::Twice { name } => write!(f, "`{name}` is given twice"),
            ExpressionProblem::NotOne => f.write_str("expected one expression"),
            ExpressionProblem::Refused(error) => match &error.help {
                Some(help) => write!(f, "{}; {help}", error.message),
                None => f.write_str(&error.message),
            },
            ExpressionProblem::Entries {
                name,
                needed,
                found,
            } => write!(
                f,
                "`{name}` is {}, this is {}",
                numbers(*needed),
                numbers(*found)
            ),
        }
    }
}

impl error::Error for ExpressionProblem {}

/// The name by which the expression of an input is compiled.
const COMPILED: &str = "hamel_input";

/// Inputs that are given by expressions of t, x and ξ.
#[derive(Clone, Debug)]
pub struct Expressions {
    /// Each expression with the entries of u that it sets.
    all: Vec<(Vec<usize>, Interpreter)>,
    params: Vec<f64>,
    /// Whether time is their first argument: unless the description uses its name for something else.
    timed: bool,
    /// The first input that mentions a velocity or a state of first order.
    moving: Option<String>,
}

impl Expressions {
    /// Reads `NAME = EXPRESSION` texts; `None` if there are none.
    pub fn new(
        asked: &[String],
        model: &Model,
        params: &[f64],
    ) -> Result<Option<Self>, InputProblem> {
        if asked.is_empty() {
            return Ok(None);
        }
        let entries: Vec<String> = model.inputs.iter().flat_map(names::group).collect();
        let (known, timed) = known(model);
        let entries_of = entries_of(model, &known);
        let rates = names::rates(model);
        let groups = model.velocities.iter().chain(&model.states);
        let moving: Vec<&str> = groups.map(|group| group.name.as_str()).collect();
        let mut first = None;
        let mut all: Vec<(Vec<usize>, Interpreter)> = Vec::new();
        for text in asked {
            let wrong = |problem| InputProblem::Expression {
                text: text.clone(),
                problem,
            };
            let Some((name, expression)) = text.split_once('=') else {
                return Err(wrong(ExpressionProblem::NoName));
            };
            let name = name.trim();
            let group = model.inputs.iter().find(|group| group.name == plain(name));
            let places: Vec<usize> = match group {
                Some(group) => (group.offset..group.offset + group.len).collect(),
                None => {
                    let place = place(name, &entries).map_err(ExpressionProblem::Unknown);
                    vec![place.map_err(wrong)?]
                }
            };
            if all
                .iter()
                .any(|(taken, _)| taken.iter().any(|place| places.contains(place)))
            {
                return Err(wrong(ExpressionProblem::Twice { name: name.into() }));
            }
            let shape = match group.map(|group| group.shape) {
                Some(ShapeKind::Vector(n)) => format!(": vec{n}"),
                _ => String::new(),
            };
            let Compiled {
                interpreter,
                count,
                mentions,
            } = compiled(&known, &shape, &renamed(expression, &entries_of), &rates)
                .map_err(|problem| wrong(problem.about(name)))?;
            if mentions.iter().any(|one| moving.contains(&one.as_str())) {
                first = first.or_else(|| Some(name.to_string()));
            }
            if count != places.len() {
                return Err(wrong(ExpressionProblem::Entries {
                    name: name.into(),
                    needed: places.len(),
                    found: count,
                }));
            }
            all.push((places, interpreter));
        }
        Ok(Some(Expressions {
            all,
            params: params.to_vec(),
            timed,
            moving: first,
        }))
    }

    /// Returns the indices of the entries of u that expressions set.
    pub fn places(&self) -> impl Iterator<Item = usize> {
        self.all
            .iter()
            .flat_map(|(places, _)| places.iter().copied())
    }

    /// Names the input whose expression depends on velocities or on states of first order; `None` if there is none.
    pub fn moving(&self) -> Option<&str> {
        self.moving.as_deref()
    }

    /// Changes the values of the parameters.
    pub fn set_params(&mut self, params: &[f64]) {
        self.params = params.to_vec();
    }

    /// Sets the entries of u that have expressions, at a time of the description.
    pub fn set(&self, t: f64, x: &[f64], xi: &[f64], u: &mut [f64]) {
        let time = self.timed.then_some(t).into_iter();
        let rest = self.params.iter().chain(x).chain(xi).copied();
        let given: Vec<f64> = time.chain(rest).collect();
        for (places, interpreter) in &self.all {
            let values = interpreter.call(&[0.0], &[0.0], &given, &[]);
            let values = values.unwrap_or_else(|_| vec![f64::NAN; places.len()]);
            for (&place, value) in places.iter().zip(values) {
                u[place] = value;
            }
        }
    }
}

/// Evaluates an expression of parameters and constants, entry by entry.
pub fn constant(
    expression: &str,
    model: &Model,
    params: &[f64],
) -> Result<Vec<f64>, ExpressionProblem> {
    let mut known: Vec<String> = model.params.iter().map(declared).collect();
    if known.is_empty() {
        known.push("hamel_t".into());
    }
    let Compiled {
        interpreter, count, ..
    } = compiled(&known, "", expression, &[])?;
    let given = match params {
        [] => &[0.0],
        params => params,
    };
    let values = interpreter.call(&[0.0], &[0.0], given, &[]);
    Ok(values.unwrap_or_else(|_| vec![f64::NAN; count]))
}

/// Returns the declaration of a group with its shape.
fn declared(group: &Group) -> String {
    match group.shape {
        ShapeKind::Scalar => group.name.clone(),
        ShapeKind::Vector(n) => format!("{}: vec{n}", group.name),
        ShapeKind::Matrix(n) => format!("{}: mat{n}", group.name),
        ShapeKind::Symmetric(n) => format!("{}: sym{n}", group.name),
    }
}

/// Declarations of the symbols that expressions may mention, in the order of t, the parameters, x, ξ and z; and whether
/// t is among them.
fn known(model: &Model) -> (Vec<String>, bool) {
    let mut all: Vec<String> = model.params.iter().map(declared).collect();
    for coordinate in &model.coordinates {
        let name = &coordinate.name;
        match coordinate.kind {
            CoordKind::Real => all.push(name.clone()),
            CoordKind::SE3 => all.extend([format!("{name}_p: vec3"), format!("{name}_R: mat3")]),
            CoordKind::SO3 => all.push(format!("{name}: mat3")),
            kind => all.push(format!("{name}: vec{}", entry_names(name, kind).len())),
        }
    }
    all.extend(model.velocities.iter().chain(&model.states).map(declared));
    let is_time = |one: &String| one.split(':').next() == Some(TIME);
    let timed = !all.iter().any(is_time);
    if timed {
        all.insert(0, TIME.into());
    }
    (all, timed)
}

/// Entries of vectors of which constraints have eliminated others, as the description writes them, and their names:
/// `v[2]` is `v_2`, unless another known symbol is called `v`.
fn entries_of(model: &Model, known: &[String]) -> Vec<(String, String)> {
    let is_known = |name: &str| known.iter().any(|one| one.split(':').next() == Some(name));
    let entry = |group: &Group| {
        let (vector, index) = group.name.rsplit_once('_')?;
        let is_entry = !is_known(vector) && index.parse::<usize>().is_ok_and(|i| i > 0);
        is_entry.then(|| (format!("{vector}[{index}]"), group.name.clone()))
    };
    let groups = model.velocities.iter().chain(&model.states);
    groups.filter_map(entry).collect()
}

/// Replaces these entries in an expression by their names.
fn renamed(expression: &str, entries: &[(String, String)]) -> String {
    let mut text = expression.to_string();
    for (entry, name) in entries {
        let mut rest = 0;
        while let Some(found) = text[rest..].find(entry.as_str()) {
            let place = rest + found;
            let before = text[..place].chars().next_back();
            let inside = before.is_some_and(|c| c.is_alphanumeric() || "_.".contains(c));
            if !inside {
                text.replace_range(place..place + entry.len(), name);
            }
            rest = place + if inside { entry.len() } else { name.len() };
        }
    }
    text
}

/// A compiled expression.
struct Compiled {
    interpreter: Interpreter,
    /// Number of entries.
    count: usize,
    /// Symbols on which its value depends.
    mentions: Vec<String>,
}

/// Compiles an expression as the output of a description. Errors about names such as `x_dot` name the velocity that is
/// meant, from the coordinates and velocities in `rates`.
fn compiled(
    known: &[String],
    shape: &str,
    expression: &str,
    rates: &[(String, String)],
) -> Result<Compiled, ExpressionProblem> {
    if expression.contains(';') {
        return Err(ExpressionProblem::NotOne);
    }
    let text = format!(
        "system Input {{
    input {};
    coord hamel_x;
    velocity hamel_v;
    rate hamel_x = hamel_v;
    particle mass 1 at [hamel_x, 0, 0];
    let {COMPILED}{shape} = {expression};
    output hamel_output = {COMPILED};
    generate hamel_output;
}}",
        known.join(", ")
    );
    let generated = from_text(&text).map_err(|errors| refused(errors, &text, rates))?;
    let program = &generated.program;
    let function = program
        .functions
        .iter()
        .find(|function| function.id.is_none());
    match function {
        Some(function) => {
            let graph = &program.graph;
            let reached = graph.reachable(&function.outputs).into_iter();
            let mentions = reached.filter_map(|id| match graph.node(id) {
                Node::Symbol(symbol) => graph.symbols().get(symbol as usize),
                _ => None,
            });
            // `w[1]` is an entry of `w`.
            let mentions = mentions.filter_map(|symbol| symbol.name.split('[').next());
            Ok(Compiled {
                interpreter: Interpreter::new(program, function, &[]),
                count: function.outputs.len(),
                mentions: mentions.map(String::from).collect(),
            })
        }
        None => Err(ExpressionProblem::NotOne),
    }
}

/// Returns the first of all errors of a text, with advice if its place is a name that seems to denote a rate.
fn refused(errors: Vec<Diagnostic>, text: &str, rates: &[(String, String)]) -> ExpressionProblem {
    let Some(mut error) = errors.into_iter().next() else {
        return ExpressionProblem::NotOne;
    };
    let place = error.span.range().and_then(|range| text.get(range));
    if let Some(advice) = place.and_then(|name| names::advice_on_rate(rates, name)) {
        error.help = Some(advice);
    }
    ExpressionProblem::Refused(Box::new(error))
}

impl ExpressionProblem {
    /// Replaces the name by which the expression is compiled by that of the input.
    fn about(self, name: &str) -> Self {
        let named = |text: &String| text.replace(COMPILED, name);
        match self {
            ExpressionProblem::Refused(error) => ExpressionProblem::Refused(Box::new(Diagnostic {
                message: named(&error.message),
                help: error.help.as_ref().map(named),
                ..*error
            })),
            other => other,
        }
    }
}
