//! Functions in Rust: `extern fn lift(alpha, mach) -> 2;`.
//!
//! Here they have names and no values: a result is treated as an unknown number that the arguments determine. Loads,
//! outputs and rates of states may depend on such functions; anything that proofs differentiate more than once may
//! not.

use super::expression::Evaluator;
use super::scope::Scope;
use crate::algebra::external;
use crate::algebra::graph::{Component, Edge, Graph};
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::model::{Model, class};
use crate::syntax::ast::{Expr, External, ItemKind, Span, System};

fn all(system: &System) -> impl Iterator<Item = &External> {
    system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::External(function) => Some(function),
        _ => None,
    })
}

/// Registers the functions with the graph; those in error are known by name only.
pub fn declare(system: &System, graph: &mut Graph, scope: &mut Scope, report: &mut Report) {
    let mut known = Vec::new();
    for function in all(system) {
        let name = &function.name;
        if scope.externals.contains_key(&name.name) {
            // The name is taken, which is reported elsewhere.
            continue;
        }
        check(function, report);
        if known.len() == Component::MAX_COUNT {
            let message = format!("more than {} functions in Rust", Component::MAX_COUNT);
            report.push(
                Diagnostic::new(name.span, message)
                    .help("combine some of them into one function with several components"),
            );
            break;
        }
        let place = (known.len(), function.clone());
        scope.externals.insert(name.name.clone(), place);
        let arguments = function.parameters.iter();
        known.push(external::External {
            name: name.name.clone(),
            arguments: arguments.map(|name| name.name.clone()).collect(),
            components: function.components.0,
        });
    }
    graph.set_externals(known);
}

/// Returns where the functions are declared, in order of their indices.
pub fn places(scope: &Scope) -> Vec<Span> {
    let mut all: Vec<(usize, Span)> = scope
        .externals
        .values()
        .map(|(place, function)| (*place, function.name.span))
        .collect();
    all.sort_by_key(|(place, _)| *place);
    all.into_iter().map(|(_, span)| span).collect()
}

fn check(function: &External, report: &mut Report) {
    let name = &function.name;
    for (place, parameter) in function.parameters.iter().enumerate() {
        let before = function.parameters[..place].iter();
        if let Some(first) = before.into_iter().find(|p| p.name == parameter.name) {
            let message = format!("two arguments are called `{}`", parameter.name);
            report.push(
                Diagnostic::new(parameter.span, message)
                    .help("rename one of the two")
                    .note(first.span, "the first one"),
            );
        }
    }
    let most = Component::MAX_COUNT;
    if function.parameters.len() > most {
        let message = format!("a function of {} arguments", function.parameters.len());
        let help = format!("functions in Rust take up to {most} numbers");
        report.push(Diagnostic::new(name.span, message).help(help));
    }
    let (count, span) = function.components;
    if !(1..=most).contains(&count) {
        let message = format!("this function returns {count} numbers");
        let help = format!("functions in Rust return from 1 to {most} numbers");
        report.push(Diagnostic::new(span, message).help(help));
    }
    if function.evaluated && function.stand_in.is_none() {
        let parameters = function.parameters.iter().map(|name| name.name.as_str());
        let parameters = parameters.collect::<Vec<_>>().join(", ");
        let value = match count {
            1 => "0".into(),
            _ => format!("[{}]", vec!["0"; count.min(most)].join(", ")),
        };
        let message = format!(
            "`{}` is a function in Rust, which cannot be called here",
            name.name
        );
        let help = format!(
            "give it a stand-in for where it cannot be called: `extern fn {}({parameters}) -> {count} = {value};`",
            name.name
        );
        report.push(Diagnostic::new(name.span, message).help(help));
    }
}

impl Evaluator<'_> {
    /// Returns the result of a function in Rust: a number, or a vector if it has several components.
    pub(super) fn external(
        &mut self,
        place: usize,
        function: &External,
        arguments: &[Expr],
        span: Span,
    ) -> Option<Value> {
        let (name, given) = (&function.name, arguments.len());
        let edges: Vec<Option<Edge>> = arguments.iter().map(|a| self.scalar(a)).collect();
        let edges = edges.into_iter().collect::<Option<Vec<Edge>>>()?;
        if given != function.parameters.len() {
            return None;
        }
        let names = function.parameters.iter().map(|name| name.name.as_str());
        let values = edges.iter().map(|edge| Value::Scalar(*edge));
        let stand_in = match &function.stand_in {
            Some(value) => Some(self.written_out(names.zip(values).collect(), value, span)?),
            None => None,
        };
        if function.evaluated {
            return stand_in;
        }
        let constant = |edge: &Edge| self.graph.class(edge.node()) & !class::PARAM == 0;
        if edges.iter().all(constant) {
            let message = format!("the arguments of `{}` never change", name.name);
            return self.error(Diagnostic::new(span, message).help(
                "a function in Rust is called while the system moves: replace this value by a parameter",
            ));
        }
        let count = function.components.0.clamp(1, Component::MAX_COUNT);
        let of = |component| Component::new(place, component, given);
        let made = (0..count).map(|k| self.graph.external(of(k), &edges));
        let made: Vec<Edge> = made.collect();
        self.scope.called.borrow_mut().push((made[0], span));
        Some(match made.as_slice() {
            [one] => Value::Scalar(*one),
            _ => Value::Vector(made),
        })
    }

    /// Reports an error if a value depends on a function in Rust.
    pub(super) fn inside(&mut self, value: &Value, span: Span, what: &str) -> Option<()> {
        let Some((component, _)) = self.graph.find_external(&value.entries(), 0) else {
            return Some(());
        };
        let functions = self.graph.externals();
        let name = &functions.get(usize::from(component.function))?.name;
        let message = format!("{what} cannot depend on `{name}`, a function in Rust");
        self.error(Diagnostic::new(span, message).help(PLACES))
    }
}

/// Help text: where functions in Rust may be called.
const PLACES: &str = "forces, torques, outputs and rates of states may depend on it; energies, places, constraints and prescribed motions have to be expressions";

/// Returns an error if anything but a load, an output or the rate of a state depends on a function in Rust.
pub fn misplaced(model: &Model, called: &[(Edge, Span)]) -> Option<Diagnostic> {
    if called.is_empty() {
        return None;
    }
    let mut kept = model.clone();
    kept.wrenches.clear();
    kept.generalized.clear();
    kept.elements.pushes.clear();
    kept.elements.generalized.clear();
    kept.elements.wrenches.clear();
    kept.observed.clear();
    kept.outputs.clear();
    kept.lets.clear();
    kept.state_rates.clear();
    let edges = kept.all_edges();
    let (component, list) = model.graph.find_external(&edges, 0)?;
    let lists = |edge: Edge| model.graph.as_external_call(edge).map(|(_, list)| list);
    let call = called.iter().find(|(edge, _)| lists(*edge) == Some(list));
    let function = model
        .graph
        .externals()
        .get(usize::from(component.function))?;
    let span = call.map_or(model.span, |(_, span)| *span);
    let message = format!(
        "`{}` is a function in Rust, and something other than a load depends on it",
        function.name
    );
    Some(Diagnostic::new(span, message).help(PLACES))
}
