//! Search for the statements of a description that make forces depend on velocities.

use super::variation::Variation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_language::model::{Model, Wrench, class};
use hamel_program::structure::Reason;
use std::collections::BTreeSet;

/// Returns the statements that make the generalised force depend on velocities; empty if the total
/// force does not.
pub fn velocity_dependent_loads(
    full: &Model,
    model: &Model,
    graph: &Graph,
    variation: &Variation,
    force: &[Edge],
) -> Vec<Reason> {
    if !variation.changes(graph, force, &model.xi).contains(&true) {
        return Vec::new();
    }
    let mut found: Vec<String> = Vec::new();
    let zero = full.graph.zero();
    let moves = |edge: &Edge| full.graph.class(edge.node()) & class::VELOCITY != 0;
    let elements = &full.elements;
    let dampers = elements.dampers.iter();
    match dampers.filter(|damper| damper.coefficient != zero).count() {
        0 => {}
        1 => found.push("a `damper`".into()),
        number => found.push(format!("each of {number} dampers")),
    }
    if elements.dissipation != zero {
        found.push("`dissipation`".into());
    }
    for (i, edge) in elements.generalized.iter().enumerate() {
        if moves(edge) {
            let symbols = full.graph.symbols().iter();
            let name = symbols
                .filter(|symbol| full.xi.get(i).is_some_and(|xi| xi.node() == symbol.node))
                .map(|symbol| symbol.name.as_str())
                .next()
                .unwrap_or("ξ");
            found.push(format!("the `generalized force` on `{name}`"));
        }
    }
    let wrench = |wrench: &Wrench| {
        let entries = wrench.at.iter().chain(&wrench.force).chain(&wrench.torque);
        entries.into_iter().any(moves)
    };
    let wrenches = elements.wrenches.iter().filter(|load| wrench(load));
    let frames: BTreeSet<usize> = wrenches.map(|load| load.frame).collect();
    for frame in frames {
        let name = full
            .frames
            .get(frame)
            .map_or("", |frame| frame.name.as_str());
        found.push(format!("a load on frame `{name}`"));
    }
    if elements.pushes.iter().any(|push| moves(&push.force)) {
        found.push("a force along a line".into());
    }
    if found.is_empty() {
        found.push("a load".into());
    }
    found
        .into_iter()
        .map(|what| Reason::Velocities { what })
        .collect()
}
