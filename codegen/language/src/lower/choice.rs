//! Choices between values: `if a < b { … } else { … }`, minimum and maximum.

use super::expression::Evaluator;
use crate::algebra::graph::{Edge, Graph, NodeId};
use crate::algebra::text::short;
use crate::diagnostics::Diagnostic;
use crate::model::class;
use crate::model::value::Value;
use crate::syntax::ast::{Choice, Comparison, Span};

impl Evaluator<'_> {
    /// Returns the value of an `if`. Both branches have a value; the choice is made at run time, or here if numbers
    /// are compared.
    pub(super) fn choice(&mut self, choice: &Choice) -> Option<Value> {
        let (left, right) = (self.scalar(&choice.left), self.scalar(&choice.right));
        let (then, otherwise) = (self.value(&choice.then), self.value(&choice.otherwise));
        let (left, right, then, otherwise) = (left?, right?, then?, otherwise?);
        if !then.same_shape(&otherwise) {
            return None;
        }
        let graph = &mut *self.graph;
        // a <= b is true where a > b is false.
        let (positive, turned) = match choice.comparison {
            Comparison::Less => (graph.sub(right, left), false),
            Comparison::Greater => (graph.sub(left, right), false),
            Comparison::AtMost => (graph.sub(left, right), true),
            Comparison::AtLeast => (graph.sub(right, left), true),
        };
        Some(then.zip(&otherwise, |a, b| match turned {
            false => graph.select(positive, a, b),
            true => graph.select(positive, b, a),
        }))
    }

    /// Reports an error if a value may jump where it changes from one branch to another, as far as that can be found.
    /// Anything that is derived from the slopes of a function is wrong at a jump.
    pub(super) fn continuous(&mut self, value: &Value, span: Span, what: &str) -> Option<()> {
        self.inside(value, span, what)?;
        let graph = &*self.graph;
        let coordinates = self.scope.plain();
        let free =
            |symbol: NodeId| graph.class(symbol) != class::COORD || coordinates.contains(&symbol);
        let Some(by) = graph.find_discontinuity(&value.entries(), class::PARAM, &free) else {
            return Some(());
        };
        let place =
            short(graph, by, LONGEST).map_or("a branch ends".into(), |by| format!("{by} = 0"));
        let message = format!("{what} has to be continuous, but this may jump where {place}");
        self.error(Diagnostic::new(span, message).help(
            "make the branches of an `if` equal there, and extend tables by `hold` or `linear`; \
             write what jumps as a load, such as a `generalized force`",
        ))
    }
}

/// Largest length of an expression that is shown.
const LONGEST: usize = 40;

/// Returns the lesser of two values; the second if they are equal.
pub(super) fn lesser(graph: &mut Graph, a: Edge, b: Edge) -> Edge {
    let more = graph.sub(b, a);
    graph.select(more, a, b)
}

/// Returns the greater of two values; the second if they are equal.
pub(super) fn greater(graph: &mut Graph, a: Edge, b: Edge) -> Edge {
    let more = graph.sub(a, b);
    graph.select(more, a, b)
}
