//! Expressions as a list of steps, for evaluation modulo p at many points.
//!
//! The steps of an expression are found once. A point then costs one pass over them, whether values or
//! derivatives (`jets`, `second_derivative`) are wanted.

use super::field_point::FieldPoint;
use super::graph::{Edge, Graph, Node, NodeId};
use super::numbers::{Form, Modular};
use super::residue_pair::ResiduePair;
use num_rational::BigRational;

/// A node whose children are earlier steps, and the linear form of its argument.
#[derive(Clone, Debug)]
struct Step {
    node: Node,
    form: Vec<(NodeId, BigRational)>,
}

/// Expressions prepared for evaluation at many points.
#[derive(Clone, Debug)]
pub struct Tape {
    /// Steps; those of the numbers 0 and 1 come first, as in a graph.
    steps: Vec<Step>,
    constants: Vec<ResiduePair>,
    roots: Vec<Edge>,
}

impl Tape {
    /// Builds the steps of expressions; `None` if p divides the denominator of a number.
    pub fn new(graph: &Graph, roots: &[Edge]) -> Option<Self> {
        let mut tape = Tape {
            steps: Vec::new(),
            constants: Vec::new(),
            roots: Vec::new(),
        };
        let mut places = vec![0; graph.len()];
        let varying = graph.reachable(roots).into_iter().filter(|&id| id > 1);
        for id in [0, 1].into_iter().chain(varying) {
            places[id as usize] = tape.steps.len() as NodeId;
            let mut form = Vec::new();
            let node = match graph.node(id) {
                Node::Constant(index) => {
                    let value = graph.constant(index);
                    tape.constants.push(ResiduePair::from_rational(value)?);
                    Node::Constant(tape.constants.len() as u32 - 1)
                }
                Node::Apply(function, a) => {
                    form = graph.form(function, a);
                    form.iter_mut()
                        .for_each(|(atom, _)| *atom = places[*atom as usize]);
                    Node::Apply(function, a.renumber(&places))
                }
                Node::External(component, list) => {
                    form = graph.signed_list(list);
                    form.iter_mut()
                        .for_each(|(atom, _)| *atom = places[*atom as usize]);
                    Node::External(component, list.renumber(&places))
                }
                node => node.map_children(|edge| edge.renumber(&places)),
            };
            tape.steps.push(Step { node, form });
        }
        tape.roots = roots.iter().map(|root| root.renumber(&places)).collect();
        Some(tape)
    }

    /// Evaluates the expressions in numbers of any kind; `None` if something has no value.
    pub(super) fn run<C: Modular>(&self, numbers: &mut C) -> Option<Vec<C::Number>> {
        let mut values: Vec<C::Number> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            let form = || -> Form<C::Number> {
                let value =
                    |(atom, c): &(NodeId, BigRational)| (values[*atom as usize].clone(), c.clone());
                step.form.iter().map(value).collect()
            };
            let at = |edge: Edge| values.get(edge.node() as usize);
            let value = match step.node {
                Node::Constant(index) => numbers.residue(self.constants[index as usize])?,
                node => numbers.node(node, at, &form)?,
            };
            values.push(value);
        }
        numbers.read(&values, &self.roots)
    }

    /// Evaluates the expressions at a point; `None` if something has no value there.
    pub fn values(&self, point: &FieldPoint) -> Option<Vec<ResiduePair>> {
        let mut point = point.clone();
        let values = self.run(&mut point)?;
        (!point.has_missing_root()).then_some(values)
    }
}
