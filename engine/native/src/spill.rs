//! Plans which values of a tape are in registers, before it is lowered.
//!
//! All arguments and constants are in memory, and results are written to `out` as soon as they are computed. Therefore
//! a value that is in no register is often in memory already; otherwise it gets a slot on the stack. The value evicted
//! is the one read again last (Belady 1966), which is known, since tapes have no branches.
//!
//! A register allocator that sees a whole tape is slower than linear in the live values, and no better: with this plan
//! it never sees more of them than there are registers.

use hamel_codegen::program::tape::{Operand, Source, Step, Tape};
use std::collections::HashMap;

/// Registers for values. Two of sixteen remain for temporaries.
pub const REGISTERS: usize = 14;
/// Registers that sine and cosine need during their computation.
const SIN_COS_REGISTERS: usize = 8;

/// Index of a value: first the values of the tape, then those read from memory.
pub type Id = usize;

/// An action of the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// A value is read from memory.
    Load(Id),
    /// A value is written to its place on the stack.
    Store(Id),
    /// A step of the tape is computed; its operands are in registers.
    Step(usize),
}

/// The memory location of a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Home {
    /// None.
    None,
    /// An argument, a constant or a number.
    Given(Source),
    /// An entry of the result.
    Out(usize),
    /// A slot on the stack.
    Slot(usize),
}

/// The plan of a tape.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The actions of each part: no value stays in a register from one part to the next.
    pub parts: Vec<Vec<Action>>,
    /// The locations of values once they are in memory.
    pub homes: Vec<Home>,
    /// The number of slots of the stack.
    pub slots: usize,
    /// The operands of each step.
    pub operands: Vec<[Id; 3]>,
    /// The last step that reads each value.
    pub last: Vec<Option<usize>>,
}

/// Returns whether a step is computed by a call, which preserves no register.
pub fn is_call(step: &Step) -> bool {
    use hamel_codegen::algebra::graph::Function;
    match step {
        Step::Atan2(..) => true,
        Step::Apply(function, _) => !matches!(
            function,
            Function::Sqrt
                | Function::Norm
                | Function::Sign
                | Function::Abs
                | Function::Inverse
                | Function::Raised
        ),
        _ => false,
    }
}

/// Plans a tape, in equal parts of at most `longest` steps.
pub fn plan(tape: &Tape, longest: usize) -> Plan {
    let mut plan = Plan {
        parts: vec![Vec::new()],
        homes: homes(tape),
        slots: 0,
        operands: Vec::with_capacity(tape.steps.len()),
        last: Vec::new(),
    };
    let mut given: HashMap<(u8, u64), Id> = HashMap::new();
    for step in &tape.steps {
        let mut ids = [usize::MAX; 3];
        for (id, operand) in ids.iter_mut().zip(step.operands()) {
            *id = match operand.source {
                Source::Value(value) => value,
                source => *given.entry(key(source)).or_insert_with(|| {
                    plan.homes.push(Home::Given(source));
                    plan.homes.len() - 1
                }),
            };
        }
        plan.operands.push(ids);
    }
    let parts = tape.steps.len().div_ceil(longest).max(1);
    Planner::new(plan).run(tape, tape.steps.len().div_ceil(parts))
}

/// Returns the locations of values that are results, which are stored once they are computed.
fn homes(tape: &Tape) -> Vec<Home> {
    let mut homes = vec![Home::None; tape.values()];
    for (place, output) in tape.outputs.iter().enumerate() {
        if let Operand {
            source: Source::Value(value),
            negative: false,
        } = *output
            && let Some(home) = homes.get_mut(value)
        {
            *home = Home::Out(place);
        }
    }
    homes
}

/// Returns a key that is equal for equal sources.
fn key(source: Source) -> (u8, u64) {
    match source {
        Source::Argument(argument, index) => (argument as u8, index as u64),
        Source::Constant(index) => (100, index as u64),
        Source::Number(number) => (101, number.to_bits()),
        Source::Value(index) => (102, index as u64),
    }
}

struct Planner {
    plan: Plan,
    /// The remaining steps that read each value, the last first.
    uses: Vec<Vec<usize>>,
    held: Vec<Id>,
    free: Vec<usize>,
}

impl Planner {
    fn new(mut plan: Plan) -> Self {
        let mut uses = vec![Vec::new(); plan.homes.len()];
        for (step, ids) in plan.operands.iter().enumerate().rev() {
            for &id in ids.iter().filter(|&&id| id != usize::MAX) {
                let list: &mut Vec<usize> = &mut uses[id];
                if list.last() != Some(&step) {
                    list.push(step);
                }
            }
        }
        plan.last = uses.iter().map(|list| list.first().copied()).collect();
        Planner {
            plan,
            uses,
            held: Vec::with_capacity(REGISTERS),
            free: Vec::new(),
        }
    }

    fn run(mut self, tape: &Tape, length: usize) -> Plan {
        let mut next = 0;
        for (index, step) in tape.steps.iter().enumerate() {
            if index > 0 && index % length == 0 {
                self.leave(0, &[]);
                self.plan.parts.push(Vec::new());
            }
            let ids = self.plan.operands[index];
            let reads = || ids.into_iter().filter(|&id| id != usize::MAX);
            for id in reads() {
                if !self.held.contains(&id) {
                    self.leave(REGISTERS - 1, &ids);
                    self.act(Action::Load(id));
                    self.held.push(id);
                }
            }
            for id in reads() {
                // A step may read a value twice.
                if self.uses[id].last() == Some(&index) {
                    self.uses[id].pop();
                    if self.uses[id].is_empty() {
                        self.die(id);
                    }
                }
            }
            match step {
                Step::SinCos(_) => self.leave(REGISTERS - SIN_COS_REGISTERS, &[]),
                step if is_call(step) => self.leave(0, &[]),
                _ => {}
            }
            self.act(Action::Step(index));
            for id in next..next + step.results() {
                if !self.uses[id].is_empty() {
                    self.leave(REGISTERS - 1, &[]);
                    self.held.push(id);
                }
            }
            next += step.results();
        }
        self.plan
    }

    fn act(&mut self, action: Action) {
        if let Some(part) = self.plan.parts.last_mut() {
            part.push(action);
        }
    }

    /// Evicts values until `most` are left, but none of `stay`.
    fn leave(&mut self, most: usize, stay: &[Id]) {
        while self.held.len() > most {
            let places = 0..self.held.len();
            let furthest = places
                .filter(|&place| !stay.contains(&self.held[place]))
                .max_by_key(|&place| self.uses[self.held[place]].last());
            let Some(place) = furthest else { return };
            let id = self.held.swap_remove(place);
            if self.plan.homes[id] == Home::None {
                let slot = self.free.pop().unwrap_or_else(|| {
                    self.plan.slots += 1;
                    self.plan.slots - 1
                });
                self.plan.homes[id] = Home::Slot(slot);
                self.act(Action::Store(id));
            }
        }
    }

    /// Releases a value that is not read again.
    fn die(&mut self, id: Id) {
        self.held.retain(|&held| held != id);
        if let Home::Slot(slot) = self.plan.homes[id] {
            self.free.push(slot);
        }
    }
}
