//! Springs, dampers, forces along a line, and dissipation.
//!
//! Between two points with difference d and distance ℓ = |d|: a spring has V = ½ k (ℓ − l)², which
//! is ½ k d·d for l = 0; a damper has D = ½ c ℓ̇²; a force F drives the points apart, fᵢ = F ∂ᵢℓ. On a
//! scalar e: V = ½ k (e − l)², D = ½ c e². Rayleigh's function D(x, ξ) acts by fᵢ = −∂D/∂ξⁱ (W; N, N m).
//!
//! Where d·d is a perfect square, such as that of points on one line, ℓ is its root with the sign
//! that makes it positive at the start: smooth, and as in textbooks.

use super::bodies::is_quadratic;
use super::class;
use super::dynamics::{Dynamics, Reader};
use super::functions::root;
use super::value::Value;
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Function, Graph, Node};
use crate::algebra::linear::{Vec3, add3, apply3, sub3, zero3};
use crate::algebra::numeric::evaluate;
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Acting, End, Expr, ItemKind, Span};

/// Distances below this (m) are none.
const COINCIDENT: f64 = 1e-12;

/// What a spring or damper acts along.
#[derive(Clone, Debug)]
pub enum Along {
    /// The line between two points, world axes (m); its length where it was needed.
    Line {
        /// The first point.
        from: Vec3,
        /// The second point.
        to: Vec3,
        /// Their distance ℓ.
        length: Option<Edge>,
    },
    /// A scalar of the configuration, or for a damper a rate.
    Scalar(Edge),
}

/// V = ½ k (ℓ − l)².
#[derive(Clone, Debug)]
pub struct Spring {
    /// Stiffness k (N/m, N m/rad).
    pub stiffness: Edge,
    /// Length l without force.
    pub length: Edge,
    /// What ℓ is.
    pub along: Along,
}

/// D = ½ c ℓ̇².
#[derive(Clone, Debug)]
pub struct Damper {
    /// Coefficient c (N s/m, N m s/rad).
    pub coefficient: Edge,
    /// What ℓ is.
    pub along: Along,
}

/// A force F along a line, positive apart.
#[derive(Clone, Debug)]
pub struct Push {
    /// F (N).
    pub force: Edge,
    /// The line.
    pub along: Along,
}

/// Springs, dampers and forces along lines as they were given, and what was given beside them:
/// `potential`, `dissipation` and `generalized force` alone. For proofs on another route.
#[derive(Clone, Debug)]
pub struct Elements {
    /// Springs.
    pub springs: Vec<Spring>,
    /// Dampers.
    pub dampers: Vec<Damper>,
    /// Forces along lines.
    pub pushes: Vec<Push>,
    /// The sum of all `potential` statements.
    pub potential: Edge,
    /// The sum of all `dissipation` statements.
    pub dissipation: Edge,
    /// The sums of all `generalized force` statements.
    pub generalized: Vec<Edge>,
}

impl Elements {
    /// None yet.
    pub fn none(graph: &Graph, n: usize) -> Self {
        Elements {
            springs: Vec::new(),
            dampers: Vec::new(),
            pushes: Vec::new(),
            potential: graph.zero(),
            dissipation: graph.zero(),
            generalized: vec![graph.zero(); n],
        }
    }
}

/// Two points and how they are called in messages.
struct Line<'a> {
    what: &'a str,
    span: Span,
    ends: (&'a End, &'a End),
    from: Vec3,
    to: Vec3,
    /// d·d.
    square: Edge,
}

impl Reader<'_, '_> {
    /// Reads a statement of this kind into the energies and generalised forces; `start` are the
    /// numbers of all symbols at the start.
    pub fn element(
        &mut self,
        kind: &ItemKind,
        span: Span,
        start: &[f64],
        dynamics: &mut Dynamics,
    ) -> Option<()> {
        match kind {
            ItemKind::Spring {
                stiffness,
                length,
                acting,
            } => {
                let spring = self.spring(stiffness, length.as_ref(), acting, span, start)?;
                let energy = self.half_square(spring.stiffness, &spring.along, spring.length);
                let graph = &mut *self.evaluator.graph;
                dynamics.potential = graph.add(dynamics.potential, energy);
                dynamics.elements.springs.push(spring);
            }
            ItemKind::Damper {
                coefficient,
                acting,
            } => {
                let (damper, energy) = self.damper(coefficient, acting, span, start)?;
                let graph = &mut *self.evaluator.graph;
                dynamics.dissipation = graph.add(dynamics.dissipation, energy);
                dynamics.elements.dampers.push(damper);
            }
            ItemKind::Push { force, from, to } => {
                let value = self.evaluator.scalar(force, "a force along a line");
                let line = self.line("force", span, from, to);
                let (value, line) = (value?, line?);
                self.no_acceleration(&Value::Scalar(value), force.span, "a force")?;
                let length = self.length(&line, start)?;
                let rate = self.rate(length)?;
                let graph = &mut *self.evaluator.graph;
                for (sum, xi) in dynamics.generalized.iter_mut().zip(&self.declared.xi) {
                    let slope = Derivation::new([(xi.node(), graph.one())]).of(graph, rate);
                    let force = graph.mul(value, slope);
                    *sum = graph.add(*sum, force);
                }
                dynamics.elements.pushes.push(Push {
                    force: value,
                    along: line.along(Some(length)),
                });
            }
            ItemKind::Dissipation(expr) => {
                let term = self.dissipation(expr)?;
                let graph = &mut *self.evaluator.graph;
                dynamics.dissipation = graph.add(dynamics.dissipation, term);
                let given = &mut dynamics.elements.dissipation;
                *given = graph.add(*given, term);
            }
            _ => {}
        }
        Some(())
    }

    fn spring(
        &mut self,
        stiffness: &Expr,
        length: Option<&Expr>,
        acting: &Acting,
        span: Span,
        start: &[f64],
    ) -> Option<Spring> {
        let stiffness = self.constant_scalar(stiffness, "a stiffness");
        let rest = match length {
            Some(expr) => self.constant_scalar(expr, "the length of a spring without force"),
            None => Some(self.evaluator.graph.zero()),
        };
        let along = match acting {
            Acting::On(expr) => self.spring_scalar(expr).map(Along::Scalar),
            Acting::Between(from, to) => {
                let line = self.line("spring", span, from, to);
                let (line, rest) = (line?, rest?);
                let slack = rest == self.evaluator.graph.zero();
                let length = if slack {
                    None
                } else {
                    Some(self.length(&line, start)?)
                };
                Some(line.along(length))
            }
        };
        Some(Spring {
            stiffness: stiffness?,
            length: rest?,
            along: along?,
        })
    }

    fn spring_scalar(&mut self, expr: &Expr) -> Option<Edge> {
        const WHAT: &str = "what a spring acts on";
        let scalar = self.evaluator.scalar(expr, WHAT)?;
        let help = "it is a length or an angle; on a rate acts a `damper`";
        self.configuration(&Value::Scalar(scalar), expr.span, WHAT, help)?;
        if self.rate(scalar)? == self.evaluator.graph.zero() {
            let message = "this spring does nothing: what it acts on never changes";
            return self.evaluator.error(
                Diagnostic::new(expr.span, message)
                    .help("let it act on coordinates, as in `spring stiffness k on q2 - q1;`"),
            );
        }
        Some(scalar)
    }

    fn damper(
        &mut self,
        coefficient: &Expr,
        acting: &Acting,
        span: Span,
        start: &[f64],
    ) -> Option<(Damper, Edge)> {
        let coefficient = self.constant_scalar(coefficient, "the coefficient of a damper");
        let (along, square) = match acting {
            Acting::On(expr) => {
                let rate = self.damper_rate(expr)?;
                let square = self.evaluator.graph.mul(rate, rate);
                (Along::Scalar(rate), square)
            }
            Acting::Between(from, to) => {
                let line = self.line("damper", span, from, to)?;
                let square = self.length_rate_square(&line, start)?;
                (line.along(None), square)
            }
        };
        let coefficient = coefficient?;
        let graph = &mut *self.evaluator.graph;
        let half = graph.ratio(1, 2);
        let half = graph.mul(half, coefficient);
        let energy = graph.mul(half, square);
        Some((Damper { coefficient, along }, energy))
    }

    fn damper_rate(&mut self, expr: &Expr) -> Option<Edge> {
        let rate = self.evaluator.scalar(expr, "what a damper acts on")?;
        let graph = &mut *self.evaluator.graph;
        let known = class::PARAM | class::COORD | class::VELOCITY;
        let square = graph.mul(rate, rate);
        let linear = graph.class(rate.node()) & !known == 0
            && is_quadratic(graph.clone(), square, &self.declared.xi);
        let message = if rate == graph.zero() {
            "this damper does nothing: the rate that it acts on is 0"
        } else if linear {
            return Some(rate);
        } else {
            "what a damper acts on has to be a rate, linear in the velocities"
        };
        self.evaluator.error(
            Diagnostic::new(expr.span, message)
                .help("write a rate, as in `damper coefficient c on w2 - w1;`"),
        )
    }

    fn dissipation(&mut self, expr: &Expr) -> Option<Edge> {
        let energy = self.evaluator.scalar(expr, "a dissipation")?;
        let graph = &mut *self.evaluator.graph;
        if graph.class(energy.node()) & (class::INPUT | class::ACCEL) != 0 {
            return self.evaluator.error(
                Diagnostic::new(
                    expr.span,
                    "a dissipation may depend on coordinates, velocities and parameters alone",
                )
                .help("what depends on inputs is a load: `generalized force w = -u * w;`"),
            );
        }
        if !is_quadratic(graph.clone(), energy, &self.declared.xi) {
            return self.evaluator.error(
                Diagnostic::new(
                    expr.span,
                    "this dissipation is not quadratic in the velocities",
                )
                .help(
                    "D = ½ ξᵀ C(x) ξ: every term has exactly two velocities as factors; other friction is a `generalized force`",
                ),
            );
        }
        Some(energy)
    }

    /// ½ k (ℓ − l)², of a line or a scalar.
    fn half_square(&mut self, factor: Edge, along: &Along, rest: Edge) -> Edge {
        let graph = &mut *self.evaluator.graph;
        let square = match along {
            Along::Line {
                from,
                to,
                length: None,
            } => {
                let d = sub3(graph, *to, *from);
                graph.dot(&d, &d)
            }
            Along::Line {
                length: Some(length),
                ..
            }
            | Along::Scalar(length) => {
                let stretch = graph.sub(*length, rest);
                graph.mul(stretch, stretch)
            }
        };
        let half = graph.ratio(1, 2);
        let half = graph.mul(half, factor);
        graph.mul(half, square)
    }

    /// d/dt of an expression; `None` where the rates are in error.
    fn rate(&mut self, edge: Edge) -> Option<Edge> {
        let motion = self.evaluator.scope.motion.as_ref()?;
        let [rate] = motion.rates(self.evaluator.graph, [edge]);
        Some(rate)
    }

    fn line<'a>(
        &mut self,
        what: &'a str,
        span: Span,
        from: &'a End,
        to: &'a End,
    ) -> Option<Line<'a>> {
        let (start, end) = (self.end(from), self.end(to));
        let (start, end) = (start?, end?);
        let graph = &mut *self.evaluator.graph;
        let d = sub3(graph, end, start);
        let square = graph.dot(&d, &d);
        if self.rate(square)? == self.evaluator.graph.zero() {
            let message = if from.frame.name == to.frame.name {
                let frame = &from.frame.name;
                format!("this {what} does nothing: both its points are fixed to `{frame}`")
            } else {
                format!("this {what} does nothing: its points keep their distance")
            };
            return self.evaluator.error(
                Diagnostic::new(from.frame.span, message)
                    .help("let it act between points of frames that move against one another")
                    .note(to.frame.span, "the other point"),
            );
        }
        Some(Line {
            what,
            span,
            ends: (from, to),
            from: start,
            to: end,
            square,
        })
    }

    /// A point of a frame or of the world, world axes.
    fn end(&mut self, end: &End) -> Option<Vec3> {
        const WHAT: &str = "a point of a frame";
        let point = match &end.at {
            Some(expr) => self.evaluator.vec3(expr, WHAT).and_then(|point| {
                let help = "it is given in the axes of its frame";
                self.configuration(&Value::Vector(point.to_vec()), expr.span, WHAT, help)?;
                Some(point)
            }),
            None => Some(zero3(self.evaluator.graph)),
        };
        if end.frame.name == "world" && self.evaluator.scope.get("world").is_none() {
            return point;
        }
        let frame = self.frame(&end.frame);
        let (frame, point) = (&self.frames[frame?], point?);
        let arm = apply3(self.evaluator.graph, &frame.rotation, point);
        Some(add3(self.evaluator.graph, frame.position, arm))
    }

    /// ℓ, positive at the start.
    fn length(&mut self, line: &Line, start: &[f64]) -> Option<Edge> {
        let length = match self.smooth_length(line) {
            Some(length) => length,
            None => self
                .evaluator
                .graph
                .apply(Function::Sqrt, line.square),
        };
        let now = self.apart_at_start(line, length, start)?;
        Some(length.signed(now < 0.0))
    }

    /// ℓ̇² = (d·ḋ)²/(d·d), without a root.
    fn length_rate_square(&mut self, line: &Line, start: &[f64]) -> Option<Edge> {
        if let Some(length) = self.smooth_length(line) {
            let rate = self.rate(length)?;
            return Some(self.evaluator.graph.mul(rate, rate));
        }
        self.apart_at_start(line, line.square, start)?;
        let rate = self.rate(line.square)?;
        let graph = &mut *self.evaluator.graph;
        let half = graph.ratio(1, 2);
        let product = graph.mul(half, rate);
        let square = graph.mul(product, product);
        graph.div(square, line.square)
    }

    /// ±ℓ without a root of what varies: where d·d is the square of something known, or d has a
    /// fixed direction.
    fn smooth_length(&mut self, line: &Line) -> Option<Edge> {
        let graph = &mut *self.evaluator.graph;
        let is_root = |graph: &Graph, edge: Edge| {
            matches!(graph.node(edge.node()), Node::Apply(Function::Sqrt, _))
        };
        if let Some(known) = graph.known_root(line.square)
            && !is_root(graph, known)
        {
            return Some(known);
        }
        let d = sub3(graph, line.to, line.from);
        let first = *d.iter().find(|entry| **entry != graph.zero())?;
        let ratios = d.map(|entry| graph.div(entry, first).unwrap_or(graph.zero()));
        let motion = self.evaluator.scope.motion.as_ref()?;
        let graph = &mut *self.evaluator.graph;
        let fixed = motion.rates(graph, ratios) == zero3(graph);
        if !fixed {
            return None;
        }
        let square = graph.dot(&ratios, &ratios);
        let factor = root(graph, square);
        Some(graph.mul(first, factor))
    }

    /// A measure of the distance at the start, where it is not 0; NaN where it is not known.
    fn apart_at_start(&mut self, line: &Line, measure: Edge, start: &[f64]) -> Option<f64> {
        let now = evaluate(self.evaluator.graph, &[measure], start)[0];
        if now.abs() > COINCIDENT || now.is_nan() {
            return Some(now);
        }
        let what = line.what;
        let message =
            format!("the points of this {what} coincide at the start: it has no direction there");
        let (from, to) = line.ends;
        let help = match what {
            "spring" => "start elsewhere, or leave out its `length`",
            _ => "start elsewhere, or choose other points",
        };
        self.evaluator.error(
            Diagnostic::new(line.span, message)
                .help(help)
                .note(from.frame.span, "from here")
                .note(to.frame.span, "to here"),
        )
    }
}

impl Line<'_> {
    fn along(&self, length: Option<Edge>) -> Along {
        Along::Line {
            from: self.from,
            to: self.to,
            length,
        }
    }
}
