//! Springs, cables, dampers, inerters, forces along a line, and dissipation.
//!
//! Between two points with difference d and distance ℓ = |d|, a spring has V = ½ k (ℓ − l)², which is ½ k d·d for
//! l = 0; a damper has D = ½ c ℓ̇²; a force F pushes the points apart. All of these act as wrenches on the frames of
//! the two points. A cable is a spring with V = ½ k max(0, ℓ − l)². On a scalar e, V = ½ k (e − l)² and D = ½ c e². An inerter has T = ½ b ℓ̇² or ½ b e² (Smith 2002),
//! a part of the kinetic energy. The remaining part of D acts through Rayleigh's fᵢ = −∂D/∂ξⁱ (W; N, N m).

use super::functions::angle_from;
use super::line::{Line, is_root};
use super::quadratic::is_quadratic;
use super::reader::{Dynamics, Reader};
use super::time;
use crate::algebra::graph::{Edge, Function};
use crate::algebra::linear::{scale3, sub3};
use crate::diagnostics::Diagnostic;
use crate::model::class;
use crate::model::elements::{Along, Damper, Push, Spring};
use crate::model::value::Value;
use crate::syntax::ast::{Acting, End, Expr, ExprKind, ItemKind, Span};

impl Reader<'_, '_> {
    /// Adds a statement about one of these elements to energies and forces; ignores other statements. `start` are the
    /// values of all symbols at the start.
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
                let energy = self.stored(&spring);
                let graph = &mut *self.evaluator.graph;
                dynamics.potential = graph.add(dynamics.potential, energy);
                if let Along::Scalar(_) = spring.along {
                    let sum = &mut dynamics.elements.scalar_potential;
                    *sum = graph.add(*sum, energy);
                }
                dynamics.elements.springs.push(spring);
            }
            ItemKind::Cable {
                stiffness,
                length,
                from,
                to,
            } => {
                let cable = self.cable(stiffness, length, [from, to], span)?;
                let energy = self.stored(&cable);
                dynamics.potential = self.evaluator.graph.add(dynamics.potential, energy);
                dynamics.elements.springs.push(cable);
            }
            ItemKind::Damper {
                coefficient,
                acting,
            } => {
                let factor = self.constant_scalar(coefficient, "the coefficient of a damper");
                let along = match acting {
                    Acting::On(expr) => {
                        let rate = self.acted_rate("a damper", "damper coefficient c", expr)?;
                        let energy = self.half_square(factor?, rate);
                        self.resist(energy, dynamics);
                        Along::Scalar(rate)
                    }
                    Acting::Between(from, to) => {
                        let line = self.line("damper", span, from, to);
                        let line = line?;
                        self.damp(&line, factor?, start, dynamics)?;
                        line.along(None)
                    }
                };
                let coefficient = factor?;
                dynamics
                    .elements
                    .dampers
                    .push(Damper { coefficient, along });
            }
            ItemKind::Inerter { inertance, acting } => {
                let factor = self.constant_scalar(inertance, "the inertance of an inerter");
                let rate = match acting {
                    Acting::On(expr) => {
                        self.acted_rate("an inerter", "inerter inertance b", expr)?
                    }
                    Acting::Between(from, to) => {
                        let line = self.line("inerter", span, from, to)?;
                        let length = self.length(&line, start)?;
                        self.rate(length)?
                    }
                };
                let energy = self.half_square(factor?, rate);
                self.evaluator
                    .continuous(&Value::Scalar(energy), span, "a kinetic energy")?;
                dynamics.kinetic = self.evaluator.graph.add(dynamics.kinetic, energy);
            }
            ItemKind::Push { force, from, to } => {
                let value = self.evaluator.scalar(force);
                let line = self.line("force", span, from, to);
                let (value, line) = (value?, line?);
                self.no_acceleration(&Value::Scalar(value), force.span, "a force")?;
                let length = self.length(&line, start)?;
                let wrenches = self.along_line(&line, length, value)?;
                dynamics.wrenches.extend(wrenches);
                dynamics.elements.pushes.push(Push {
                    force: value,
                    along: line.along(Some(length)),
                });
            }
            ItemKind::Dissipation(expr) => {
                let term = self.dissipation(expr)?;
                self.resist(term, dynamics);
                let given = &mut dynamics.elements.dissipation;
                *given = self.evaluator.graph.add(*given, term);
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
            Some(expr) => self.constant_scalar(expr, "the free length of a spring"),
            None => Some(self.evaluator.graph.zero()),
        };
        let (from, to) = match acting {
            Acting::On(expr) => {
                let (scalar, rest) = match self.circle(expr) {
                    // For an S1 coordinate, the angle is measured from where the spring is relaxed.
                    Some(point) => {
                        let graph = &mut *self.evaluator.graph;
                        let angle = rest.map(|rest| angle_from(graph, point, Some(rest)));
                        (angle, Some(graph.zero()))
                    }
                    None => (self.spring_scalar(expr), rest),
                };
                return Some(Spring {
                    stiffness: stiffness?,
                    length: rest?,
                    along: Along::Scalar(scalar?),
                    wrenches: Vec::new(),
                });
            }
            Acting::Between(from, to) => (from, to),
        };
        let line = self.line("spring", span, from, to);
        let (stiffness, rest, line) = (stiffness?, rest?, line?);
        if rest == self.evaluator.graph.zero() {
            let force = scale3(self.evaluator.graph, -stiffness, line.difference);
            return Some(Spring {
                stiffness,
                length: rest,
                along: line.along(None),
                wrenches: self.pair(&line, force),
            });
        }
        let length = self.length(&line, start)?;
        let graph = &mut *self.evaluator.graph;
        let wrenches = if is_root(graph, length) {
            // −k (1 − l/ℓ) d
            let slack = graph.div(rest, length)?;
            let stretch = graph.sub(graph.one(), slack);
            let factor = graph.mul(stiffness, stretch);
            let force = scale3(graph, -factor, line.difference);
            self.pair(&line, force)
        } else {
            let stretch = graph.sub(length, rest);
            let tension = graph.mul(stiffness, stretch);
            self.along_line(&line, length, -tension)?
        };
        Some(Spring {
            stiffness,
            length: rest,
            along: line.along(Some(length)),
            wrenches,
        })
    }

    /// Reads a cable: a spring whose stiffness is 0 while the distance ℓ of its points is at most l.
    fn cable(
        &mut self,
        stiffness: &Expr,
        length: &Expr,
        [from, to]: [&End; 2],
        span: Span,
    ) -> Option<Spring> {
        let stiffness = self.constant_scalar(stiffness, "a stiffness");
        let limit = self.constant_scalar(length, "the length of a cable");
        let line = self.line("cable", span, from, to);
        let (stiffness, limit, line) = (stiffness?, limit?, line?);
        let graph = &mut *self.evaluator.graph;
        // Not the smooth distance of points on one straight line, which is negative after they have passed each other.
        let distance = graph.apply(Function::Sqrt, line.square);
        let stretch = graph.sub(distance, limit);
        let share = graph.div(stretch, distance)?;
        let pull = graph.mul(stiffness, share);
        let zero = graph.zero();
        let [stiffness, pull] = [stiffness, pull].map(|taut| graph.select(stretch, taut, zero));
        let force = scale3(graph, -pull, line.difference);
        Some(Spring {
            stiffness,
            length: limit,
            along: line.along(Some(distance)),
            wrenches: self.pair(&line, force),
        })
    }

    /// Returns cosine and sine of an S1 coordinate if the expression is the name of one.
    fn circle(&mut self, expr: &Expr) -> Option<[Edge; 2]> {
        let ExprKind::Name(name) = &expr.kind else {
            return None;
        };
        let scope = self.evaluator.scope;
        match scope.value(name)? {
            Value::Vector(point) if scope.symbols.is_circle(name) => {
                Some([*point.first()?, *point.get(1)?])
            }
            _ => None,
        }
    }

    fn spring_scalar(&mut self, expr: &Expr) -> Option<Edge> {
        const WHAT: &str = "what a spring acts on";
        let scalar = self.evaluator.scalar(expr)?;
        let help = "a spring acts on a length or an angle; use a `damper` on a rate";
        self.configuration(&Value::Scalar(scalar), expr.span, WHAT, help)?;
        self.evaluator
            .continuous(&Value::Scalar(scalar), expr.span, WHAT)?;
        if self.rate(scalar)? == self.evaluator.graph.zero() {
            let message = "this spring does nothing: what it acts on never changes";
            return self.evaluator.error(
                Diagnostic::new(expr.span, message)
                    .help("make it act on coordinates, as in `spring stiffness k on q2 - q1;`"),
            );
        }
        Some(scalar)
    }

    /// Returns the potential energy V = ½ k (ℓ − l)².
    fn stored(&mut self, spring: &Spring) -> Edge {
        let graph = &mut *self.evaluator.graph;
        let square = match spring.along {
            Along::Line {
                from,
                to,
                length: None,
            } => {
                let d = sub3(graph, to, from);
                graph.dot(&d, &d)
            }
            Along::Line {
                length: Some(length),
                ..
            }
            | Along::Scalar(length) => {
                let stretch = graph.sub(length, spring.length);
                graph.mul(stretch, stretch)
            }
        };
        let half = graph.ratio(1, 2);
        let half = graph.mul(half, spring.stiffness);
        graph.mul(half, square)
    }

    /// Adds a damper along a line, D = ½ c (d·ḋ)²/(d·d), with the force −c (d·ḋ)/(d·d) d.
    fn damp(
        &mut self,
        line: &Line,
        coefficient: Edge,
        start: &[f64],
        dynamics: &mut Dynamics,
    ) -> Option<()> {
        let (twice, wrenches) = if let Some(length) = self.smooth_length(line) {
            let rate = self.rate(length)?;
            let graph = &mut *self.evaluator.graph;
            let force = graph.mul(coefficient, rate);
            let twice = graph.mul(force, rate);
            (twice, self.along_line(line, length, -force)?)
        } else {
            self.apart_at_start(line, line.square, start)?;
            let rate = self.rate(line.square)?;
            let graph = &mut *self.evaluator.graph;
            let half = graph.ratio(1, 2);
            let product = graph.mul(half, rate);
            let speed = graph.div(product, line.square)?;
            let factor = graph.mul(coefficient, speed);
            let twice = graph.mul(factor, product);
            let force = scale3(graph, -factor, line.difference);
            (twice, self.pair(line, force))
        };
        let graph = &mut *self.evaluator.graph;
        let half = graph.ratio(1, 2);
        let energy = graph.mul(half, twice);
        dynamics.dissipation = graph.add(dynamics.dissipation, energy);
        dynamics.wrenches.extend(wrenches);
        Some(())
    }

    /// Reads a rate that an element acts on; `written` is the beginning of its statement, for the help text.
    fn acted_rate(&mut self, what: &str, written: &str, expr: &Expr) -> Option<Edge> {
        let on = format!("what {what} acts on");
        let rate = self.evaluator.scalar(expr)?;
        let graph = &mut *self.evaluator.graph;
        let rate = time::linear(graph, self.declared, rate);
        let known = class::PARAM | class::CONFIGURATION | class::VELOCITY;
        let square = graph.mul(rate, rate);
        let linear = graph.class(rate.node()) & !known == 0
            && is_quadratic(graph.clone(), square, &self.declared.xi);
        let message = if rate == graph.zero() {
            let (_, name) = what.split_once(' ').unwrap_or(("", what));
            format!("this {name} does nothing: the rate that it acts on is 0")
        } else if linear {
            return Some(rate);
        } else {
            format!("{on} has to be a rate that is linear in the velocities")
        };
        self.evaluator.error(
            Diagnostic::new(expr.span, message)
                .help(format!("write a rate, as in `{written} on w2 - w1;`")),
        )
    }

    /// Returns ½ c e² for a rate e.
    fn half_square(&mut self, coefficient: Edge, rate: Edge) -> Edge {
        let graph = &mut *self.evaluator.graph;
        let square = graph.mul(rate, rate);
        let half = graph.ratio(1, 2);
        let half = graph.mul(half, coefficient);
        graph.mul(half, square)
    }

    /// Adds a term to D that acts through −∂D/∂ξⁱ.
    fn resist(&mut self, energy: Edge, dynamics: &mut Dynamics) {
        let graph = &mut *self.evaluator.graph;
        dynamics.dissipation = graph.add(dynamics.dissipation, energy);
        let sum = &mut dynamics.elements.scalar_dissipation;
        *sum = graph.add(*sum, energy);
    }

    fn dissipation(&mut self, expr: &Expr) -> Option<Edge> {
        let energy = self.evaluator.scalar(expr)?;
        let graph = &mut *self.evaluator.graph;
        if graph.class(energy.node()) & (class::INPUT | class::ACCEL) != 0 {
            return self.evaluator.error(
                Diagnostic::new(
                    expr.span,
                    "a dissipation may depend only on coordinates, velocities and parameters",
                )
                .help(
                    "write what depends on inputs or states as a load: `generalized force w = -u * w;`",
                ),
            );
        }
        let energy = time::homogeneous(graph, self.declared, energy);
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
}

impl Line<'_> {
    fn along(&self, length: Option<Edge>) -> Along {
        Along::Line {
            from: self.from.world,
            to: self.to.world,
            length,
        }
    }
}
