//! Relates A, Y and φ: completes A if it is not given, and checks Φ A = 0, n = dim X, rank A = n and Y A = I on X,
//! KR18 (6).

use super::completion::{Given, complete};
use super::configuration_manifold::{ConfigurationManifold, Origin};
use super::declare::Declared;
use super::definitions::Row;
use super::rate::{At, Kinematics, Rate};
use super::tangency::{Checker, constraint_span};
use super::{agreement, independent};
use crate::algebra::graph::{Edge, Graph};
use crate::diagnostics::{Diagnostic, Report};
use crate::model::charts::jacobian;
use crate::model::completion::Completion;
use crate::syntax::ast::System;

/// Contents of the statements: the rate of each entry of x with its statement, the rows of A, and the rows of Y.
pub type Statements<'a> = (
    &'a [Option<Rate>],
    Option<Vec<Vec<Edge>>>,
    &'a [Option<Row>],
);

/// Completes A and checks all relations between A, Y and φ, as far as they are known.
pub fn relate(
    system: &System,
    graph: &mut Graph,
    manifold: &ConfigurationManifold,
    declared: &Declared,
    (rates, a, rows): Statements,
    at: Option<At>,
    report: &mut Report,
) -> Option<Kinematics> {
    if !manifold.complete || declared.faulty || declared.x.is_empty() || declared.xi.is_empty() {
        return None;
    }
    let jacobian = jacobian(&manifold.points, &manifold.phi, declared.x.len(), graph);
    let checker = |graph: &Graph, report: &mut Report, check: fn(&mut Checker) -> bool| {
        check(&mut Checker {
            system,
            graph,
            manifold,
            declared,
            jacobian: &jacobian,
            report,
        })
    };
    if !checker(graph, report, |checks| checks.regular()) {
        return None;
    }
    let numbers: Option<Vec<Vec<f64>>> = at.map(|at| {
        let rows = jacobian.iter();
        rows.map(|row| at.evaluate(graph, row)).collect()
    });
    let independent = independent::choose(graph, &jacobian, numbers.as_deref());
    let Some(mut a) = a else {
        checker(graph, report, |checks| checks.count());
        return None;
    };
    let mut completion = Completion::default();
    let missing = a.iter().any(Vec::is_empty);
    if missing {
        if !checker(graph, report, |checks| checks.count()) {
            return None;
        }
        // Errors in the start have been reported.
        let at = at?;
        if let Some(row) = independent.singular {
            let span = match manifold.origins[row] {
                Origin::Statement(item) => constraint_span(system, item),
                Origin::Coordinate(index) => declared.coordinates[index].span,
            };
            report.push(
                Diagnostic::new(
                    span,
                    "the start is a singular configuration: ∂φ/∂x has a smaller rank there than elsewhere",
                )
                .help("start elsewhere, or write the constraints so that their derivatives are independent there"),
            );
            return None;
        }
        let start = |graph: &Graph, edges: &[Edge]| at.evaluate(graph, edges);
        let given = Given {
            a: &a,
            rows,
            jacobian: &jacobian,
            independent: &independent.rows,
            start: &start,
        };
        (a, completion) = complete(system, graph, manifold, declared, &given, report)?;
    }
    completion.independent = independent.rows;
    completion.y = rows
        .iter()
        .map(|row| Some(row.as_ref()?.entries.clone()))
        .collect();
    let mut checks = Checker {
        system,
        graph,
        manifold,
        declared,
        jacobian: &jacobian,
        report,
    };
    let tangent = checks.tangent(rates, &a);
    let counted = missing || checks.count();
    if !tangent || !counted || !checks.independent(&a) {
        return None;
    }
    if !agreement::check(system, graph, declared, rates, &a, rows, report) {
        return None;
    }
    let rate = rates
        .iter()
        .zip(&a)
        .map(|(given, row)| match given {
            Some(rate) => rate.edge,
            None => graph.dot(row, &declared.xi),
        })
        .collect();
    Some(Kinematics {
        rate,
        a,
        completion,
    })
}
