//! Evaluates `rate(e)`, d/dt of an expression. In the definition of a velocity it is a row of Y ẋ; anywhere else it
//! is a function of x, ξ and, if e depends on velocities, of ξ̇.
//!
//! | `rate(…)` of | is |
//! |---|---|
//! | a real, a vector, a unit quaternion, a rotation matrix | its ẋ, of the same shape |
//! | an S1 coordinate q | its angular rate c ṡ − s ċ; ċ and ṡ are `rate(q.c)`, `rate(q.s)` |
//! | any expression of coordinates | its derivative by the chain rule, entry by entry |

use super::expression::Evaluator;
use crate::algebra::graph::Edge;
use crate::algebra::linear::{identity3, zero3};
use crate::diagnostics::Diagnostic;
use crate::model::class;
use crate::model::motion::{Observed, Quantity};
use crate::model::value::Value;
use crate::syntax::ast::{Expr, Span};

impl Evaluator<'_> {
    /// Evaluates `rate(…)` of an expression.
    pub fn rate(&mut self, argument: &Expr, span: Span) -> Option<Value> {
        let value = self.value(argument)?;
        let scope = self.scope;
        let (motion, known) = match (&scope.rates, &scope.motion) {
            (Some(motion), _) => (motion, class::PARAM | class::CONFIGURATION),
            (None, Some(motion)) => {
                let known = class::PARAM | class::CONFIGURATION | class::VELOCITY;
                (motion, known)
            }
            (None, None) if scope.unmoved => return None,
            (None, None) => {
                return self.error(
                    Diagnostic::new(span, "`rate` is not known here: it follows from the rates").help(
                        "use it in definitions of velocities, outputs, loads and named expressions, not in the definitions of coordinates and their rates",
                    ),
                );
            }
        };
        if matches!(value, Value::Pose(..)) {
            return None;
        }
        let entries = value.entries();
        let found = entries
            .iter()
            .fold(0, |found, e| found | self.graph.class(e.node()));
        let (what, help) = match found & !known {
            0 => ("", ""),
            unknown if unknown & class::INPUT != 0 => (
                "an input",
                "inputs are given at run time, without their rates; make the rate itself an input",
            ),
            _ if scope.rates.is_some() => (
                "a velocity or a rate",
                "a definition is a row of Y(x) ẋ: `rate(…)` stands for coordinates and expressions of them",
            ),
            _ => (
                "a rate of a velocity",
                "second derivatives of coordinates are known, but not third derivatives",
            ),
        };
        if !help.is_empty() {
            let message = format!("an expression that depends on {what} has no `rate`");
            return self.error(Diagnostic::new(argument.span, message).help(help));
        }
        let rates = motion.along(self.graph, &entries);
        if scope.rates.is_none() {
            motion
                .seen
                .borrow_mut()
                .extend(noted(self, &entries, &rates));
        }
        let circle = self.is_circle(argument);
        if let (true, Value::Vector(x), [c_dot, s_dot]) = (circle, &value, rates.as_slice()) {
            let graph = &mut *self.graph;
            let (gain, loss) = (graph.mul(x[0], *s_dot), graph.mul(x[1], *c_dot));
            return Some(Value::Scalar(graph.sub(gain, loss)));
        }
        let mut next = rates.into_iter();
        Some(value.map(|entry| next.next().unwrap_or(entry)))
    }
}

/// Records the derivatives for an independent check, three entries at a time.
fn noted(evaluator: &Evaluator, entries: &[Edge], rates: &[Edge]) -> Vec<Observed> {
    let graph = &*evaluator.graph;
    let three = |list: &[Edge]| -> [Edge; 3] {
        std::array::from_fn(|k| list.get(k).copied().unwrap_or(graph.zero()))
    };
    let pairs = entries.chunks(3).zip(rates.chunks(3));
    let observed = pairs.map(|(entries, rates)| Observed {
        quantity: Quantity::Rate,
        rotation: identity3(graph),
        position: three(entries),
        point: zero3(graph),
        value: three(rates),
    });
    observed.collect()
}
