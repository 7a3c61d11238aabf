//! Functions of a program with their parameters set, as machine code if the machine supports it.

use super::numbers::Numbers;
use crate::failure::Failure;
use hamel_codegen::program::{Cause, Function, Program};
use hamel_native::{Compiled, Constants};

/// Functions compiled together, with their parameters.
#[derive(Clone, Debug)]
pub struct Functions {
    compiled: Compiled,
    constants: Constants,
}

/// Compiles the functions of the program that have these names.
pub fn compiled(program: &Program, names: &[&str]) -> Result<Compiled, Failure> {
    let all = names.iter().filter_map(|name| program.function(name));
    let all: Vec<&Function> = all.collect();
    Compiled::new(program, &all).map_err(|foreign| {
        Failure::failed(format!(
            "`{}` is a function in Rust, which cannot be evaluated here",
            foreign.name
        ))
    })
}

/// The place of a function, if it was compiled.
pub fn place(compiled: &Compiled, name: &str) -> Option<Place> {
    let index = compiled.place(name)?;
    let tape = compiled.tapes().functions.get(index)?;
    Some(Place {
        index,
        length: tape.outputs.len(),
    })
}

/// The place of one compiled function.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    index: usize,
    /// Number of entries of its result.
    length: usize,
}

impl Place {
    /// Index among the tapes.
    pub fn index(self) -> usize {
        self.index
    }

    /// Number of entries of its result.
    pub fn length(self) -> usize {
        self.length
    }
}

impl Functions {
    /// Sets the parameters of compiled functions.
    pub fn new(compiled: &Compiled, params: &[f64]) -> Self {
        Functions {
            constants: compiled.constants(params),
            compiled: compiled.clone(),
        }
    }

    /// The parameters.
    pub fn params(&self) -> &[f64] {
        let known = self.constants.known();
        known
            .get(..self.compiled.tapes().parameters)
            .unwrap_or(known)
    }

    /// Whether a mass matrix that is constant in time is not positive definite with these parameters.
    pub fn are_singular(&self) -> bool {
        self.compiled.singular(&self.constants).is_some()
    }

    /// The result for x, ξ and z, u, ξ̇ and p, or the cause of a pivot that is not positive.
    pub fn call(&self, place: Place, arguments: [&[f64]; 5]) -> Result<Numbers, Cause> {
        let mut out = Numbers::filled(f64::NAN, place.length);
        let constants = &self.constants;
        self.compiled
            .call(place.index, constants, arguments, out.as_mut())?;
        Ok(out)
    }

    /// The result of a function with one entry; NaN if it has no value.
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
