//! Statements as text.

use super::locals::Locals;
use super::lower::{Call, Operation, Statement};
use super::names::{self, ExternalNames};
use super::number;
use super::places::{Place, Places, Time};
use crate::algebra::graph::{Edge, Function, NodeId};
use crate::program::{Argument, Program};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeSet;

/// What a text reads and writes beyond its own values.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Used {
    /// Arguments read.
    pub arguments: BTreeSet<Argument>,
    /// Whether kept constants are read.
    pub kept: bool,
    /// Whether slots are read.
    pub reads: bool,
    /// Whether slots are written.
    pub writes: bool,
    /// Whether results are written.
    pub out: bool,
    /// Whether it can return an error.
    pub checks: bool,
}

/// Prints the statements of one function or part.
pub struct Printer<'a> {
    /// The program.
    pub program: &'a Program,
    /// Where values are found.
    pub places: &'a Places<'a>,
    /// When the function runs.
    pub time: Time,
    /// What the function takes.
    pub arguments: &'a [Argument],
    /// Names of values.
    pub locals: &'a Locals,
    /// The parameters as expressions, in order.
    pub parameters: &'a [String],
    /// Names of functions in Rust.
    pub externals: &'a ExternalNames,
    /// Slots of values that cross parts.
    pub slots: &'a FxHashMap<NodeId, usize>,
    /// Values computed by statements printed so far.
    pub here: FxHashSet<NodeId>,
    /// What was used so far.
    pub used: Used,
}

impl Printer<'_> {
    /// A value without its sign.
    fn value(&mut self, node: NodeId) -> String {
        match self.places.of(node, self.time) {
            // The value of the function does not depend on it, as was proved, but expressions that are equal
            // are one node. The interpreter takes 0 as well.
            Place::Argument(argument, _) if !self.arguments.contains(&argument) => {
                number::scalar(0.0)
            }
            Place::Argument(argument, index) => {
                self.used.arguments.insert(argument);
                format!("{}[{index}]", names::argument(argument))
            }
            Place::Parameter(index) => self.parameters[index].clone(),
            Place::Kept(index) => {
                self.used.kept = true;
                format!("k[{index}]")
            }
            Place::Number => self.locals.name(node).into(),
            Place::Temporary if self.here.contains(&node) => self.locals.name(node).into(),
            Place::Temporary => match self.slots.get(&node) {
                Some(slot) => {
                    self.used.reads = true;
                    format!("slots[{slot}]")
                }
                // No Rust, so that the text never leaves the generator.
                None => format!("no value for node {node}"),
            },
        }
    }

    /// A value with its sign, as an operand.
    pub fn signed(&mut self, edge: Edge) -> String {
        let value = self.value(edge.node());
        if edge.is_negative() {
            format!("-{value}")
        } else {
            value
        }
    }

    /// A value with its sign, as the receiver of a method.
    fn receiver(&mut self, edge: Edge) -> String {
        let value = self.signed(edge);
        if edge.is_negative() {
            format!("({value})")
        } else {
            value
        }
    }

    /// A result that is written by itself: a number stands as a literal.
    pub fn result(&mut self, edge: Edge) -> String {
        match self.places.of(edge.node(), self.time) {
            Place::Number => {
                let sign = if edge.is_negative() { "-" } else { "" };
                format!("{sign}{}", number::of(self.places.graph(), edge.node()))
            }
            _ => self.signed(edge),
        }
    }

    /// The binding of a number.
    pub fn number(&self, node: NodeId) -> String {
        let literal = number::of(self.places.graph(), node);
        format!("let {} = {literal};\n", self.locals.name(node))
    }

    /// A statement; its values go to their slots at once.
    pub fn statement(&mut self, statement: &Statement) -> String {
        if let Operation::Check(pivot, edge) = statement.operation {
            self.used.checks = true;
            return check(self.program, edge, &self.receiver(edge), pivot);
        }
        let expression = self.expression(&statement.operation);
        let name = |node: Option<NodeId>| node.map_or("_", |node| self.locals.name(node));
        let [first, second] = statement.results.map(name);
        let mut text = match &statement.operation {
            Operation::Call(call) => format!("let {} = {expression};\n", self.pattern(call)),
            Operation::SinCos(_) => format!("let ({first}, {second}) = {expression};\n"),
            _ => format!("let {first} = {expression};\n"),
        };
        for node in statement.defined() {
            self.here.insert(node);
            if let Some(slot) = self.slots.get(&node) {
                self.used.writes = true;
                text.push_str(&format!("slots[{slot}] = {};\n", self.locals.name(node)));
            }
        }
        text
    }

    /// What a function in Rust gives, by rows where it has several components.
    fn pattern(&self, call: &Call) -> String {
        let name = |node: &Option<NodeId>| node.map_or("_", |node| self.locals.name(node));
        let list = |nodes: &[Option<NodeId>]| {
            let names: Vec<&str> = nodes.iter().map(name).collect();
            format!("[{}]", names.join(", "))
        };
        match (call.slopes, call.results.as_slice()) {
            (false, [one]) => name(one).into(),
            (false, all) => list(all),
            (true, all) if all.len() == call.arguments.len() => list(all),
            (true, all) => {
                let rows = all.chunks(call.arguments.len().max(1)).map(list);
                format!("[{}]", rows.collect::<Vec<_>>().join(", "))
            }
        }
    }

    fn expression(&mut self, operation: &Operation) -> String {
        match *operation {
            Operation::Add(a, b) if a.is_negative() && !b.is_negative() => {
                self.expression(&Operation::Add(b, a))
            }
            Operation::Add(a, b) => {
                let sign = if b.is_negative() { "-" } else { "+" };
                format!("{} {sign} {}", self.signed(a), self.value(b.node()))
            }
            Operation::Multiply(a, b) => format!("{} * {}", self.signed(a), self.signed(b)),
            Operation::Fused(a, b, c) => {
                let (a, b, c) = (self.receiver(a), self.signed(b), self.signed(c));
                format!("{a}.mul_add({b}, {c})")
            }
            Operation::Divide(a, b) => format!("{} / {}", self.signed(a), self.signed(b)),
            Operation::SinCos(a) => format!("{}.sin_cos()", self.receiver(a)),
            Operation::Atan2(y, x) => format!("{}.atan2({})", self.receiver(y), self.signed(x)),
            Operation::Select(c, a, b) => {
                let (c, a, b) = (self.receiver(c), self.signed(a), self.signed(b));
                format!("{c}.{}({a}, {b})", Function::Select.row().rust)
            }
            Operation::Apply(function, a) => {
                format!("{}.{}", self.receiver(a), function.row().rust)
            }
            Operation::Check(_, a) => self.signed(a),
            Operation::Call(ref call) => {
                let given: Vec<String> = call.arguments.iter().map(|&a| self.signed(a)).collect();
                let [value, slopes] = &self.externals.methods[call.function];
                let method = if call.slopes { slopes } else { value };
                let field = &self.externals.field;
                format!("self.{field}.{method}({})", given.join(", "))
            }
        }
    }
}

/// Leaves a function unless a pivot is positive: a pivot of [Y; Φ] or of the mass matrix.
pub fn check(program: &Program, guard: Edge, pivot: &str, index: usize) -> String {
    let error = match program.kinematic_pivot(guard) {
        Some(index) => format!("::hamel::Singular::kinematics({index})"),
        None => format!("::hamel::Singular::inertia({index})"),
    };
    format!("if !{pivot}.is_positive() {{ return Err({error}); }}\n")
}
