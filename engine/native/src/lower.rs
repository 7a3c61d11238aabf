//! Lowers the steps of a tape to Cranelift's intermediate code, with values placed by the plan of [`crate::spill`].
//!
//! Code has one lane or two. With two lanes, every list holds pairs, one number of each lane, and a lane has the same
//! bits as alone.

use crate::spill::{Home, is_call};
use crate::target::{Pool, Target};
use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{
    AbiParam, Block, FuncRef, InstBuilder, MemFlags, Signature, StackSlot, Type, Value, types,
};
use cranelift_frontend::{FuncInstBuilder, FunctionBuilder};
use hamel::trig::{self, Arithmetic};
use hamel_codegen::algebra::graph::Function;
use hamel_codegen::program::Cause;
use hamel_codegen::program::tape::{ARGUMENTS, Operand, Source, Step};
use std::collections::HashMap;

/// The bits of infinity.
const INFINITY_BITS: i64 = f64::INFINITY.to_bits().cast_signed();
/// The bits of the smallest number that is not subnormal.
const MIN_NORMAL_BITS: i64 = f64::MIN_POSITIVE.to_bits().cast_signed();
/// Status of a function that succeeded.
pub const STATUS_SUCCESS: i32 = 0;
/// Status if the tape has to be evaluated step by step. Positive numbers denote causes, from 1.
pub const STATUS_INTERPRET: i32 = -1;
/// Smaller arguments of `Inverse` are replaced by this one.
const MIN_INVERSE_ARGUMENT: f64 = 1e-100;

/// References to the functions that code calls.
pub type Callees = HashMap<Callee, FuncRef>;

/// The function that code calls for a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Callee {
    /// A function of one number.
    Apply(Function),
    /// The angle of (x, y), arguments (y, x).
    Atan2,
}

/// Returns the function called for a step, if any.
pub fn callee(step: &Step) -> Option<Callee> {
    match *step {
        _ if !is_call(step) => None,
        Step::Atan2(..) => Some(Callee::Atan2),
        Step::Apply(function, _) => Some(Callee::Apply(function)),
        _ => None,
    }
}

/// Addresses of the constants, of the result, and of the arguments; returns a status.
pub fn signature(mut empty: Signature, pointer: Type) -> Signature {
    let addresses = 2 + ARGUMENTS.len();
    empty
        .params
        .extend([AbiParam::new(pointer)].repeat(addresses));
    empty.returns.push(AbiParam::new(types::I32));
    empty
}

/// The frame for values that are in no register.
#[derive(Clone, Copy)]
pub enum Frame {
    /// No frame: no value needs one.
    None,
    /// On the stack of this function.
    Own(StackSlot),
    /// On the stack of its caller, from this address on.
    Given(Value),
}

/// Writes a function.
pub struct Writer<'a, 'b> {
    /// Builder to which instructions are added.
    pub builder: &'a mut FunctionBuilder<'b>,
    /// The numbers that code reads.
    pub pool: &'a mut Pool,
    /// The target of the code.
    pub target: Target,
    /// The address of the constants.
    pub constants: Value,
    /// The address of the result.
    pub out: Value,
    /// The addresses of the arguments.
    pub arguments: [Value; 5],
    /// The block that returns a status.
    pub ends: Block,
    pub frame: Frame,
}

impl<'a, 'b> Writer<'a, 'b> {
    /// Returns the inserter of the next instruction.
    fn ins(&mut self) -> FuncInstBuilder<'_, 'b> {
        self.builder.ins()
    }

    /// Computes (sin x, cos x); returns from the function if x is too large or NaN.
    fn sin_cos(&mut self, x: Value) -> [Value; 2] {
        let size = self.ins().fabs(x);
        let farthest = self.constant(trig::FARTHEST);
        let near = self.ins().fcmp(FloatCC::LessThanOrEqual, size, farthest);
        let near = match self.target.paired {
            true => self.ins().vall_true(near),
            false => near,
        };
        self.end_unless(near, STATUS_INTERPRET);
        let reduced = trig::reduced(self, x);
        let row = self.row(reduced.shifted);
        trig::turned(self, row, reduced)
    }

    /// Loads the row of [`trig::TURNED`] whose index is in the last two bits.
    fn row(&mut self, shifted: Value) -> [Value; 4] {
        let start = self.pool.turned();
        let rows: Vec<[Value; 4]> = self
            .alone(shifted)
            .into_iter()
            .map(|shifted| {
                let constants = self.constants;
                let bits = self.ins().bitcast(types::I64, MemFlags::new(), shifted);
                let quadrant = self.ins().band_imm(bits, 3);
                // A row has four entries.
                let length = i64::from(self.target.bytes(4).ilog2());
                let away = self.ins().ishl_imm(quadrant, length);
                let row = self.ins().iadd(constants, away);
                [0, 1, 2, 3].map(|i| {
                    let (flags, place) = (self.target.flags(), self.target.bytes(start + i));
                    self.ins().load(types::F64, flags, row, place)
                })
            })
            .collect();
        [0, 1, 2, 3].map(|i| {
            let entries: Vec<Value> = rows.iter().map(|row| row[i]).collect();
            self.together(&entries)
        })
    }

    /// Extracts the numbers of a value, lane by lane.
    fn alone(&mut self, value: Value) -> Vec<Value> {
        match self.target.paired {
            true => vec![
                self.ins().extractlane(value, 0),
                self.ins().extractlane(value, 1),
            ],
            false => vec![value],
        }
    }

    /// Builds the value with these numbers in its lanes.
    fn together(&mut self, lanes: &[Value]) -> Value {
        match *lanes {
            [first, second] => {
                let value = self.ins().scalar_to_vector(types::F64X2, first);
                self.ins().insertlane(value, second, 1)
            }
            [one] => one,
            _ => self.constant(f64::NAN),
        }
    }

    /// Selects per lane: one value where a comparison holds, otherwise another.
    fn choose(&mut self, (a, how, b): (Value, FloatCC, Value), then: Value, other: Value) -> Value {
        let holds = self.ins().fcmp(how, a, b);
        match self.target.paired {
            true => {
                let mask = self.ins().bitcast(types::F64X2, MemFlags::new(), holds);
                self.ins().bitselect(mask, then, other)
            }
            false => self.ins().select(holds, then, other),
        }
    }

    /// Returns a number, in all lanes.
    pub fn constant(&mut self, number: f64) -> Value {
        let place = self.pool.place(number);
        self.load(self.constants, place)
    }

    fn end_unless(&mut self, condition: Value, code: i32) {
        let well = self.builder.create_block();
        let code = self.ins().iconst(types::I32, i64::from(code));
        let ends = self.ends;
        self.ins().brif(condition, well, &[], ends, &[code.into()]);
        self.builder.switch_to_block(well);
    }

    fn load(&mut self, base: Value, place: usize) -> Value {
        let target = self.target;
        self.ins()
            .load(target.number(), target.flags(), base, target.bytes(place))
    }

    /// Stores a number in a list.
    pub fn store(&mut self, value: Value, base: Value, place: usize) {
        let target = self.target;
        self.ins()
            .store(target.flags(), value, base, target.bytes(place));
    }

    /// Stores a value in its slot of the frame.
    pub fn keep(&mut self, value: Value, slot: usize) {
        let place = self.target.bytes(slot);
        match self.frame {
            Frame::Own(stack) => {
                self.ins().stack_store(value, stack, place);
            }
            Frame::Given(address) => self.store(value, address, slot),
            Frame::None => {}
        }
    }

    /// Loads a value from memory.
    pub fn fetch(&mut self, home: Home) -> Value {
        match home {
            Home::Given(Source::Number(number)) => self.constant(number),
            Home::Given(Source::Constant(place)) => self.load(self.constants, place),
            Home::Given(Source::Argument(argument, place)) => {
                let index = ARGUMENTS.iter().position(|&of| of == argument);
                let base = self.arguments[index.unwrap_or(0)];
                self.load(base, place)
            }
            Home::Out(place) => self.load(self.out, place),
            Home::Slot(slot) => match self.frame {
                Frame::Own(stack) => {
                    let target = self.target;
                    self.ins()
                        .stack_load(target.number(), stack, target.bytes(slot))
                }
                Frame::Given(address) => self.load(address, slot),
                Frame::None => self.constant(f64::NAN),
            },
            // The plan loads only values that are in memory.
            Home::Given(Source::Value(_)) | Home::None => self.constant(f64::NAN),
        }
    }

    /// Returns the value or its negative.
    pub fn signed(&mut self, (value, negative): (Value, bool)) -> Value {
        match negative {
            true => self.ins().fneg(value),
            false => value,
        }
    }

    /// Writes one step; `dies` flags the operands that are not read again.
    pub fn step(
        &mut self,
        step: &Step,
        values: [(Value, bool); 3],
        dies: [bool; 3],
        callees: &Callees,
        causes: &mut Vec<Cause>,
    ) -> Option<[Value; 2]> {
        let [a, b, c] = values;
        let one = match *step {
            Step::Add(..) => match (a.1, b.1) {
                (false, false) => self.ins().fadd(a.0, b.0),
                (false, true) => self.ins().fsub(a.0, b.0),
                (true, false) => self.ins().fsub(b.0, a.0),
                (true, true) => {
                    // Not −(a + b), in which a zero has the other sign.
                    let first = self.ins().fneg(a.0);
                    self.ins().fsub(first, b.0)
                }
            },
            Step::Multiply(..) => {
                let product = self.ins().fmul(a.0, b.0);
                self.signed((product, a.1 != b.1))
            }
            Step::Divide(..) => {
                let quotient = self.ins().fdiv(a.0, b.0);
                self.signed((quotient, a.1 != b.1))
            }
            Step::Fused(..) => {
                // The instruction overwrites its first factor.
                let (first, second) = match dies[1] && !dies[0] {
                    true => (b.0, a.0),
                    false => (a.0, b.0),
                };
                if self.target.fused {
                    let first = self.signed((first, a.1 != b.1));
                    let sum = self.signed(c);
                    self.ins().fma(first, second, sum)
                } else {
                    let product = self.ins().fmul(a.0, b.0);
                    let product = (product, a.1 != b.1);
                    return self.step(
                        &Step::Add(NONE, NONE),
                        [product, c, c],
                        dies,
                        callees,
                        causes,
                    );
                }
            }
            Step::SinCos(_) => {
                let angle = self.signed(a);
                return Some(self.sin_cos(angle));
            }
            Step::Apply(Function::Sqrt | Function::Norm, _) => {
                let a = self.signed(a);
                self.ins().sqrt(a)
            }
            Step::Apply(Function::Abs, _) => self.ins().fabs(a.0),
            Step::Apply(Function::Sign, _) => {
                let a = self.signed(a);
                let (zero, one, minus) =
                    (self.constant(0.0), self.constant(1.0), self.constant(-1.0));
                let below = self.choose((a, FloatCC::LessThan, zero), minus, a);
                self.choose((a, FloatCC::GreaterThan, zero), one, below)
            }
            Step::Apply(Function::Inverse, _) => {
                let a = self.signed(a);
                let (shortest, one) = (self.constant(MIN_INVERSE_ARGUMENT), self.constant(1.0));
                let size = self.ins().fabs(a);
                let by = self.choose((size, FloatCC::LessThan, shortest), shortest, a);
                self.ins().fdiv(one, by)
            }
            Step::Apply(Function::Raised, _) => {
                let factor = (Function::Raised.row().value)(1.0);
                let (a, factor) = (self.signed(a), self.constant(factor));
                self.ins().fmul(a, factor)
            }
            Step::Apply(..) | Step::Atan2(..) => {
                let (a, b) = (self.signed(a), self.signed(b));
                let callee = callee(step).and_then(|callee| callees.get(&callee));
                let Some(&callee) = callee else {
                    let nan = self.constant(f64::NAN);
                    return Some([nan, nan]);
                };
                let (a, b) = (self.alone(a), self.alone(b));
                let mut results = Vec::with_capacity(a.len());
                for (a, b) in a.into_iter().zip(b) {
                    let call = match step {
                        Step::Atan2(..) => self.ins().call(callee, &[a, b]),
                        _ => self.ins().call(callee, &[a]),
                    };
                    results.push(self.builder.inst_results(call)[0]);
                }
                self.together(&results)
            }
            Step::Select(..) => {
                let [c, a, b] = values.map(|value| self.signed(value));
                let (zero, one) = (self.constant(0.0), self.constant(1.0));
                let other = self.choose((c, FloatCC::LessThan, one), b, c);
                self.choose((c, FloatCC::GreaterThan, zero), a, other)
            }
            Step::Check(cause, _) => {
                let pivot = self.signed(a);
                let known = causes.iter().position(|&known| known == cause);
                let place = known.unwrap_or_else(|| {
                    causes.push(cause);
                    causes.len() - 1
                });
                for pivot in self.alone(pivot) {
                    // Positive, finite and not subnormal, tested by its bits as in generated code.
                    let bits = self.ins().bitcast(types::I64, MemFlags::new(), pivot);
                    let bits = self.ins().iadd_imm(bits, -MIN_NORMAL_BITS);
                    let limit = self
                        .ins()
                        .iconst(types::I64, INFINITY_BITS - MIN_NORMAL_BITS);
                    let positive = self.ins().icmp(IntCC::UnsignedLessThan, bits, limit);
                    self.end_unless(
                        positive,
                        i32::try_from(place + 1).unwrap_or(STATUS_INTERPRET),
                    );
                }
                return None;
            }
        };
        Some([one, one])
    }
}

impl Arithmetic for Writer<'_, '_> {
    type Number = Value;

    fn is_fused(&self) -> bool {
        self.target.fused
    }

    fn number(&mut self, number: f64) -> Value {
        self.constant(number)
    }

    fn minus(&mut self, a: Value, b: Value) -> Value {
        self.ins().fsub(a, b)
    }

    fn times(&mut self, a: Value, b: Value) -> Value {
        self.ins().fmul(a, b)
    }

    fn times_plus(&mut self, a: Value, b: Value, c: Value) -> Value {
        if self.target.fused {
            return self.ins().fma(a, b, c);
        }
        let product = self.ins().fmul(a, b);
        self.ins().fadd(product, c)
    }

    fn less_times(&mut self, c: Value, a: Value, b: Value) -> Value {
        if self.target.fused {
            let a = self.ins().fneg(a);
            return self.ins().fma(a, b, c);
        }
        let product = self.ins().fmul(a, b);
        self.ins().fsub(c, product)
    }

    fn plus(&mut self, a: Value, b: Value) -> Value {
        self.ins().fadd(a, b)
    }
}

/// Operand of steps of which only the kind matters.
const NONE: Operand = Operand {
    source: Source::Number(0.0),
    negative: false,
};
