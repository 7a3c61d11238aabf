//! Inertia, energies, loads, outputs: everything but the kinematics.

use super::declare::Declared;
use super::elements::Elements;
use super::expression::Evaluator;
use super::scope::{NameKind, Scope};
use super::value::Value;
use super::{Body, Frame, Particle, Wrench, class};
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Vec3, zero3};
use crate::diagnostics::{Diagnostic, Report};
use crate::functions::{Asked, FunctionId};
use crate::syntax::ast::{Expr, Ident, ItemKind, Span, System};
use crate::syntax::suggest::closest;

/// What stands in `generate` for everything that a description without it gets.
const ALL: &str = "all";

/// What the statements about inertia and loads say.
pub struct Dynamics {
    pub bodies: Vec<Body>,
    pub particles: Vec<Particle>,
    pub kinetic: Edge,
    pub potential: Edge,
    pub gravity: Vec3,
    pub wrenches: Vec<Wrench>,
    pub generalized: Vec<Edge>,
    pub dissipation: Edge,
    pub elements: Elements,
    pub outputs: Vec<(String, Value)>,
    pub asked: Asked,
}

/// Reads the statements about inertia and loads.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    frames: &[Frame],
    declared: &Declared,
    start: &[f64],
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
        dissipation: zero,
        elements: Elements::none(graph, declared.xi.len()),
        outputs: Vec::new(),
        asked: Asked::everything(),
    };
    let mut gravity: Option<Span> = None;
    let mut has_inertia = false;
    for item in &system.items {
        let evaluator = Evaluator {
            graph,
            scope,
            report,
        };
        let mut reader = Reader {
            evaluator,
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
                if let Some(term) = reader.potential(expr) {
                    dynamics.potential = graph.add(dynamics.potential, term);
                    let elements = &mut dynamics.elements;
                    elements.potential = graph.add(elements.potential, term);
                    elements.scalar_potential = graph.add(elements.scalar_potential, term);
                }
            }
            ItemKind::Gravity(expr) => {
                if let Some(value) = reader.constant_vec3(expr, "gravity") {
                    dynamics.gravity = value;
                }
                if let Some(first) = gravity {
                    report.push(
                        Diagnostic::new(item.span, "gravity is given twice")
                            .help("remove one of the two, or write their sum")
                            .note(first, "first given here"),
                    );
                }
                gravity = gravity.or(Some(item.span));
            }
            ItemKind::Load {
                load,
                frame,
                from,
                axes,
            } => {
                if let Some(wrenches) = reader.load(load, frame, from.as_ref(), axes) {
                    dynamics.elements.wrenches.extend(wrenches.iter().cloned());
                    dynamics.wrenches.extend(wrenches);
                }
            }
            ItemKind::Spring { .. }
            | ItemKind::Damper { .. }
            | ItemKind::Push { .. }
            | ItemKind::Dissipation(_) => {
                reader.element(&item.kind, item.span, start, &mut dynamics);
            }
            ItemKind::Generalized { target, value } => {
                if let Some((offset, entries)) = reader.generalized(target, value) {
                    for (place, edge) in entries.into_iter().enumerate() {
                        let sum = &mut dynamics.generalized[offset + place];
                        *sum = graph.add(*sum, edge);
                        let given = &mut dynamics.elements.generalized[offset + place];
                        *given = graph.add(*given, edge);
                    }
                }
            }
            ItemKind::Output { value, .. } => {
                let value = reader.evaluator.value(value);
                dynamics.outputs.extend(name_of(item).zip(value));
            }
            _ => {}
        }
    }
    // Rayleigh: fᵢ = −∂D/∂ξⁱ.
    for (sum, xi) in dynamics.generalized.iter_mut().zip(&declared.xi) {
        let mut along = Derivation::new([(xi.node(), graph.one())]);
        let resistance = along.of(graph, dynamics.elements.scalar_dissipation);
        *sum = graph.sub(*sum, resistance);
    }
    if !has_inertia {
        report.push(
            Diagnostic::new(system.name.span, "the system has no inertia")
                .help("write `body on f { mass m; … }`, `particle mass m at p;` or `kinetic …;`"),
        );
    }
    let mut outputs = output_names(system, report);
    outputs.extend(super::invariants::names(system));
    dynamics.asked = asked(system, &outputs, report);
    dynamics
}

fn name_of(item: &crate::syntax::ast::Item) -> Option<String> {
    match &item.kind {
        ItemKind::Output { name, .. } => Some(name.name.clone()),
        _ => None,
    }
}

/// The names of the outputs; those that are taken are reported.
fn output_names<'a>(system: &'a System, report: &mut Report) -> Vec<&'a Ident> {
    let mut outputs: Vec<&Ident> = Vec::new();
    for item in &system.items {
        let ItemKind::Output { name, .. } = &item.kind else {
            continue;
        };
        let first = outputs.iter().find(|known| known.name == name.name);
        if first.is_none() && !is_taken(&name.name) {
            outputs.push(name);
            continue;
        }
        let error = Diagnostic::new(
            name.span,
            format!("there is already a function `{}`", name.name),
        )
        .help("choose another name for this output");
        report.push(match first {
            Some(first) => error.note(first.span, "first given here"),
            None => error,
        });
    }
    outputs
}

/// Whether a name is that of a function, which no output or invariant can have.
pub fn is_taken(name: &str) -> bool {
    name == ALL || FunctionId::named(name).is_some()
}

/// What the statements `generate` ask for, everything where there are none; unknown names are reported.
fn asked(system: &System, outputs: &[&Ident], report: &mut Report) -> Asked {
    let statements = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Generate(names) => Some(names),
        _ => None,
    });
    let names: Vec<&Ident> = statements.flatten().collect();
    if names.is_empty() {
        return Asked::everything();
    }
    let mut asked = Asked::only(&[]);
    let functions = FunctionId::ALL.iter().filter(|id| id.row().named);
    let functions: Vec<&str> = functions.map(|id| id.name()).collect();
    for name in names {
        let text = name.name.as_str();
        let function = FunctionId::named(text).filter(|id| id.row().named);
        if text == ALL {
            asked.everything = true;
        } else if let Some(function) = function {
            asked.functions.push(function);
        } else if outputs.iter().any(|output| output.name == text) {
            asked.outputs.push(text.to_string());
        } else {
            let outputs = outputs.iter().map(|output| output.name.as_str());
            let known = [ALL]
                .into_iter()
                .chain(functions.iter().copied())
                .chain(outputs);
            let message = format!("no function to generate is called `{text}`");
            let error = Diagnostic::new(name.span, message);
            report.push(match closest(text, known) {
                Some(near) => error.help(format!("did you mean `{near}`?")),
                None => error.help(format!(
                    "the functions are {}, and the outputs and invariants by their names; `all` stands for what a description without `generate` gets",
                    functions.join(", ")
                )),
            });
        }
    }
    asked
}

/// Reads single statements.
pub struct Reader<'a, 'b> {
    pub evaluator: Evaluator<'a>,
    pub frames: &'b [Frame],
    pub declared: &'b Declared,
}

impl Reader<'_, '_> {
    pub fn class_of(&self, value: &Value) -> u8 {
        let entries = value.entries();
        entries.iter().fold(0, |class, edge| {
            class | self.evaluator.graph.class(edge.node())
        })
    }

    /// Whether a value is made of parameters and constants alone; reports it where not.
    pub fn constant(&mut self, value: &Value, span: Span, what: &str) -> Option<()> {
        if self.class_of(value) & !class::PARAM == 0 {
            return Some(());
        }
        self.evaluator.error(
            Diagnostic::new(span, format!("{what} has to be constant"))
                .help("it may depend on parameters and constants alone"),
        )
    }

    pub fn constant_scalar(&mut self, expr: &Expr, what: &str) -> Option<Edge> {
        let edge = self.evaluator.scalar(expr, what)?;
        self.constant(&Value::Scalar(edge), expr.span, what)?;
        Some(edge)
    }

    pub fn constant_vec3(&mut self, expr: &Expr, what: &str) -> Option<Vec3> {
        let value = self.evaluator.vec3(expr, what)?;
        self.constant(&Value::Vector(value.to_vec()), expr.span, what)?;
        Some(value)
    }

    /// Whether a load is free of accelerations; reports it where not.
    pub fn no_acceleration(&mut self, value: &Value, span: Span, what: &str) -> Option<()> {
        if self.class_of(value) & class::ACCEL == 0 {
            return Some(());
        }
        self.evaluator.error(
            Diagnostic::new(span, format!("{what} cannot depend on accelerations"))
                .help("what resists acceleration is inertia: a `body`, a `particle` or a `kinetic` energy"),
        )
    }

    /// Whether a value is a function of the configuration; reports it where not.
    pub fn configuration(
        &mut self,
        value: &Value,
        span: Span,
        what: &str,
        help: &str,
    ) -> Option<()> {
        if self.class_of(value) & !(class::PARAM | class::COORD) == 0 {
            return Some(());
        }
        let message = format!("{what} may depend on coordinates and parameters alone");
        self.evaluator
            .error(Diagnostic::new(span, message).help(help))
    }

    pub fn frame(&mut self, name: &Ident) -> Option<usize> {
        if let Some(index) = self.frames.iter().position(|frame| frame.name == name.name) {
            return Some(index);
        }
        let scope = self.evaluator.scope;
        match scope.get(&name.name) {
            // Its own definition was in error.
            Some(entry) if entry.kind == NameKind::Frame => None,
            _ => {
                let is_frame = |kind| kind == NameKind::Frame;
                let error = scope.unknown(name.span, &name.name, Some("frame"), is_frame);
                self.evaluator.error(if name.name == "world" {
                    error.help("write `frame ground = world;` and use `ground`")
                } else {
                    error
                })
            }
        }
    }
}
