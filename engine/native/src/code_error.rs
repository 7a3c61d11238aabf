//! Reasons why there is no machine code.

use std::error::Error;
use std::fmt;

/// Reason why the functions of tapes are interpreted, although machine code would be faster.
#[derive(Debug)]
pub enum CodeError {
    /// The caller asked for the interpreter.
    NotRequested,
    /// The crate was built without the feature `machine`.
    NoGenerator,
    /// Cranelift does not know this machine.
    UnknownMachine(&'static str),
    /// Addresses of this machine do not have 64 bits.
    NarrowAddresses,
    /// A tape reads a value before it is computed.
    Disordered {
        /// Function of the tape.
        function: String,
    },
    /// A tape has more values than the offsets of instructions can reach.
    TooLong {
        /// Function of the tape.
        function: String,
    },
    /// Cranelift refuses its settings, or cannot compile a function.
    Cranelift(Box<dyn Error + Send + Sync>),
}

impl fmt::Display for CodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CodeError::NotRequested => f.write_str("not asked for"),
            CodeError::NoGenerator => f.write_str("this build has no generator of machine code"),
            CodeError::UnknownMachine(why) => f.write_str(why),
            CodeError::NarrowAddresses => {
                f.write_str("addresses of this machine do not have 64 bits")
            }
            CodeError::Disordered { function } => {
                write!(f, "`{function}` reads what is not there yet")
            }
            CodeError::TooLong { function } => write!(f, "`{function}` is too long"),
            CodeError::Cranelift(error) => error.fmt(f),
        }
    }
}

impl Error for CodeError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            CodeError::Cranelift(error) => Some(error.as_ref()),
            _ => None,
        }
    }
}
