//! Forces, torques, wrenches and generalised forces.

use super::Wrench;
use super::dynamics::Reader;
use super::scope::NameKind;
use super::value::Value;
use crate::algebra::graph::Edge;
use crate::algebra::linear::{Vec3, zero3};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Axes, Expr, Ident, Load, Target};

impl Reader<'_, '_> {
    pub fn load(&mut self, load: &Load, frame: &Ident, axes: Axes) -> Option<Wrench> {
        let index = self.frame(frame);
        let zero = zero3(self.evaluator.graph);
        let (force, torque, at) = match load {
            Load::Force { force, at } => (self.evaluator.vec3(force, "a force"), Some(zero), at),
            Load::Torque { torque } => (Some(zero), self.evaluator.vec3(torque, "a torque"), &None),
            Load::Wrench { force, torque, at } => {
                let force = self.evaluator.vec3(force, "a force");
                (force, self.evaluator.vec3(torque, "a torque"), at)
            }
        };
        let at = match at {
            Some(point) => self.point(point),
            None => Some(zero),
        };
        Some(Wrench {
            frame: index?,
            at: at?,
            force: force?,
            torque: torque?,
            axes,
        })
    }

    fn point(&mut self, expr: &Expr) -> Option<Vec3> {
        const WHAT: &str = "a point of attack";
        let point = self.evaluator.vec3(expr, WHAT)?;
        let help = "it is given in the axes of the frame that the load acts on";
        self.configuration(&Value::Vector(point.to_vec()), expr.span, WHAT, help)?;
        Some(point)
    }

    /// The place in ξ of a generalised force, and its entries.
    pub fn generalized(&mut self, target: &Target, value: &Expr) -> Option<(usize, Vec<Edge>)> {
        let force = self.evaluator.value(value);
        let name = &target.name;
        let scope = self.evaluator.scope;
        let Some(group) = self
            .declared
            .velocities
            .iter()
            .find(|group| group.name == name.name)
        else {
            let is_velocity = |kind| kind == NameKind::Velocity;
            if scope
                .get(&name.name)
                .is_some_and(|entry| is_velocity(entry.kind))
            {
                // Its own definition was in error.
                return None;
            }
            let error = scope.unknown(name.span, &name.name, Some("velocity"), is_velocity);
            return self.evaluator.error(error);
        };
        if let Some(field) = &target.field {
            let message = format!("`{}` has no part `.{}`", name.name, field.name);
            let help = format!(
                "give the whole of it: `generalized force {} = …;`",
                name.name
            );
            return self
                .evaluator
                .error(Diagnostic::new(field.span, message).help(help));
        }
        let force = force?;
        if !force.same_shape(&group.value) {
            let what = format!("the generalized force of `{}`", group.name);
            let wanted = group.value.shape();
            return self
                .evaluator
                .wrong_shape(value.span, &what, &wanted, &force);
        }
        Some((group.offset, force.entries()))
    }
}
