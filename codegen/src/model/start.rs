//! The start: numbers for x and ξ, on the constraint, with a positive definite mass matrix.

use super::declare::Declared;
use super::expression::Evaluator;
use super::kinematics::part;
use super::layout::{blocks, identity};
use super::scope::{NameKind, Scope};
use super::value::Value;
use super::{Model, class};
use crate::algebra::graph::Graph;
use crate::algebra::numeric::evaluate;
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{CoordKind, Expr, ItemKind, Span, System, Target};

/// Largest violation of φ at the start that counts as rounding of the numbers given.
const ROUNDING: f64 = 1e-9;

/// x and ξ from the `start` statements; what is not given is at the identity and at rest.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    defaults: &[f64],
    report: &mut Report,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let mut x = Vec::new();
    for coordinate in &declared.coordinates {
        x.extend(blocks(coordinate.kind).into_iter().flat_map(identity));
    }
    let mut xi = vec![0.0; declared.xi.len()];
    let mut symbols = vec![std::f64::consts::PI];
    symbols.extend_from_slice(defaults);
    symbols.resize(graph.symbols().len(), f64::NAN);
    let mut complete = true;
    for item in &system.items {
        let ItemKind::Start { target, value } = &item.kind else {
            continue;
        };
        complete &= read_one(
            target, value, graph, scope, declared, &symbols, &mut x, &mut xi, report,
        )
        .is_some();
    }
    complete.then_some((x, xi))
}

fn read_one(
    target: &Target,
    expr: &Expr,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    symbols: &[f64],
    x: &mut [f64],
    xi: &mut [f64],
    report: &mut Report,
) -> Option<()> {
    let value = Evaluator {
        graph,
        scope,
        report,
    }
    .value(expr);
    let group = declared
        .velocities
        .iter()
        .find(|group| group.name == target.name.name && target.field.is_none());
    let coordinate = declared
        .coordinates
        .iter()
        .any(|c| c.name == target.name.name);
    let (range, wanted, of_x) = if let Some(group) = group {
        (
            group.offset..group.offset + group.len,
            group.value.clone(),
            false,
        )
    } else if coordinate {
        let (range, wanted) = part(target, scope, declared, report)?;
        (range, wanted, true)
    } else {
        let accept = |kind: NameKind| matches!(kind, NameKind::Coord(_) | NameKind::Velocity);
        report.push(scope.unknown(
            target.name.span,
            &target.name.name,
            "coordinate or velocity",
            accept,
        ));
        return None;
    };
    let mut value = value?;
    if let (Value::Scalar(angle), Some(c)) = (
        &value,
        declared
            .coordinates
            .iter()
            .find(|c| of_x && c.offset == range.start),
    ) && c.kind == CoordKind::S1
        && range.len() == 2
    {
        let angle = *angle;
        let (c, s) = (
            graph.apply(crate::algebra::graph::Function::Cos, angle),
            graph.apply(crate::algebra::graph::Function::Sin, angle),
        );
        value = Value::Vector(vec![c, s]);
    }
    if !value.same_shape(&wanted) {
        report.push(Diagnostic::new(
            expr.span,
            format!(
                "the start of `{}` has to be {}, this is {}",
                target.name.name,
                wanted.shape(),
                value.shape()
            ),
        ));
        return None;
    }
    let class = value
        .entries()
        .iter()
        .fold(0, |class, edge| class | graph.class(edge.node()));
    if class & !class::PARAM != 0 {
        report.push(
            Diagnostic::new(
                expr.span,
                format!("the start of `{}` is no number", target.name.name),
            )
            .help("a start is made of numbers, constants and parameters"),
        );
        return None;
    }
    let numbers = evaluate(graph, &value.entries(), symbols);
    if numbers.iter().any(|number| !number.is_finite()) {
        report.push(
            Diagnostic::new(
                expr.span,
                format!("the start of `{}` is not finite", target.name.name),
            )
            .help("write finite numbers"),
        );
        return None;
    }
    let into = if of_x { x } else { xi };
    into[range].copy_from_slice(&numbers);
    Some(())
}

/// φ(x) = 0 at the start.
pub fn check(system: &System, model: &Model, report: &mut Report) {
    let numbers = model.numbers(
        &model.defaults,
        &model.start_x,
        &model.start_xi,
        &vec![0.0; model.u.len()],
        &vec![0.0; model.n()],
    );
    let rows: Vec<_> = model.phi.iter().map(|(edge, _)| *edge).collect();
    let residuals = evaluate(&model.points.free, &rows, &numbers);
    let place = |model: &Model, row: usize| -> Span {
        let names: Vec<&str> = model
            .coordinates
            .iter()
            .map(|c| c.name.as_str())
            .filter(|name| mentions(&model.phi[row].1, name))
            .collect();
        let starts = system.items.iter().filter_map(|item| match &item.kind {
            ItemKind::Start { target, value } => Some((target.name.name.as_str(), value.span)),
            _ => None,
        });
        let mut last = None;
        for (name, span) in starts {
            if names.contains(&name) || last.is_none() {
                last = Some(span);
            }
        }
        last.unwrap_or(system.name.span)
    };
    if let Some(row) =
        (0..rows.len()).find(|&row| residuals[row].abs() > ROUNDING || residuals[row].is_nan())
    {
        report.push(
            Diagnostic::new(place(model, row), format!("the start violates {}: the difference is {:.3e}", model.phi[row].1, residuals[row]))
                .help("give a start that satisfies the constraint; rotations by `rotx(angle)`, `rpy(…)`, `axis_angle(…)`"),
        );
    }
}

fn mentions(text: &str, name: &str) -> bool {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .any(|word| word == name)
}
