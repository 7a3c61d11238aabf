//! Dimensions of springs, dampers and inerters, by what they act on, and of the fields of joints.

use super::form::Term;
use super::statements::{ENERGY, FORCE, LENGTH, MASS, POWER};
use super::value::Value;
use super::walk::Walk;
use crate::syntax::ast::{Acting, End, Expr, Item, ItemKind, Joint, JointField};
use crate::units::Dimension;
use num_rational::BigRational;

impl<'a> Walk<'a> {
    /// Checks a spring, damper, inerter, force along a line, or joint.
    pub fn element(&mut self, item: &'a Item) {
        match &item.kind {
            ItemKind::Push { force, from, to } => {
                self.demand(force, "a force along a line", FORCE);
                self.ends([from, to]);
            }
            ItemKind::Spring {
                stiffness,
                length,
                acting,
            } => {
                let stretch =
                    self.factor(stiffness, "a stiffness", acting, [1, 0, -2, 0, 0], ENERGY);
                if let Some(length) = length {
                    let found = self.of(length);
                    self.fits(length, &found, "the free length of a spring", &stretch);
                }
            }
            ItemKind::Damper {
                coefficient,
                acting,
            } => {
                _ = self.factor(
                    coefficient,
                    "a damping coefficient",
                    acting,
                    [1, 0, -1, 0, 0],
                    POWER,
                )
            }
            ItemKind::Inerter { inertance, acting } => {
                _ = self.factor(inertance, "an inertance", acting, MASS, ENERGY);
            }
            ItemKind::Cable {
                stiffness,
                length,
                from,
                to,
            } => {
                self.demand(stiffness, "a stiffness", [1, 0, -2, 0, 0]);
                self.demand(length, "the length of a cable", LENGTH);
                self.ends([from, to]);
            }
            ItemKind::Joint(joint) => self.joint(joint),
            _ => {}
        }
    }

    fn ends(&mut self, ends: [&'a End; 2]) {
        for at in ends.into_iter().filter_map(|end| end.at.as_ref()) {
            self.demand(at, "a point of a frame", LENGTH);
        }
    }

    /// Checks the factor of an element: `line` is its dimension between two points; on a scalar e, the factor times e²
    /// has the dimension `product`. Returns the dimension of the length or of the scalar.
    fn factor(
        &mut self,
        factor: &'a Expr,
        what: &str,
        acting: &'a Acting,
        line: [i32; 5],
        product: [i32; 5],
    ) -> Value {
        let (acts_on, wanted) = match acting {
            Acting::Between(from, to) => {
                self.ends([from, to]);
                (
                    Term::of(Dimension::of(LENGTH)),
                    Term::of(Dimension::of(line)),
                )
            }
            Acting::On(expr) => {
                let term = match self.shapes.is_circle(expr) {
                    true => Term::one(),
                    false => self.of(expr).at(0).clone(),
                };
                let wanted = over_square(product, &term);
                (term, wanted)
            }
        };
        let found = self.of(factor);
        self.fits(factor, &found, what, &Value::scalar(wanted));
        Value::scalar(acts_on)
    }

    /// Checks the fields of a joint that are not expanded into statements.
    fn joint(&mut self, joint: &'a Joint) {
        let name = joint.name.name.as_str();
        let coordinate = self.names.get(name).map(|value| value.at(0).clone());
        let velocities = self.names.iter();
        let mut velocities =
            velocities.filter(|(other, _)| other.strip_prefix(name) == Some("_dot"));
        let velocity = velocities.next().map(|(_, value)| value.at(0).clone());
        for (field, _, values) in &joint.fields {
            let power = Term::of(Dimension::of(POWER));
            let (what, wanted) = match field {
                JointField::Limit => ("a limit of a joint", coordinate.clone()),
                JointField::MaxSpeed => ("the largest speed of a joint", velocity.clone()),
                JointField::MaxForce => (
                    "the largest force of a joint",
                    velocity.as_ref().map(|rate| power.quotient(rate)),
                ),
                JointField::Armature => (
                    "the armature of a joint",
                    velocity.as_ref().map(|rate| over_square(ENERGY, rate)),
                ),
                _ => continue,
            };
            for expr in values {
                let found = self.of(expr);
                if let Some(wanted) = wanted.clone() {
                    self.fits(expr, &found, what, &Value::scalar(wanted));
                }
            }
        }
    }
}

/// Returns the dimension that, times the square of another, is the given one.
fn over_square(product: [i32; 5], of: &Term) -> Term {
    Term::of(Dimension::of(product)).times(of, &BigRational::from_integer((-2).into()))
}
