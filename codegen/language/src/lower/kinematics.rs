//! Reads the rates ẋ = A ξ, statement by statement.

use super::configuration_manifold::ConfigurationManifold;
use super::declare::{Declared, size};
use super::definitions;
use super::expression::Evaluator;
use super::rate::{At, Kinematics, Rate, advised, part};
use super::relations::relate;
use super::scope::Scope;
use super::states;
use super::tangency::linear_part;
use crate::algebra::graph::Graph;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::syntax::ast::{CoordKind, Expr, ItemKind, System, Target};
use crate::syntax::written::target as written;

/// Reads all `rate` statements and definitions of velocities, and relates A, Y and φ.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    manifold: &ConfigurationManifold,
    declared: &Declared,
    at: Option<At>,
    report: &mut Report,
) -> Option<Kinematics> {
    let mut rates: Vec<Option<Rate>> = vec![None; declared.x.len()];
    // Coordinates with a statement, even if it is in error.
    let mut tried: Vec<&str> = Vec::new();
    for (item, statement) in system.items.iter().enumerate() {
        let ItemKind::Rate { target, value } = &statement.kind else {
            continue;
        };
        if states::is_one(declared, target) {
            continue;
        }
        tried.push(&target.name.name);
        let evaluator = Evaluator::new(graph, scope, report);
        read_rate(target, value, item, evaluator, declared, &mut rates, system);
    }
    let definitions =
        definitions::read_velocity_definitions(system, graph, scope, declared, report);
    let derivable = definitions.any || !manifold.user_rows().is_empty();
    let mut complete = definitions.complete;
    for coordinate in &declared.coordinates {
        let range = coordinate.offset..coordinate.offset + size(coordinate.kind);
        let missing = rates[range.clone()].iter().any(Option::is_none);
        let parts = !rates[range].iter().all(Option::is_none);
        let wrong = tried.contains(&coordinate.name.as_str());
        complete &= !missing || !wrong;
        if missing && (parts || !wrong && !derivable) {
            complete = false;
            let name = &coordinate.name;
            let message = if parts {
                format!("a part of coordinate `{name}` has no rate")
            } else {
                format!("coordinate `{name}` has no rate")
            };
            let help = advised(coordinate, None, declared);
            report.push(Diagnostic::new(coordinate.span, message).help(help));
        }
    }
    let a = linear_part(system, graph, &mut rates, declared, report).filter(|_| complete);
    relate(
        system,
        graph,
        manifold,
        declared,
        (&rates, a, &definitions.rows),
        at,
        report,
    )
}

fn read_rate(
    target: &Target,
    value: &Expr,
    item: usize,
    mut evaluator: Evaluator,
    declared: &Declared,
    rates: &mut [Option<Rate>],
    system: &System,
) -> Option<()> {
    if !target.entry.is_empty() {
        return evaluator.miss();
    }
    let found = part(target, declared);
    let value_of = evaluator.value(value);
    let (range, wanted) = found?;
    let mut entries = value_of?;
    let coordinate = declared
        .coordinates
        .iter()
        .rfind(|c| c.offset <= range.start)?;
    // A scalar rate of an S1 coordinate is its angular velocity: (c, s)' = (−s, c) ω.
    if let (Value::Scalar(w), Value::Vector(x), CoordKind::S1) =
        (&entries, &wanted, coordinate.kind)
    {
        let graph = &mut *evaluator.graph;
        let turned = [-graph.mul(x[1], *w), graph.mul(x[0], *w)];
        entries = Value::Vector(turned.to_vec()).unsigned_zeros(graph);
    }
    if !entries.same_shape(&wanted) {
        return evaluator.miss();
    }
    let twice = rates[range.clone()]
        .iter()
        .flatten()
        .next()
        .map(|rate| rate.item);
    if let Some(ItemKind::Rate { target: first, .. }) = twice.map(|item| &system.items[item].kind) {
        return evaluator.error(
            Diagnostic::new(
                target.span(),
                format!("the rate of `{}` is given twice", written(target)),
            )
            .help("remove one of the two")
            .note(first.span(), "first given here"),
        );
    }
    for (place, edge) in range.zip(entries.entries()) {
        rates[place] = Some(Rate { edge, item });
    }
    Some(())
}
