//! Bodies, particles and kinetic energies.

use super::quadratic::is_quadratic;
use super::reader::Reader;
use super::time;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Mat3, Vec3, add3, apply3, zero3};
use crate::diagnostics::Diagnostic;
use crate::model::value::Value;
use crate::model::{Body, Particle, class};
use crate::syntax::ast::{self, About, Expr, Ident, Span};

impl Reader<'_, '_> {
    pub fn body(&mut self, body: &ast::Body, span: Span) -> Option<Body> {
        let frame = self.frame(&body.frame);
        let mass = match &body.mass {
            Some(expr) => self.constant_scalar(expr, "a mass"),
            None => self.evaluator.error(
                Diagnostic::new(span.to(body.frame.span), "this body has no mass")
                    .help("write `mass m;` between its braces"),
            ),
        };
        let com = match &body.com {
            Some(expr) => self.constant_vec3(expr, "a centre of mass"),
            None => Some(zero3(self.evaluator.graph)),
        };
        let inertia = match &body.inertia {
            Some((expr, about)) => self.inertia(expr).map(|m| (m, *about, expr.span)),
            None => Some(([zero3(self.evaluator.graph); 3], Some(About::Com), span)),
        };
        let (frame, mass, com, (inertia, about, place)) = (frame?, mass?, com?, inertia?);
        let centred = com.iter().all(|&edge| edge == self.evaluator.graph.zero());
        let about = match about {
            Some(about) => about,
            None if centred => About::Com,
            None => {
                return self.evaluator.error(
                    Diagnostic::new(
                        place,
                        "the reference point of this inertia is ambiguous: the centre of mass is not the frame's origin",
                    )
                    .help("write `about com` or `about origin` after it"),
                );
            }
        };
        let graph = &mut *self.evaluator.graph;
        let (inertia_com, inertia_origin) = match about {
            About::Com => (inertia, shifted(graph, &inertia, mass, com, false)),
            About::Origin => (shifted(graph, &inertia, mass, com, true), inertia),
        };
        Some(Body {
            frame,
            mass,
            com,
            inertia_com,
            inertia_origin,
        })
    }

    fn inertia(&mut self, expr: &Expr) -> Option<Mat3> {
        let value = self.evaluator.value(expr)?;
        let matrix = value.as_mat3().or_else(|| self.evaluator.miss())?;
        self.constant(&value, expr.span, "an inertia")?;
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            if matrix[i][j] != matrix[j][i] {
                let (i, j) = (i + 1, j + 1);
                let message = format!(
                    "this inertia is not symmetric: entries [{i},{j}] and [{j},{i}] differ"
                );
                return self
                    .evaluator
                    .error(Diagnostic::new(expr.span, message).help(
                        "declare it `sym3`, or write the same value on both sides of the diagonal",
                    ));
            }
        }
        Some(matrix)
    }

    pub fn particle(
        &mut self,
        span: Span,
        (mass, at): (&Expr, &Expr),
        on: Option<&Ident>,
    ) -> Option<Particle> {
        const WHAT: &str = "the position of a particle";
        let mass = self.constant_scalar(mass, "a mass");
        let position = self.evaluator.vec3(at).and_then(|position| {
            let help = "write its position as a function of coordinates and parameters";
            let value = Value::Vector(position.to_vec());
            self.configuration(&value, at.span, WHAT, help)?;
            self.evaluator.continuous(&value, at.span, WHAT)?;
            Some(position)
        });
        let frame = match on {
            Some(name) => Some(self.frame(name)?),
            None => None,
        };
        let (mass, mut position) = (mass?, position?);
        if let Some(index) = frame {
            let frame = &self.frames[index];
            let moved = apply3(self.evaluator.graph, &frame.rotation, position);
            position = add3(self.evaluator.graph, frame.position, moved);
        }
        Some(Particle {
            mass,
            position,
            span,
        })
    }

    /// Reads a kinetic energy T = ½ ξᵀ M(x) ξ.
    pub fn kinetic(&mut self, expr: &Expr) -> Option<Edge> {
        let energy = self.evaluator.scalar(expr)?;
        let class = self.evaluator.graph.class(energy.node());
        if class & !(class::PARAM | class::CONFIGURATION | class::VELOCITY) != 0 {
            return self.evaluator.error(
                Diagnostic::new(
                    expr.span,
                    "a kinetic energy cannot depend on inputs or states",
                )
                .help("it is a function of coordinates, velocities and parameters"),
            );
        }
        let energy = time::homogeneous(self.evaluator.graph, self.declared, energy);
        if !is_quadratic(self.evaluator.graph.clone(), energy, &self.declared.xi) {
            return self.evaluator.error(
                Diagnostic::new(
                    expr.span,
                    "this kinetic energy is not quadratic in the velocities",
                )
                .help(match self.declared.clock {
                    None => "T = ½ ξᵀ M(x) ξ: every term has exactly two velocities as factors; with the time declared, `time t;`, it may have terms with fewer",
                    Some(_) => "T = T₂ + T₁ + T₀: no term has more than two velocities as factors",
                }),
            );
        }
        let value = Value::Scalar(energy);
        self.evaluator
            .continuous(&value, expr.span, "a kinetic energy")?;
        Some(energy)
    }

    pub fn potential(&mut self, expr: &Expr) -> Option<Edge> {
        let edge = self.evaluator.scalar(expr)?;
        let help = "write what depends on velocities, inputs or states as a load: `generalized force`, `force`, `torque` or `wrench`";
        let value = Value::Scalar(edge);
        self.configuration(&value, expr.span, "a potential", help)?;
        self.evaluator
            .continuous(&value, expr.span, "a potential")?;
        Some(edge)
    }
}

/// Shifts an inertia by the parallel axis theorem, Θ_origin = Θ_com + m (s·s I − s sᵀ), or back.
fn shifted(graph: &mut Graph, inertia: &Mat3, mass: Edge, com: Vec3, back: bool) -> Mat3 {
    let square = graph.dot(&com, &com);
    let steiner: Mat3 = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let product = graph.mul(com[i], com[j]);
            let entry = if i == j {
                graph.sub(square, product)
            } else {
                -product
            };
            graph.mul(mass, entry)
        })
    });
    std::array::from_fn(|i| {
        std::array::from_fn(|j| graph.add(inertia[i][j], steiner[i][j].signed(back)))
    })
}
