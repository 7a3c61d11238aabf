//! Single functions of a description, compiled to machine code.

use crate::error::Error;
use crate::mechanism;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::{Argument, Cause, Shape};
use hamel_native::{Compiled, Constants, Paired};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// Number of states whose evaluation takes about as long as compiling code for two states at once.
const MIN_STATES_TO_PAIR: u64 = 1 << 15;

/// Function of a description that is compiled to machine code, such as `mass_matrix`.
#[derive(Clone, Debug)]
pub struct Function {
    /// Name.
    pub name: String,
    /// Documentation of the result.
    pub docs: String,
    /// Arguments.
    pub arguments: Vec<Argument>,
    /// Shape of the result.
    pub shape: Shape,
    compiled: Compiled,
    lanes: Arc<PairedCode>,
}

/// Code for two states at once, and the number of states requested before it existed.
#[derive(Debug, Default)]
struct PairedCode {
    states: AtomicU64,
    code: OnceLock<Option<Paired>>,
}

impl Function {
    /// Returns the number of entries that an argument of this kind has for this system.
    pub fn length(&self, argument: Argument) -> usize {
        let all = hamel_native::ARGUMENTS.iter();
        let lengths = all.zip(self.compiled.tapes().lengths);
        lengths
            .filter(|(of, _)| **of == argument)
            .map(|(_, length)| length)
            .sum()
    }

    /// Computes all values of the function that depend on parameters alone, for its calls.
    ///
    /// # Errors
    /// M is constant, and not positive definite with these parameters.
    pub fn constants(&self, params: &[f64]) -> Result<Constants, Cause> {
        let constants = self.compiled.constants(params);
        match self.compiled.singular(&constants) {
            Some(cause) => Err(cause),
            None => Ok(constants),
        }
    }

    /// Evaluates the function for x, ξ and z, u, ξ̇ and p; only the arguments of the function are read.
    ///
    /// # Errors
    /// The cause of a pivot that is not positive.
    pub fn call(
        &self,
        constants: &Constants,
        arguments: [&[f64]; 5],
        out: &mut [f64],
    ) -> Result<(), Cause> {
        self.compiled.call(0, constants, arguments, out)
    }

    /// Evaluates the function at two states at once: all lists contain pairs, constants are those of
    /// [`Paired::constants`]. Returns whether both exist; otherwise `out` is unspecified.
    pub fn both(
        &self,
        paired: &Paired,
        constants: &[f64],
        arguments: [&[f64]; 5],
        out: &mut [f64],
    ) -> bool {
        paired.call(0, constants, arguments, out)
    }

    /// Returns code for two states at once, if this many more states are worth compiling it and the machine supports
    /// it.
    pub fn paired(&self, states: u64) -> Option<&Paired> {
        if self.lanes.code.get().is_none() {
            let before = self.lanes.states.fetch_add(states, Ordering::Relaxed);
            if before.saturating_add(states) < MIN_STATES_TO_PAIR {
                return None;
            }
        }
        let make = || Paired::new(&self.compiled);
        self.lanes.code.get_or_init(make).as_ref()
    }
}

/// Compiles a function of a program by its name.
pub(super) fn compile(generated: &Generated, name: &str) -> Result<Function, Error> {
    let program = &generated.program;
    let Some(function) = program.function(name) else {
        return Err(Error::UnavailableFunction {
            system: program.name.clone(),
            name: name.into(),
        });
    };
    let compiled = mechanism::compile_functions(program, &[name])?;
    Ok(Function {
        name: function.name.clone(),
        docs: function.docs.join("\n"),
        arguments: function.arguments.clone(),
        shape: function.shape,
        compiled,
        lanes: Arc::default(),
    })
}
