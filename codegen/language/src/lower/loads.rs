//! Forces, torques, wrenches and generalised forces.

use super::rate::entry;
use super::reader::Reader;
use crate::algebra::graph::Edge;
use crate::algebra::linear::{
    Vec3, add3, apply_transposed, apply3, multiply3, sub3, transpose3, zero3,
};
use crate::diagnostics::Diagnostic;
use crate::model::Wrench;
use crate::model::value::Value;
use crate::syntax::ast::{Axes, Components, Expr, Ident, Load, Target};

impl Reader<'_, '_> {
    /// Returns the wrench on a frame and, with `from`, its reaction on the frame that exerts it: the opposite wrench
    /// at the same point in space.
    pub fn load(
        &mut self,
        load: &Load,
        frame: &Ident,
        from: Option<&Ident>,
        axes: &Components,
    ) -> Option<Vec<Wrench>> {
        let wrench = self.wrench(load, frame, axes);
        let other = match from {
            Some(other) if other.name == "world" => None,
            Some(other) => Some(self.frame(other)),
            None => None,
        };
        let wrench = wrench?;
        let Some(other) = other else {
            return Some(vec![wrench]);
        };
        let other = other?;
        if let Some(from) = from.filter(|_| other == wrench.frame) {
            let message = format!(
                "this load does nothing: `{}` exerts it on itself",
                from.name
            );
            return self.evaluator.error(
                Diagnostic::new(from.span, message).help("name the frame that takes the reaction"),
            );
        }
        let reaction = self.reaction(&wrench, other);
        Some(vec![wrench, reaction])
    }

    fn reaction(&mut self, wrench: &Wrench, other: usize) -> Wrench {
        let (frame, other_frame) = (&self.frames[wrench.frame], &self.frames[other]);
        let graph = &mut *self.evaluator.graph;
        let turn = multiply3(graph, &transpose3(&other_frame.rotation), &frame.rotation);
        let pure_torque = wrench.force == zero3(graph);
        let at = if pure_torque {
            zero3(graph)
        } else {
            let apart = sub3(graph, frame.position, other_frame.position);
            let origin = apply_transposed(graph, &other_frame.rotation, apart);
            let arm = apply3(graph, &turn, wrench.at);
            add3(graph, origin, arm)
        };
        let mut opposite = |a: Vec3| match wrench.axes {
            Axes::World => a.map(|entry| -entry),
            Axes::Body => apply3(graph, &turn, a).map(|entry| -entry),
        };
        Wrench {
            frame: other,
            at,
            force: opposite(wrench.force),
            torque: opposite(wrench.torque),
            axes: wrench.axes,
        }
    }

    fn wrench(&mut self, load: &Load, frame: &Ident, axes: &Components) -> Option<Wrench> {
        let index = self.frame(frame);
        let zero = zero3(self.evaluator.graph);
        let (force, torque, at) = match load {
            Load::Force { force, at } => (self.applied(force, "a force"), Some(zero), at),
            Load::Torque { torque } => (Some(zero), self.applied(torque, "a torque"), &None),
            Load::Wrench { force, torque, at } => {
                let force = self.applied(force, "a force");
                (force, self.applied(torque, "a torque"), at)
            }
        };
        let at = match at {
            Some(point) => self.point(point),
            None => Some(zero),
        };
        let (seen, axes) = match axes {
            Components::Body => (None, Axes::Body),
            Components::World => (None, Axes::World),
            Components::Frame(name) => (Some(self.frame(name)?), Axes::Body),
        };
        let (frame, at) = (index?, at?);
        let (mut force, mut torque) = (force?, torque?);
        if let Some(seen) = seen.filter(|seen| *seen != frame) {
            let graph = &mut *self.evaluator.graph;
            let own = transpose3(&self.frames[frame].rotation);
            let turn = multiply3(graph, &own, &self.frames[seen].rotation);
            force = apply3(graph, &turn, force);
            torque = apply3(graph, &turn, torque);
        }
        Some(Wrench {
            frame,
            at,
            force,
            torque,
            axes,
        })
    }

    fn applied(&mut self, expr: &Expr, what: &str) -> Option<Vec3> {
        let value = self.evaluator.vec3(expr)?;
        self.no_acceleration(&Value::Vector(value.to_vec()), expr.span, what)?;
        Some(value)
    }

    fn point(&mut self, expr: &Expr) -> Option<Vec3> {
        const WHAT: &str = "a point of application";
        let point = self.evaluator.vec3(expr)?;
        let help = "it is given in the axes of the frame that the load acts on";
        self.configuration(&Value::Vector(point.to_vec()), expr.span, WHAT, help)?;
        Some(point)
    }

    /// Returns the index in ξ of a generalised force, and its entries.
    pub fn generalized(&mut self, target: &Target, value: &Expr) -> Option<(usize, Vec<Edge>)> {
        let force = self.evaluator.value(value)?;
        let mut groups = self.declared.velocities.iter();
        let group = groups.find(|group| group.name == target.name.name)?;
        let range = group.offset..group.offset + group.len;
        let (range, wanted) = entry(target, range, group.value.clone());
        if target.field.is_some() || !force.same_shape(&wanted) {
            return self.evaluator.miss();
        }
        self.no_acceleration(&force, value.span, "a generalized force")?;
        Some((range.start, force.entries()))
    }
}
