//! Names and what they stand for.

use super::value::Value;
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{CoordKind, Ident, Span};
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
    /// A frame.
    Frame,
    /// An output.
    Output,
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
            NameKind::Frame => "a frame",
            NameKind::Output => "an output",
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
pub const RESERVED: &[&str] = &[
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
    "rotx",
    "roty",
    "rotz",
    "rpy",
    "axis_angle",
    "rot",
    "qmul",
    "pose",
    "inverse",
    "pi",
    "world",
];

/// The names of a description.
#[derive(Clone, Debug, Default)]
pub struct Scope {
    names: BTreeMap<String, Entry>,
}

impl Scope {
    /// Defines a name; a second definition is an error.
    pub fn define(
        &mut self,
        name: &Ident,
        kind: NameKind,
        value: Option<Value>,
        report: &mut Report,
    ) {
        if RESERVED.contains(&name.name.as_str()) {
            report.push(
                Diagnostic::new(
                    name.span,
                    format!("`{}` is a word of the language", name.name),
                )
                .help("choose another name"),
            );
            return;
        }
        if let Some(first) = self.names.get(&name.name) {
            report.push(
                Diagnostic::new(name.span, format!("`{}` is defined twice", name.name))
                    .help("rename one of the two")
                    .note(
                        first.span,
                        format!("first defined here, as {}", first.kind.describe()),
                    ),
            );
            return;
        }
        self.names.insert(
            name.name.clone(),
            Entry {
                kind,
                value,
                span: name.span,
            },
        );
    }

    /// The entry of a name.
    pub fn get(&self, name: &str) -> Option<&Entry> {
        self.names.get(name)
    }

    /// Gives an already defined name its value.
    pub fn set(&mut self, name: &str, value: Option<Value>) {
        if let Some(entry) = self.names.get_mut(name) {
            entry.value = value;
        }
    }

    /// An error for an unknown name, with the closest known one of the wanted kind.
    pub fn unknown(
        &self,
        span: Span,
        name: &str,
        wanted: &str,
        accept: impl Fn(NameKind) -> bool,
    ) -> Diagnostic {
        let known = self
            .names
            .iter()
            .filter(|(_, e)| accept(e.kind))
            .map(|(n, _)| n.as_str());
        let error = Diagnostic::new(span, format!("no {wanted} is called `{name}`"));
        match closest(name, known) {
            Some(known) => error.help(format!("did you mean `{known}`?")),
            None => {
                let all: Vec<String> = self
                    .names
                    .iter()
                    .filter(|(_, e)| accept(e.kind))
                    .map(|(n, _)| format!("`{n}`"))
                    .take(12)
                    .collect();
                if all.is_empty() {
                    error.help("define it first")
                } else {
                    error.help(format!("known here: {}", all.join(", ")))
                }
            }
        }
    }
}

/// The known word nearest to a misspelt one, if it is near enough.
pub fn closest<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let limit = if word.chars().count() <= 3 { 1 } else { 2 };
    known
        .map(|k| (distance(word, k), k))
        .filter(|(d, _)| *d <= limit)
        .min()
        .map(|(_, k)| k)
}

/// Levenshtein distance, letters of different case being near to equal.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (
        a.to_lowercase().chars().collect(),
        b.to_lowercase().chars().collect(),
    );
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + (x != y) as usize;
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
