//! Reads velocities defined by rates: rows of Y with ξ = Y(x) ẋ, KR18 (5).

use super::affine::Affine;
use super::declare::{Declared, shape_fits};
use super::expression::Evaluator;
use super::motion::TimeDerivative;
use super::scope::Scope;
use super::time;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::residue_pair::Random;
use crate::algebra::transplant::rebuild;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::class;
use crate::model::value::Value;
use crate::syntax::ast::{Declaration, Expr, ItemKind, ShapeKind, Span, System};

/// Seed of the values of the symbols for ẋ.
const SEED: u64 = 0x7261_7465;

/// A row of Y, and where it comes from.
#[derive(Clone, Debug)]
pub struct Row {
    /// Entries of the row, one for each of the ν coordinates.
    pub entries: Vec<Edge>,
    /// Place of the expression that gives it.
    pub span: Span,
}

/// The definitions of velocities in a description.
pub struct Definitions {
    /// Row of Y for each ξⁱ that is defined by rates.
    pub rows: Vec<Option<Row>>,
    /// Whether any velocity is defined by rates, even in error.
    pub any: bool,
    /// Whether all definitions could be read.
    pub complete: bool,
}

/// Reads the velocities that the description defines by rates, and returns for each ξⁱ its row of Y in ξ = Y(x) ẋ; the
/// rows are linear in ẋ, or an error is reported.
pub fn read_velocity_definitions(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    report: &mut Report,
) -> Definitions {
    let list: Vec<&Declaration> = system
        .items
        .iter()
        .filter_map(|item| match &item.kind {
            ItemKind::Velocity(list) => Some(list.iter().filter(|d| d.value.is_some())),
            _ => None,
        })
        .flatten()
        .collect();
    let mut definitions = Definitions {
        rows: vec![None; declared.xi.len()],
        any: !list.is_empty(),
        complete: true,
    };
    if list.is_empty() {
        return definitions;
    }
    let mut with_rates = graph.clone();
    let (scope, x_dot) = rates(&mut with_rates, scope, &declared.x);
    for declaration in list {
        let evaluator = Evaluator::new(&mut with_rates, &scope, report);
        let read = define(declaration, evaluator, declared, &x_dot);
        let group = declared
            .velocities
            .iter()
            .find(|group| group.name == declaration.name.name);
        let (Some(rows), Some(group), Some(value)) = (read, group, &declaration.value) else {
            definitions.complete = false;
            continue;
        };
        for (row, place) in rows.iter().zip(group.offset..group.offset + group.len) {
            definitions.rows[place] = Some(Row {
                entries: rebuild(&with_rates, graph, row),
                span: value.span,
            });
        }
    }
    definitions
}

/// Adds symbols for ẋ to a graph; returns them with a scope in which d/dt is taken along them.
fn rates<'a>(graph: &mut Graph, scope: &Scope<'a>, x: &[Edge]) -> (Scope<'a>, Vec<Edge>) {
    let mut random = Random::new(SEED);
    let mut x_dot = Vec::new();
    for _ in x {
        let value = random.element();
        x_dot.push(graph.symbol("rate", class::RATE, value));
    }
    let mut scope = scope.clone();
    scope.rates = Some(TimeDerivative::new(x, &x_dot, &[], &[]));
    (scope, x_dot)
}

/// Reads the rows of Y of one definition.
fn define(
    declaration: &Declaration,
    mut evaluator: Evaluator,
    declared: &Declared,
    x_dot: &[Edge],
) -> Option<Vec<Vec<Edge>>> {
    let expr = declaration.value.as_ref()?;
    let value = evaluator.value(expr)?;
    let name = &declaration.name.name;
    let entries = match (declaration.shape.kind, &value) {
        (ShapeKind::Scalar, Value::Scalar(edge)) => vec![*edge],
        (ShapeKind::Scalar | ShapeKind::Symmetric(_), _) => return None,
        _ if shape_fits(declaration, &value, evaluator.report) => value.entries(),
        _ => return None,
    };
    let graph = &mut *evaluator.graph;
    let mut rows = Vec::new();
    for mut affine in Affine::of_each(graph, &entries, x_dot) {
        // ξ = Y ẋ + y(x, t): the term without a rate is multiplied by ṫ.
        if let (Some(clock), Some((_, given))) =
            (declared.clock, time::with_time(graph, declared, &affine))
        {
            affine.slopes[clock.x] = graph.add(affine.slopes[clock.x], given);
            affine.rest = graph.zero();
        }
        let (slopes, rest) = affine.classes(graph);
        let found = slopes | rest;
        if affine.rest.abs() != graph.zero() || found & !(class::PARAM | class::CONFIGURATION) != 0
        {
            return evaluator.error(not_linear(name, expr, found));
        }
        rows.push(affine.slopes);
    }
    Some(rows)
}

/// Explains why a definition is not a row of Y.
fn not_linear(name: &str, expr: &Expr, found: u8) -> Diagnostic {
    const HELP: &str = "a definition is a row of Y(x) ẋ: every term has exactly one `rate(…)` as a factor, times coordinates and parameters";
    let message = if found & class::INPUT != 0 {
        format!("the definition of velocity `{name}` depends on an input or a state")
    } else if found & (class::VELOCITY | class::ACCEL) != 0 {
        format!("the definition of velocity `{name}` depends on a velocity")
    } else if found & class::RATE == 0 {
        format!("the definition of velocity `{name}` has a term without a rate")
    } else {
        format!("the definition of velocity `{name}` is not linear in the rates")
    };
    let help = match found & !(class::PARAM | class::CONFIGURATION) {
        0 => format!("{HELP}; an initial value is written `start {name} = …;`"),
        _ => HELP.into(),
    };
    Diagnostic::new(expr.span, message).help(help)
}
