//! Functions of the description: `fn drag(v: vec3, c) = -c * norm(v) * v;`.
//!
//! The value of a call is the function's expression with the values of the arguments in the place of its parameters;
//! all other names are those of the description. Functions may call others, but not themselves.

use super::expression::Evaluator;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::syntax::ast::{Expr, Function, Shape, ShapeKind, Span};
use std::collections::BTreeMap;

/// The most calls of functions that a description writes out.
const MOST_CALLS: usize = 100_000;

/// Calls around an error that are shown with it.
const MOST_NOTES: usize = 4;

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
                let (what, found) = (shape.kind.describe(), value.shape());
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
