//! Interface through which front ends receive warnings and the progress of long work.

use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::generate::LeftOut;
use hamel_codegen::render::warnings;
use hamel_codegen::urdf::{self, Imported};
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// Receiver of warnings and of the progress of long work.
pub trait Reporter: Send + Sync {
    /// Receives a warning.
    fn warn(&self, warning: &Warning<'_>);

    /// Called when work of unknown length begins, such as a derivation.
    fn begin(&self, _work: &'static str) {}

    /// Called from time to time during a long run, with the number of steps done and the expected total. The first call
    /// comes late: short runs make none.
    fn advance(&self, _done: u64, _all: u64) {}

    /// Called when the work is done.
    fn end(&self) {}
}

/// Warning, with the texts that are needed to show it.
#[derive(Clone, Copy, Debug)]
pub enum Warning<'a> {
    /// Parts of a description are legal but suspicious.
    Description {
        /// Its path.
        path: &'a str,
        /// Text of the file.
        text: &'a str,
        /// The warnings, with their places in the text.
        diagnostics: &'a [Diagnostic],
    },
    /// Parts of a robot in URDF are legal but suspicious, or not modelled.
    Robot {
        /// The path of its file.
        path: &'a str,
        /// The text of that file.
        urdf: &'a str,
        /// Result of the import, with the warnings.
        imported: &'a Imported,
    },
    /// Functions are left out.
    LeftOut {
        /// The path of the description.
        path: &'a str,
        /// The functions and the reason.
        left_out: &'a LeftOut,
    },
}

impl fmt::Display for Warning<'_> {
    /// Writes the warning in plain text, with the source underlined, and a line break behind it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Warning::Description {
                path,
                text,
                diagnostics,
            } => f.write_str(&warnings(diagnostics, path, text, false)),
            Warning::Robot {
                path,
                urdf,
                imported,
            } => f.write_str(&urdf::warnings(imported, path, urdf, false)),
            Warning::LeftOut { path, left_out } => {
                writeln!(f, "warning: {path}: {}", left_out.said())
            }
        }
    }
}

/// Reporter that ignores everything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quiet;

impl Reporter for Quiet {
    fn warn(&self, _: &Warning<'_>) {}
}

/// Reporter that collects the texts of warnings.
#[derive(Debug, Default)]
pub struct WarningTexts(Mutex<String>);

impl WarningTexts {
    /// Takes the warnings collected since the last call.
    pub fn take(&self) -> String {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Reporter for WarningTexts {
    fn warn(&self, warning: &Warning<'_>) {
        let mut text = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        text.push_str(&warning.to_string());
    }
}
