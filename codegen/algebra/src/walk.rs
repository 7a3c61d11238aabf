//! Evaluation of expressions in numbers of any kind, by one walk over their nodes.

use super::graph::Graph;
use super::node::{Edge, Node, NodeId};
use super::numbers::{Arithmetic, Form, Step};
use num_rational::BigRational;

/// Evaluates the expressions; `None` if something has no value.
pub fn evaluate<C: Arithmetic>(
    graph: &Graph,
    roots: &[Edge],
    numbers: &mut C,
) -> Option<Vec<C::Number>> {
    let order = graph.reachable(roots);
    let count = order.last().map_or(0, |&last| last as usize + 1);
    let mut values = vec![numbers.make(Step::Whole(0))?; count.max(2)];
    // Node 1 is the number 1, the atom of constant angles.
    values[1] = numbers.make(Step::Whole(1))?;
    for id in order {
        let form = || {
            let value = |(atom, c): (NodeId, BigRational)| (values[atom as usize].clone(), c);
            let atoms = match graph.node(id) {
                Node::Apply(function, a) => graph.form(function, a),
                Node::External(_, list) => graph.signed_list(list),
                _ => return Form::new(),
            };
            atoms.into_iter().map(value).collect()
        };
        let at = |edge: Edge| values.get(edge.node() as usize);
        values[id as usize] = match graph.node(id) {
            Node::Constant(index) => numbers.make(Step::Constant(graph.constant(index)))?,
            node => numbers.node(node, at, &form)?,
        };
    }
    numbers.read(&values, roots)
}
