//! Evaluation of a program's functions in floating point, without compiling them.

use super::{Argument, Function, Program};
use crate::algebra::graph::{Edge, Function as Elementary, Node, NodeId};
use num_traits::ToPrimitive;

/// One step: what to compute from earlier places.
#[derive(Clone, Copy, Debug)]
enum Step {
    Add(Place, Place),
    Mul(Place, Place),
    Div(Place, Place),
    Apply(Elementary, Place),
    Atan2(Place, Place),
}

/// A signed place in the table of values.
#[derive(Clone, Copy, Debug)]
struct Place {
    index: usize,
    negative: bool,
}

/// A function compiled to steps, with everything that is constant evaluated once.
#[derive(Clone, Debug)]
pub struct Interpreter {
    initial: Vec<f64>,
    steps: Vec<(usize, Step)>,
    outputs: Vec<Place>,
    /// Guards with their numbers, in the order in which they are computed.
    guards: Vec<(usize, Place)>,
    inputs: [usize; 5],
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
    /// Compiles a function of a program with given parameters.
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
        let mut initial = vec![0.0; symbols];
        initial[0] = std::f64::consts::PI;
        initial[1..1 + params.len()].copy_from_slice(params);
        let mut places: rustc_hash::FxHashMap<NodeId, usize> = rustc_hash::FxHashMap::default();
        let mut steps = Vec::new();
        for id in reachable {
            let place = |edge: Edge| Place {
                index: places.get(&edge.node()).copied().unwrap_or(0),
                negative: edge.is_negative(),
            };
            let index = initial.len();
            let step = match graph.node(id) {
                Node::Symbol(symbol) => {
                    places.insert(id, symbol as usize);
                    continue;
                }
                Node::Constant(constant) => {
                    places.insert(id, index);
                    initial.push(graph.constant(constant).to_f64().unwrap_or(f64::NAN));
                    continue;
                }
                Node::Add(a, b) => Step::Add(place(a), place(b)),
                Node::Mul(a, b) => Step::Mul(place(a), place(b)),
                Node::Div(a, b) => Step::Div(place(a), place(b)),
                Node::Apply(f, a) => Step::Apply(f, place(a)),
                Node::Atan2(y, x) => Step::Atan2(place(y), place(x)),
            };
            places.insert(id, index);
            let value = if graph.is_free(id) {
                run(step, &initial)
            } else {
                steps.push((index, step));
                0.0
            };
            initial.push(value);
        }
        let place = |edge: &Edge| Place {
            index: places.get(&edge.node()).copied().unwrap_or(0),
            negative: edge.is_negative(),
        };
        let mut guards: Vec<(usize, Place)> =
            function.guards.iter().map(place).enumerate().collect();
        guards.sort_by_key(|(_, place)| place.index);
        let first = 1 + params.len();
        let inputs = [
            first,
            first + program.nu,
            first + program.nu + program.n,
            first + program.nu + program.n + program.m,
            first + program.nu + 2 * program.n + program.m,
        ];
        Interpreter {
            outputs: function.outputs.iter().map(place).collect(),
            guards,
            initial,
            steps,
            inputs,
            arguments: ORDER.map(|argument| function.arguments.contains(&argument)),
        }
    }

    /// The function's value; the number of the first pivot that is not positive where it has none.
    pub fn call(
        &self,
        x: &[f64],
        xi: &[f64],
        u: &[f64],
        xi_dot: &[f64],
    ) -> Result<Vec<f64>, usize> {
        self.call_with([x, xi, u, xi_dot, &[]])
    }

    /// The same for all arguments in the order x, ξ, u, ξ̇, p.
    pub fn call_with(&self, arguments: [&[f64]; 5]) -> Result<Vec<f64>, usize> {
        let mut values = self.initial.clone();
        for (index, part) in arguments.into_iter().enumerate() {
            if self.arguments[index] {
                values[self.inputs[index]..self.inputs[index] + part.len()].copy_from_slice(part);
            }
        }
        for &(index, step) in &self.steps {
            values[index] = run(step, &values);
        }
        for &(pivot, guard) in &self.guards {
            let value = read(guard, &values);
            if value.is_nan() || value <= 0.0 {
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

fn read(place: Place, values: &[f64]) -> f64 {
    if place.negative {
        -values[place.index]
    } else {
        values[place.index]
    }
}

fn run(step: Step, values: &[f64]) -> f64 {
    match step {
        Step::Add(a, b) => read(a, values) + read(b, values),
        Step::Mul(a, b) => read(a, values) * read(b, values),
        Step::Div(a, b) => read(a, values) / read(b, values),
        Step::Apply(Elementary::Sin, a) => read(a, values).sin(),
        Step::Apply(Elementary::Cos, a) => read(a, values).cos(),
        Step::Apply(Elementary::Exp, a) => read(a, values).exp(),
        Step::Apply(Elementary::Log, a) => read(a, values).ln(),
        Step::Apply(Elementary::Sqrt, a) => read(a, values).sqrt(),
        Step::Apply(Elementary::Atan2, _) => f64::NAN,
        Step::Atan2(y, x) => read(y, values).atan2(read(x, values)),
    }
}
