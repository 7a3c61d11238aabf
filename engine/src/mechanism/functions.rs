//! Functions of a program with their parameters set, as machine code if the machine supports it.

use super::numbers::Numbers;
use crate::error::Error;
use hamel_codegen::program::{Cause, Function, Program};
use hamel_native::{Compiled, Constants};

/// Compiled functions of a program together with values of its parameters.
#[derive(Clone, Debug)]
pub struct Functions {
    compiled: Compiled,
    constants: Constants,
}

/// Compiles the functions of the program that have these names.
pub fn compile_functions(program: &Program, names: &[&str]) -> Result<Compiled, Error> {
    let all = names.iter().filter_map(|name| program.function(name));
    let all: Vec<&Function> = all.collect();
    Compiled::new(program, &all).map_err(|foreign| Error::ForeignFunction {
        name: foreign.name,
        missing: "numbers",
    })
}

/// Finds a function by its name; `None` if it was not compiled.
pub fn find_function(compiled: &Compiled, name: &str) -> Option<FunctionIndex> {
    let index = compiled.place(name)?;
    let tape = compiled.tapes().functions.get(index)?;
    Some(FunctionIndex {
        index,
        length: tape.outputs.len(),
    })
}

/// Index of a compiled function, with the length of its result.
#[derive(Clone, Copy, Debug)]
pub struct FunctionIndex {
    index: usize,
    /// Returns the number of entries of the result.
    length: usize,
}

impl FunctionIndex {
    /// Returns the index among the tapes.
    pub fn index(self) -> usize {
        self.index
    }

    /// Returns the number of entries of the result.
    pub fn length(self) -> usize {
        self.length
    }
}

impl Functions {
    /// Takes compiled functions, and computes their values that depend on these parameters alone.
    pub fn new(compiled: &Compiled, params: &[f64]) -> Self {
        Functions {
            constants: compiled.constants(params),
            compiled: compiled.clone(),
        }
    }

    /// Returns the parameters.
    pub fn params(&self) -> &[f64] {
        let known = self.constants.known();
        known
            .get(..self.compiled.tapes().parameters)
            .unwrap_or(known)
    }

    /// Returns whether a mass matrix that is constant in time is not positive definite with these parameters.
    pub fn are_singular(&self) -> bool {
        self.compiled.singular(&self.constants).is_some()
    }

    /// Evaluates a function for x, ξ and z, u, ξ̇ and p; returns the result, or the cause of a pivot that is not
    /// positive.
    pub fn call(&self, place: FunctionIndex, arguments: [&[f64]; 5]) -> Result<Numbers, Cause> {
        let mut out = Numbers::filled(f64::NAN, place.length);
        let constants = &self.constants;
        self.compiled
            .call(place.index, constants, arguments, out.as_mut())?;
        Ok(out)
    }

    /// Evaluates a function with one entry; NaN if it has no value.
    pub fn number(&self, place: FunctionIndex, arguments: [&[f64]; 5]) -> f64 {
        let mut out = [f64::NAN];
        if place.length == 1 {
            let constants = &self.constants;
            let ended = self
                .compiled
                .call(place.index, constants, arguments, &mut out);
            if ended.is_err() {
                return f64::NAN;
            }
        }
        let [number] = out;
        number
    }
}
