//! Interpreter: evaluates the functions of a program in floating point, without compiling them.

use super::{Argument, Function, Program};
use hamel_algebra::graph::{Edge, Node, NodeId};
use hamel_algebra::numbers::{Arithmetic, Form};
use hamel_algebra::numeric::Floats;
use num_traits::ToPrimitive;
use std::ops::Range;

/// A function translated to steps for given parameters; its constants are evaluated once.
#[derive(Clone, Debug)]
pub struct Interpreter {
    /// Initial values of all places: the number 0 (as in a graph), the symbols, then constants and results of steps.
    initial: Vec<f64>,
    /// Steps: the place of the result, and a node whose operands are earlier places.
    steps: Vec<(usize, Node)>,
    outputs: Vec<Edge>,
    /// Guards with their indices in the function, in the order of their places.
    guards: Vec<(usize, Edge)>,
    /// Places at which x, ξ, u, ξ̇ and p begin.
    inputs: [usize; 5],
    states: Range<usize>,
    arguments: [bool; 5],
}

const ORDER: [Argument; 5] = [
    Argument::Coordinates,
    Argument::Velocities,
    Argument::Inputs,
    Argument::Accelerations,
    Argument::Momenta,
];

impl Interpreter {
    /// Prepares a function of a program for given parameters.
    pub fn new(program: &Program, function: &Function, params: &[f64]) -> Self {
        let graph = &program.graph;
        let roots: Vec<Edge> = function
            .outputs
            .iter()
            .chain(&function.guards)
            .copied()
            .collect();
        let reachable = graph.reachable(&roots);
        let symbols = graph.symbols().len();
        let first = 2 + params.len();
        let mut initial = vec![0.0; 1 + symbols];
        initial[1] = std::f64::consts::PI;
        initial[2..first].copy_from_slice(params);
        let mut places: Vec<NodeId> = vec![0; graph.len()];
        let mut steps = Vec::new();
        for id in reachable {
            let node = graph.node(id);
            if let Node::Symbol(symbol) = node {
                places[id as usize] = 1 + symbol;
                continue;
            }
            let step = node.map_children(|edge| edge.renumber(&places));
            let index = initial.len();
            places[id as usize] = index as NodeId;
            initial.push(match node {
                Node::Constant(index) => graph.constant(index).to_f64().unwrap_or(f64::NAN),
                _ if graph.is_free(id) => run(step, &initial),
                _ => {
                    steps.push((index, step));
                    0.0
                }
            });
        }
        let place = |edge: &Edge| edge.renumber(&places);
        let mut guards: Vec<(usize, Edge)> =
            function.guards.iter().map(place).enumerate().collect();
        guards.sort_by_key(|(_, place)| place.node());
        // The number 0 precedes the symbols.
        let [_, x, xi, u, z, xi_dot, p, _] = program.symbols().map(|start| start + 1);
        Interpreter {
            outputs: function.outputs.iter().map(place).collect(),
            guards,
            initial,
            steps,
            inputs: [x, xi, u, xi_dot, p],
            states: z..z + program.n_z,
            arguments: ORDER.map(|argument| function.arguments.contains(&argument)),
        }
    }

    /// Evaluates the function.
    ///
    /// # Errors
    /// The index of the first pivot that is not positive.
    pub fn call(
        &self,
        x: &[f64],
        xi: &[f64],
        u: &[f64],
        xi_dot: &[f64],
    ) -> Result<Vec<f64>, usize> {
        self.call_with([x, xi, u, xi_dot, &[]])
    }

    /// Evaluates the function, with all arguments in the order x, ξ, u, ξ̇, p.
    ///
    /// z follows ξ in its argument; entries behind the n of ξ̇ are ignored.
    ///
    /// # Errors
    /// The index of the first pivot that is not positive.
    pub fn call_with(&self, arguments: [&[f64]; 5]) -> Result<Vec<f64>, usize> {
        let mut values = self.initial.clone();
        for (index, part) in arguments.into_iter().enumerate() {
            if !self.arguments[index] {
                continue;
            }
            let (part, behind) = match ORDER[index] {
                // u follows ξ among the symbols, so that the difference of their places is n.
                Argument::Velocities | Argument::Accelerations => {
                    part.split_at(part.len().min(self.inputs[2] - self.inputs[1]))
                }
                _ => (part, &[][..]),
            };
            values[self.inputs[index]..self.inputs[index] + part.len()].copy_from_slice(part);
            if ORDER[index] == Argument::Velocities {
                values[self.states.start..][..behind.len()].copy_from_slice(behind);
            }
        }
        for &(index, step) in &self.steps {
            values[index] = run(step, &values);
        }
        for &(pivot, guard) in &self.guards {
            let value = read(guard, &values);
            if !(value.is_normal() && value > 0.0) {
                return Err(pivot);
            }
        }
        Ok(self
            .outputs
            .iter()
            .map(|&output| read(output, &values))
            .collect())
    }
}

fn read(edge: Edge, values: &[f64]) -> f64 {
    let value = values[edge.node() as usize];
    if edge.is_negative() { -value } else { value }
}

fn run(step: Node, values: &[f64]) -> f64 {
    let at = |edge: Edge| values.get(edge.node() as usize);
    // Numbers and symbols have their values from the start.
    let value = Floats(&[]).node(step, at, &Form::new);
    value.unwrap_or(f64::NAN)
}
