//! Executable memory and calls into it: all `unsafe` code of this project.
//!
//! Calls are sound for these reasons:
//! - The code of a function is made by [`Lowering`] only, from a tape whose steps read nothing that comes after them.
//!   It reads whole entries of the constants and the five arguments, and writes to the result and to its own stack. The
//!   parts of a long function are called by it only, with the address of its stack, which has room for all of them. The
//!   greatest index that it can access in each of the seven slices is known from the tape (`AccessLengths`) before the
//!   code is made, and every call compares lengths with it. Indices are less than `MAX_ENTRIES`, so that no offset is too
//!   large for an instruction.
//! - Frames longer than a page touch the pages of the stack in order: a stack overflow ends the process, as in Rust,
//!   without access to other memory.
//! - Code reads 64-bit numbers from slices of `f64`, for which any bits are valid.
//! - The result is borrowed exclusively, so that no memory that is read changes while it is written.
//! - Code is finished, and its memory made executable and read-only, before the address of a function is taken; the
//!   address has the signature given by [`signature`].
//! - Memory is freed when the last owner of [`Code`] is dropped, and addresses never leave it.
//! - Code has no state except its arguments, so it can be called from many threads at once.

#![allow(unsafe_code)]

use crate::code_error::CodeError;
use crate::evaluate::apply;
use crate::lower::{Callee, STATUS_INTERPRET, STATUS_SUCCESS, callee, signature};
use crate::parts::{Lowering, signature_of_part};
use crate::target::{Pool, Target};
use cranelift_codegen::Context;
use cranelift_codegen::ir::{AbiParam, FuncRef, Signature, types};
use cranelift_codegen::settings::{Configurable, Flags, builder};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Linkage, Module, default_libcall_names};
use hamel_codegen::algebra::for_each_function;
use hamel_codegen::algebra::graph::Function;
use hamel_codegen::program::Cause;
use hamel_codegen::program::tape::{ARGUMENTS, Source, Tape, Tapes};
use std::collections::HashMap;
use std::error::Error;
use std::fmt;
use std::mem::ManuallyDrop;

type Entry = unsafe extern "C" fn(
    *const f64,
    *mut f64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
) -> i32;

/// Functions with more steps, and slices with more entries, get no code.
const MAX_ENTRIES: usize = 1 << 26;

/// Outcome of a call of machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CallOutcome {
    /// The result is written.
    Success,
    /// A pivot was not positive.
    Pivot(Cause),
    /// Nothing meaningful is written: the tape has to be evaluated step by step.
    Interpret,
}

/// A compiled function.
struct Callable {
    entry: Entry,
    reach: AccessLengths,
    causes: Vec<Cause>,
}

/// Lengths of the slices that a function accesses.
#[derive(Clone, Copy, Debug, Default)]
struct AccessLengths {
    constants: usize,
    out: usize,
    arguments: [usize; 5],
}

impl AccessLengths {
    fn of(tape: &Tape) -> Self {
        let mut reach = AccessLengths {
            out: tape.outputs.len(),
            ..AccessLengths::default()
        };
        let read = tape.steps.iter().flat_map(|step| step.operands());
        for operand in read.chain(tape.outputs.iter().copied()) {
            match operand.source {
                Source::Constant(place) => reach.constants = reach.constants.max(place + 1),
                Source::Argument(argument, place) => {
                    for (of, reach) in ARGUMENTS.iter().zip(&mut reach.arguments) {
                        if *of == argument {
                            *reach = (*reach).max(place + 1);
                        }
                    }
                }
                Source::Number(_) | Source::Value(_) => {}
            }
        }
        reach
    }

    /// Scales the lengths to slices with `lanes` numbers in place of each.
    fn of_lanes(self, lanes: usize) -> Self {
        AccessLengths {
            constants: lanes * self.constants,
            out: lanes * self.out,
            arguments: self.arguments.map(|place| lanes * place),
        }
    }
}

/// Functions in memory, in the order of [`Tapes::all`].
pub struct Code {
    functions: Vec<Callable>,
    size: usize,
    module: ManuallyDrop<JITModule>,
}

// SAFETY: between `new` and `drop`, which has exclusive access, the module is not used, and the memory behind the
// addresses is not written.
unsafe impl Send for Code {}
// SAFETY: as above; calls share nothing except code.
unsafe impl Sync for Code {}

impl fmt::Debug for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let functions = self.functions.len();
        write!(f, "{functions} functions, {} bytes", self.size)
    }
}

impl Drop for Code {
    fn drop(&mut self) {
        // SAFETY: the module is taken once, here. All addresses of its functions are dropped with `self`, and a caller
        // of one of them borrows `self`.
        unsafe { ManuallyDrop::take(&mut self.module).free_memory() }
    }
}

/// Returns whether a b + c is one instruction of this machine.
pub fn is_fused() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    true
}

extern "C" fn atan2(y: f64, x: f64) -> f64 {
    hamel::Scalar::atan2(y, x)
}

/// Gives each function of one argument a symbol of its own.
macro_rules! symbols {
    ($($function:ident $call:tt)*) => {
        /// Returns the name and the address of a function that code calls.
        fn known(callee: Callee) -> (&'static str, *const u8) {
            match callee {
                Callee::Atan2 => ("hamel_atan2", atan2 as *const u8),
                $(Callee::Apply(Function::$function) => {
                    extern "C" fn called(a: f64) -> f64 {
                        apply(Function::$function, a)
                    }
                    (concat!("hamel_", stringify!($function)), called as *const u8)
                })*
            }
        }
    };
}
for_each_function!(symbols);

impl Code {
    /// Compiles tapes. Returns also the numbers that have to follow the constants in every call.
    ///
    /// # Errors
    /// If no code can be made on this machine, with the reason.
    pub fn new(tapes: &Tapes, target: Target) -> Result<(Self, Vec<f64>), CodeError> {
        let mut flags = builder();
        for (name, value) in [
            ("opt_level", "none"),
            (
                "enable_verifier",
                if target.verified { "true" } else { "false" },
            ),
            ("use_colocated_libcalls", "false"),
            ("is_pic", "false"),
            ("unwind_info", "false"),
            // Frames longer than a page of the stack touch all its pages in order.
            ("enable_probestack", "true"),
            ("probestack_strategy", "inline"),
        ] {
            flags.set(name, value).map_err(cranelift)?;
        }
        let machine = cranelift_native::builder().map_err(CodeError::UnknownMachine)?;
        let machine = machine.finish(Flags::new(flags));
        let machine = machine.map_err(cranelift)?;
        if machine.pointer_bits() != 64 {
            return Err(CodeError::NarrowAddresses);
        }
        let calls: Vec<Callee> = tapes
            .all()
            .flat_map(|tape| &tape.steps)
            .filter_map(callee)
            .collect();
        let mut jit = JITBuilder::with_isa(machine, default_libcall_names());
        for (name, address) in calls.iter().map(|&callee| known(callee)) {
            jit.symbol(name, address);
        }
        let mut code_builder = CodeBuilder {
            module: ManuallyDrop::new(JITModule::new(jit)),
            pool: Pool::behind(tapes.kept()),
            context: FunctionBuilderContext::new(),
            size: 0,
            target,
        };
        let made: Result<Vec<(FuncId, Vec<Cause>)>, CodeError> = tapes
            .all()
            .enumerate()
            .map(|(index, tape)| code_builder.function(index, tape))
            .collect();
        let made = made.and_then(|made| {
            let finished = code_builder.module.finalize_definitions();
            finished.map_err(cranelift)?;
            Ok(made)
        });
        let CodeBuilder {
            module, pool, size, ..
        } = code_builder;
        let made = match made {
            Ok(made) => made,
            Err(why) => {
                // SAFETY: no address was taken.
                unsafe { ManuallyDrop::into_inner(module).free_memory() }
                return Err(why);
            }
        };
        let functions: Vec<Callable> = made
            .into_iter()
            .zip(tapes.all())
            .map(|((id, causes), tape)| {
                let address = module.get_finalized_function(id);
                // SAFETY: the function was declared with `signature`, which has these arguments and this result.
                let entry = unsafe { std::mem::transmute::<*const u8, Entry>(address) };
                let mut reach = AccessLengths::of(tape);
                reach.constants = reach.constants.max(pool.start + pool.numbers.len());
                let reach = reach.of_lanes(target.lanes());
                Callable {
                    entry,
                    reach,
                    causes,
                }
            })
            .collect();
        let code = Code {
            functions,
            size,
            module,
        };
        Ok((code, pool.numbers))
    }

    /// Returns the size of the code in bytes.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Calls a function. Returns [`CallOutcome::Interpret`] if a slice is shorter than the function accesses.
    #[inline]
    pub fn call(
        &self,
        function: usize,
        constants: &[f64],
        arguments: [&[f64]; 5],
        out: &mut [f64],
    ) -> CallOutcome {
        let Some(Callable {
            entry,
            reach,
            causes,
        }) = self.functions.get(function)
        else {
            return CallOutcome::Interpret;
        };
        let [x, xi, u, xi_dot, p] = arguments;
        // All comparisons at once: a branch for each would take longer than a small function.
        let short = (constants.len() < reach.constants)
            | (out.len() < reach.out)
            | (x.len() < reach.arguments[0])
            | (xi.len() < reach.arguments[1])
            | (u.len() < reach.arguments[2])
            | (xi_dot.len() < reach.arguments[3])
            | (p.len() < reach.arguments[4]);
        if short {
            return CallOutcome::Interpret;
        }
        // SAFETY: `entry` is code of `self.module`, which is alive; all seven slices have the entries that it accesses,
        // as just compared, and `out` is borrowed exclusively.
        let code = unsafe {
            entry(
                constants.as_ptr(),
                out.as_mut_ptr(),
                x.as_ptr(),
                xi.as_ptr(),
                u.as_ptr(),
                xi_dot.as_ptr(),
                p.as_ptr(),
            )
        };
        outcome(code, causes)
    }
}

/// A function whose argument lengths are known at compile time, so that they are compared only once.
#[derive(Clone, Copy)]
pub struct Fixed<'a, const X: usize, const V: usize, const U: usize, const OUT: usize> {
    callable: &'a Callable,
    constants: &'a [f64],
}

impl<'a, const X: usize, const V: usize, const U: usize, const OUT: usize> Fixed<'a, X, V, U, OUT> {
    /// Returns a function of x, ξ and u; `None` if it accesses more entries than these lengths, or other arguments.
    pub fn new(code: &'a Code, function: usize, constants: &'a [f64]) -> Option<Self> {
        let callable = code.functions.get(function)?;
        let AccessLengths {
            constants: kept,
            out,
            arguments: [x, xi, u, xi_dot, p],
        } = callable.reach;
        let fits = kept <= constants.len() && out <= OUT && x <= X && xi <= V && u <= U;
        (fits && xi_dot == 0 && p == 0).then_some(Fixed {
            callable,
            constants,
        })
    }

    /// Calls the function.
    #[inline]
    pub fn call(
        &self,
        x: &[f64; X],
        xi: &[f64; V],
        u: &[f64; U],
        out: &mut [f64; OUT],
    ) -> CallOutcome {
        let Callable { entry, causes, .. } = self.callable;
        let none = std::ptr::null();
        // SAFETY: the code lives as long as `'a`. Constants, `out`, x, ξ and u have the entries that it accesses, as
        // compared in `new`; it does not access the last two arguments, and `out` is borrowed exclusively.
        let code = unsafe {
            entry(
                self.constants.as_ptr(),
                out.as_mut_ptr(),
                x.as_ptr(),
                xi.as_ptr(),
                u.as_ptr(),
                none,
                none,
            )
        };
        outcome(code, causes)
    }
}

/// Converts the status that a function returned.
#[inline]
fn outcome(code: i32, causes: &[Cause]) -> CallOutcome {
    match code {
        STATUS_SUCCESS => CallOutcome::Success,
        STATUS_INTERPRET => CallOutcome::Interpret,
        code => {
            let place = usize::try_from(code - 1).ok();
            let cause = place.and_then(|place| causes.get(place));
            cause.map_or(CallOutcome::Interpret, |&cause| CallOutcome::Pivot(cause))
        }
    }
}

/// Keeps an error of Cranelift.
fn cranelift(error: impl Error + Send + Sync + 'static) -> CodeError {
    CodeError::Cranelift(Box::new(error))
}

/// The compiler with its module and buffers.
struct CodeBuilder {
    module: ManuallyDrop<JITModule>,
    pool: Pool,
    context: FunctionBuilderContext,
    size: usize,
    target: Target,
}

impl CodeBuilder {
    fn function(&mut self, index: usize, tape: &Tape) -> Result<(FuncId, Vec<Cause>), CodeError> {
        if !tape.is_in_order() {
            return Err(CodeError::Disordered {
                function: tape.name.clone(),
            });
        }
        let reach = AccessLengths::of(tape);
        let lists = reach
            .arguments
            .into_iter()
            .chain([reach.out, reach.constants]);
        let largest = lists.chain([tape.values(), self.pool.start]).max();
        if largest.is_some_and(|largest| largest > MAX_ENTRIES) {
            return Err(CodeError::TooLong {
                function: tape.name.clone(),
            });
        }
        let pointer = self.module.target_config().pointer_type();
        let whole = signature(self.module.make_signature(), pointer);
        let mut lowering = Lowering::new(tape, self.target);
        let name = format!("hamel_{index}");
        if lowering.parts() == 1 {
            let id = self.part(&name, whole, &mut lowering, 0)?;
            return Ok((id, lowering.causes));
        }
        let parts: Result<Vec<FuncId>, CodeError> = (0..lowering.parts())
            .map(|part| {
                let signature = signature_of_part(whole.clone(), pointer);
                self.part(&format!("{name}_{part}"), signature, &mut lowering, part)
            })
            .collect();
        let parts = parts?;
        let mut context = self.module.make_context();
        context.func.signature = whole;
        let parts: Vec<FuncRef> = parts
            .into_iter()
            .map(|part| self.module.declare_func_in_func(part, &mut context.func))
            .collect();
        let mut builder = FunctionBuilder::new(&mut context.func, &mut self.context);
        lowering.whole(&mut builder, &parts, pointer);
        builder.finalize();
        let id = self.defined(&name, context)?;
        Ok((id, lowering.causes))
    }

    /// Compiles a part of a tape to a function.
    fn part(
        &mut self,
        name: &str,
        signature: Signature,
        lowering: &mut Lowering,
        part: usize,
    ) -> Result<FuncId, CodeError> {
        let mut context = self.module.make_context();
        context.func.signature = signature;
        let mut callees = HashMap::new();
        for callee in lowering.calls(part) {
            let (name, _) = known(callee);
            if callees.contains_key(&callee) {
                continue;
            }
            let mut signature = self.module.make_signature();
            let count = if callee == Callee::Atan2 { 2 } else { 1 };
            signature.params = vec![AbiParam::new(types::F64); count];
            signature.returns.push(AbiParam::new(types::F64));
            let declared = self
                .module
                .declare_function(name, Linkage::Import, &signature)
                .map_err(cranelift)?;
            let here = self
                .module
                .declare_func_in_func(declared, &mut context.func);
            callees.insert(callee, here);
        }
        let mut builder = FunctionBuilder::new(&mut context.func, &mut self.context);
        lowering.part(part, &mut builder, &mut self.pool, &callees);
        builder.finalize();
        self.defined(name, context)
    }

    /// Compiles a function and defines it in the module.
    fn defined(&mut self, name: &str, mut context: Context) -> Result<FuncId, CodeError> {
        let id = self
            .module
            .declare_function(name, Linkage::Local, &context.func.signature)
            .map_err(cranelift)?;
        self.module
            .define_function(id, &mut context)
            .map_err(cranelift)?;
        let compiled = context.compiled_code();
        self.size += compiled.map_or(0, |code| code.code_info().total_size as usize);
        Ok(id)
    }
}
