//! Functions of a program with its parameters set, as machine code where this machine has any.

use super::Numbers;
use crate::failure::Failure;
use hamel_codegen::program::{Cause, Function, Program};
use hamel_native::{Compiled, Constants};

/// Functions that were compiled together.
#[derive(Clone, Debug)]
pub struct Functions {
    compiled: Compiled,
    constants: Constants,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    index: usize,
    /// How many numbers its result has.
    length: usize,
}

impl Place {
    /// How many numbers its result has.
    pub fn length(self) -> usize {
        self.length
    }
}

impl Functions {
    /// Those with these names that the program has.
    pub fn new(program: &Program, names: &[&str], params: &[f64]) -> Result<Self, Failure> {
        let all = names.iter().filter_map(|name| program.function(name));
        let all: Vec<&Function> = all.collect();
        let compiled = Compiled::new(program, &all).map_err(|foreign| {
            Failure::failed(format!(
                "`{}` is a function in Rust, of which there are no numbers here",
                foreign.name
            ))
        })?;
        Ok(Functions {
            constants: compiled.constants(params),
            compiled,
        })
    }

    /// Where a function is.
    pub fn known(&self, name: &str) -> Option<Place> {
        let index = self.compiled.place(name)?;
        let tape = self.compiled.tapes().functions.get(index)?;
        Some(Place {
            index,
            length: tape.outputs.len(),
        })
    }

    /// Where a function is that the program should have.
    pub fn place(&self, program: &Program, name: &str) -> Result<Place, Failure> {
        self.known(name)
            .ok_or_else(|| super::missing(program, name))
    }

    /// The result for x, ξ and z, u, ξ̇ and p; what it means that a pivot is not positive.
    pub fn call(&self, place: Place, arguments: [&[f64]; 5]) -> Result<Numbers, Cause> {
        let mut out = Numbers::filled(f64::NAN, place.length);
        let constants = &self.constants;
        self.compiled
            .call(place.index, constants, arguments, out.as_mut())?;
        Ok(out)
    }

    /// The result of a function that is one number; NaN where it has none.
    pub fn number(&self, place: Place, arguments: [&[f64]; 5]) -> f64 {
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
