//! Functions as tapes: the statements that are emitted, in single assignment, without the graph that they come from.
//!
//! A tape has numbers in place of nodes and can go to other threads. What reads it does nothing but arithmetic: it is
//! what machine code is made of.

use super::places::{Place, Places, Time};
use super::schedule::Schedule;
use super::statements::{Body, Operation, statements};
use super::together::together;
use super::{Argument, Cause, Function, FunctionId, Program};
use hamel_algebra::graph::{self, Edge, Graph, Node, NodeId};
use num_traits::ToPrimitive;
use rustc_hash::{FxHashMap, FxHashSet};

/// Where a value is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// An entry of an argument.
    Argument(Argument, usize),
    /// A parameter; behind the parameters stands what depends on them alone.
    Constant(usize),
    /// A number.
    Number(f64),
    /// The result of a step, by its number among all results.
    Value(usize),
}

/// A value with its sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Operand {
    /// Where it is found.
    pub source: Source,
    /// Whether it is read with the other sign.
    pub negative: bool,
}

/// One step. All but `SinCos` and `Check` have one result, which is the next value of the tape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// a + b
    Add(Operand, Operand),
    /// a b
    Multiply(Operand, Operand),
    /// a b + c, rounded once where the machine can
    Fused(Operand, Operand, Operand),
    /// a / b
    Divide(Operand, Operand),
    /// sin a and cos a, two results.
    SinCos(Operand),
    /// f(a)
    Apply(graph::Function, Operand),
    /// atan2(y, x)
    Atan2(Operand, Operand),
    /// a where c > 0, b where it is not, NaN where c is NaN
    Select(Operand, Operand, Operand),
    /// No result; ends the tape unless a pivot is positive.
    Check(Cause, Operand),
}

impl Step {
    /// What it reads, in order.
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

    /// How many results it has.
    pub fn results(&self) -> usize {
        match self {
            Step::SinCos(_) => 2,
            Step::Check(..) => 0,
            _ => 1,
        }
    }
}

/// One function.
#[derive(Clone, Debug, PartialEq)]
pub struct Tape {
    /// Its name.
    pub name: String,
    /// Its steps, operands before their readers.
    pub steps: Vec<Step>,
    /// Its results, matrices by rows.
    pub outputs: Vec<Operand>,
}

impl Tape {
    /// Whether steps and results read only values that are there before them.
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

    /// How many values its steps have.
    pub fn values(&self) -> usize {
        self.steps.iter().map(Step::results).sum()
    }
}

/// Functions of a program, and what they have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Tapes {
    /// How many parameters there are.
    pub parameters: usize,
    /// How many entries the arguments x, ξ with z, u, ξ̇ and p have.
    pub lengths: [usize; 5],
    /// What depends on parameters alone: computed whenever they are set, and kept behind them.
    pub constants: Tape,
    /// Pivots of what is constant at run time, which are constants: where one is not positive, M is not either.
    pub pivots: Vec<(Operand, Cause)>,
    /// The functions.
    pub functions: Vec<Tape>,
}

/// The arguments in the order of [`Tapes::lengths`].
pub const ARGUMENTS: [Argument; 5] = [
    Argument::Coordinates,
    Argument::Velocities,
    Argument::Inputs,
    Argument::Accelerations,
    Argument::Momenta,
];

/// A function in Rust that a tape would have to call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Foreign {
    /// Its name.
    pub name: String,
}

impl Tapes {
    /// The tapes of functions of a program.
    ///
    /// # Errors
    /// Where one of them calls a function in Rust, of which nothing is known here.
    pub fn new(program: &Program, functions: &[&Function]) -> Result<Self, Foreign> {
        // All that the program keeps, not only what these functions read: so sums are rounded as in generated code.
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
        // As it is emitted: products that both read are not fused.
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
            call(&program.graph.varying(&roots), &function.outputs, guards)
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

    /// All tapes: the functions, and behind them the constants.
    pub fn all(&self) -> impl Iterator<Item = &Tape> {
        self.functions.iter().chain([&self.constants])
    }

    /// How many numbers depend on parameters alone, parameters among them.
    pub fn kept(&self) -> usize {
        self.parameters + self.constants.outputs.len()
    }
}

/// The nodes among these that the user named: each keeps a statement of its own.
pub fn named(program: &Program, nodes: &[NodeId]) -> FxHashSet<NodeId> {
    let here: FxHashSet<NodeId> = nodes.iter().copied().collect();
    let names = program.names.iter().map(|(_, edge)| edge.node());
    names.filter(|node| here.contains(node)).collect()
}

/// From statements to steps.
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
            // The value does not depend on it, as was proved, but expressions that are equal are one node.
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

/// The number that a node is: the nearest to an exact rational, or π.
pub fn number(graph: &Graph, node: NodeId) -> f64 {
    match graph.node(node) {
        Node::Constant(index) => graph.constant(index).to_f64().unwrap_or(f64::NAN),
        _ => std::f64::consts::PI,
    }
}
