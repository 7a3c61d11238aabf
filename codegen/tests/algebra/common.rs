//! Functions of one argument, for the laws that all of them obey.

use hamel_algebra::function::Slope;
use hamel_algebra::graph::{Edge, Function, Graph};

/// Every function of one argument.
pub(crate) fn functions() -> impl Iterator<Item = Function> {
    let all = Function::ALL.iter().copied();
    all.filter(|function| function.row().slope != Slope::SeveralArguments)
}

/// All of them of an argument, over what is not 0.
pub(crate) fn quotients(graph: &mut Graph, argument: Edge, over: Edge) -> Vec<Edge> {
    let quotient = |function| {
        let value = graph.apply(function, argument);
        graph.div(value, over).expect("not 0")
    };
    functions().map(quotient).collect()
}
