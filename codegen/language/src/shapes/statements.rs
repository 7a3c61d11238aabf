//! Checks of the shapes that statements require of their expressions.

use super::infer::Inference;
use super::shape::{Shape, Shaped};
use crate::diagnostics::Diagnostic;
use crate::symbols::Kind;
use crate::syntax::ast::{
    Acting, Body, Condition, Conserved, End, Expr, ExprKind, Item, ItemKind, Joint, JointField,
    Load, System,
};
use crate::syntax::written;
use num_traits::Zero;

impl<'a> Inference<'a> {
    /// Checks the expressions of one statement, except those that were checked with the declarations.
    pub fn statement(&mut self, system: &'a System, item: &'a Item) {
        match &item.kind {
            ItemKind::Param(list) => list.iter().for_each(|one| _ = self.default_of(one)),
            ItemKind::State(list) => list.iter().for_each(|one| _ = self.state(one)),
            ItemKind::Velocity(list) => list.iter().for_each(|one| _ = self.definition(one)),
            ItemKind::Constraint { left, right } => self.constraint(left, right),
            ItemKind::Rate { target, value } => _ = self.rate_of(system, target, value),
            ItemKind::Start { target, value } | ItemKind::Guess { target, value } => {
                _ = self.start_of(target, value);
            }
            ItemKind::Prescribe {
                target,
                rate,
                value,
            } => _ = self.prescribed(target, *rate, value),
            ItemKind::Generalized { target, value } => _ = self.force_of(target, value),
            ItemKind::Inactive(list) | ItemKind::Independent(list) => {
                list.iter().for_each(|expr| _ = self.of(expr));
            }
            ItemKind::Nonholonomic {
                left,
                right,
                stabilized,
            }
            | ItemKind::Loop {
                left,
                right,
                stabilized,
            } => {
                self.equation(left, right);
                self.scalars(stabilized, "a rate of stabilisation");
            }
            ItemKind::Joint(joint) => self.joint(joint),
            ItemKind::Body(body) => self.body(body),
            ItemKind::Particle { mass, at, .. } => {
                self.scalars([mass], "a mass");
                self.vectors([at], "the position of a particle");
            }
            ItemKind::Kinetic(expr) => self.scalars([expr], "a kinetic energy"),
            ItemKind::Potential(expr) => self.scalars([expr], "a potential"),
            ItemKind::Gravity(expr) => self.vectors([expr], "gravity"),
            ItemKind::Dissipation(expr) => self.scalars([expr], "a dissipation"),
            ItemKind::Load { load, .. } => self.load(load),
            ItemKind::Push { force, from, to } => {
                self.scalars([force], "a force along a line");
                self.ends([from, to]);
            }
            ItemKind::Spring {
                stiffness,
                length,
                acting,
            } => {
                self.scalars([stiffness], "a stiffness");
                self.scalars(length, "the free length of a spring");
                match acting {
                    // A spring on an S1 coordinate acts on its angle.
                    Acting::On(expr) if self.is_circle(expr) => {}
                    acting => self.acting(acting, "what a spring acts on"),
                }
            }
            ItemKind::Cable {
                stiffness,
                length,
                from,
                to,
            } => {
                self.scalars([stiffness], "a stiffness");
                self.scalars([length], "the length of a cable");
                self.ends([from, to]);
            }
            ItemKind::Damper {
                coefficient,
                acting,
            } => {
                self.scalars([coefficient], "the coefficient of a damper");
                self.acting(acting, "what a damper acts on");
            }
            ItemKind::Inerter { inertance, acting } => {
                self.scalars([inertance], "the inertance of an inerter");
                self.acting(acting, "what an inerter acts on");
            }
            ItemKind::Output { value, .. } => _ = self.of(value),
            ItemKind::Invariant {
                conserved, when, ..
            } => {
                self.conserved(conserved);
                when.iter().for_each(|one| _ = self.condition(one));
            }
            // The others were checked with the declarations, or have no expressions.
            _ => {}
        }
    }

    fn scalars(&mut self, list: impl IntoIterator<Item = &'a Expr>, what: &str) {
        let list = list.into_iter();
        list.for_each(|expr| _ = self.wants(expr, what, Shape::Scalar));
    }

    fn vectors(&mut self, list: impl IntoIterator<Item = &'a Expr>, what: &str) {
        let list = list.into_iter();
        list.for_each(|expr| _ = self.wants(expr, what, Shape::Vector(3)));
    }

    fn constraint(&mut self, left: &'a Expr, right: &'a Expr) {
        let (Some(a), Some(b)) = (self.of(left), self.of(right)) else {
            return;
        };
        if a.shape != b.shape {
            let (a, b) = (a.shape.describe(), b.shape.describe());
            let message = format!("one side of the constraint is {a}, but the other is {b}");
            let error = Diagnostic::new(left.span.to(right.span), message);
            self.error::<()>(error.help("both sides need the same shape"));
        }
    }

    /// Checks both sides of a loop or of a constraint on velocities. A right side of 0 applies to every entry.
    fn equation(&mut self, left: &'a Expr, right: &'a Expr) {
        let (a, b) = (self.of(left), self.of(right));
        let (Some(a), Some(b)) = (a, b) else { return };
        if a.shape != b.shape && !is_zero(&b) {
            let (a, b) = (a.shape.describe(), b.shape.describe());
            let message = format!("one side is {a}, but the other is {b}");
            let error = Diagnostic::new(left.span.to(right.span), message);
            self.error::<()>(error.help("both sides need the same shape, or 0 on the right"));
        }
    }

    /// Checks the fields of a joint that are not expanded into statements.
    fn joint(&mut self, joint: &'a Joint) {
        for (field, _, values) in &joint.fields {
            let what = match field {
                JointField::Limit => "a limit of a joint",
                JointField::MaxSpeed => "the largest speed of a joint",
                JointField::MaxForce => "the largest force of a joint",
                JointField::Armature => "the armature of a joint",
                _ => continue,
            };
            self.scalars(values, what);
        }
    }

    fn body(&mut self, body: &'a Body) {
        self.scalars(&body.mass, "a mass");
        self.vectors(&body.com, "a centre of mass");
        if let Some((expr, _)) = &body.inertia
            && let Some(found) = self.of(expr)
            && found.shape != Shape::Matrix(3, 3)
        {
            let found = found.shape.describe();
            let message = format!("an inertia has to be a 3×3 matrix, but this is {found}");
            self.error::<()>(
                Diagnostic::new(expr.span, message)
                    .help("write `diag(Ix, Iy, Iz)`, or name a parameter of shape sym3"),
            );
        }
    }

    fn load(&mut self, load: &'a Load) {
        let (forces, torques, at) = match load {
            Load::Force { force, at } => (Some(force), None, at.as_ref()),
            Load::Torque { torque } => (None, Some(torque), None),
            Load::Wrench { force, torque, at } => (Some(force), Some(torque), at.as_ref()),
        };
        self.vectors(forces, "a force");
        self.vectors(torques, "a torque");
        self.vectors(at, "a point of application");
    }

    fn ends(&mut self, ends: [&'a End; 2]) {
        let points = ends.into_iter().filter_map(|end| end.at.as_ref());
        self.vectors(points, "a point of a frame");
    }

    fn acting(&mut self, acting: &'a Acting, what: &str) {
        match acting {
            Acting::On(expr) => self.scalars([expr], what),
            Acting::Between(from, to) => self.ends([from, to]),
        }
    }

    fn conserved(&mut self, conserved: &'a Conserved) {
        let (about, along) = match conserved {
            Conserved::Energy => (None, None),
            Conserved::LinearMomentum { along, .. } => (None, along.as_ref()),
            Conserved::AngularMomentum { about, along, .. } => (about.as_ref(), along.as_ref()),
            Conserved::Value(expr) => {
                self.of(expr);
                return;
            }
        };
        self.vectors(about, "the point of an angular momentum");
        self.vectors(along, "the direction of a momentum");
    }

    /// Checks a condition such as `F = 0`. A value of 0 sets every entry.
    fn condition(&mut self, condition: &'a Condition) -> Option<()> {
        let Condition { target, value } = condition;
        let set = match &target.kind {
            ExprKind::Index(base, _) => &base.kind,
            name => name,
        };
        // A target that cannot be set has been reported already.
        let ExprKind::Name(name) = set else {
            return None;
        };
        self.symbols
            .kind(name)
            .filter(|kind: &Kind| kind.is_settable())?;
        let (wanted, found) = (self.of(target), self.of(value));
        let (wanted, found) = (wanted?.shape, found?);
        if is_zero(&found) {
            return Some(());
        }
        let what = format!("the value of `{}`", written::written(target));
        self.agree(value, &what, wanted, found.shape)
    }
}

fn is_zero(found: &Shaped) -> bool {
    found.as_number().is_some_and(Zero::is_zero)
}
