//! Names and what they stand for.

use super::curve::Curve;
use super::motion::TimeDerivative;
use crate::algebra::function::Function;
use crate::algebra::graph::{Edge, NodeId};
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::syntax::ast::{
    CoordKind, External, Function as Defined, Ident, Item, ItemKind, Span, System,
};
use crate::syntax::suggest::closest;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

/// What kind of thing a name is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NameKind {
    /// A run-time parameter.
    Param,
    /// A build-time constant.
    Const,
    /// A named expression.
    Let,
    /// A coordinate.
    Coord(CoordKind),
    /// A velocity coordinate.
    Velocity,
    /// A run-time input.
    Input,
    /// A state of first order.
    State,
    /// A frame.
    Frame,
    /// An output.
    Output,
    /// A function of expressions.
    Function,
}

impl NameKind {
    /// The kind in words.
    pub fn describe(self) -> &'static str {
        match self {
            NameKind::Param => "a parameter",
            NameKind::Const => "a constant",
            NameKind::Let => "a named expression",
            NameKind::Coord(_) => "a coordinate",
            NameKind::Velocity => "a velocity",
            NameKind::Input => "an input",
            NameKind::State => "a state",
            NameKind::Frame => "a frame",
            NameKind::Output => "an output",
            NameKind::Function => "a function",
        }
    }
}

/// One defined name; `value` is `None` where its definition was itself in error.
#[derive(Clone, Debug)]
pub struct Entry {
    /// What kind of thing it is.
    pub kind: NameKind,
    /// Its value.
    pub value: Option<Value>,
    /// Where it was defined.
    pub span: Span,
}

/// Names of functions and constants of the language, which cannot be redefined.
const RESERVED: &[&str] = &[
    "transpose",
    "dot",
    "cross",
    "hat",
    "vee",
    "norm",
    "diag",
    "trace",
    "outer",
    "identity",
    "sin",
    "cos",
    "tan",
    "atan2",
    "sqrt",
    "exp",
    "log",
    "sinh",
    "cosh",
    "tanh",
    "asin",
    "acos",
    "min",
    "max",
    "clamp",
    "hypot",
    "rotx",
    "roty",
    "rotz",
    "rpy",
    "axis_angle",
    "rot",
    "qmul",
    "pose",
    "inverse",
    "rate",
    "pi",
    "world",
];

/// Names of functions and constants of the language: those of the table of functions without a place of their own
/// come last.
pub fn reserved() -> impl Iterator<Item = &'static str> {
    let table = Function::ALL.iter().map(|function| function.name());
    let further = table.filter(|name| !RESERVED.contains(name) && Function::named(name).is_some());
    RESERVED.iter().copied().chain(further)
}

/// Names listed where none is close to a misspelt one.
const LISTED: usize = 12;

/// The names of a description.
#[derive(Clone, Debug, Default)]
pub struct Scope {
    names: BTreeMap<String, Entry>,
    /// What the description defines anywhere, for names that are used too early.
    written: BTreeMap<String, (NameKind, Span)>,
    /// Whether the user wrote constraints, so that no coordinate moves alone.
    constrained: bool,
    /// Whether values are those at points off the variety: what holds on it alone is not checked.
    pub free: bool,
    /// How x and ξ move, once the rates are known.
    pub motion: Option<TimeDerivative>,
    /// Whether the rates are in error: what needs them is no further error.
    pub unmoved: bool,
    /// How x moves along symbols that stand for ẋ, in definitions of velocities.
    pub rates: Option<TimeDerivative>,
    /// The functions of the description.
    pub functions: BTreeMap<String, Defined>,
    /// The tables of the description; `None` where they are in error.
    pub tables: BTreeMap<String, Option<Curve>>,
    /// The functions in Rust, in the order of the text, each with its place among those of the graph.
    pub externals: BTreeMap<String, (usize, External)>,
    /// Where functions in Rust are called, by the lists of their arguments.
    pub called: RefCell<Vec<(Edge, Span)>>,
    /// How many calls of them have been written out.
    pub calls: Cell<usize>,
    /// How many names were found to be unknown.
    misspelt: Cell<usize>,
}

/// Misspelt names for which a close one is looked for.
const MOST_MISSPELT: usize = 50;

impl Scope {
    /// No names yet, but the knowledge of which ones will come.
    pub fn new(system: &System, free: bool) -> Self {
        let mut written = BTreeMap::new();
        let mut note = |name: &Ident, kind| {
            written
                .entry(name.name.clone())
                .or_insert((kind, name.span));
        };
        for item in &system.items {
            let (list, kind) = match &item.kind {
                ItemKind::Param(list) => (list, NameKind::Param),
                ItemKind::Const(list) => (list, NameKind::Const),
                ItemKind::Let(list) => (list, NameKind::Let),
                ItemKind::Velocity(list) => (list, NameKind::Velocity),
                ItemKind::Input(list) => (list, NameKind::Input),
                ItemKind::State(list) => (list, NameKind::State),
                ItemKind::Coord(list) => {
                    list.iter()
                        .for_each(|(name, kind)| note(name, NameKind::Coord(*kind)));
                    continue;
                }
                ItemKind::Frame { name, .. } => {
                    note(name, NameKind::Frame);
                    continue;
                }
                ItemKind::Function(function) => {
                    note(&function.name, NameKind::Function);
                    continue;
                }
                ItemKind::External(function) => {
                    note(&function.name, NameKind::Function);
                    continue;
                }
                ItemKind::Table(table) => {
                    note(&table.name, NameKind::Function);
                    continue;
                }
                _ => continue,
            };
            list.iter()
                .for_each(|declaration| note(&declaration.name, kind));
        }
        // An output may share the name of the expression that it returns.
        for item in &system.items {
            if let ItemKind::Output { name, .. } = &item.kind {
                note(name, NameKind::Output);
            }
        }
        let constraint = |item: &Item| matches!(item.kind, ItemKind::Constraint { .. });
        Scope {
            names: BTreeMap::new(),
            written,
            constrained: system.items.iter().any(constraint),
            free,
            motion: None,
            unmoved: false,
            rates: None,
            functions: BTreeMap::new(),
            tables: BTreeMap::new(),
            externals: BTreeMap::new(),
            called: RefCell::default(),
            calls: Cell::new(0),
            misspelt: Cell::new(0),
        }
    }

    /// The coordinates that are a chart by themselves: plain numbers, where no constraint was written.
    pub fn plain(&self) -> Vec<NodeId> {
        let coordinates = self.names.values().filter(|entry| {
            let plain = matches!(
                entry.kind,
                NameKind::Coord(CoordKind::Real | CoordKind::Euclidean(_))
            );
            plain && !self.constrained
        });
        let values = coordinates.filter_map(|entry| entry.value.as_ref());
        let entries = values.flat_map(Value::entries);
        entries.map(Edge::node).collect()
    }

    /// Takes a name, its value to follow; a second definition is an error. Whether it was free.
    ///
    /// A word of the language is taken all the same, so that its uses are no further errors.
    pub fn claim(&mut self, name: &Ident, kind: NameKind, report: &mut Report) -> bool {
        if let Some(first) = self.names.get(&name.name) {
            report.push(
                Diagnostic::new(name.span, format!("`{}` is defined twice", name.name))
                    .help("rename one of the two")
                    .note(
                        first.span,
                        format!("first defined here, as {}", first.kind.describe()),
                    ),
            );
            return false;
        }
        let entry = Entry {
            kind,
            value: None,
            span: name.span,
        };
        self.names.insert(name.name.clone(), entry);
        let reserved = reserved().any(|word| word == name.name);
        if reserved {
            report.push(
                Diagnostic::new(
                    name.span,
                    format!("`{}` is a word of the language", name.name),
                )
                .help(format!("choose another name, such as `{}_1`", name.name)),
            );
        }
        !reserved
    }

    /// Gives a claimed name its value.
    pub fn set(&mut self, name: &Ident, value: Option<Value>) {
        if let Some(entry) = self.names.get_mut(&name.name) {
            entry.value = value;
        }
    }

    /// Defines a name; whether it was free.
    pub fn define(
        &mut self,
        name: &Ident,
        kind: NameKind,
        value: Option<Value>,
        report: &mut Report,
    ) -> bool {
        let free = self.claim(name, kind, report);
        if free {
            self.set(name, value);
        }
        free
    }

    /// The entry of a name.
    pub fn get(&self, name: &str) -> Option<&Entry> {
        self.names.get(name)
    }

    /// An error for a name that stands for nothing of the wanted kind (or for nothing at all,
    /// where `wanted` is `None`), with the closest name that does.
    pub fn unknown(
        &self,
        span: Span,
        name: &str,
        wanted: Option<&str>,
        accept: impl Fn(NameKind) -> bool,
    ) -> Diagnostic {
        let known = || {
            self.names
                .iter()
                .filter(|(_, e)| accept(e.kind))
                .map(|(n, _)| n.as_str())
        };
        let error = match (self.names.get(name), self.written.get(name), wanted) {
            (Some(entry), _, Some(wanted)) => {
                let message = format!("`{name}` is {}, not a {wanted}", entry.kind.describe());
                Diagnostic::new(span, message).note(entry.span, "defined here")
            }
            (None, Some(&(kind, place)), _) if kind != NameKind::Output => {
                return early(span, name, kind, place);
            }
            (_, Some(_), None) => {
                return Diagnostic::new(
                    span,
                    format!("`{name}` is an output, which other expressions cannot use"),
                )
                .help(format!("name the expression with `let {name} = …;`"));
            }
            (_, _, wanted) => {
                let wanted = wanted.map_or("nothing".into(), |wanted| format!("no {wanted}"));
                Diagnostic::new(span, format!("{wanted} is called `{name}`"))
            }
        };
        self.misspelt.set(self.misspelt.get() + 1);
        if self.misspelt.get() > MOST_MISSPELT {
            return error.help("define it, or check its spelling");
        }
        if let Some(near) = closest(name, known().filter(|&near| near != name)) {
            return error.help(format!("did you mean `{near}`?"));
        }
        let all: Vec<String> = known()
            .take(LISTED)
            .map(|name| format!("`{name}`"))
            .collect();
        match (all.is_empty(), wanted) {
            (true, Some("frame")) => error.help(format!("define it: `frame {name} = pose(R, p);`")),
            (true, _) => error.help("define it first"),
            (false, _) => error.help(format!("known here: {}", all.join(", "))),
        }
    }
}

/// A name that is defined, but not yet where it is used.
fn early(span: Span, name: &str, kind: NameKind, place: Span) -> Diagnostic {
    let error = match kind {
        NameKind::Const | NameKind::Let | NameKind::Frame | NameKind::Output => {
            Diagnostic::new(span, format!("`{name}` is used before it is defined"))
                .help("move its definition before this statement")
        }
        _ => {
            let message = format!("a constant cannot depend on `{name}`, {}", kind.describe());
            Diagnostic::new(span, message).help(
                "constants are made of numbers and constants; name this expression with `let`",
            )
        }
    };
    error.note(place, "defined here")
}
