//! Computes A from the definitions of velocities and from φ: `[A Ψ] = [Y; Φ]⁻¹`, KR18 after (5).
//!
//! Coordinates without a `rate` move along the tangents K of their kinds, ẋ = K η, which leaves Y K η = ξ and, for
//! the constraints of the description, Φ K η = 0. Rates that are given are moved to the right-hand side.

use super::configuration_manifold::ConfigurationManifold;
use super::declare::{Declared, size};
use super::definitions::Row;
use super::rate::advised;
use crate::algebra::blocks::{Failure, StartValues, solve};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::transpose;
use crate::algebra::numeric::rank;
use crate::algebra::residue_pair::ResiduePair;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::charts::all_tangents;
use crate::model::completion::Completion;
use crate::model::layout::{Block, blocks};
use crate::syntax::ast::{Span, System};

/// Quantities that are known before A is computed.
pub struct Given<'a> {
    /// Rows of A that are given; empty for coordinates without a rate.
    pub a: &'a [Vec<Edge>],
    /// Rows of Y that are given.
    pub rows: &'a [Option<Row>],
    /// ∂φ/∂x.
    pub jacobian: &'a [Vec<Edge>],
    /// Indices of the rows of Φ in ∂φ/∂x.
    pub independent: &'a [usize],
    /// Evaluates expressions at the start.
    pub start: &'a StartValues<'a>,
}

/// An equation for the unknown rates: coefficients of all ẋ, and the right-hand side.
struct Equation<'a> {
    coefficients: &'a [Edge],
    velocity: Option<usize>,
}

/// Completes A with the rows that follow from Y and φ; `None` after an error has been reported.
pub fn complete(
    system: &System,
    graph: &mut Graph,
    manifold: &ConfigurationManifold,
    declared: &Declared,
    given: &Given,
    report: &mut Report,
) -> Option<(Vec<Vec<Edge>>, Completion)> {
    let (n, nu) = (declared.xi.len(), declared.x.len());
    let unknown = |place: usize| given.a[place].is_empty();
    let all: Vec<Block> = declared
        .coordinates
        .iter()
        .flat_map(|c| blocks(c.kind))
        .collect();
    let columns = all_tangents(graph, &all, &declared.x, unknown);
    let definitions = given.rows.iter().enumerate().filter_map(|(i, row)| {
        Some(Equation {
            coefficients: &row.as_ref()?.entries,
            velocity: Some(i),
        })
    });
    let user = manifold.user_rows();
    let constraints = given.independent.iter().filter(|row| user.contains(row));
    let constraints = constraints.map(|&row| Equation {
        coefficients: &given.jacobian[row],
        velocity: None,
    });
    let equations: Vec<Equation> = definitions.chain(constraints).collect();
    let (mut m, mut b) = (Vec::new(), Vec::new());
    for equation in &equations {
        m.push(
            columns
                .iter()
                .map(|k| graph.dot(equation.coefficients, k))
                .collect::<Vec<_>>(),
        );
        let mut right = vec![graph.zero(); n];
        if let Some(i) = equation.velocity {
            right[i] = graph.one();
        }
        for alpha in (0..nu).filter(|&alpha| !unknown(alpha)) {
            for (entry, &known) in right.iter_mut().zip(&given.a[alpha]) {
                let product = graph.mul(equation.coefficients[alpha], known);
                *entry = graph.sub(*entry, product);
            }
        }
        b.push(right);
    }
    let solution = match solve(graph, &m, &b, Some(given.start)) {
        Ok(solution) => solution,
        Err(Failure::Undetermined(_)) | Err(Failure::SingularStart) if m.is_empty() => {
            undetermined(
                declared,
                given,
                &columns,
                &(0..columns.len()).collect::<Vec<_>>(),
                report,
            );
            return None;
        }
        Err(Failure::Undetermined(which)) => {
            match dependent(graph, &equations, &m, given) {
                Some((i, span)) if given.rows.iter().all(Option::is_some) => {
                    report.push(no_new_velocity(declared, graph, i, span, columns.len(), &m));
                }
                _ => undetermined(declared, given, &columns, &which, report),
            }
            return None;
        }
        Err(Failure::SingularStart) => {
            report.push(singular_start(system, given));
            return None;
        }
    };
    let numbers = (given.start)(graph, &solution.pivots);
    if !numbers
        .iter()
        .all(|&pivot| pivot.is_finite() && pivot > 1e-12)
    {
        report.push(singular_start(system, given));
        return None;
    }
    let mut a = given.a.to_vec();
    let k = transpose(&columns);
    for alpha in (0..nu).filter(|&alpha| unknown(alpha)) {
        a[alpha] = (0..n)
            .map(|i| {
                let column: Vec<Edge> = solution.x.iter().map(|row| row[i]).collect();
                graph.dot(&k[alpha], &column)
            })
            .collect();
    }
    let constants = solution
        .constants
        .iter()
        .map(|&d| graph.mul(d, d))
        .collect();
    let completion = Completion {
        pivots: solution.pivots,
        constants,
        ..Completion::default()
    };
    Some((a, completion))
}

/// Returns the first definition that depends on the constraints and the definitions before it.
fn dependent(
    graph: &Graph,
    equations: &[Equation],
    m: &[Vec<Edge>],
    given: &Given,
) -> Option<(usize, Span)> {
    let values = |row: &Vec<Edge>| {
        row.iter()
            .map(|&e| graph.value(e))
            .collect::<Vec<ResiduePair>>()
    };
    let with = |velocity: bool| {
        let rows = equations.iter().zip(m);
        rows.filter(move |(equation, _)| equation.velocity.is_some() == velocity)
    };
    let mut rows: Vec<Vec<ResiduePair>> = with(false).map(|(_, row)| values(row)).collect();
    for (equation, row) in with(true) {
        let before = rank(rows.clone());
        rows.push(values(row));
        if rank(rows.clone()) == before {
            let i = equation.velocity?;
            return Some((i, given.rows[i].as_ref()?.span));
        }
    }
    None
}

fn no_new_velocity(
    declared: &Declared,
    graph: &Graph,
    i: usize,
    span: Span,
    unknowns: usize,
    m: &[Vec<Edge>],
) -> Diagnostic {
    let values = |row: &Vec<Edge>| row.iter().map(|&e| graph.value(e)).collect();
    let (found, nu) = (rank(m.iter().map(values).collect()), declared.x.len());
    let node = declared.xi[i].node();
    let name = graph
        .symbols()
        .iter()
        .find(|s| s.node == node)
        .map_or("", |s| s.name.as_str());
    let message = format!(
        "velocity `{name}` follows from the constraints and the velocities before it: [Y; Φ] has rank {}, not {nu}",
        nu + found - unknowns
    );
    Diagnostic::new(span, message).help(
        "define it by a motion that the constraints allow and the other velocities do not have",
    )
}

/// Reports coordinates that no rate, definition or constraint determines.
fn undetermined(
    declared: &Declared,
    given: &Given,
    columns: &[Vec<Edge>],
    which: &[usize],
    report: &mut Report,
) {
    let zero = Edge::of(0);
    for coordinate in &declared.coordinates {
        let range = coordinate.offset..coordinate.offset + size(coordinate.kind);
        let moves = |&j: &usize| columns[j][range.clone()].iter().any(|&entry| entry != zero);
        if !given.a[range.start].is_empty() || !which.iter().any(moves) {
            continue;
        }
        let name = &coordinate.name;
        let message = format!(
            "coordinate `{name}` has no rate, and neither the definitions of velocities nor the constraints give one"
        );
        let help = advised(coordinate, None, declared);
        let help = format!("{help}, or define a velocity by `rate({name})`");
        report.push(Diagnostic::new(coordinate.span, message).help(help));
    }
}

fn singular_start(system: &System, given: &Given) -> Diagnostic {
    let spans: Vec<Span> = given.rows.iter().flatten().map(|row| row.span).collect();
    let span = spans.first().copied().unwrap_or(system.name.span);
    Diagnostic::new(
        span,
        "the start is a singular configuration: [Y; Φ] has no inverse there, so the velocities do not determine the motion",
    )
    .help("start elsewhere, or choose velocities that are independent there")
}
