//! Inertia, energies, loads, outputs.

use super::declare::Declared;
use super::expression::Evaluator;
use super::scope::{NameKind, Scope, closest};
use super::value::Value;
use super::{Body, Frame, Particle, Wrench, class};
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Mat3, Vec3, identity3, zero3};
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{self, About, Expr, Ident, ItemKind, Load, Span, System, Target};

/// The functions that `generate` can name, beside outputs.
pub const FUNCTIONS: &[&str] = &[
    "rate",
    "accel",
    "inverse_dynamics",
    "mass_matrix",
    "bias",
    "potential_force",
    "generalized_force",
    "momentum",
    "kinetic_energy",
    "potential_energy",
    "energy",
    "constraint",
];

/// Everything but the kinematics.
pub struct Dynamics {
    pub bodies: Vec<Body>,
    pub particles: Vec<Particle>,
    pub kinetic: Edge,
    pub potential: Edge,
    pub gravity: Vec3,
    pub wrenches: Vec<Wrench>,
    pub generalized: Vec<Edge>,
    pub outputs: Vec<(String, Value)>,
    pub generate: Vec<String>,
}

/// Reads the statements about inertia and loads.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    frames: &[Frame],
    declared: &Declared,
    report: &mut Report,
) -> Dynamics {
    let zero = graph.zero();
    let mut dynamics = Dynamics {
        bodies: Vec::new(),
        particles: Vec::new(),
        kinetic: zero,
        potential: zero,
        gravity: zero3(graph),
        wrenches: Vec::new(),
        generalized: vec![zero; declared.xi.len()],
        outputs: Vec::new(),
        generate: Vec::new(),
    };
    let mut gravity: Option<Span> = None;
    let mut has_inertia = false;
    for item in &system.items {
        let mut reader = Reader {
            evaluator: Evaluator {
                graph,
                scope,
                report,
            },
            frames,
            declared,
        };
        match &item.kind {
            ItemKind::Body(body) => {
                has_inertia = true;
                dynamics.bodies.extend(reader.body(body, item.span));
            }
            ItemKind::Particle { mass, at, on } => {
                has_inertia = true;
                dynamics
                    .particles
                    .extend(reader.particle(mass, at, on.as_ref()));
            }
            ItemKind::Kinetic(expr) => {
                has_inertia = true;
                if let Some(term) = reader.kinetic(expr) {
                    dynamics.kinetic = graph.add(dynamics.kinetic, term);
                }
            }
            ItemKind::Potential(expr) => {
                if let Some(term) = reader.configuration_scalar(expr, "a potential") {
                    dynamics.potential = graph.add(dynamics.potential, term);
                }
            }
            ItemKind::Gravity(expr) => {
                if let Some(first) = gravity {
                    report.push(
                        Diagnostic::new(item.span, "gravity is given twice")
                            .help("remove one of the two")
                            .note(first, "first given here"),
                    );
                    continue;
                }
                gravity = Some(item.span);
                if let Some(value) = reader.constant_vec3(expr, "gravity") {
                    dynamics.gravity = value;
                }
            }
            ItemKind::Load { load, frame, axes } => {
                dynamics.wrenches.extend(reader.load(load, frame, *axes))
            }
            ItemKind::Generalized { target, value } => {
                if let Some((offset, entries)) = reader.generalized(target, value) {
                    for (place, edge) in entries.into_iter().enumerate() {
                        let sum = &mut dynamics.generalized[offset + place];
                        *sum = graph.add(*sum, edge);
                    }
                }
            }
            ItemKind::Output { name, value } => {
                dynamics
                    .outputs
                    .extend(reader.output(name, value, &dynamics.outputs))
            }
            _ => {}
        }
    }
    if !has_inertia {
        report.push(
            Diagnostic::new(system.name.span, "the system has no inertia")
                .help("write `body on f { mass m; … }`, `particle mass m at p;` or `kinetic …;`"),
        );
    }
    for item in &system.items {
        if let ItemKind::Generate(names) = &item.kind {
            generate(names, &dynamics.outputs, &mut dynamics.generate, report);
        }
    }
    dynamics
}

fn generate(
    names: &[Ident],
    outputs: &[(String, Value)],
    all: &mut Vec<String>,
    report: &mut Report,
) {
    for name in names {
        let known = FUNCTIONS
            .iter()
            .copied()
            .chain(outputs.iter().map(|(name, _)| name.as_str()));
        if known.clone().any(|known| known == name.name) {
            all.push(name.name.clone());
            continue;
        }
        let error = Diagnostic::new(
            name.span,
            format!("`generate` does not know `{}`", name.name),
        );
        report.push(match closest(&name.name, known) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(format!(
                "functions are {}, and the outputs by their names",
                FUNCTIONS.join(", ")
            )),
        });
    }
}

struct Reader<'a, 'b> {
    evaluator: Evaluator<'a>,
    frames: &'b [Frame],
    declared: &'b Declared,
}

impl Reader<'_, '_> {
    fn class_of(&self, value: &Value) -> u8 {
        value.entries().iter().fold(0, |class, edge| {
            class | self.evaluator.graph.class(edge.node())
        })
    }

    /// Whether a value is made of parameters and constants alone; reports it where not.
    fn constant(&mut self, value: &Value, span: Span, what: &str) -> Option<()> {
        if self.class_of(value) & !class::PARAM == 0 {
            return Some(());
        }
        self.evaluator.error(
            Diagnostic::new(span, format!("{what} has to be constant"))
                .help("it may depend on parameters and constants alone"),
        )
    }

    fn constant_scalar(&mut self, expr: &Expr, what: &str) -> Option<Edge> {
        let edge = self.evaluator.scalar(expr, what)?;
        self.constant(&Value::Scalar(edge), expr.span, what)?;
        Some(edge)
    }

    fn constant_vec3(&mut self, expr: &Expr, what: &str) -> Option<Vec3> {
        let value = self.evaluator.vec3(expr, what)?;
        self.constant(&Value::Vector(value.to_vec()), expr.span, what)?;
        Some(value)
    }

    fn configuration(&mut self, value: &Value, span: Span, what: &str) -> Option<()> {
        if self.class_of(value) & !(class::PARAM | class::COORD) == 0 {
            return Some(());
        }
        self.evaluator.error(Diagnostic::new(span, format!("{what} may depend on coordinates and parameters alone")).help("loads that depend on velocities or inputs are `force`, `torque`, `wrench` or `generalized force`"))
    }

    fn configuration_scalar(&mut self, expr: &Expr, what: &str) -> Option<Edge> {
        let edge = self.evaluator.scalar(expr, what)?;
        self.configuration(&Value::Scalar(edge), expr.span, what)?;
        Some(edge)
    }

    fn frame(&mut self, name: &Ident) -> Option<usize> {
        if let Some(index) = self.frames.iter().position(|frame| frame.name == name.name) {
            return Some(index);
        }
        match self.evaluator.scope.get(&name.name) {
            // Its own definition was in error.
            Some(entry) if entry.kind == NameKind::Frame => None,
            _ => {
                let error = self
                    .evaluator
                    .scope
                    .unknown(name.span, &name.name, "frame", |kind| {
                        kind == NameKind::Frame
                    });
                self.evaluator.error(error)
            }
        }
    }

    fn body(&mut self, body: &ast::Body, span: Span) -> Option<Body> {
        let frame = self.frame(&body.frame);
        let mass = match &body.mass {
            Some(expr) => self.constant_scalar(expr, "a mass"),
            None => self
                .evaluator
                .error(Diagnostic::new(span, "this body has no mass").help("write `mass m;`")),
        };
        let com = match &body.com {
            Some(expr) => self.constant_vec3(expr, "a centre of mass"),
            None => Some(zero3(self.evaluator.graph)),
        };
        let inertia = match &body.inertia {
            Some((expr, about)) => self.inertia(expr).map(|m| (m, *about, expr.span)),
            None => Some((
                identity3(self.evaluator.graph).map(|row| row.map(|_| self.evaluator.graph.zero())),
                Some(About::Com),
                span,
            )),
        };
        let (frame, mass, com, (inertia, about, place)) = (frame?, mass?, com?, inertia?);
        let centred = com.iter().all(|&edge| edge == self.evaluator.graph.zero());
        let about = match about {
            Some(about) => about,
            None if centred => About::Com,
            None => {
                return self.evaluator.error(
                    Diagnostic::new(place, "the inertia's reference point is missing: the centre of mass is not the frame's origin")
                        .help("write `inertia Theta about com;` or `inertia Theta about origin;`"),
                );
            }
        };
        // Θ_origin = Θ_com + m (s·s I − s sᵀ)
        let graph = &mut *self.evaluator.graph;
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
        let shifted = |graph: &mut Graph, sign: bool| -> Mat3 {
            std::array::from_fn(|i| {
                std::array::from_fn(|j| graph.add(inertia[i][j], steiner[i][j].signed(sign)))
            })
        };
        let (inertia_com, inertia_origin) = match about {
            About::Com => (inertia, shifted(graph, false)),
            About::Origin => (shifted(graph, true), inertia),
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
        let Some(matrix) = value.as_mat3() else {
            return self.evaluator.error(
                Diagnostic::new(
                    expr.span,
                    format!(
                        "an inertia has to be a 3×3 matrix, this is {}",
                        value.shape()
                    ),
                )
                .help("write `diag(Ix, Iy, Iz)` or a `sym3` parameter"),
            );
        };
        self.constant(&value, expr.span, "an inertia")?;
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            if matrix[i][j] != matrix[j][i] {
                return self.evaluator.error(
                    Diagnostic::new(
                        expr.span,
                        format!(
                            "this inertia is not symmetric: entries [{},{}] and [{},{}] differ",
                            i + 1,
                            j + 1,
                            j + 1,
                            i + 1
                        ),
                    )
                    .help(
                        "declare it `sym3`, or write the same value on both sides of the diagonal",
                    ),
                );
            }
        }
        Some(matrix)
    }

    fn particle(&mut self, mass: &Expr, at: &Expr, on: Option<&Ident>) -> Option<Particle> {
        let mass = self.constant_scalar(mass, "a mass");
        let position = self.evaluator.vec3(at, "the position of a particle");
        let frame = match on {
            Some(name) => Some(self.frame(name)?),
            None => None,
        };
        let (mass, mut position) = (mass?, position?);
        self.configuration(
            &Value::Vector(position.to_vec()),
            at.span,
            "the position of a particle",
        )?;
        if let Some(index) = frame {
            let frame = &self.frames[index];
            let moved =
                crate::algebra::linear::apply3(self.evaluator.graph, &frame.rotation, position);
            position = crate::algebra::linear::add3(self.evaluator.graph, frame.position, moved);
        }
        Some(Particle { mass, position })
    }

    /// T = ½ ξᵀ M ξ: homogeneous of degree two in ξ, M free of ξ.
    fn kinetic(&mut self, expr: &Expr) -> Option<Edge> {
        let energy = self.evaluator.scalar(expr, "a kinetic energy")?;
        let graph = &mut *self.evaluator.graph;
        let xi = &self.declared.xi;
        let mut twice = graph.zero();
        let mut free = true;
        for &a in xi {
            let momentum = Derivation::new([(a.node(), graph.one())]).of(graph, energy);
            let product = graph.mul(momentum, a);
            twice = graph.add(twice, product);
            for &b in xi {
                let entry = Derivation::new([(b.node(), graph.one())]).of(graph, momentum);
                for &c in xi {
                    free &=
                        Derivation::new([(c.node(), graph.one())]).of(graph, entry) == graph.zero();
                }
            }
        }
        let double = graph.add(energy, energy);
        if !free || twice != double {
            return self.evaluator.error(
                Diagnostic::new(
                    expr.span,
                    "this kinetic energy is not quadratic in the velocities",
                )
                .help("T = ½ ξᵀ M(x) ξ: every term has exactly two velocities as factors"),
            );
        }
        let class = graph.class(energy.node());
        if class & !(class::PARAM | class::COORD | class::VELOCITY) != 0 {
            return self.evaluator.error(
                Diagnostic::new(expr.span, "a kinetic energy may not depend on inputs")
                    .help("it is a function of coordinates, velocities and parameters"),
            );
        }
        Some(energy)
    }

    fn load(&mut self, load: &Load, frame: &Ident, axes: ast::Axes) -> Option<Wrench> {
        let index = self.frame(frame);
        let zero = zero3(self.evaluator.graph);
        let (force, torque, at) = match load {
            Load::Force { force, at } => (self.evaluator.vec3(force, "a force"), Some(zero), at),
            Load::Torque { torque } => (Some(zero), self.evaluator.vec3(torque, "a torque"), &None),
            Load::Wrench { force, torque, at } => (
                self.evaluator.vec3(force, "a force"),
                self.evaluator.vec3(torque, "a torque"),
                at,
            ),
        };
        let at = match at {
            Some(point) => self
                .evaluator
                .vec3(point, "a point of attack")
                .and_then(|p| {
                    self.configuration(
                        &Value::Vector(p.to_vec()),
                        point.span,
                        "a point of attack",
                    )?;
                    Some(p)
                }),
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

    fn generalized(&mut self, target: &Target, value: &Expr) -> Option<(usize, Vec<Edge>)> {
        let group = self
            .declared
            .velocities
            .iter()
            .find(|group| group.name == target.name.name && target.field.is_none());
        let force = self.evaluator.value(value);
        let Some(group) = group else {
            let error = self.evaluator.scope.unknown(
                target.name.span,
                &target.name.name,
                "velocity",
                |kind| kind == NameKind::Velocity,
            );
            return self.evaluator.error(error);
        };
        let force = force?;
        if !force.same_shape(&group.value) {
            let wanted = group.value.shape();
            return self.evaluator.wrong_shape(
                value.span,
                &format!("the generalized force of `{}`", group.name),
                &wanted,
                &force,
            );
        }
        Some((group.offset, force.entries()))
    }

    fn output(
        &mut self,
        name: &Ident,
        value: &Expr,
        outputs: &[(String, Value)],
    ) -> Option<(String, Value)> {
        let result = self.evaluator.value(value)?;
        let taken = FUNCTIONS.contains(&name.name.as_str())
            || outputs.iter().any(|(known, _)| *known == name.name);
        if taken {
            return self.evaluator.error(
                Diagnostic::new(
                    name.span,
                    format!("there is already a function `{}`", name.name),
                )
                .help("choose another name for this output"),
            );
        }
        Some((name.name.clone(), result))
    }
}
