//! Functions as tapes: lists of steps in single assignment form, without the graph from which they come.
//!
//! A tape refers to values by index in place of nodes and can be sent to other threads. Evaluating it takes nothing but
//! arithmetic: machine code is made from it.

use super::places::{Place, Places, Time};
use super::schedule::Schedule;
use super::statements::{Body, Operation, statements};
use super::together::together;
use super::{Argument, Cause, Function, FunctionId, Program};
use hamel_algebra::graph::{self, Edge, Graph, Node, NodeId};
use num_traits::ToPrimitive;
use rustc_hash::{FxHashMap, FxHashSet};

/// Where an operand is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// Entry of an argument.
    Argument(Argument, usize),
    /// Parameter, or, at indices behind the parameters, a value that depends on parameters alone.
    Constant(usize),
    /// Number known when code is generated.
    Number(f64),
    /// Result of a step, by its index among all results.
    Value(usize),
}

/// Operand of a step: a value and a sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Operand {
    /// Where the value is found.
    pub source: Source,
    /// Whether the value is negated when it is read.
    pub negative: bool,
}

/// One step. Every step but `SinCos` and `Check` has one result, which becomes the next value of the tape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// a + b
    Add(Operand, Operand),
    /// a b
    Multiply(Operand, Operand),
    /// a b + c, rounded only once if the machine has fused multiply-add.
    Fused(Operand, Operand, Operand),
    /// a / b
    Divide(Operand, Operand),
    /// sin a and cos a, as two results.
    SinCos(Operand),
    /// f(a)
    Apply(graph::Function, Operand),
    /// atan2(y, x)
    Atan2(Operand, Operand),
    /// a if c > 0, NaN if c is NaN, else b
    Select(Operand, Operand, Operand),
    /// Ends the tape if a pivot is not positive; has no result.
    Check(Cause, Operand),
}

impl Step {
    /// Returns the operands, in order.
    pub fn operands(&self) -> impl Iterator<Item = Operand> {
        let list = match *self {
            Step::Add(a, b) | Step::Multiply(a, b) | Step::Divide(a, b) | Step::Atan2(a, b) => {
                [Some(a), Some(b), None]
            }
            Step::Fused(a, b, c) | Step::Select(a, b, c) => [Some(a), Some(b), Some(c)],
            Step::SinCos(a) | Step::Apply(_, a) | Step::Check(_, a) => [Some(a), None, None],
        };
        list.into_iter().flatten()
    }

    /// Returns the number of results.
    pub fn results(&self) -> usize {
        match self {
            Step::SinCos(_) => 2,
            Step::Check(..) => 0,
            _ => 1,
        }
    }
}

/// Tape of one function.
#[derive(Clone, Debug, PartialEq)]
pub struct Tape {
    /// Name of the function.
    pub name: String,
    /// Steps, operands before their readers.
    pub steps: Vec<Step>,
    /// Results of the function, matrices by rows.
    pub outputs: Vec<Operand>,
}

impl Tape {
    /// Returns whether steps and results read only values that have been computed before.
    pub fn is_in_order(&self) -> bool {
        let mut known = 0;
        let there = |operand: Operand, known: usize| match operand.source {
            Source::Value(value) => value < known,
            _ => true,
        };
        for step in &self.steps {
            if !step.operands().all(|operand| there(operand, known)) {
                return false;
            }
            known += step.results();
        }
        self.outputs.iter().all(|&output| there(output, known))
    }

    /// Returns the number of values that the steps compute.
    pub fn values(&self) -> usize {
        self.steps.iter().map(Step::results).sum()
    }
}

/// Tapes of functions of a program, and the data that they share.
#[derive(Clone, Debug, PartialEq)]
pub struct Tapes {
    /// Number of parameters.
    pub parameters: usize,
    /// Lengths of the arguments x, (ξ, z), u, ξ̇ and p.
    pub lengths: [usize; 5],
    /// Computes the values that depend on parameters alone; runs whenever parameters are set, and its results are
    /// stored behind them.
    pub constants: Tape,
    /// Pivots of a mass matrix that is constant at run time, all of them constants; if one is not positive, neither is
    /// M.
    pub pivots: Vec<(Operand, Cause)>,
    /// Tapes of the functions.
    pub functions: Vec<Tape>,
}

/// Arguments in the order of [`Tapes::lengths`].
pub const ARGUMENTS: [Argument; 5] = [
    Argument::Coordinates,
    Argument::Velocities,
    Argument::Inputs,
    Argument::Accelerations,
    Argument::Momenta,
];

/// Function in Rust that a tape would have to call, which it cannot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Foreign {
    /// Name of the function in Rust.
    pub name: String,
}

impl Tapes {
    /// Translates functions of a program to tapes.
    ///
    /// # Errors
    /// The name of a function in Rust, if one of the functions calls it: its code is not known here.
    pub fn new(program: &Program, functions: &[&Function]) -> Result<Self, Foreign> {
        // Keeps all constants of the program, not only those that these functions read: so sums are rounded as in
        // generated code.
        let schedule = Schedule::of(program);
        let places = Places::new(program, &schedule.kept);
        let parameters = places.parameters();
        let tape =
            |name: &str, time, nodes: &[NodeId], outputs: &[Edge], guards: &[Edge], reads| {
                let named = named(program, nodes);
                let guards: Vec<(Edge, Cause)> = guards
                    .iter()
                    .map(|&guard| (guard, program.cause(guard)))
                    .collect();
                let body = statements(&places, time, nodes, outputs, &guards, &named);
                let lowering = Lowering {
                    places: &places,
                    time,
                    arguments: reads,
                    parameters,
                    values: FxHashMap::default(),
                };
                lowering.tape(name, body)
            };
        let constants = tape(
            "constants",
            Time::Parameters,
            &schedule.hoisted,
            &places.kept(),
            &[],
            &[],
        )?;
        // As in generated code, where [A B] is computed together with ξ̇: products that both read are not fused.
        let both = together(program);
        let functions = functions.iter().map(|function| {
            let guards: &[Edge] = match function.fallible {
                true => &function.guards,
                false => &[],
            };
            let call = |nodes: &[NodeId], outputs: &[Edge], guards: &[Edge]| {
                let (name, reads) = (&function.name, &function.arguments);
                tape(name, Time::Call, nodes, outputs, guards, reads)
            };
            let both = both
                .as_ref()
                .filter(|_| function.id == Some(FunctionId::Linearize));
            if let Some(both) = both {
                let guards = if function.fallible {
                    &both.guards
                } else {
                    guards
                };
                let mut tape = call(&both.nodes, &both.outputs, guards)?;
                let rates = both.outputs.len() - function.outputs.len();
                tape.outputs.drain(..rates);
                return Ok(tape);
            }
            let roots = [&function.outputs, guards].concat();
            call(
                &program.graph.varying_nodes(&roots),
                &function.outputs,
                guards,
            )
        });
        let pivots = Lowering {
            places: &places,
            time: Time::Call,
            arguments: &[],
            parameters,
            values: FxHashMap::default(),
        };
        let pivots = program
            .constant_guards
            .iter()
            .map(|&guard| (pivots.operand(guard), program.cause(guard)))
            .collect();
        Ok(Tapes {
            pivots,
            parameters,
            lengths: ARGUMENTS.map(|argument| program.length(argument)),
            constants,
            functions: functions.collect::<Result<_, Foreign>>()?,
        })
    }

    /// Returns all tapes: those of the functions, then that of the constants.
    pub fn all(&self) -> impl Iterator<Item = &Tape> {
        self.functions.iter().chain([&self.constants])
    }

    /// Returns the number of values that depend on parameters alone, including the parameters.
    pub fn kept(&self) -> usize {
        self.parameters + self.constants.outputs.len()
    }
}

/// Returns those of the given nodes that the user has named; each of them keeps a statement of its own.
pub fn named(program: &Program, nodes: &[NodeId]) -> FxHashSet<NodeId> {
    let here: FxHashSet<NodeId> = nodes.iter().copied().collect();
    let names = program.names.iter().map(|(_, edge)| edge.node());
    names.filter(|node| here.contains(node)).collect()
}

/// Translation of statements to steps.
struct Lowering<'a> {
    places: &'a Places<'a>,
    time: Time,
    arguments: &'a [Argument],
    parameters: usize,
    values: FxHashMap<NodeId, usize>,
}

impl Lowering<'_> {
    fn tape(mut self, name: &str, body: Body) -> Result<Tape, Foreign> {
        let mut steps = Vec::with_capacity(body.statements.len());
        let mut values = 0;
        for statement in body.statements {
            let of = |edge: Edge| self.operand(edge);
            let step = match statement.operation {
                Operation::Add(a, b) => Step::Add(of(a), of(b)),
                Operation::Multiply(a, b) => Step::Multiply(of(a), of(b)),
                Operation::Fused(a, b, c) => Step::Fused(of(a), of(b), of(c)),
                Operation::Divide(a, b) => Step::Divide(of(a), of(b)),
                Operation::SinCos(a) => Step::SinCos(of(a)),
                Operation::Apply(function, a) => Step::Apply(function, of(a)),
                Operation::Atan2(y, x) => Step::Atan2(of(y), of(x)),
                Operation::Select(c, a, b) => Step::Select(of(c), of(a), of(b)),
                Operation::Check(cause, a) => Step::Check(cause, of(a)),
                Operation::Call(call) => {
                    let externals = self.places.graph().externals();
                    let name = externals.get(call.function);
                    let name = name.map(|external| external.name.clone());
                    return Err(Foreign {
                        name: name.unwrap_or_default(),
                    });
                }
            };
            steps.push(step);
            for (place, node) in statement.results.into_iter().enumerate() {
                if let Some(node) = node {
                    self.values.insert(node, values + place);
                }
            }
            values += step.results();
        }
        let outputs = body.outputs.iter().map(|&edge| self.operand(edge));
        Ok(Tape {
            name: name.into(),
            outputs: outputs.collect(),
            steps,
        })
    }

    fn operand(&self, edge: Edge) -> Operand {
        let node = edge.node();
        let source = match self.places.of(node, self.time) {
            // The node is written in an argument that the function does not take: expressions that are equal on X share
            // a node. The value was proved not to depend on this argument, so that any number does.
            Place::Argument(argument, _) if !self.arguments.contains(&argument) => {
                Source::Number(0.0)
            }
            Place::Argument(argument, index) => Source::Argument(argument, index),
            Place::Parameter(index) => Source::Constant(index),
            Place::Kept(index) => Source::Constant(self.parameters + index),
            Place::Number => Source::Number(number(self.places.graph(), node)),
            Place::Temporary => match self.values.get(&node) {
                Some(&value) => Source::Value(value),
                None => Source::Number(f64::NAN),
            },
        };
        Operand {
            source,
            negative: edge.is_negative(),
        }
    }
}

/// Returns the value of a constant node: the nearest `f64` to an exact rational, or π.
pub fn number(graph: &Graph, node: NodeId) -> f64 {
    match graph.node(node) {
        Node::Constant(index) => graph.constant(index).to_f64().unwrap_or(f64::NAN),
        _ => std::f64::consts::PI,
    }
}
