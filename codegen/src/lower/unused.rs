//! Declarations that nothing uses: parameters, constants, named expressions, functions, inputs and frames.
//!
//! Such a description is correct, so these are warnings. What is looked at is the text as written, before joints
//! are written out: a frame that a joint moves is used by the joint. Names that begin with `_` are left alone.

use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{
    Acting, Components, Conserved, Declaration, End, Expr, ExprKind, Ident, Item, ItemKind, Load,
    Origins, Source, Span, System, Table, Wanted,
};
use std::collections::{BTreeMap, BTreeSet};

/// A warning for every declaration whose name occurs nowhere else, in the order of the text; `used` are further names
/// that are used. What stands in several copies is used where one of them is, and what is included need not be.
pub fn warnings(system: &System, used: &BTreeSet<String>) -> Vec<Diagnostic> {
    let mut uses = Uses {
        origins: Some(&system.origins),
        ..Uses::default()
    };
    uses.names.extend(used.iter().map(String::as_str));
    system.items.iter().for_each(|item| uses.item(item));
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
                if statements == Some(&1) && placed.insert(&name.name) {
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
#[derive(Default)]
struct Uses<'a> {
    names: BTreeSet<&'a str>,
    /// How names are written.
    origins: Option<&'a Origins>,
}

impl<'a> Uses<'a> {
    /// A warning, or the place of what is used.
    fn unused(&self, name: &Ident, kind: &str) -> Result<Diagnostic, Span> {
        let Ident { name, span } = name;
        let written = self.origins.and_then(|origins| origins.written(name));
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

    fn name(&mut self, name: &'a Ident) {
        self.names.insert(&name.name);
    }

    fn names(&mut self, list: impl IntoIterator<Item = &'a Ident>) {
        list.into_iter().for_each(|name| self.name(name));
    }

    fn all(&mut self, list: impl IntoIterator<Item = &'a Expr>) {
        list.into_iter().for_each(|expr| self.expr(expr));
    }

    fn expr(&mut self, expr: &'a Expr) {
        match &expr.kind {
            ExprKind::Name(name) => _ = self.names.insert(name),
            ExprKind::Call(function, _) => self.name(function),
            _ => {}
        }
        self.all(expr.parts());
    }

    fn values(&mut self, list: &'a [Declaration]) {
        self.all(
            list.iter()
                .filter_map(|declaration| declaration.value.as_ref()),
        );
    }

    fn end(&mut self, end: &'a End) {
        self.all(&end.at);
        self.name(&end.frame);
    }

    fn acting(&mut self, acting: &'a Acting) {
        match acting {
            Acting::Between(from, to) => [from, to].into_iter().for_each(|end| self.end(end)),
            Acting::On(expr) => self.expr(expr),
        }
    }

    fn load(&mut self, load: &'a Load) {
        match load {
            Load::Force { force, at } => self.all([force].into_iter().chain(at)),
            Load::Torque { torque } => self.expr(torque),
            Load::Wrench { force, torque, at } => {
                self.all([force, torque].into_iter().chain(at));
            }
        }
    }

    fn item(&mut self, item: &'a Item) {
        match &item.kind {
            ItemKind::Param(list)
            | ItemKind::Const(list)
            | ItemKind::Let(list)
            | ItemKind::Velocity(list)
            | ItemKind::Input(list)
            | ItemKind::State(list) => self.values(list),
            ItemKind::Coord(_) | ItemKind::Time(_) => {}
            ItemKind::Prescribe { target, value, .. } => {
                self.name(&target.name);
                self.expr(value);
            }
            ItemKind::Function(function) => {
                let mut inner = Uses::default();
                inner.expr(&function.value);
                for (parameter, _) in &function.parameters {
                    inner.names.remove(parameter.name.as_str());
                }
                self.names.extend(inner.names);
            }
            ItemKind::External(function) => {
                let mut inner = Uses::default();
                function.stand_in.iter().for_each(|value| inner.expr(value));
                for parameter in &function.parameters {
                    inner.names.remove(parameter.name.as_str());
                }
                self.names.extend(inner.names);
            }
            ItemKind::Table(Table {
                source: Source::Points(points, _),
                ..
            }) => points.iter().for_each(|(a, b)| self.all([a, b])),
            ItemKind::Table(_) => {}
            ItemKind::Constraint { left, right } => self.all([left, right]),
            ItemKind::Rate { value, .. }
            | ItemKind::Generalized { value, .. }
            | ItemKind::Start { value, .. }
            | ItemKind::Guess { value, .. }
            | ItemKind::Output { value, .. } => self.expr(value),
            ItemKind::Inactive(list) | ItemKind::Independent(list) => self.all(list),
            ItemKind::Nonholonomic {
                left,
                right,
                stabilized,
            }
            | ItemKind::Loop {
                left,
                right,
                stabilized,
            } => self.all([left, right].into_iter().chain(stabilized)),
            ItemKind::Frame { on, pose, .. } => {
                self.names(on);
                self.expr(pose);
            }
            ItemKind::Joint(joint) => {
                self.names(joint.on.iter().chain([&joint.moves]));
                self.all(joint.axes.iter().chain(&joint.at).chain(&joint.follows));
                let fields = joint.fields.iter();
                self.all(fields.flat_map(|(_, _, values)| values));
            }
            ItemKind::Body(body) => {
                self.name(&body.frame);
                self.all(body.mass.iter().chain(&body.com));
                self.all(body.inertia.iter().map(|(inertia, _)| inertia));
            }
            ItemKind::Particle { mass, at, on } => {
                self.all([mass, at]);
                self.names(on);
            }
            ItemKind::Kinetic(expr)
            | ItemKind::Potential(expr)
            | ItemKind::Gravity(expr)
            | ItemKind::Dissipation(expr) => self.expr(expr),
            ItemKind::Load {
                load,
                frame,
                from,
                axes,
            } => {
                self.load(load);
                self.names([frame].into_iter().chain(from));
                if let Components::Frame(frame) = axes {
                    self.name(frame);
                }
            }
            ItemKind::Push { force, from, to } => {
                self.expr(force);
                self.end(from);
                self.end(to);
            }
            ItemKind::Spring {
                stiffness,
                length,
                acting,
            } => {
                self.all([stiffness].into_iter().chain(length));
                self.acting(acting);
            }
            ItemKind::Damper {
                coefficient,
                acting,
            } => {
                self.expr(coefficient);
                self.acting(acting);
            }
            ItemKind::Invariant {
                conserved, when, ..
            } => {
                self.conserved(conserved);
                self.all(when.iter().flat_map(|set| [&set.target, &set.value]));
            }
            ItemKind::Generate(all) => {
                for wanted in all {
                    if let Wanted::Jacobian { frame, .. } = wanted {
                        self.name(frame);
                    }
                }
            }
            // Written out already.
            ItemKind::Include(..)
            | ItemKind::Component(_)
            | ItemKind::Part(_)
            | ItemKind::Repeat(_) => {}
        }
    }

    fn conserved(&mut self, conserved: &'a Conserved) {
        match conserved {
            Conserved::Energy => {}
            Conserved::LinearMomentum { of, along } => {
                self.names(of);
                self.all(along);
            }
            Conserved::AngularMomentum { of, about, along } => {
                self.names(of);
                self.all(about.iter().chain(along));
            }
            Conserved::Value(expr) => self.expr(expr),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::warnings;
    use crate::syntax::parse_text;

    /// What is said of a description with further statements.
    fn said(statements: &str) -> Vec<String> {
        let text = format!(
            "system A {{ coord q; velocity w; rate q = w; kinetic w^2 / 2; {statements} }}"
        );
        let system = parse_text(&text).expect("a description");
        let list = warnings(&system, &Default::default()).into_iter();
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
