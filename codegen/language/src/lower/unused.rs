//! Warns of declarations that nothing uses: parameters, constants, named expressions, functions, inputs and frames.
//!
//! Such a description is correct, so these are warnings. Declarations are examined as written, before joints are
//! expanded: a frame that a joint moves is used by the joint. Names that begin with `_` are ignored.

use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Ident, Item, ItemKind, Origins, Span, System};
use std::collections::{BTreeMap, BTreeSet};

/// Returns a warning for every declaration whose name occurs nowhere else, in the order of the text; `used` are the
/// names that are used. A declaration that occurs in several copies is used if one copy is; included declarations
/// need not be used.
pub fn unused_warnings(system: &System, used: &BTreeSet<String>) -> Vec<Diagnostic> {
    let uses = Uses {
        names: used,
        origins: &system.origins,
    };
    let mut found = Vec::new();
    let mut placed = BTreeSet::new();
    let mut frames: BTreeMap<&str, usize> = BTreeMap::new();
    for name in system.items.iter().filter_map(frame) {
        *frames.entry(name).or_default() += 1;
    }
    for item in &system.items {
        let (list, kind) = match &item.kind {
            ItemKind::Param(list) => (list, "parameter"),
            ItemKind::Const(list) => (list, "constant"),
            ItemKind::Let(list) => (list, "named expression"),
            ItemKind::Input(list) => (list, "input"),
            ItemKind::Frame { name, .. } => {
                // A frame with two statements is used: it relates them.
                let statements = frames.get(name.name.as_str());
                if !system.shows_frames && statements == Some(&1) && placed.insert(&name.name) {
                    found.push(uses.unused(name, "frame"));
                }
                continue;
            }
            ItemKind::Table(table) => {
                found.push(uses.unused(&table.name, "table"));
                continue;
            }
            ItemKind::External(function) => {
                found.push(uses.unused(&function.name, "function"));
                continue;
            }
            ItemKind::Function(function) => {
                found.push(uses.unused(&function.name, "function"));
                continue;
            }
            _ => continue,
        };
        let names = list.iter().map(|declaration| &declaration.name);
        found.extend(names.map(|name| uses.unused(name, kind)));
    }
    let origins = &system.origins;
    let place = |span: Span| origins.source(span).range().map(|at| (at.start, at.end));
    let used = found.iter().filter_map(|one| one.as_ref().err());
    let mut seen: BTreeSet<_> = used.filter_map(|span| place(*span)).collect();
    let unused = found.into_iter().filter_map(Result::ok);
    let first = |warning: &Diagnostic| {
        let place = place(warning.span);
        !origins.is_included(warning.span) && place.is_none_or(|place| seen.insert(place))
    };
    unused.filter(first).collect()
}

/// Returns the name on the left of a `frame` statement.
fn frame(item: &Item) -> Option<&str> {
    match &item.kind {
        ItemKind::Frame { name, .. } => Some(&name.name),
        _ => None,
    }
}

/// The names that statements mention, other than those that they declare.
struct Uses<'a> {
    names: &'a BTreeSet<String>,
    /// Origins of names, which tell how they are written.
    origins: &'a Origins,
}

impl Uses<'_> {
    /// Returns a warning, or the place of the declaration if it is used.
    fn unused(&self, name: &Ident, kind: &str) -> Result<Diagnostic, Span> {
        let Ident { name, span } = name;
        let written = self.origins.written(name);
        let last = written.map(|name| name.rsplit_once('.').map_or(name, |(_, last)| last));
        let begins = last.unwrap_or(name).starts_with('_');
        if begins || self.names.contains(name.as_str()) {
            return Err(*span);
        }
        let warning = Diagnostic::new(*span, format!("the {kind} `{name}` is never used"));
        Ok(match written {
            None => warning.help(format!("remove it, or call it `_{name}`")),
            Some(_) => warning.help("remove it, or begin its name with `_`"),
        })
    }
}
