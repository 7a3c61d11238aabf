//! Prints statements: everything that all languages share, such as the places of values, and signs.

use super::language::{Language, Operand, SharedArray};
use super::locals::Locals;
use super::names::{self, ExternalNames};
use hamel_algebra::graph::{Edge, NodeId};
use hamel_program::places::{Place, Places, Time};
use hamel_program::statements::{Call, Operation, Statement};
use hamel_program::{Argument, Program, Shape};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// The arguments, constants and arrays that a text uses, in addition to its own values.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UsedNames {
    /// Arguments read.
    pub arguments: BTreeSet<Argument>,
    /// Whether kept constants are read.
    pub kept: bool,
    /// Entries of arrays that are read or written, once for each access.
    pub entries: Vec<(SharedArray, usize)>,
    /// Access to each array.
    access: BTreeMap<SharedArray, ArrayAccess>,
    /// Whether the text can return an error.
    pub checks: bool,
}

impl UsedNames {
    /// Returns how an array is accessed.
    pub fn access(&self, array: SharedArray) -> ArrayAccess {
        self.access.get(&array).copied().unwrap_or_default()
    }

    /// Records that the text reads or writes an entry of an array that parts of a function share (slots, results, slopes),
    /// which decides how the array is passed.
    pub fn record_shared_access(&mut self, array: SharedArray, place: usize, access: ArrayAccess) {
        self.entries.push((array, place));
        let known = self.access.entry(array).or_default();
        *known = access.max(*known);
    }
}

/// How a text accesses an array.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum ArrayAccess {
    /// Not at all.
    #[default]
    None,
    /// It only reads entries.
    Read,
    /// It writes entries, and may read some.
    Written,
}

/// A result that is read from the output array to which it was written.
pub struct WrittenResult {
    /// The array, its shape, and the index of the entry.
    pub place: (SharedArray, Shape, usize),
    /// Whether the entry is the negative of the value.
    pub negative: bool,
}

/// Comments above the statements that serve one quantity, by the nodes that these define.
pub type Headings = FxHashMap<NodeId, Rc<str>>;

/// Prints the statements of one function or part.
pub struct Printer<'a> {
    /// Target language.
    pub language: &'a dyn Language,
    /// The program.
    pub program: &'a Program,
    /// Where values are found.
    pub places: &'a Places<'a>,
    /// When the function runs.
    pub time: Time,
    /// Arguments of the function.
    pub arguments: &'a [Argument],
    /// Names of values.
    pub locals: &'a Locals,
    /// The parameters as expressions, in order.
    pub parameters: &'a [String],
    /// Names of external functions.
    pub externals: &'a ExternalNames,
    /// Slots of values that cross parts.
    pub slots: &'a FxHashMap<NodeId, usize>,
    /// Results that are read from the output array.
    pub written: &'a FxHashMap<NodeId, WrittenResult>,
    /// Headings of statements, by the nodes that they define; empty if there are to be none.
    pub headings: &'a Headings,
    /// The heading printed last.
    pub heading: &'a str,
    /// Values computed by statements printed so far.
    pub here: FxHashSet<NodeId>,
    /// What was used so far.
    pub used: UsedNames,
}

impl Printer<'_> {
    /// A value without its sign.
    fn value(&mut self, node: NodeId) -> String {
        match self.places.of(node, self.time) {
            // The function was proved not to depend on this argument, but equal expressions share a node, which may
            // read it elsewhere. The interpreter substitutes 0 as well.
            Place::Argument(argument, _) if !self.arguments.contains(&argument) => {
                self.language.zero()
            }
            Place::Argument(argument, index) => {
                self.used.arguments.insert(argument);
                format!("{}[{index}]", names::argument_name(argument))
            }
            Place::Parameter(index) => self.parameters[index].clone(),
            Place::Kept(index) => {
                self.used.kept = true;
                format!("k[{index}]")
            }
            Place::Number => {
                let name = self.locals.name_of(node);
                self.language.number(self.places.graph(), node, name)
            }
            Place::Temporary if self.here.contains(&node) => self.locals.name_of(node).into(),
            Place::Temporary => match self.slots.get(&node) {
                Some(&slot) => self.slot(slot, ArrayAccess::Read),
                // Not valid in any language, so that the text never leaves the generator.
                None => format!("no value for node {node}"),
            },
        }
    }

    /// Returns the slot of a value, and records the access.
    fn slot(&mut self, slot: usize, access: ArrayAccess) -> String {
        self.used
            .record_shared_access(SharedArray::Slots, slot, access);
        let shape = Shape::Vector(self.slots.len());
        self.language.entry(SharedArray::Slots, shape, slot)
    }

    /// Returns a value with its sign, as an argument or a term: `-x` has no parentheses.
    pub fn signed_value(&mut self, edge: Edge) -> String {
        self.operand(edge).with_sign()
    }

    fn operand(&mut self, edge: Edge) -> Operand {
        let node = edge.node();
        let negative = edge.is_negative();
        match self
            .written
            .get(&node)
            .filter(|_| !self.here.contains(&node))
        {
            Some(written) => {
                let (array, shape, place) = written.place;
                self.used
                    .record_shared_access(array, place, ArrayAccess::Read);
                Operand {
                    value: self.language.entry(array, shape, place),
                    negative: negative != written.negative,
                }
            }
            None => Operand {
                value: self.value(node),
                negative,
            },
        }
    }

    /// Returns a result that is written separately: numbers are literals.
    pub fn result_expression(&mut self, edge: Edge) -> String {
        match self.places.of(edge.node(), self.time) {
            Place::Number => {
                let sign = if edge.is_negative() { "-" } else { "" };
                let literal = self.language.literal(self.places.graph(), edge.node());
                format!("{sign}{literal}")
            }
            _ => self.signed_value(edge),
        }
    }

    /// Returns the statement that binds a number to its name.
    pub fn number(&self, node: NodeId) -> String {
        let name = self.locals.name_of(node);
        self.language
            .number_binding(self.places.graph(), node, name)
    }

    /// Prints a statement; values that have a slot are copied to it at once.
    pub fn statement(&mut self, statement: &Statement) -> String {
        if let Operation::Check(cause, edge) = statement.operation {
            self.used.checks = true;
            let operand = self.operand(edge);
            return self.language.check(&operand, cause, self.program);
        }
        let name = |node: NodeId| self.locals.name_of(node);
        let heading = self.heading_of(statement);
        let mut text = match &statement.operation {
            Operation::SinCos(angle) => {
                let names = statement.results.map(|node| node.map(name));
                let angle = self.operand(*angle);
                self.language.pair(names, &angle)
            }
            Operation::Call(call) => {
                let expression = self.expression(&statement.operation);
                format!("let {} = {expression};\n", self.pattern(call))
            }
            operation => {
                let name = statement.results[0].map_or("_", name);
                let expression = self.expression(operation);
                self.language.binding(name, &expression)
            }
        };
        text.insert_str(0, &heading);
        for node in statement.defined() {
            self.here.insert(node);
            if let Some(&slot) = self.slots.get(&node) {
                let slot = self.slot(slot, ArrayAccess::Written);
                text.push_str(&format!("{slot} = {};\n", self.locals.name_of(node)));
            }
        }
        text
    }

    /// Returns the heading of a statement, if it differs from that of the statement before.
    fn heading_of(&mut self, statement: &Statement) -> String {
        let mut headings = statement
            .defined()
            .filter_map(|node| self.headings.get(&node));
        match headings.next() {
            Some(heading) if **heading != *self.heading => {
                self.heading = heading;
                heading.to_string()
            }
            _ => String::new(),
        }
    }

    /// Returns the pattern that binds the result of an external function; a matrix of slopes by rows.
    fn pattern(&self, call: &Call) -> String {
        let name = |node: &Option<NodeId>| node.map_or("_", |node| self.locals.name_of(node));
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

    /// Returns the expression of an operation with one result.
    pub fn expression(&mut self, operation: &Operation) -> String {
        match *operation {
            Operation::Add(a, b) => {
                let [mut a, mut b] = [a, b].map(|edge| self.operand(edge));
                if a.negative && !b.negative {
                    std::mem::swap(&mut a, &mut b);
                }
                let sign = if b.negative { "-" } else { "+" };
                format!("{} {sign} {}", a.with_sign(), b.value)
            }
            Operation::Multiply(a, b) => {
                format!("{} * {}", self.signed_value(a), self.signed_value(b))
            }
            Operation::Divide(a, b) => {
                format!("{} / {}", self.signed_value(a), self.signed_value(b))
            }
            Operation::Fused(a, b, c) => {
                let operands = [a, b, c].map(|edge| self.operand(edge));
                self.language.fused(&operands)
            }
            Operation::Atan2(y, x) => {
                let operands = [y, x].map(|edge| self.operand(edge));
                self.language.atan2(&operands)
            }
            Operation::Select(c, a, b) => {
                let operands = [c, a, b].map(|edge| self.operand(edge));
                self.language.select(&operands)
            }
            Operation::Apply(function, a) => {
                let operand = self.operand(a);
                self.language.function(function, &operand)
            }
            // Printed by `statement` as statements of their own.
            Operation::SinCos(a) | Operation::Check(_, a) => self.signed_value(a),
            Operation::Call(ref call) => {
                let given: Vec<String> = call
                    .arguments
                    .iter()
                    .map(|&a| self.signed_value(a))
                    .collect();
                let [value, slopes] = &self.externals.methods[call.function];
                let method = if call.slopes { slopes } else { value };
                let field = &self.externals.field;
                format!("self.{field}.{method}({})", given.join(", "))
            }
        }
    }
}
