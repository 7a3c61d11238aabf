//! Replacement for machine code where the crate is built without it. No code exists, so every call evaluates its tape
//! step by step.

// The interface of `code`, none of which can be called here.
#![allow(dead_code)]

use crate::code_error::CodeError;
use hamel_codegen::program::Cause;
use hamel_codegen::program::tape::Tapes;

/// Outcome of a call of machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CallOutcome {
    /// The result is written.
    Success,
    /// A pivot was not positive.
    Pivot(Cause),
    /// The tape has to be evaluated step by step.
    Interpret,
}

/// The instructions to generate code for.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Whether a b + c is one instruction.
    pub fused: bool,
    /// Whether code has two lanes.
    pub paired: bool,
    /// Whether Cranelift verifies its input before it compiles it.
    pub verified: bool,
}

/// Machine code: no value of this type exists.
#[derive(Debug)]
pub enum Code {}

impl Code {
    /// Returns an error, since no code can be made.
    ///
    /// # Errors
    /// Always, with the reason.
    pub fn new(_: &Tapes, _: Target) -> Result<(Self, Vec<f64>), CodeError> {
        Err(CodeError::NoGenerator)
    }

    pub fn size(&self) -> usize {
        match *self {}
    }

    pub fn call(&self, _: usize, _: &[f64], _: [&[f64]; 5], _: &mut [f64]) -> CallOutcome {
        match *self {}
    }
}

/// A function whose argument lengths are known at compile time: no value exists.
#[derive(Clone, Copy)]
pub struct Fixed<'a, const X: usize, const V: usize, const U: usize, const OUT: usize>(&'a Code);

impl<'a, const X: usize, const V: usize, const U: usize, const OUT: usize> Fixed<'a, X, V, U, OUT> {
    pub fn new(code: &'a Code, _: usize, _: &'a [f64]) -> Option<Self> {
        Some(Fixed(code))
    }

    pub fn call(
        &self,
        _: &[f64; X],
        _: &[f64; V],
        _: &[f64; U],
        _: &mut [f64; OUT],
    ) -> CallOutcome {
        match *self.0 {}
    }
}

/// Returns whether a b + c is rounded once. Always false: a fused product in software would be slow.
pub fn is_fused() -> bool {
    false
}
