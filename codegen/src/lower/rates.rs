//! `rate(q)` in the definition of a velocity: ẋ of a coordinate, of a part or of entries of it.
//!
//! | `rate(…)` of | is |
//! |---|---|
//! | a real, a vector, a unit quaternion, a rotation matrix | its ẋ, of the same shape |
//! | an S1 coordinate q | its angular rate c ṡ − s ċ; ċ and ṡ are `rate(q.c)`, `rate(q.s)` |
//! | a part `X.p`, `X.R`, an entry `r[1]`, an array `[x, y]` | the same of its entries |

use super::expression::Evaluator;
use super::scope::NameKind;
use crate::algebra::graph::Edge;
use crate::diagnostics::Diagnostic;
use crate::model::value::Value;
use crate::syntax::ast::{CoordKind, Expr, ExprKind, Span};

impl Evaluator<'_> {
    /// `rate(…)` of coordinates.
    pub fn rate(&mut self, arguments: &[Expr], span: Span) -> Option<Value> {
        const USAGE: &str =
            "write `rate(q)` of a coordinate, of a part `rate(X.p)` or of an entry `rate(r[1])`";
        let [argument] = arguments else {
            let message = format!("`rate` takes one coordinate, not {}", arguments.len());
            return self.error(Diagnostic::new(span, message).help(USAGE));
        };
        let value = self.value(argument)?;
        let Some(rates) = &self.scope.rates else {
            return self.error(
                Diagnostic::new(
                    span,
                    "`rate(…)` stands in the definition of a velocity only",
                )
                .help("define a velocity by it, `velocity w = …;`, and write that velocity here"),
            );
        };
        if let Value::Pose(..) = value {
            return self.error(
                Diagnostic::new(argument.span, "the rate of a pose is no pose")
                    .help("take its parts: `rate(X.p)` and `rate(X.R)`"),
            );
        }
        let found: Option<Vec<Edge>> = value
            .entries()
            .iter()
            .map(|entry| {
                let rate = rates.of.get(&entry.node())?;
                Some(rate.signed(entry.is_negative()))
            })
            .collect();
        let Some(found) = found else {
            return self.error(
                Diagnostic::new(argument.span, "`rate` takes coordinates only, not expressions")
                    .help("write the derivative out by the chain rule, with the rate of every coordinate in it"),
            );
        };
        let circle = matches!(&argument.kind, ExprKind::Name(name)
            if self.scope.get(name).is_some_and(|e| e.kind == NameKind::Coord(CoordKind::S1)));
        if let (true, Value::Vector(x), [c_dot, s_dot]) = (circle, &value, found.as_slice()) {
            let graph = &mut *self.graph;
            let (gain, loss) = (graph.mul(x[0], *s_dot), graph.mul(x[1], *c_dot));
            return Some(Value::Scalar(graph.sub(gain, loss)));
        }
        let mut next = found.into_iter();
        Some(value.map(|entry| next.next().unwrap_or(entry)))
    }
}
