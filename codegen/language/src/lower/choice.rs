//! Choices between values: `if a < b { … } else { … }`, the lesser and the greater of two.

use super::expression::Evaluator;
use crate::algebra::graph::{Edge, Graph, NodeId};
use crate::algebra::text::short;
use crate::diagnostics::Diagnostic;
use crate::model::class;
use crate::model::value::Value;
use crate::syntax::ast::{Choice, Comparison, Span};

impl Evaluator<'_> {
    /// Both branches have a value; which of the two it is turns out where the program runs, or here where numbers
    /// are compared.
    pub(super) fn choice(&mut self, choice: &Choice) -> Option<Value> {
        let (left, right) = (self.scalar(&choice.left), self.scalar(&choice.right));
        let (then, otherwise) = (self.value(&choice.then), self.value(&choice.otherwise));
        let (left, right, then, otherwise) = (left?, right?, then?, otherwise?);
        if !then.same_shape(&otherwise) {
            return None;
        }
        let graph = &mut *self.graph;
        // a <= b is where a > b is not.
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

    /// Whether a value does not jump where it changes from one branch to another, as far as that is found; reports it
    /// where not. What is derived from the slopes of a function is true of a jump nowhere.
    pub(super) fn continuous(&mut self, value: &Value, span: Span, what: &str) -> Option<()> {
        self.inside(value, span, what)?;
        let graph = &*self.graph;
        let coordinates = self.scope.plain();
        let free =
            |symbol: NodeId| graph.class(symbol) != class::COORD || coordinates.contains(&symbol);
        let Some(by) = graph.jump(&value.entries(), class::PARAM, &free) else {
            return Some(());
        };
        let place =
            short(graph, by, LONGEST).map_or("a branch ends".into(), |by| format!("{by} = 0"));
        let message = format!("{what} has to be continuous, and this may jump where {place}");
        self.error(Diagnostic::new(span, message).help(
            "let the branches of an `if` be equal there, and extend tables by `hold` or `linear`; \
             what jumps is a load, such as a `generalized force`",
        ))
    }
}

/// Longer expressions are not shown.
const LONGEST: usize = 40;

/// The lesser of two; the second where they are equal.
pub(super) fn lesser(graph: &mut Graph, a: Edge, b: Edge) -> Edge {
    let more = graph.sub(b, a);
    graph.select(more, a, b)
}

/// The greater of two; the second where they are equal.
pub(super) fn greater(graph: &mut Graph, a: Edge, b: Edge) -> Edge {
    let more = graph.sub(a, b);
    graph.select(more, a, b)
}
