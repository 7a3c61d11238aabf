//! Declarations that nothing uses: parameters, constants, named expressions, functions, inputs and frames.
//!
//! Such a description is correct, so these are warnings. What is looked at is the text as written, before joints
//! are written out: a frame that a joint moves is used by the joint. Names that begin with `_` are left alone.

use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{
    Acting, Components, Conserved, Declaration, End, Expr, ExprKind, Ident, Item, ItemKind, Load,
    Source, System, Table,
};
use std::collections::BTreeSet;

/// A warning for every declaration whose name occurs nowhere else, in the order of the text.
pub fn warnings(system: &System) -> Vec<Diagnostic> {
    let mut uses = Uses::default();
    system.items.iter().for_each(|item| uses.item(item));
    let mut warnings = Vec::new();
    let mut placed = BTreeSet::new();
    for item in &system.items {
        let (list, kind) = match &item.kind {
            ItemKind::Param(list) => (list, "parameter"),
            ItemKind::Const(list) => (list, "constant"),
            ItemKind::Let(list) => (list, "named expression"),
            ItemKind::Input(list) => (list, "input"),
            ItemKind::Frame { name, .. } => {
                // A frame of two statements is the one that relates them.
                let frames = system.items.iter().filter_map(frame);
                let statements = frames.filter(|other| *other == name.name).count();
                if statements == 1 && placed.insert(&name.name) {
                    warnings.extend(uses.unused(name, "frame"));
                }
                continue;
            }
            ItemKind::Table(table) => {
                warnings.extend(uses.unused(&table.name, "table"));
                continue;
            }
            ItemKind::Function(function) => {
                warnings.extend(uses.unused(&function.name, "function"));
                continue;
            }
            _ => continue,
        };
        let names = list.iter().map(|declaration| &declaration.name);
        warnings.extend(names.filter_map(|name| uses.unused(name, kind)));
    }
    warnings
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
}

impl<'a> Uses<'a> {
    fn unused(&self, name: &Ident, kind: &str) -> Option<Diagnostic> {
        let Ident { name, span } = name;
        if name.starts_with('_') || self.names.contains(name.as_str()) {
            return None;
        }
        let warning = Diagnostic::new(*span, format!("the {kind} `{name}` is never used"));
        Some(warning.help(format!("remove it, or call it `_{name}`")))
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
            ItemKind::Generate(_) => {}
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
        let list = warnings(&system).into_iter();
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
