//! Reads inertia, energies, loads and outputs: everything but the kinematics.

use super::declare::Declared;
use super::expression::Evaluator;
use super::reader::{ALL, Dynamics, Reader, is_taken};
use super::scope::Scope;
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::Graph;
use crate::algebra::linear::zero3;
use crate::diagnostics::{Diagnostic, Report};
use crate::functions::{Asked, FunctionId, Jacobian, SLOPES};
use crate::model::Frame;
use crate::model::elements::Elements;
use crate::syntax::ast::{Ident, ItemKind, Span, System, Wanted};
use crate::syntax::suggest::closest;

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
        has_inertia: false,
    };
    let mut gravity: Option<Span> = None;
    for item in &system.items {
        let evaluator = Evaluator::new(graph, scope, report);
        let mut reader = Reader {
            evaluator,
            frames,
            declared,
        };
        match &item.kind {
            ItemKind::Body(body) => {
                dynamics.has_inertia = true;
                dynamics.bodies.extend(reader.body(body, item.span));
            }
            ItemKind::Particle { mass, at, on } => {
                dynamics.has_inertia = true;
                dynamics
                    .particles
                    .extend(reader.particle(item.span, (mass, at), on.as_ref()));
            }
            ItemKind::Kinetic(expr) => {
                dynamics.has_inertia = true;
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
            kind => _ = reader.element(kind, item.span, start, &mut dynamics),
        }
    }
    // Rayleigh: fᵢ = −∂D/∂ξⁱ.
    for (sum, xi) in dynamics.generalized.iter_mut().zip(&declared.xi) {
        let mut along = Derivation::new([(xi.node(), graph.one())]);
        let resistance = along.of(graph, dynamics.elements.scalar_dissipation);
        *sum = graph.sub(*sum, resistance);
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

/// Returns the names of the outputs, and reports those that are taken.
fn output_names<'a>(system: &'a System, report: &mut Report) -> Vec<&'a Ident> {
    let mut outputs: Vec<&Ident> = Vec::new();
    let described: Vec<String> = system.items.iter().filter_map(name_of).collect();
    for item in &system.items {
        let ItemKind::Output { name, .. } = &item.kind else {
            continue;
        };
        let first = outputs.iter().find(|known| known.name == name.name);
        if let Some(of) = name.name.strip_suffix(SLOPES)
            && described.iter().any(|name| name == of)
        {
            let message = format!(
                "`{}` is the name of the slopes of the output `{of}`",
                name.name
            );
            report.push(
                Diagnostic::new(name.span, message).help("choose another name for this output"),
            );
            continue;
        }
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

/// Returns what the `generate` statements ask for, or everything if there are none; reports unknown names.
fn asked(system: &System, outputs: &[&Ident], report: &mut Report) -> Asked {
    let statements = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Generate(all) => Some(all),
        _ => None,
    });
    let all: Vec<&Wanted> = statements.flatten().collect();
    if all.is_empty() {
        return Asked::everything();
    }
    let mut asked = Asked::only(&[]);
    for wanted in all {
        match wanted {
            Wanted::Function(name) => function(name, (system, outputs), &mut asked, report),
            Wanted::Jacobian { frame, axes } => {
                let own = |axes: &Ident| axes.name == frame.name || axes.name == "body";
                let jacobian = Jacobian {
                    frame: frame.name.clone(),
                    own: axes.as_ref().is_some_and(own),
                };
                let others = asked.jacobians.iter();
                let mut others = others.filter(|other| other.frame != jacobian.frame);
                let both = others.find_map(|other| {
                    let name = other
                        .names()
                        .find(|name| jacobian.names().any(|own| own == *name))?;
                    Some((other.frame.clone(), name))
                });
                if let Some((other, name)) = both {
                    let message = format!(
                        "the frames `{other}` and `{}` would both have a function `{name}`",
                        jacobian.frame
                    );
                    let error = Diagnostic::new(frame.span, message);
                    report.push(error.help("give one of these frames another name"));
                }
                asked.jacobians.push(jacobian);
            }
        }
    }
    for output in outputs {
        let mut frames = asked.jacobians.iter().flat_map(Jacobian::names);
        if frames.any(|name| name == output.name) || asked.wants_slopes(&output.name) {
            let message = format!(
                "`generate` already lists another function `{}`",
                output.name
            );
            report.push(
                Diagnostic::new(output.span, message).help("choose another name for this output"),
            );
        }
    }
    asked
}

/// Finds a function to generate by its name.
fn function(
    name: &Ident,
    (system, outputs): (&System, &[&Ident]),
    asked: &mut Asked,
    report: &mut Report,
) {
    let text = name.name.as_str();
    let known = FunctionId::from_name(text).filter(|id| id.row().named);
    if text == ALL {
        asked.everything = true;
        return;
    }
    if let Some(function) = known {
        asked.functions.push(function);
        return;
    }
    if outputs.iter().any(|output| output.name == text) {
        asked.outputs.push(text.to_string());
        return;
    }
    let described = || system.items.iter().filter_map(name_of);
    if let Some(output) = text.strip_suffix(SLOPES)
        && described().any(|known| known == output)
    {
        asked.slopes.push(output.to_string());
        // They are used together with the linearization [A B], and come after it if they depend on ξ̇.
        asked.functions.push(FunctionId::Linearize);
        return;
    }
    let functions = FunctionId::ALL.iter().filter(|id| id.row().named);
    let functions: Vec<&str> = functions.map(|id| id.name()).collect();
    let slopes: Vec<String> = described().map(|name| name + SLOPES).collect();
    let names = outputs.iter().map(|output| output.name.as_str());
    let known = [ALL]
        .into_iter()
        .chain(functions.iter().copied())
        .chain(names)
        .chain(slopes.iter().map(String::as_str));
    let message = format!("no function to generate is called `{text}`");
    let error = Diagnostic::new(name.span, message);
    report.push(match closest(text, known) {
        Some(near) => error.help(format!("did you mean `{near}`?")),
        None => error.help(format!(
            "the functions are {}, and the outputs and invariants by their names; `y_slopes` are the slopes of an output y, `jacobian f` is the kinematics of a frame f; `all` stands for the functions of a description without `generate`",
            functions.join(", ")
        )),
    });
}
