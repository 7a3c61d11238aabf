//! Warnings as Python gets them: their texts.

use hamel_cli::Terminal;
use hamel_engine::{Reporter, Warning};
use std::sync::{Mutex, PoisonError};

/// Keeps the texts of warnings until they are taken; later ones are shown on standard error. Progress is shown where
/// that is a terminal.
pub struct Warnings {
    /// None once they were taken.
    kept: Mutex<Option<String>>,
    terminal: Terminal,
}

impl Default for Warnings {
    fn default() -> Self {
        Warnings {
            kept: Mutex::new(Some(String::new())),
            terminal: Terminal::default(),
        }
    }
}

impl Warnings {
    /// Returns the warnings so far.
    pub fn take(&self) -> String {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.take().unwrap_or_default()
    }
}

impl Reporter for Warnings {
    fn warn(&self, warning: &Warning<'_>) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        match kept.as_mut() {
            Some(text) => text.push_str(&warning.to_string()),
            None => self.terminal.warn(warning),
        }
    }

    fn begin(&self, work: &'static str) {
        self.terminal.begin(work);
    }

    fn advance(&self, done: u64, all: u64) {
        self.terminal.advance(done, all);
    }

    fn end(&self) {
        self.terminal.end();
    }
}
