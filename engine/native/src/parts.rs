//! Compiles a tape as one function, or as several.
//!
//! Long tapes become several functions, which one more function calls in turn: the memory that Cranelift needs grows
//! with the length of a function, by a kilobyte and more for each instruction. Values that pass from one part to the
//! next are in the frame of the caller.

use crate::lower::{Callee, Callees, Frame, STATUS_SUCCESS, Writer, callee};
use crate::spill::{Action, Home, Id, Plan, plan};
use crate::target::{Pool, Target};
use cranelift_codegen::ir::{
    AbiParam, Block, FuncRef, InstBuilder, Signature, StackSlot, StackSlotData, StackSlotKind,
    Type, Value, types,
};
use cranelift_frontend::FunctionBuilder;
use hamel_codegen::program::Cause;
use hamel_codegen::program::tape::{ARGUMENTS, Source, Tape};
use std::collections::HashMap;

/// Largest number of steps of a function.
const MAX_STEPS_OF_PART: usize = 10_000;

/// Returns the signature of a part: in addition, it takes the address of the frame.
pub fn signature_of_part(mut whole: Signature, pointer: Type) -> Signature {
    whole.params.push(AbiParam::new(pointer));
    whole
}

/// A tape to be compiled.
pub struct Lowering<'a> {
    tape: &'a Tape,
    plan: Plan,
    /// The first result of every step.
    firsts: Vec<Id>,
    /// The entries of the result that are equal to each value.
    results: HashMap<Id, Vec<(usize, bool)>>,
    target: Target,
    /// The causes of pivots, in the order of their numbers.
    pub causes: Vec<Cause>,
}

impl<'a> Lowering<'a> {
    /// Plans the code of a tape.
    pub fn new(tape: &'a Tape, target: Target) -> Self {
        let mut results: HashMap<Id, Vec<(usize, bool)>> = HashMap::new();
        for (place, output) in tape.outputs.iter().enumerate() {
            if let Source::Value(value) = output.source {
                let entries = results.entry(value).or_default();
                entries.push((place, output.negative));
            }
        }
        let firsts = tape.steps.iter().scan(0, |next, step| {
            let first = *next;
            *next += step.results();
            Some(first)
        });
        Lowering {
            firsts: firsts.collect(),
            plan: plan(tape, MAX_STEPS_OF_PART),
            tape,
            results,
            target,
            causes: Vec::new(),
        }
    }

    /// Returns the number of functions for the tape; a single one is the whole function.
    pub fn parts(&self) -> usize {
        self.plan.parts.len()
    }

    /// Returns the functions that a part calls.
    pub fn calls(&self, part: usize) -> impl Iterator<Item = Callee> {
        let steps = self.plan.parts[part]
            .iter()
            .filter_map(|action| match action {
                Action::Step(index) => Some(&self.tape.steps[*index]),
                Action::Load(_) | Action::Store(_) => None,
            });
        steps.filter_map(callee)
    }

    /// Writes a part as a function, with [`signature_of_part`] if there are several.
    pub fn part(
        &mut self,
        part: usize,
        builder: &mut FunctionBuilder,
        pool: &mut Pool,
        callees: &Callees,
    ) {
        let (given, ends) = begin(builder);
        let frame = match given.get(2 + ARGUMENTS.len()) {
            Some(&address) => Frame::Given(address),
            // A function without a frame is faster to call.
            None if self.plan.slots == 0 => Frame::None,
            None => Frame::Own(self.stack(builder)),
        };
        let mut writer = Writer {
            pool,
            target: self.target,
            constants: given[0],
            out: given[1],
            arguments: [2, 3, 4, 5, 6].map(|place| given[place]),
            ends,
            frame,
            builder,
        };
        self.body(part, &mut writer, callees);
        end(builder, ends);
    }

    /// Writes the function that calls all parts in turn, until one fails.
    pub fn whole(&self, builder: &mut FunctionBuilder, parts: &[FuncRef], pointer: Type) {
        let (mut given, ends) = begin(builder);
        let stack = self.stack(builder);
        given.push(builder.ins().stack_addr(pointer, stack, 0));
        for &part in parts {
            let call = builder.ins().call(part, &given);
            let code = builder.inst_results(call)[0];
            let well = builder.create_block();
            builder.ins().brif(code, ends, &[code.into()], well, &[]);
            builder.switch_to_block(well);
        }
        end(builder, ends);
    }

    fn stack(&self, builder: &mut FunctionBuilder) -> StackSlot {
        let size = u32::try_from(self.target.bytes(self.plan.slots)).unwrap_or(u32::MAX);
        let alignment = if self.target.paired { 4 } else { 3 };
        let slots = StackSlotData::new(StackSlotKind::ExplicitSlot, size, alignment);
        builder.create_sized_stack_slot(slots)
    }

    fn body(&mut self, part: usize, w: &mut Writer, callees: &Callees) {
        let (tape, plan, causes) = (self.tape, &self.plan, &mut self.causes);
        let mut values: Vec<Option<Value>> = vec![None; plan.homes.len()];
        for action in &plan.parts[part] {
            match *action {
                Action::Load(id) => values[id] = Some(w.fetch(plan.homes[id])),
                Action::Store(id) => {
                    if let (Some(value), Home::Slot(slot)) = (values[id], plan.homes[id]) {
                        w.keep(value, slot);
                    }
                }
                Action::Step(index) => {
                    let step = &tape.steps[index];
                    let ids = plan.operands[index];
                    let first = values[ids[0]];
                    let mut read = [(first, false); 3];
                    let mut dies = [false; 3];
                    for (place, operand) in step.operands().enumerate() {
                        read[place] = (values[ids[place]], operand.negative);
                        dies[place] = plan.last[ids[place]] == Some(index);
                    }
                    let read = read.map(|(value, sign)| match value {
                        Some(value) => (value, sign),
                        None => (w.constant(f64::NAN), sign),
                    });
                    let Some(made) = w.step(step, read, dies, callees, causes) else {
                        continue;
                    };
                    let first = self.firsts[index];
                    for (id, made) in (first..).take(step.results()).zip(made) {
                        values[id] = Some(made);
                        for &(place, negative) in self.results.get(&id).into_iter().flatten() {
                            let value = w.signed((made, negative));
                            w.store(value, w.out, place);
                        }
                    }
                }
            }
        }
        if part + 1 < plan.parts.len() {
            return;
        }
        for (place, output) in tape.outputs.iter().enumerate() {
            if !matches!(output.source, Source::Value(_)) {
                let value = w.fetch(Home::Given(output.source));
                let value = w.signed((value, output.negative));
                w.store(value, w.out, place);
            }
        }
    }
}

/// Returns the arguments of a function, and the block that ends it with a status.
fn begin(builder: &mut FunctionBuilder) -> (Vec<Value>, Block) {
    let entry = builder.create_block();
    builder.append_block_params_for_function_params(entry);
    builder.switch_to_block(entry);
    let given = builder.block_params(entry).to_vec();
    let ends = builder.create_block();
    builder.set_cold_block(ends);
    builder.append_block_param(ends, types::I32);
    (given, ends)
}

/// Writes the successful end of a function here, and the end with a status in its last block.
fn end(builder: &mut FunctionBuilder, ends: Block) {
    let well = builder.ins().iconst(types::I32, i64::from(STATUS_SUCCESS));
    builder.ins().return_(&[well]);
    builder.switch_to_block(ends);
    let code = builder.block_params(ends)[0];
    builder.ins().return_(&[code]);
    builder.seal_all_blocks();
}
