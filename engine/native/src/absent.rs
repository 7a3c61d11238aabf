//! What stands in for machine code where the crate is built without it: there is never any, so that every call
//! evaluates its tape step by step.

// The interface is that of `code`, of which nothing can be called here.
#![allow(dead_code)]

use hamel_codegen::program::Cause;
use hamel_codegen::program::tape::Tapes;

/// How a call ends that machine code would have answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// The result is written.
    Well,
    /// A pivot is not positive.
    At(Cause),
    /// The tape has to be evaluated step by step.
    Undone,
}

/// What code would be written for.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Whether a b + c is one instruction.
    pub fused: bool,
    /// Whether there are two lanes.
    pub paired: bool,
    /// Whether Cranelift looks at what it is given before it makes code of it.
    pub verified: bool,
}

/// Machine code: no value of this type exists.
#[derive(Debug)]
pub enum Code {}

impl Code {
    /// Makes no code.
    ///
    /// # Errors
    /// Always, with the reason.
    pub fn new(_: &Tapes, _: Target) -> Result<(Self, Vec<f64>), String> {
        Err("this build has no generator of machine code".into())
    }

    pub fn size(&self) -> usize {
        match *self {}
    }

    pub fn call(&self, _: usize, _: &[f64], _: [&[f64]; 5], _: &mut [f64]) -> Ended {
        match *self {}
    }
}

/// A function whose arguments have lengths that are known when Rust compiles the call: there is none.
#[derive(Clone, Copy)]
pub struct Fixed<'a, const X: usize, const V: usize, const U: usize, const OUT: usize>(&'a Code);

impl<'a, const X: usize, const V: usize, const U: usize, const OUT: usize> Fixed<'a, X, V, U, OUT> {
    pub fn new(code: &'a Code, _: usize, _: &'a [f64]) -> Option<Self> {
        Some(Fixed(code))
    }

    pub fn call(&self, _: &[f64; X], _: &[f64; V], _: &[f64; U], _: &mut [f64; OUT]) -> Ended {
        match *self.0 {}
    }
}

/// Whether a b + c is rounded once: a fused product in software would be slow.
pub fn is_fused() -> bool {
    false
}
