//! Functions of one argument, for laws that hold for all of them.

use hamel_algebra::function::Slope;
use hamel_algebra::graph::{Edge, Function, Graph};

/// Returns every function of one argument.
pub(crate) fn functions() -> impl Iterator<Item = Function> {
    let all = Function::ALL.iter().copied();
    all.filter(|function| function.row().slope != Slope::SeveralArguments)
}

/// Returns all functions of an argument, divided by a nonzero edge.
pub(crate) fn quotients(graph: &mut Graph, argument: Edge, over: Edge) -> Vec<Edge> {
    let quotient = |function| {
        let value = graph.apply(function, argument);
        graph.div(value, over).expect("not 0")
    };
    functions().map(quotient).collect()
}
