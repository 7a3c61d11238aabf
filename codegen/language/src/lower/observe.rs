//! Evaluates calls of `position`, `velocity`, `acceleration`, `angular_velocity` and `angular_acceleration` in
//! expressions.

use super::expression::Evaluator;
use crate::algebra::graph::Edge;
use crate::algebra::linear::{Mat3, Vec3, add3, apply3, multiply3, sub3, transpose3, zero3};
use crate::diagnostics::Diagnostic;
use crate::model::class;
use crate::model::motion::{Observed, Quantity};
use crate::model::value::Value;
use crate::syntax::ast::{Expr, ExprKind, Ident, Span};

impl Evaluator<'_> {
    /// Evaluates a call of one of these functions; returns the outer `None` for other functions.
    pub fn motion(
        &mut self,
        function: &Ident,
        arguments: &[Expr],
        values: &[Value],
        span: Span,
    ) -> Option<Option<Value>> {
        let quantity = Quantity::named(&function.name)?;
        Some(self.observe(quantity, function, arguments, values, span))
    }

    fn observe(
        &mut self,
        quantity: Quantity,
        function: &Ident,
        arguments: &[Expr],
        values: &[Value],
        span: Span,
    ) -> Option<Value> {
        let name = &function.name;
        let (Value::Pose(rotation, position), rest) = values.split_first()? else {
            return None;
        };
        let (point, other) = match rest {
            [] => (None, None),
            [Value::Pose(r, p)] => (None, Some((r, p))),
            [point] => (Some(point), None),
            [point, Value::Pose(r, p)] => (Some(point), Some((r, p))),
            _ => return None,
        };
        let point = match point {
            Some(point) => point.as_vec3()?,
            None => zero3(self.graph),
        };
        for (value, expr) in values.iter().zip(arguments) {
            let class = |class, edge: &Edge| class | self.graph.class(edge.node());
            let class = value.entries().iter().fold(0, class);
            if class & !(class::PARAM | class::CONFIGURATION) != 0 {
                let message =
                    format!("an argument of `{name}` depends on velocities, inputs or states");
                return self.error(
                    Diagnostic::new(expr.span, message).help(
                        "frames and their points are functions of coordinates and parameters",
                    ),
                );
            }
        }
        let (rotation, position) = match other {
            None => (*rotation, *position),
            Some((r, p)) => {
                let back = transpose3(r);
                let arm = sub3(self.graph, *position, *p);
                let arm = apply3(self.graph, &back, arm);
                (multiply3(self.graph, &back, rotation), arm)
            }
        };
        let graph = &mut *self.graph;
        if let Some(motion) = &self.scope.motion {
            motion.note_in_frame(graph, &rotation, position, point, quantity);
        }
        let value = match (&self.scope.motion, quantity) {
            (_, Quantity::Position) => {
                let arm = apply3(graph, &rotation, point);
                add3(graph, position, arm)
            }
            (None, _) if self.scope.rates.is_some() => {
                return self.defining(quantity, (&rotation, position, point), span);
            }
            (None, _) if self.scope.unmoved => return None,
            (None, _) => {
                let message = format!("`{name}` is not known here: it follows from the rates");
                return self.error(Diagnostic::new(span, message).help(
                    "use it in outputs, loads, energies and named expressions, not in the definitions of coordinates and their rates",
                ));
            }
            (Some(motion), Quantity::Velocity) => {
                motion.velocity(graph, &rotation, position, point)
            }
            (Some(motion), Quantity::Acceleration) => {
                motion.acceleration(graph, &rotation, position, point)
            }
            // `rate(e)` is evaluated elsewhere.
            (Some(_), Quantity::Rate) => return None,
            (Some(motion), Quantity::AngularVelocity) => motion.spin(graph, &rotation),
            (Some(motion), Quantity::AngularAcceleration) => {
                let spin = motion.spin(graph, &rotation);
                motion.rates(graph, spin)
            }
        };
        if let Some(motion) = &self.scope.motion {
            motion.seen.borrow_mut().push(Observed {
                quantity,
                rotation,
                position,
                point,
                value,
            });
        }
        Some(Value::Vector(value.to_vec()))
    }

    /// Evaluates a motion in the definition of a velocity, with symbols for ẋ.
    fn defining(
        &mut self,
        quantity: Quantity,
        (rotation, position, point): (&Mat3, Vec3, Vec3),
        span: Span,
    ) -> Option<Value> {
        let motion = self.scope.rates.as_ref()?;
        let (velocity, spin) = motion.defining(self.graph, rotation, position, point);
        match quantity {
            Quantity::Velocity => Some(Value::Vector(velocity.to_vec())),
            Quantity::AngularVelocity => Some(Value::Vector(spin.to_vec())),
            _ => self.error(
                Diagnostic::new(span, "a velocity is not defined by accelerations")
                    .help("define it by `velocity(f, p)`, `angular_velocity(f)` or rates"),
            ),
        }
    }

    /// Evaluates `velocity(f, p) in g`: the components of a motion in the axes of a frame; `in body` means the axes
    /// of f itself.
    pub fn in_axes(&mut self, call: &Expr, frame: &Expr) -> Option<Value> {
        let ExprKind::Call(_, arguments) = &call.kind else {
            return None;
        };
        let value = self.value(call);
        let own = matches!(&frame.kind, ExprKind::Name(name) if name == "body");
        let axes = match own {
            true => self.value(arguments.first()?),
            false => self.value(frame),
        };
        let (value, axes) = (value?.as_vec3()?, axes?);
        let Value::Pose(axes, _) = axes else {
            return None;
        };
        // If the motion is relative to another frame, its components are in the axes of that frame.
        let seen = arguments.last().filter(|_| arguments.len() > 1);
        let seen = match seen.map(|seen| self.value(seen)) {
            Some(Some(Value::Pose(rotation, _))) => Some(rotation),
            _ => None,
        };
        let graph = &mut *self.graph;
        let world = seen.map_or(value, |rotation| apply3(graph, &rotation, value));
        let turned = apply3(graph, &transpose3(&axes), world);
        Some(Value::Vector(turned.to_vec()))
    }
}
