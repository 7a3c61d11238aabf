//! Declarations that nothing uses: parameters, constants, named expressions, functions, inputs and frames.
//!
//! Such a description is correct, so these are warnings. What is looked at are declarations as written, before joints
//! are written out: a frame that a joint moves is used by the joint. Names that begin with `_` are left alone.

use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Ident, Item, ItemKind, Origins, Span, System};
use std::collections::{BTreeMap, BTreeSet};

/// A warning for every declaration whose name occurs nowhere else, in the order of the text; `used` are the names
/// that are used. What stands in several copies is used where one of them is, and what is included need not be.
pub fn warnings(system: &System, used: &BTreeSet<String>) -> Vec<Diagnostic> {
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
                // A frame of two statements is the one that relates them.
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

/// The name on the left of a `frame` statement.
fn frame(item: &Item) -> Option<&str> {
    match &item.kind {
        ItemKind::Frame { name, .. } => Some(&name.name),
        _ => None,
    }
}

/// The names that statements mention, but for what they declare.
struct Uses<'a> {
    names: &'a BTreeSet<String>,
    /// How names are written.
    origins: &'a Origins,
}

impl Uses<'_> {
    /// A warning, or the place of what is used.
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
            Some(_) => warning.help("remove it, or let its name begin with `_`"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::warnings;
    use crate::diagnostics::Report;
    use crate::lower::joints;
    use crate::symbols;
    use crate::syntax::parse_text;

    /// What is said of a description with further statements.
    fn said(statements: &str) -> Vec<String> {
        let text = format!(
            "system A {{ coord q; velocity w; rate q = w; kinetic w^2 / 2; {statements} }}"
        );
        let system = parse_text(&text).expect("a description");
        let mut report = Report::new();
        let written = joints::expand(&system, &mut report);
        let used = symbols::resolve(&written, &mut report).used;
        assert!(report.is_empty(), "{text}: {report:?}");
        let list = warnings(&system, &used).into_iter();
        list.map(|warning| warning.message).collect()
    }

    #[test]
    fn every_kind_of_declaration_is_missed() {
        let text = "param m = 1, _spare = 2; const k = 3; let e = q * w; input u: vec2; frame f = pose(rotz(q), [0, 0, 0]);";
        let expected = [
            "the parameter `m` is never used",
            "the constant `k` is never used",
            "the named expression `e` is never used",
            "the input `u` is never used",
            "the frame `f` is never used",
        ];
        assert_eq!(said(text), expected);
    }

    #[test]
    fn every_place_is_a_use() {
        for (name, used) in [
            (
                "frame f = world",
                "frame g on f = world; body on g { mass 1; }",
            ),
            (
                "frame f = world",
                "joint j: revolute [0, 0, 1] on f moves g;",
            ),
            ("frame f = world", "particle mass 1 at [0, 0, 0] on f;"),
            ("frame f = world", "output p = position(f, [0, 0, 0]);"),
            ("frame f = world", "let p = f.p; output p = p;"),
            (
                "frame f = world",
                "joint j: fixed moves g; torque [0, 0, 1] on g from f in world;",
            ),
            (
                "frame f = world",
                "joint j: fixed moves g; torque [0, 0, 1] on g in f;",
            ),
            (
                "frame f = world",
                "damper coefficient 1 from f to [1, 0, 0] on f;",
            ),
            ("frame f = world", "invariant p = linear_momentum of f;"),
            // Two statements about one frame: it relates two others.
            (
                "frame f = world",
                "frame f on g = world; body on g { mass 1; }",
            ),
            (
                "param a = 1",
                "joint j: revolute [0, 0, 1] at pose(rotz(a), [0, 0, 0]) moves g;",
            ),
            (
                "param a = 1",
                "joint j: revolute [0, 0, 1] moves g { armature a; }",
            ),
            ("param a = 1", "start q = a;"),
            ("param a = 1", "loop cos(q) = 1 stabilized a;"),
            ("param a = 1", "spring stiffness 1 length a on q;"),
            ("param a = 1", "potential -a * q;"),
            ("param a = 1", "let b = a; output c = b;"),
            ("input a", "generalized force w = a;"),
            ("input a", "invariant energy when a = 0;"),
        ] {
            assert_eq!(said(&format!("{name}; {used}")), [""; 0], "{name}; {used}");
        }
    }
}
