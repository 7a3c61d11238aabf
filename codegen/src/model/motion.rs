//! Motion of frames and of their points: the functions `position`, `velocity`, `acceleration`,
//! `angular_velocity` and `angular_acceleration`.
//!
//! | call | value | unit |
//! |---|---|---|
//! | `position(f, p)` | r + R p | m |
//! | `velocity(f, p)` | ṙ + Ṙ p | m/s |
//! | `acceleration(f, p)` | r̈ + R̈ p | m/s² |
//! | `angular_velocity(f)` | ω with ω̂ = Ṙ Rᵀ | rad/s |
//! | `angular_acceleration(f)` | ω̇ | rad/s² |
//!
//! The point p is fixed in f and given in its axes, the origin where absent; components are in world
//! axes. With a frame g as last argument (r, R) is the pose f has in g: the motion as g sees it, in
//! the axes of g. Time derivatives are those along ẋ = A ξ, and of ξ along ξ̇: accelerations are
//! functions of ξ̇.

use super::class;
use super::expression::Evaluator;
use super::value::Value;
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Mat3, Vec3, add3, apply3, cross, multiply3, sub3, transpose3, zero3};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Expr, Ident, Span};
use std::cell::RefCell;

/// The functions; a value may share the name of one, as a coordinate `position` does.
pub const FUNCTIONS: [&str; 5] = [
    "position",
    "velocity",
    "acceleration",
    "angular_velocity",
    "angular_acceleration",
];

/// Whether a function is known only once the rates are.
pub fn needs_rates(function: &str) -> bool {
    FUNCTIONS.contains(&function) && function != "position"
}

/// A motion that an expression asked for, to be derived once more on another route.
#[derive(Clone, Debug)]
pub struct Observed {
    /// The function.
    pub quantity: Quantity,
    /// Rotation of the frame as seen from the other, or from the world.
    pub rotation: Mat3,
    /// Its origin.
    pub position: Vec3,
    /// The point, in the frame's axes.
    pub point: Vec3,
    /// What the expression stands for.
    pub value: Vec3,
}

/// What is asked about a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// r + R p.
    Position,
    /// ṙ + Ṙ p.
    Velocity,
    /// r̈ + R̈ p.
    Acceleration,
    /// ω.
    AngularVelocity,
    /// ω̇.
    AngularAcceleration,
}

impl Quantity {
    fn named(function: &str) -> Option<Self> {
        Some(match function {
            "position" => Quantity::Position,
            "velocity" => Quantity::Velocity,
            "acceleration" => Quantity::Acceleration,
            "angular_velocity" => Quantity::AngularVelocity,
            "angular_acceleration" => Quantity::AngularAcceleration,
            _ => return None,
        })
    }

    fn is_angular(self) -> bool {
        matches!(
            self,
            Quantity::AngularVelocity | Quantity::AngularAcceleration
        )
    }
}

/// ẋ and ξ̇: what d/dt does to x and ξ.
#[derive(Clone, Debug)]
pub struct Motion {
    seeds: Vec<(u32, Edge)>,
    /// What was asked for so far.
    pub seen: RefCell<Vec<Observed>>,
}

impl Motion {
    /// Along ẋ = `rate` and the symbols ξ̇.
    pub fn new(x: &[Edge], rate: &[Edge], xi: &[Edge], xi_dot: &[Edge]) -> Self {
        let pairs = x.iter().zip(rate).chain(xi.iter().zip(xi_dot));
        Motion {
            seeds: pairs.map(|(symbol, &rate)| (symbol.node(), rate)).collect(),
            seen: RefCell::new(Vec::new()),
        }
    }

    /// d/dt of several expressions.
    pub fn rates<const N: usize>(&self, graph: &mut Graph, edges: [Edge; N]) -> [Edge; N] {
        let mut along = Derivation::new(self.seeds.iter().copied());
        edges.map(|edge| along.of(graph, edge))
    }

    fn velocity(&self, graph: &mut Graph, rotation: &Mat3, position: Vec3, point: Vec3) -> Vec3 {
        let origin = self.rates(graph, position);
        let turned = self.turning(graph, rotation);
        let moved = apply3(graph, &turned, point);
        add3(graph, origin, moved)
    }

    fn acceleration(
        &self,
        graph: &mut Graph,
        rotation: &Mat3,
        position: Vec3,
        point: Vec3,
    ) -> Vec3 {
        let origin = self.rates(graph, position);
        let origin = self.rates(graph, origin);
        let turned = self.turning(graph, rotation);
        let turned = self.turning(graph, &turned);
        let moved = apply3(graph, &turned, point);
        add3(graph, origin, moved)
    }

    /// Makes the same in the axes of the frame, v = Rᵀṙ + ω × p and v̇ + ω × v, known to the graph:
    /// `f.R.T * velocity(f, p)` is then that, and not computed in the world and turned back.
    fn note_in_frame(
        &self,
        graph: &mut Graph,
        rotation: &Mat3,
        position: Vec3,
        point: Vec3,
        quantity: Quantity,
    ) {
        let back = transpose3(rotation);
        let turned = self.turning(graph, rotation);
        let skew = multiply3(graph, &back, &turned);
        let omega = [skew[2][1], skew[0][2], skew[1][0]];
        let moved = self.rates(graph, position);
        let origin = apply3(graph, &back, moved);
        let lever = cross(graph, omega, point);
        let velocity = add3(graph, origin, lever);
        if matches!(
            quantity,
            Quantity::Acceleration | Quantity::AngularAcceleration
        ) {
            self.rates(graph, omega);
            let change = self.rates(graph, velocity);
            let turn = cross(graph, omega, velocity);
            add3(graph, change, turn);
        }
    }

    fn turning(&self, graph: &mut Graph, rotation: &Mat3) -> Mat3 {
        let mut along = Derivation::new(self.seeds.iter().copied());
        rotation.map(|row| row.map(|entry| along.of(graph, entry)))
    }

    /// ω with ω̂ = Ṙ Rᵀ.
    fn spin(&self, graph: &mut Graph, rotation: &Mat3) -> Vec3 {
        let turned = self.turning(graph, rotation);
        let skew = multiply3(graph, &turned, &transpose3(rotation));
        [skew[2][1], skew[0][2], skew[1][0]]
    }
}

impl Evaluator<'_> {
    /// A call of one of these functions; `None` where the function is another.
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
        let (frame, point, other) = match values {
            [frame] => (frame, None, None),
            [frame, other @ Value::Pose(..)] => (frame, None, Some(other)),
            [frame, point] => (frame, Some(point), None),
            [frame, point, other] => (frame, Some(point), Some(other)),
            _ => return self.misused(name, span),
        };
        let point = match point {
            _ if quantity.is_angular() && point.is_some() => None,
            Some(point) => point.as_vec3(),
            None => Some(zero3(self.graph)),
        };
        let (Value::Pose(rotation, position), Some(point)) = (frame, point) else {
            return self.misused(name, span);
        };
        for (value, expr) in values.iter().zip(arguments) {
            let class = |class, edge: &Edge| class | self.graph.class(edge.node());
            let class = value.entries().iter().fold(0, class);
            if class & !(class::PARAM | class::COORD) != 0 {
                let message = format!("an argument of `{name}` depends on velocities or inputs");
                return self.error(
                    Diagnostic::new(expr.span, message).help(
                        "frames and their points are functions of coordinates and parameters",
                    ),
                );
            }
        }
        let (rotation, position) = match other {
            None => (*rotation, *position),
            Some(Value::Pose(r, p)) => {
                let back = transpose3(r);
                let arm = sub3(self.graph, *position, *p);
                let arm = apply3(self.graph, &back, arm);
                (multiply3(self.graph, &back, rotation), arm)
            }
            Some(_) => return self.misused(name, span),
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
            (None, _) if self.scope.unmoved => return None,
            (None, _) => {
                let message = format!("`{name}` is not known here: it follows from the rates");
                return self.error(Diagnostic::new(span, message).help(
                    "use it in outputs, loads, energies and named expressions, not in what defines the coordinates and their rates",
                ));
            }
            (Some(motion), Quantity::Velocity) => {
                motion.velocity(graph, &rotation, position, point)
            }
            (Some(motion), Quantity::Acceleration) => {
                motion.acceleration(graph, &rotation, position, point)
            }
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

    fn misused(&mut self, name: &str, span: Span) -> Option<Value> {
        let help = if Quantity::named(name).is_some_and(Quantity::is_angular) {
            format!("write `{name}(f)` of a frame, or `{name}(f, g)` as the frame g sees it")
        } else {
            format!(
                "write `{name}(f)` or `{name}(f, p)` of a frame and a point in its axes, or `{name}(f, p, g)` as the frame g sees it"
            )
        };
        let message = format!("`{name}` takes a frame, a point of it, and a frame to look from");
        self.error(Diagnostic::new(span, message).help(help))
    }
}
