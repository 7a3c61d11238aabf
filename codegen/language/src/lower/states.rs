//! Reads first-order states: `state i = 0;` with `rate i = (u - R * i - k * w) / L;`.
//!
//! Forces, outputs, rates of states and prescribed rates may depend on z; energies, frames and constraints may not.
//! So z acts on the motion like an input, and the derivation of the equations of motion is unchanged. ż may be any
//! expression, even of accelerations.

use super::declare::Declared;
use super::expression::Evaluator;
use super::scope::Scope;
use super::start;
use crate::algebra::graph::{Edge, Graph};
use crate::diagnostics::{Diagnostic, Report};
use crate::model::Group;
use crate::syntax::ast::{Expr, ItemKind, Span, System, Target};

/// Expressions of the rates ż of first-order states, and values of z at the start.
#[derive(Clone, Debug, Default)]
pub struct States {
    pub rates: Vec<Edge>,
    pub start: Vec<f64>,
    /// Initial values that depend on parameters.
    pub formulas: Vec<(usize, Edge)>,
}

/// Returns whether the target of a `rate` is a state.
pub fn is_one(declared: &Declared, target: &Target) -> bool {
    let mut states = declared.states.iter();
    states.any(|group| group.name == target.name.name)
}

/// Reads initial values and rates of all states.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    defaults: &[f64],
    report: &mut Report,
) -> States {
    let mut rates: Vec<Option<(Edge, Span)>> = vec![None; declared.z.len()];
    let mut tried: Vec<&str> = Vec::new();
    for item in &system.items {
        let ItemKind::Rate { target, value } = &item.kind else {
            continue;
        };
        let mut states = declared.states.iter();
        if let Some(group) = states.find(|group| group.name == target.name.name) {
            tried.push(&group.name);
            let evaluator = Evaluator::new(graph, scope, report);
            rate(target, value, group, evaluator, &mut rates);
        }
    }
    let known = start::known(graph, defaults);
    let mut start = vec![0.0; declared.z.len()];
    let mut formulas = Vec::new();
    let lists = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::State(list) => Some(list),
        _ => None,
    });
    for declaration in lists.flatten() {
        let name = &declaration.name;
        let same = |group: &&Group| group.name == name.name;
        let (Some(group), Some(value)) = (declared.states.iter().find(same), &declaration.value)
        else {
            continue;
        };
        if !tried.contains(&name.name.as_str()) {
            let message = format!("the state `{}` has no rate", name.name);
            let help = format!(
                "write `rate {} = …;` with any expression on the right",
                name.name
            );
            report.push(Diagnostic::new(name.span, message).help(help));
        }
        let mut evaluator = Evaluator::new(graph, scope, report);
        let Some(found) = evaluator.value(value) else {
            continue;
        };
        if !found.same_shape(&group.value) {
            continue;
        }
        if let Some(numbers) =
            start::numbers(&mut evaluator, &found, &name.name, value.span, &known)
        {
            let places = group.offset..group.offset + group.len;
            start[places.clone()].copy_from_slice(&numbers);
            let varying = places.zip(found.entries());
            formulas.extend(varying.filter(|(_, edge)| graph.class(edge.node()) != 0));
        }
    }
    let zero = graph.zero();
    let edge = |rate: Option<(Edge, Span)>| rate.map_or(zero, |(edge, _)| edge);
    States {
        rates: rates.into_iter().map(edge).collect(),
        start,
        formulas,
    }
}

/// Reads one `rate` statement of a state.
fn rate(
    target: &Target,
    expr: &Expr,
    group: &Group,
    mut evaluator: Evaluator,
    rates: &mut [Option<(Edge, Span)>],
) -> Option<()> {
    let value = evaluator.value(expr)?;
    if target.field.is_some() || !value.same_shape(&group.value) {
        return evaluator.miss();
    }
    let places = group.offset..group.offset + group.len;
    if let Some((_, first)) = rates[places.clone()].iter().flatten().next() {
        let message = format!("the rate of `{}` is given twice", group.name);
        let error = Diagnostic::new(target.span(), message).help("remove one of the two");
        return evaluator.error(error.note(*first, "first given here"));
    }
    for (place, edge) in places.zip(value.entries()) {
        rates[place] = Some((edge, target.span()));
    }
    Some(())
}
