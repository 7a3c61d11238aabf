//! Functions of the description: `fn drag(v: vec3, c) = -c * norm(v) * v;`.
//!
//! The value of a call is the function's expression with the values of the arguments in the place of its parameters;
//! all other names are those of the description. Functions may call others, but not themselves.

use super::expression::Evaluator;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::syntax::ast::{Expr, Function, Span};
use std::collections::BTreeMap;

/// The most calls of functions that a description writes out.
const MOST_CALLS: usize = 100_000;

impl Evaluator<'_> {
    /// The value of a call of a function of the description.
    pub fn applied(
        &mut self,
        function: &Function,
        arguments: &[Expr],
        span: Span,
    ) -> Option<Value> {
        let values: Vec<Option<Value>> = arguments.iter().map(|a| self.value(a)).collect();
        let values = values.into_iter().collect::<Option<Vec<Value>>>()?;
        let parameters = function.parameters.iter();
        let names = parameters.map(|(name, _)| name.name.as_str());
        self.written_out(names.zip(values).collect(), &function.value, span)
    }

    /// The value of a function's expression, where its parameters have these values. An error in it is reported there,
    /// with a note at the call.
    pub fn written_out(
        &mut self,
        parameters: BTreeMap<&str, Value>,
        value: &Expr,
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
        let mut inner = Report::new();
        let value = self.within(&mut inner, parameters).value(value);
        for error in inner.finish().err().unwrap_or_default() {
            self.report.push_once(error.in_call(span));
        }
        value
    }
}
