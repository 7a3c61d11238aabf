//! Warns of negative masses of particles and negative damping coefficients, which are legal but hardly meant.

use crate::algebra::graph::Edge;
use crate::algebra::numeric::evaluate;
use crate::diagnostics::Diagnostic;
use crate::model::Model;
use crate::syntax::ast::{Expr, ItemKind, System};

/// Returns a warning for every particle of negative mass and every negative damping coefficient, in the order of the
/// text; the joints of `system` have been expanded.
pub fn negative_value_warnings(system: &System, model: &Model) -> Vec<Diagnostic> {
    let mut particles = model.particles.iter().map(|particle| particle.mass);
    let mut dampers = model.elements.dampers.iter().map(|it| it.coefficient);
    let numbers = model.numbers(
        &model.defaults,
        &model.start_x,
        &model.start_xi,
        &vec![0.0; model.u.len()],
        &vec![0.0; model.n()],
    );
    let mut warnings: Vec<Diagnostic> = Vec::new();
    for item in &system.items {
        let (text, edge, what, help) = match &item.kind {
            ItemKind::Particle { mass, .. } => (
                mass,
                particles.next(),
                "the mass of this particle",
                "a mass is a positive number (kg)",
            ),
            ItemKind::Damper { coefficient, .. } => (
                coefficient,
                dampers.next(),
                "this damping coefficient",
                "a positive one takes energy out of the system, a negative one puts energy in",
            ),
            _ => continue,
        };
        let warning = edge.and_then(|edge| negative(model, &numbers, (text, edge), what));
        // A joint with several velocities has a damper for each of them.
        let twice = |warning: &Diagnostic| {
            let place = warning.span.range();
            warnings.iter().any(|known| known.span.range() == place)
        };
        if let Some(warning) = warning.filter(|warning| !twice(warning)) {
            warnings.push(warning.help(help));
        }
    }
    warnings
}

fn negative(
    model: &Model,
    numbers: &[f64],
    (text, edge): (&Expr, Edge),
    what: &str,
) -> Option<Diagnostic> {
    let value = *evaluate(&model.graph, &[edge], numbers).first()?;
    let with = match model.graph.class(edge.node()) {
        0 => "",
        _ => ", with the default parameters",
    };
    let message = format!("{what} is negative{with}: {value}");
    (value < 0.0).then(|| Diagnostic::new(text.span, message))
}
