//! Dimensions that statements require of their expressions.

use super::calls::TIME;
use super::form::Term;
use super::value::Value;
use super::walk::{Walk, length};
use crate::diagnostics::Diagnostic;
use crate::shapes::Shape;
use crate::symbols::Kind;
use crate::syntax::ast::{Body, Condition, Conserved, Expr, Ident, Item, ItemKind, Load, Target};
use crate::syntax::written;
use crate::units::{Dimension, Unit};

/// Dimension of an energy or a torque.
pub const ENERGY: [i32; 5] = [1, 2, -2, 0, 0];
/// Dimension of a power.
pub const POWER: [i32; 5] = [1, 2, -3, 0, 0];
/// Dimension of a force.
pub const FORCE: [i32; 5] = [1, 1, -2, 0, 0];
/// Dimension of a length.
pub const LENGTH: [i32; 5] = [0, 1, 0, 0, 0];
/// Dimension of a mass.
pub const MASS: [i32; 5] = [1, 0, 0, 0, 0];

impl<'a> Walk<'a> {
    /// Checks the expressions of one statement, except those that were checked with the declarations.
    pub fn statement(&mut self, item: &'a Item) {
        match &item.kind {
            ItemKind::Param(list) | ItemKind::Velocity(list) | ItemKind::State(list) => {
                for one in list {
                    if let Some(value) = &one.value {
                        let found = self.of(value);
                        self.value_of(&one.name, value, &found);
                    }
                }
            }
            ItemKind::Constraint { left, right } => self.equation(left, right, None),
            ItemKind::Nonholonomic {
                left,
                right,
                stabilized,
            }
            | ItemKind::Loop {
                left,
                right,
                stabilized,
            } => self.equation(left, right, stabilized.as_ref()),
            ItemKind::Rate { target, value } => {
                self.assign(target, value, "the rate of", |term, time| {
                    term.quotient(time)
                });
            }
            ItemKind::Start { target, value } | ItemKind::Guess { target, value } => {
                self.assign(target, value, "the start of", |term, _| term.clone());
            }
            ItemKind::Prescribe {
                target,
                rate,
                value,
            } => {
                let what = if *rate {
                    "the rate of"
                } else {
                    "the motion of"
                };
                self.assign(target, value, what, |term, time| match rate {
                    true => term.quotient(time),
                    false => term.clone(),
                });
            }
            ItemKind::Generalized { target, value } => {
                let power = Term::of(Dimension::of(POWER));
                self.assign(target, value, "the generalized force of", |term, _| {
                    power.quotient(term)
                });
            }
            ItemKind::Inactive(list) | ItemKind::Independent(list) => {
                list.iter().for_each(|expr| _ = self.of(expr));
            }
            ItemKind::Body(body) => self.body(body),
            ItemKind::Particle { mass, at, .. } => {
                self.demand(mass, "a mass", MASS);
                self.demand(at, "the position of a particle", LENGTH);
            }
            ItemKind::Kinetic(expr) => self.demand(expr, "a kinetic energy", ENERGY),
            ItemKind::Potential(expr) => self.demand(expr, "a potential energy", ENERGY),
            ItemKind::Gravity(expr) => self.demand(expr, "gravity", [0, 1, -2, 0, 0]),
            ItemKind::Dissipation(expr) => self.demand(expr, "a dissipation", POWER),
            ItemKind::Load { load, .. } => self.load(load),
            ItemKind::Output { name, unit, value } => self.output(name, unit.as_ref(), value),
            ItemKind::Invariant {
                conserved, when, ..
            } => {
                self.conserved(conserved);
                for Condition { target, value } in when {
                    let (a, b) = (self.of(target), self.of(value));
                    let what = format!("the value of `{}`", written::written(target));
                    self.fits(value, &b, &what, &a);
                }
            }
            ItemKind::Push { .. }
            | ItemKind::Spring { .. }
            | ItemKind::Cable { .. }
            | ItemKind::Damper { .. }
            | ItemKind::Inerter { .. }
            | ItemKind::Joint(_) => self.element(item),
            // These were checked with the declarations, have no expressions, or are expanded.
            ItemKind::Const(_)
            | ItemKind::Let(_)
            | ItemKind::Function(_)
            | ItemKind::External(_)
            | ItemKind::Table(_)
            | ItemKind::Coord(_)
            | ItemKind::Input(_)
            | ItemKind::Time(_)
            | ItemKind::Frame { .. }
            | ItemKind::Generate(_)
            | ItemKind::Include(..)
            | ItemKind::Component(_)
            | ItemKind::Part(_)
            | ItemKind::Repeat(_) => {}
        }
    }

    /// Reads an expression whose entries have to have one dimension.
    pub fn demand(&mut self, expr: &'a Expr, what: &str, wanted: [i32; 5]) {
        let value = self.of(expr);
        self.wants(expr, &value, what, &Dimension::of(wanted));
    }

    fn equation(&mut self, left: &'a Expr, right: &'a Expr, stabilized: Option<&'a Expr>) {
        let (a, b) = (self.of(left), self.of(right));
        self.same((&a, left), (&b, right), |a, b| {
            format!("this side is {b}, but the other is {a}")
        });
        if let Some(rate) = stabilized {
            self.demand(rate, "a rate of stabilisation", [0, 0, -1, 0, 0]);
        }
    }

    /// Returns the dimensions of a coordinate, velocity or state, or of a part or an entry of one.
    fn target(&self, target: &Target) -> Option<Value> {
        let value = self.names.get(target.name.name.as_str())?;
        Some(
            match (
                target.field.as_ref().map(|field| field.name.as_str()),
                value.shape,
            ) {
                (Some("p"), Shape::Pose) => match target.entry.is_empty() {
                    true => length(Shape::Vector(3)),
                    false => length(Shape::Scalar),
                },
                (Some(_), _) => Value::scalar(Term::one()),
                (None, _) => match target.place(value.len()) {
                    Some(place) => Value::scalar(value.at(place).clone()),
                    None => value.clone(),
                },
            },
        )
    }

    /// Checks a value that is given to a coordinate, velocity or state; `of` turns the dimension of this into that of
    /// the value, given that of a time.
    fn assign(
        &mut self,
        target: &Target,
        expr: &'a Expr,
        what: &str,
        of: impl Fn(&Term, &Term) -> Term,
    ) {
        let found = self.of(expr);
        let time = Term::of(Dimension::of(TIME));
        if let Some(wanted) = self.target(target) {
            let wanted = wanted.map(|term| of(term, &time));
            let what = format!("{what} `{}`", written::target(target));
            let name = target.name.name.as_str();
            self.given(expr, &found, (&what, Some(name)), &wanted);
        }
    }

    fn body(&mut self, body: &'a Body) {
        if let Some(mass) = &body.mass {
            self.demand(mass, "a mass", MASS);
        }
        if let Some(com) = &body.com {
            self.demand(com, "a centre of mass", LENGTH);
        }
        if let Some((inertia, _)) = &body.inertia {
            self.demand(inertia, "a moment of inertia", [1, 2, 0, 0, 0]);
        }
    }

    fn load(&mut self, load: &'a Load) {
        let (force, torque, at) = match load {
            Load::Force { force, at } => (Some(force), None, at.as_ref()),
            Load::Torque { torque } => (None, Some(torque), None),
            Load::Wrench { force, torque, at } => (Some(force), Some(torque), at.as_ref()),
        };
        force
            .into_iter()
            .for_each(|expr| self.demand(expr, "a force", FORCE));
        torque
            .into_iter()
            .for_each(|expr| self.demand(expr, "a torque", ENERGY));
        at.into_iter()
            .for_each(|expr| self.demand(expr, "a point of application", LENGTH));
    }

    fn output(&mut self, name: &'a Ident, unit: Option<&'a Unit>, value: &'a Expr) {
        let found = self.of(value);
        let mut known = found.clone();
        if let Some(unit) = unit {
            known = Value::uniform(found.shape, Term::of(unit.dimension.clone()));
            self.places.entry(&name.name).or_insert(unit.span);
        }
        // An output can share its name with something else.
        if self.symbols.kind(&name.name).is_none() {
            self.names.insert(&name.name, known.clone());
        }
        let what = format!("`{}`", name.name);
        self.given(value, &found, (&what, Some(&name.name)), &known);
    }

    fn conserved(&mut self, conserved: &'a Conserved) {
        let (about, along) = match conserved {
            Conserved::Energy => (None, None),
            Conserved::LinearMomentum { along, .. } => (None, along.as_ref()),
            Conserved::AngularMomentum { about, along, .. } => (about.as_ref(), along.as_ref()),
            Conserved::Value(expr) => (None, Some(expr)),
        };
        about
            .into_iter()
            .for_each(|expr| self.demand(expr, "the point of an angular momentum", LENGTH));
        along.into_iter().for_each(|expr| _ = self.of(expr));
    }

    /// Reports a unit that the kind of a coordinate cannot have.
    pub fn misfit(&mut self, name: &Ident, unit: &Unit, wanted: &Dimension) {
        let message = format!("`{}` cannot be in [{}]", name.name, unit.text);
        let kind = match self.symbols.kind(&name.name) {
            Some(Kind::Coord(kind)) => crate::syntax::print::kind(kind),
            _ => String::new(),
        };
        let help = match wanted.is_one() {
            true => format!("a coordinate{kind} consists of numbers: leave its unit out"),
            false => format!("a coordinate{kind} has its position in [{wanted}]"),
        };
        self.report.push_once(
            Diagnostic::new(unit.span, message)
                .help(help)
                .note(name.span, "declared here"),
        );
    }
}
