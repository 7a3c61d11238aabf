//! Functions of the description: `fn drag(v: vec3, c) = -c * norm(v) * v;`.
//!
//! The value of a call is the function's expression with the values of the arguments in the place of its parameters;
//! all other names are those of the description. Functions may call others, but not themselves.

use super::expression::Evaluator;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::syntax::ast::{Expr, Function, Span};
use std::collections::BTreeMap;

/// Largest number of function calls that are expanded in a description.
const MOST_CALLS: usize = 100_000;

impl Evaluator<'_> {
    /// Returns the value of a call of a function that the description defines.
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

    /// Returns the value of a function's expression for given values of its parameters. An error in the expression is
    /// reported there, with a note at the call.
    pub fn written_out(
        &mut self,
        parameters: BTreeMap<&str, Value>,
        value: &Expr,
        span: Span,
    ) -> Option<Value> {
        let calls = self.scope.calls.get() + 1;
        self.scope.calls.set(calls);
        if calls > MOST_CALLS {
            // Reported only once, when the limit is crossed.
            return match calls == MOST_CALLS + 1 {
                true => self.error(
                    Diagnostic::new(span, "function calls expand to too many expressions here")
                        .help("name common parts with `let`"),
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
