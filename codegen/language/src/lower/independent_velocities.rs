//! Reads `independent u, w[1];`: velocities that no constraint is solved for, so that they stay in ξ.

use super::declare::Declared;
use super::expression::Evaluator;
use super::scope::Scope;
use crate::algebra::graph::Graph;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::pfaffian::{Kind, Pfaffian};
use crate::syntax::ast::{Expr, ItemKind, Span, System};

/// Returns the indices of these velocities in ξ, and where each was named.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    constraints: &[Pfaffian],
    report: &mut Report,
) -> Vec<(usize, Span)> {
    let mut all: Vec<(usize, Span)> = Vec::new();
    let lists = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Independent(list) => Some(list),
        _ => None,
    });
    for expr in lists.flatten() {
        let mut evaluator = Evaluator::new(graph, scope, report);
        let Some(value) = evaluator.value(expr) else {
            continue;
        };
        for entry in value.entries() {
            let place = declared.xi.iter().position(|&xi| xi == entry);
            let Some(place) = place else {
                report.push(
                    Diagnostic::new(expr.span, "only a velocity can be independent").help(
                        "write `independent v;`, or `independent v[2];` for an entry of a velocity",
                    ),
                );
                break;
            };
            match refused(expr, place, &all, declared, constraints) {
                Some(error) => {
                    report.push(error);
                    break;
                }
                None => all.push((place, expr.span)),
            }
        }
    }
    all
}

fn refused(
    expr: &Expr,
    place: usize,
    before: &[(usize, Span)],
    declared: &Declared,
    constraints: &[Pfaffian],
) -> Option<Diagnostic> {
    if let Some((_, first)) = before.iter().find(|(other, _)| *other == place) {
        let error = Diagnostic::new(expr.span, "this velocity is already independent");
        return Some(
            error
                .help("remove one of the two")
                .note(*first, "first here"),
        );
    }
    if declared.clock.is_some_and(|clock| clock.xi == place) {
        let error = Diagnostic::new(expr.span, "the rate of time is 1, so it is not independent");
        return Some(error.help("remove it"));
    }
    let xi = declared.xi[place];
    let alone = |row: &&Pfaffian| {
        let given = matches!(row.kind, Kind::Inactive | Kind::Drive { position: false });
        let entry = row
            .row
            .iter()
            .zip(&declared.xi)
            .find(|(_, other)| **other == xi);
        given && entry.is_some_and(|(entry, _)| entry.abs() != crate::algebra::graph::Edge::of(0))
    };
    let row = constraints.iter().find(alone)?;
    let what = match row.kind {
        Kind::Inactive => "an inactive velocity is 0, so it is not independent",
        _ => "a prescribed velocity is given, so it is not independent",
    };
    let error = Diagnostic::new(expr.span, what).help("remove it from one of the two statements");
    Some(error.note(row.span, "given here"))
}
