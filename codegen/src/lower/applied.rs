//! Functions of the description: `fn drag(v: vec3, c) = -c * norm(v) * v;`.
//!
//! The value of a call is the function's expression with the values of the arguments in the place of its parameters;
//! all other names are those of the description. Functions may call others, but not themselves.

use super::expression::Evaluator;
use super::functions;
use super::scope::Scope;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::syntax::ast::{
    Expr, ExprKind, Function, Ident, ItemKind, Shape, ShapeKind, Span, System,
};
use std::collections::{BTreeMap, BTreeSet};

/// The most calls of functions that a description writes out.
const MOST_CALLS: usize = 100_000;

/// Calls around an error that are shown with it.
const MOST_NOTES: usize = 4;

/// Makes a function known; one that calls itself, or has two parameters of one name, is refused.
pub fn declare(
    function: &Function,
    all: &BTreeMap<&str, &Function>,
    scope: &mut Scope,
    report: &mut Report,
) {
    let name = &function.name;
    if scope.functions.contains_key(&name.name) {
        // Its name is claimed later, and refused then.
        return;
    }
    let mut known: Vec<&Ident> = Vec::new();
    for (parameter, _) in &function.parameters {
        if let Some(first) = known.iter().find(|first| first.name == parameter.name) {
            let message = format!("two parameters are called `{}`", parameter.name);
            report.push(
                Diagnostic::new(parameter.span, message)
                    .help("rename one of the two")
                    .note(first.span, "the first one"),
            );
            return;
        }
        known.push(parameter);
    }
    if reaches(all, function, &name.name) {
        let message = format!("the value of `{}` needs `{}` itself", name.name, name.name);
        report
            .push(Diagnostic::new(function.value.span, message).help(
                "a function may call others, but there is no recursion: write its value out",
            ));
        return;
    }
    scope.functions.insert(name.name.clone(), function.clone());
}

/// Takes the name of a function, after all others are taken.
pub fn claim(function: &Function, scope: &mut Scope, report: &mut Report) {
    functions::claim(&function.name, scope, report);
}

/// The functions of a description, by their names.
pub fn functions(system: &System) -> BTreeMap<&str, &Function> {
    let functions = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Function(function) => Some((function.name.name.as_str(), function)),
        _ => None,
    });
    functions.collect()
}

/// Whether the value of a function calls a name, itself or by functions that it calls.
fn reaches(all: &BTreeMap<&str, &Function>, function: &Function, wanted: &str) -> bool {
    let mut reached = BTreeSet::new();
    let mut open = vec![function];
    while let Some(function) = open.pop() {
        let mut calls = BTreeSet::new();
        called(&function.value, &mut calls);
        for name in calls {
            if reached.insert(name) {
                open.extend(all.get(name));
            }
        }
    }
    reached.contains(wanted)
}

/// The functions that an expression calls.
fn called<'a>(expr: &'a Expr, names: &mut BTreeSet<&'a str>) {
    if let ExprKind::Call(function, _) = &expr.kind {
        names.insert(&function.name);
    }
    let parts = expr.parts().into_iter();
    parts.for_each(|part| called(part, names));
}

impl Evaluator<'_> {
    /// The value of a call of a function of the description. An error in the function's expression is reported
    /// there, with a note at the call.
    pub fn applied(
        &mut self,
        function: &Function,
        arguments: &[Expr],
        span: Span,
    ) -> Option<Value> {
        let calls = self.scope.calls.get() + 1;
        self.scope.calls.set(calls);
        if calls > MOST_CALLS {
            // Reported where it was crossed.
            return match calls == MOST_CALLS + 1 {
                true => self.error(
                    Diagnostic::new(span, "functions call one another too often here")
                        .help("give what they have in common a name with `let`"),
                ),
                false => None,
            };
        }
        let values: Vec<Option<Value>> = arguments
            .iter()
            .map(|argument| self.value(argument))
            .collect();
        let (name, wanted) = (&function.name, function.parameters.len());
        if wanted != arguments.len() {
            let plural = if wanted == 1 { "" } else { "s" };
            let message = format!(
                "`{}` takes {wanted} argument{plural}, not {}",
                name.name,
                arguments.len()
            );
            let parameters = function
                .parameters
                .iter()
                .map(|(name, _)| name.name.as_str());
            let parameters: Vec<&str> = parameters.collect();
            let usage = format!("write `{}({})`", name.name, parameters.join(", "));
            let error = Diagnostic::new(span, message).help(usage);
            return self.error(error.note(name.span, "defined here"));
        }
        let values = values.into_iter().collect::<Option<Vec<Value>>>()?;
        let mut locals = BTreeMap::new();
        let parameters = function.parameters.iter().zip(arguments);
        for (((parameter, shape), argument), value) in parameters.zip(values) {
            if !fits(shape, &value) {
                let (what, found) = (words(shape.kind), value.shape());
                let message = format!(
                    "`{}` of `{}` has to be {what}, this is {found}",
                    parameter.name, name.name
                );
                let error = Diagnostic::new(argument.span, message)
                    .help("make the shapes agree")
                    .note(shape.span, "declared here");
                return self.error(error);
            }
            locals.insert(parameter.name.as_str(), value);
        }
        let mut inner = Report::new();
        let value = self.within(&mut inner, locals).value(&function.value);
        for error in inner.finish().err().unwrap_or_default() {
            let error = match error.notes.len() < MOST_NOTES {
                true => error.note(span, "in this call"),
                false => error,
            };
            self.report.push_once(error);
        }
        value
    }
}

/// Whether a value has the shape of a parameter; one without a written shape takes any.
fn fits(shape: &Shape, value: &Value) -> bool {
    match (shape.kind, value) {
        (ShapeKind::Scalar, _) => true,
        (ShapeKind::Vector(n), Value::Vector(v)) => v.len() == n,
        (ShapeKind::Matrix(n) | ShapeKind::Symmetric(n), Value::Matrix(m)) => {
            m.len() == n && m.iter().all(|row| row.len() == n)
        }
        _ => false,
    }
}

fn words(shape: ShapeKind) -> String {
    match shape {
        ShapeKind::Scalar => "a scalar".into(),
        ShapeKind::Vector(n) => format!("a vector of {n}"),
        ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => format!("a {n}×{n} matrix"),
    }
}
