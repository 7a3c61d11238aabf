//! Warns of motions over time with corners, such as those of a table that is `linear` between its points: the speed
//! jumps at a corner, and no acceleration contains the impulse there.
//!
//! Such a description is legal, since the prescribed motion itself is continuous, so these are warnings.

use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, NodeId};
use crate::algebra::text::short;
use crate::diagnostics::Diagnostic;
use crate::lower::declare::size;
use crate::model::{Model, class};
use crate::syntax::ast::{ItemKind, Span, System};
use crate::syntax::written::target as written;

/// Largest length of an expression that is shown.
const LONGEST: usize = 40;

/// Returns a warning for every coordinate and frame whose speed could not be shown to be continuous in time, in the
/// order of the text.
pub fn speed_jump_warnings(system: &System, model: &Model) -> Vec<Diagnostic> {
    let Some(clock) = model.clock else {
        return Vec::new();
    };
    let time = model.x[clock.x].node();
    let one = |(what, edges, span): (String, Vec<Edge>, Span)| {
        let place = corner(model, &edges, time)?;
        let message =
            format!("the speed of {what} jumps{place}, and the impulse there is not modelled");
        Some(Diagnostic::new(span, message).help(
            "make the slopes equal on both sides: a `pchip` table has no corners, a `linear` one has",
        ))
    };
    let moved = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Prescribe {
            target,
            rate: false,
            value,
        } => {
            let coordinate = model.coordinates.iter();
            let mut coordinate = coordinate.filter(|c| c.name == target.name.name);
            let (first, len) = coordinate.next().map(|c| (c.offset, size(c.kind)))?;
            let places = match target.place(len) {
                Some(place) => first + place..first + place + 1,
                None => first..first + len,
            };
            let given = model.prescribed.iter();
            let given = given.filter(|(place, _)| places.contains(place));
            let given = given.map(|(_, edge)| *edge).collect();
            Some((format!("`{}`", written(target)), given, value.span))
        }
        ItemKind::Frame { name, pose, .. } => {
            let frame = model.frames.iter().find(|frame| frame.name == name.name)?;
            let (rotation, position) = frame.relative;
            let entries = rotation.into_iter().flatten().chain(position).collect();
            Some((format!("frame `{}`", name.name), entries, pose.span))
        }
        _ => None,
    });
    moved.filter_map(one).collect()
}

/// Describes where the time derivatives of expressions may jump; `None` if they do not.
fn corner(model: &Model, edges: &[Edge], time: NodeId) -> Option<String> {
    let reached = model.graph.reachable(edges);
    let chosen = reached
        .iter()
        .any(|&id| model.graph.condition_of(id).is_some());
    if !chosen || !reached.contains(&time) {
        return None;
    }
    let mut graph = model.graph.clone();
    let mut along = Derivation::new([(time, graph.one())]);
    let rates: Vec<Edge> = edges
        .iter()
        .map(|&edge| along.of(&mut graph, edge))
        .collect();
    let free = |symbol: NodeId| graph.class(symbol) != class::COORD || symbol == time;
    let by = graph.find_discontinuity(&rates, class::PARAM, &free)?;
    let place = short(&graph, by, LONGEST).map(|by| format!(" where {by} = 0"));
    Some(place.unwrap_or_default())
}
