//! One function of a description as machine code.

use crate::error::Error;
use crate::mechanism;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::{Argument, Cause, Shape};
use hamel_native::{Compiled, Constants, Paired};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// Code for two states at once takes about as long to make as so many states take without it.
const MANY: u64 = 1 << 15;

/// A function of the description as machine code.
#[derive(Clone, Debug)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// What it evaluates.
    pub docs: String,
    /// What it takes.
    pub arguments: Vec<Argument>,
    /// The shape of its result.
    pub shape: Shape,
    compiled: Compiled,
    lanes: Arc<Lanes>,
}

/// Code for two states at once, and how many states were asked for before there was any.
#[derive(Debug, Default)]
struct Lanes {
    states: AtomicU64,
    code: OnceLock<Option<Paired>>,
}

impl Function {
    /// How many entries an argument has.
    pub fn length(&self, argument: Argument) -> usize {
        let all = hamel_native::ARGUMENTS.iter();
        let lengths = all.zip(self.compiled.tapes().lengths);
        lengths
            .filter(|(of, _)| **of == argument)
            .map(|(_, length)| length)
            .sum()
    }

    /// Parameters, with what depends on them alone.
    ///
    /// # Errors
    /// Where M is constant, and not positive definite with them.
    pub fn constants(&self, params: &[f64]) -> Result<Constants, Cause> {
        let constants = self.compiled.constants(params);
        match self.compiled.singular(&constants) {
            Some(cause) => Err(cause),
            None => Ok(constants),
        }
    }

    /// Its result for x, ξ and z, u, ξ̇ and p, of which those that it takes are read.
    ///
    /// # Errors
    /// What it means that a pivot is not positive.
    pub fn call(
        &self,
        constants: &Constants,
        arguments: [&[f64]; 5],
        out: &mut [f64],
    ) -> Result<(), Cause> {
        self.compiled.call(0, constants, arguments, out)
    }

    /// The results for two states at once: all lists hold pairs, constants are those of [`Paired::constants`]. Whether both
    /// have one; else `out` has no meaning.
    pub fn both(
        &self,
        paired: &Paired,
        constants: &[f64],
        arguments: [&[f64]; 5],
        out: &mut [f64],
    ) -> bool {
        paired.call(0, constants, arguments, out)
    }

    /// Code for two states at once, where so many states more are worth it and this machine has such code.
    pub fn paired(&self, states: u64) -> Option<&Paired> {
        if self.lanes.code.get().is_none() {
            let before = self.lanes.states.fetch_add(states, Ordering::Relaxed);
            if before.saturating_add(states) < MANY {
                return None;
            }
        }
        let make = || Paired::new(&self.compiled);
        self.lanes.code.get_or_init(make).as_ref()
    }
}

/// A function of a program by its name.
pub(super) fn compiled(generated: &Generated, name: &str) -> Result<Function, Error> {
    let program = &generated.program;
    let Some(function) = program.function(name) else {
        return Err(Error::UnavailableFunction {
            system: program.name.clone(),
            name: name.into(),
        });
    };
    let compiled = mechanism::compiled(program, &[name])?;
    Ok(Function {
        name: function.name.clone(),
        docs: function.docs.join("\n"),
        arguments: function.arguments.clone(),
        shape: function.shape,
        compiled,
        lanes: Arc::default(),
    })
}
