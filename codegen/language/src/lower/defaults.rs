//! Reads the default values of parameters.

use super::declare::{Declared, shape_fits};
use super::expression::Evaluator;
use super::scope::Scope;
use crate::algebra::graph::Graph;
use crate::algebra::numeric::evaluate;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::syntax::ast::{Declaration, ItemKind, ShapeKind, System};

/// Evaluates the default values of all parameters, one for each symbol; NaN where there is an error.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    report: &mut Report,
) -> Vec<f64> {
    let lists = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Param(list) => Some(list),
        _ => None,
    });
    let declarations: Vec<&Declaration> = lists.flatten().collect();
    let mut numbers = Vec::new();
    for group in &declared.params {
        let before = numbers.len();
        // Of several declarations of a name, the first one counts.
        if let Some(declaration) = declarations.iter().find(|d| d.name.name == group.name) {
            numbers.extend(default_of(declaration, graph, scope, report).unwrap_or_default());
        }
        numbers.resize(before + group.len, f64::NAN);
    }
    numbers
}

fn default_of(
    declaration: &Declaration,
    graph: &mut Graph,
    scope: &Scope,
    report: &mut Report,
) -> Option<Vec<f64>> {
    let name = &declaration.name.name;
    let Some(expr) = &declaration.value else {
        report.push(
            Diagnostic::new(
                declaration.name.span,
                format!("parameter `{name}` has no default"),
            )
            .help("give it a default, with which the description is checked: `param m = 1.3;`"),
        );
        return None;
    };
    let value = Evaluator::new(graph, scope, report).value(expr)?;
    if value
        .entries()
        .iter()
        .any(|edge| graph.class(edge.node()) != 0)
    {
        report.push(
            Diagnostic::new(expr.span, format!("the default of `{name}` is not a number")).help(
                "defaults are made of numbers and constants; name an expression of parameters with `let`",
            ),
        );
        return None;
    }
    if !shape_fits(declaration, &value, report) {
        return None;
    }
    if declaration.shape.kind == ShapeKind::Scalar {
        value.as_scalar()?;
    }
    let entries = match (&value, declaration.shape.kind) {
        (Value::Matrix(m), ShapeKind::Symmetric(n)) => {
            (0..n).flat_map(|i| m[i][i..].iter().copied()).collect()
        }
        _ => value.entries(),
    };
    let numbers = evaluate(graph, &entries, &symbol_numbers(graph));
    if numbers.iter().any(|number| !number.is_finite()) {
        report.push(
            Diagnostic::new(expr.span, format!("the default of `{name}` is not finite"))
                .help("write a number that floating point can hold"),
        );
        return None;
    }
    Some(numbers)
}

/// Returns values of all symbols for expressions that contain no symbol but π.
fn symbol_numbers(graph: &Graph) -> Vec<f64> {
    let mut numbers = vec![f64::NAN; graph.symbols().len()];
    if let Some(first) = numbers.first_mut() {
        *first = std::f64::consts::PI;
    }
    numbers
}
