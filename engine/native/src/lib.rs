//! Machine code from the tapes of generated functions, made at run time without a compiler.
//!
#![doc = include_str!("../README.md")]
//!
//! # How it works
//!
//! [`Compiled`] takes the [tapes](Tapes) of a program and lowers each function separately with Cranelift. A plan made
//! beforehand (`spill`) determines which values stay in registers and when the others are reloaded from memory.
//! Therefore the compile time is linear in the number of steps, and the code is nearly as fast as that of an optimising
//! compiler.
//!
//! Where no code can be made (on other processors, or on systems that refuse executable memory), tapes are interpreted
//! step by step: more slowly, with the same numbers up to rounding.
//!
//! | file | owns |
//! |---|---|
//! | `spill` | which values are in registers, and the locations of the others |
//! | `target` | the target of code, with one lane or two; the numbers that it reads |
//! | `lower` | the steps in Cranelift's intermediate code |
//! | `parts` | a tape as one function or, if it is long, as several called by one more |
//! | `code` | executable memory and calls into it: everything that is `unsafe` |
//! | `code_error` | reasons why there is no machine code |
//! | `no_code` | the replacement without the feature `machine`: no code can be made |
//! | `repeat` | functions whose result is their next argument, for one state or for two at once |
//! | `evaluate` | the interpreter of tapes |
//! | `traced` | algorithms in Rust as tapes |
//!
//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `machine` | machine code; without it all tapes are interpreted, on any target |

#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "machine")]
mod code;
mod code_error;
mod evaluate;
#[cfg(feature = "machine")]
mod lower;
#[cfg(not(feature = "machine"))]
mod no_code;
#[cfg(feature = "machine")]
mod parts;
mod repeat;
#[cfg(feature = "machine")]
mod spill;
#[cfg(feature = "machine")]
mod target;
mod traced;

pub use code_error::CodeError;
pub use evaluate::{evaluate, evaluate_in};
pub use hamel_codegen::program::tape::{ARGUMENTS, Foreign, Tape, Tapes};
pub use repeat::Paired;
pub use traced::{Traced, inlined, traced};

#[cfg(feature = "machine")]
use code::{CallOutcome, Code, Fixed};
use hamel::Scalar;
use hamel_codegen::program::{Cause, Function, Program};
#[cfg(not(feature = "machine"))]
use no_code as code;
#[cfg(not(feature = "machine"))]
use no_code::{CallOutcome, Code, Fixed, Target};
use std::sync::Arc;
#[cfg(feature = "machine")]
use target::Target;

/// Functions of a program that can be called, by machine code where possible.
#[derive(Clone, Debug)]
pub struct Compiled(Arc<Parts>);

#[derive(Debug)]
struct Parts {
    tapes: Tapes,
    /// Numbers that code reads, after the constants.
    numbers: Vec<f64>,
    code: Result<Code, CodeError>,
    fused: bool,
    verified: bool,
}

/// Parameters and the values that depend on them only, which calls take in addition to the arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct Constants(Vec<f64>, usize);

impl Constants {
    /// Returns the parameters, followed by the values that depend on them only.
    pub fn known(&self) -> &[f64] {
        self.0.get(..self.1).unwrap_or(&self.0)
    }
}

impl Compiled {
    /// Compiles functions of a program.
    ///
    /// # Errors
    /// If one of them calls a function in Rust.
    pub fn new(program: &Program, functions: &[&Function]) -> Result<Self, Foreign> {
        Ok(Compiled::of(Tapes::new(program, functions)?))
    }

    /// Compiles the functions of tapes.
    pub fn of(tapes: Tapes) -> Self {
        Compiled::made(tapes, false)
    }

    /// Compiles for tests of this crate: Cranelift first verifies its input, which takes time, and reports errors that
    /// would otherwise give wrong results.
    pub fn verified(tapes: Tapes) -> Self {
        Compiled::made(tapes, true)
    }

    fn made(tapes: Tapes, verified: bool) -> Self {
        let fused = code::is_fused();
        let target = Target {
            fused,
            paired: false,
            verified,
        };
        let (code, numbers) = match Code::new(&tapes, target) {
            Ok((code, numbers)) => (Ok(code), numbers),
            Err(why) => (Err(why), Vec::new()),
        };
        Compiled(Arc::new(Parts {
            tapes,
            numbers,
            code,
            fused,
            verified,
        }))
    }

    /// Interprets the functions of tapes step by step.
    pub fn interpreted(tapes: Tapes) -> Self {
        Compiled(Arc::new(Parts {
            tapes,
            numbers: Vec::new(),
            code: Err(CodeError::NotRequested),
            fused: code::is_fused(),
            verified: false,
        }))
    }

    /// Returns the reason if there is no machine code.
    pub fn interpreted_because(&self) -> Option<&CodeError> {
        self.0.code.as_ref().err()
    }

    /// Returns whether a step that the machine can round once is rounded once; the last digits depend on it.
    pub fn is_fused(&self) -> bool {
        self.0.fused
    }

    /// Returns the tapes.
    pub fn tapes(&self) -> &Tapes {
        &self.0.tapes
    }

    /// Returns the index of a function by its name.
    pub fn place(&self, name: &str) -> Option<usize> {
        let functions = self.0.tapes.functions.iter();
        functions.into_iter().position(|tape| tape.name == name)
    }

    /// Returns the size of the machine code in bytes.
    pub fn size(&self) -> usize {
        self.0.code.as_ref().map_or(0, Code::size)
    }

    /// Computes the values that depend on parameters only; missing parameters are NaN.
    pub fn constants(&self, parameters: &[f64]) -> Constants {
        let parts = &*self.0;
        let mut all = parameters.to_vec();
        all.resize(parts.tapes.parameters, f64::NAN);
        all.resize(parts.tapes.kept(), 0.0);
        all.extend_from_slice(&parts.numbers);
        let mut constants = Constants(all, parts.tapes.kept());
        let mut kept = vec![0.0; parts.tapes.constants.outputs.len()];
        // This tape checks no pivots.
        let _ = self.call(parts.tapes.functions.len(), &constants, [&[]; 5], &mut kept);
        constants.0[parts.tapes.parameters..parts.tapes.kept()].copy_from_slice(&kept);
        constants
    }

    /// Returns the cause if a pivot that depends on parameters only is not positive.
    pub fn singular(&self, constants: &Constants) -> Option<Cause> {
        let mut pivots = self.0.tapes.pivots.iter();
        let none: [&[f64]; 5] = [&[]; 5];
        let positive = |pivot| Scalar::is_positive(evaluate::read(pivot, &[], &constants.0, none));
        pivots
            .find(|(pivot, _)| !positive(*pivot))
            .map(|(_, cause)| *cause)
    }

    /// Calls a function with x, ξ followed by z, u, ξ̇ and p. Missing entries are NaN; `out` must have the length of
    /// the result.
    ///
    /// # Errors
    /// The cause of a pivot that is not positive; then `out` has no meaning.
    #[inline]
    pub fn call(
        &self,
        function: usize,
        constants: &Constants,
        arguments: [&[f64]; 5],
        out: &mut [f64],
    ) -> Result<(), Cause> {
        if let Ok(code) = &self.0.code {
            match code.call(function, &constants.0, arguments, out) {
                CallOutcome::Success => return Ok(()),
                CallOutcome::Pivot(cause) => return Err(cause),
                CallOutcome::Interpret => {}
            }
        }
        self.step(function, constants, arguments, out)
    }

    /// Returns a function of x, ξ and u for arguments of these lengths; `None` if the program has other lengths.
    pub fn sized<'a, const X: usize, const V: usize, const U: usize, const OUT: usize>(
        &'a self,
        function: usize,
        constants: &'a Constants,
    ) -> Option<Sized<'a, X, V, U, OUT>> {
        let [x, xi, u, ..] = self.0.tapes.lengths;
        let out = self.0.tapes.functions.get(function)?.outputs.len();
        let code = self.0.code.as_ref().ok();
        ((x, xi, u, out) == (X, V, U, OUT)).then(|| Sized {
            compiled: self,
            function,
            constants,
            fixed: code.and_then(|code| Fixed::new(code, function, &constants.0)),
        })
    }

    /// Interprets a function.
    #[cold]
    fn step(
        &self,
        function: usize,
        constants: &Constants,
        arguments: [&[f64]; 5],
        out: &mut [f64],
    ) -> Result<(), Cause> {
        match self.0.tapes.all().nth(function) {
            Some(tape) => evaluate(tape, self.0.fused, &constants.0, arguments, out),
            None => {
                out.fill(f64::NAN);
                Ok(())
            }
        }
    }
}

/// A function of x, ξ and u whose argument lengths are known at compile time: a call costs little more than the
/// function itself.
pub struct Sized<'a, const X: usize, const V: usize, const U: usize, const OUT: usize> {
    compiled: &'a Compiled,
    function: usize,
    constants: &'a Constants,
    fixed: Option<Fixed<'a, X, V, U, OUT>>,
}

impl<const X: usize, const V: usize, const U: usize, const OUT: usize> Sized<'_, X, V, U, OUT> {
    /// Calls the function; see [`Compiled::call`].
    ///
    /// # Errors
    /// The cause of a pivot that is not positive.
    #[inline]
    pub fn call(
        &self,
        x: &[f64; X],
        xi: &[f64; V],
        u: &[f64; U],
        out: &mut [f64; OUT],
    ) -> Result<(), Cause> {
        match self.fixed.as_ref().map(|fixed| fixed.call(x, xi, u, out)) {
            Some(CallOutcome::Success) => Ok(()),
            Some(CallOutcome::Pivot(cause)) => Err(cause),
            Some(CallOutcome::Interpret) | None => {
                let arguments: [&[f64]; 5] = [x, xi, u, &[], &[]];
                self.compiled
                    .step(self.function, self.constants, arguments, out)
            }
        }
    }
}
