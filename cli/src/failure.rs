//! Failures of commands, their exit statuses, and warnings.

use hamel_codegen::diagnostics::Diagnostic;
use std::cell::RefCell;
use std::io::{ErrorKind, Write};

/// A failure, ready to be printed.
#[derive(Debug)]
pub enum Failure {
    /// A description or a check failed: status 1.
    Failed(String),
    /// Wrong usage, unreadable files: status 2.
    Usage(String),
    /// The reader of standard output has gone, as in `hamel … | head`: nothing is left to do.
    Closed,
}

impl Failure {
    /// A failure of the request, in one message.
    pub fn failed(message: impl AsRef<str>) -> Self {
        Failure::Failed(format_error(message.as_ref()))
    }

    /// Unusable input, in one message.
    pub fn usage(message: impl AsRef<str>) -> Self {
        Failure::Usage(format_error(message.as_ref()))
    }

    /// Several messages about the same subject.
    pub fn usages(about: &str, messages: &[String]) -> Self {
        let mut text: String = messages
            .iter()
            .map(|message| format_error(&format!("{about}: {message}")))
            .collect();
        if messages.len() > 1 {
            text.push_str(&format!("{} errors\n", messages.len()));
        }
        Failure::Usage(text)
    }

    /// The message without colours.
    pub fn text(&self) -> String {
        match self {
            Failure::Failed(text) | Failure::Usage(text) => plain(text),
            Failure::Closed => String::new(),
        }
    }

    /// Writes the failure to standard error and returns the exit status.
    pub fn report(self) -> u8 {
        let (text, code) = match self {
            Failure::Failed(text) => (text, 1),
            Failure::Usage(text) => (text, 2),
            Failure::Closed => return 0,
        };
        // If standard error is closed, the message cannot be delivered.
        let _ = anstream::stderr().write_all(text.as_bytes());
        code
    }

    /// The more severe of two failures, with the text of both.
    pub fn and(self, other: Failure) -> Failure {
        match (self, other) {
            (Failure::Closed, other) => other,
            (this, Failure::Closed) => this,
            (Failure::Failed(a), Failure::Failed(b)) => Failure::Failed(a + &b),
            (Failure::Failed(a) | Failure::Usage(a), Failure::Failed(b) | Failure::Usage(b)) => {
                Failure::Usage(a + &b)
            }
        }
    }
}

fn format_error(message: &str) -> String {
    format!("\x1b[1;31merror\x1b[0m: {message}\n")
}

/// Writes a result to standard output; colours are dropped if it is not a terminal, or with `NO_COLOR`.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = anstream::stdout();
    let written = stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush());
    check_written(written)
}

/// Converts an error of writing to standard output.
fn check_written(written: std::io::Result<()>) -> Result<(), Failure> {
    match written {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Err(Failure::Closed),
        Err(error) => Err(Failure::usage(format!(
            "cannot write to standard output: {error}"
        ))),
    }
}

/// Prints clap's answer, which is help, the version or a usage error, and returns the exit status.
pub fn print_clap(answer: &clap::Error) -> u8 {
    let written = answer.print();
    match (answer.use_stderr(), check_written(written)) {
        (true, _) => 2,
        (false, Ok(())) => 0,
        (false, Err(failure)) => failure.report(),
    }
}

/// Messages in addition to a result: warnings as a text without colours, and the places of errors and warnings.
#[derive(Clone, Debug, Default)]
pub struct Captured {
    /// The warnings, each with its source underlined.
    pub warnings: String,
    /// Errors and warnings with their places in the description.
    pub marks: Vec<Mark>,
}

/// An error or a warning with its place in the description, for editors that underline it.
#[derive(Clone, Debug)]
pub struct Mark {
    /// Whether it is an error.
    pub is_error: bool,
    /// The place, the message and the help.
    pub diagnostic: Diagnostic,
}

thread_local! {
    /// Messages captured in this thread, while [`capture`] runs.
    static CAPTURED: RefCell<Option<Captured>> = const { RefCell::new(None) };
}

/// Records the places of errors or warnings if messages are being captured.
pub fn mark(diagnostics: &[Diagnostic], is_error: bool) {
    CAPTURED.with_borrow_mut(|captured| {
        let Some(captured) = captured else { return };
        captured
            .marks
            .extend(diagnostics.iter().map(|diagnostic| Mark {
                is_error,
                diagnostic: diagnostic.clone(),
            }));
    });
}

/// Writes a warning to standard error, or to the captured messages.
pub fn warn(text: &str) {
    let captured = CAPTURED.with_borrow_mut(|captured| match captured {
        Some(captured) => {
            captured.warnings.push_str(&plain(text));
            true
        }
        None => false,
    });
    if !captured {
        // If standard error is closed, the warning cannot be delivered.
        let _ = anstream::stderr().write_all(text.as_bytes());
    }
}

/// Runs `act` and captures the messages that it emits.
pub fn capture<T>(act: impl FnOnce() -> T) -> (T, Captured) {
    let outer = CAPTURED.replace(Some(Captured::default()));
    let done = act();
    let captured = CAPTURED.replace(outer).unwrap_or_default();
    (done, captured)
}

/// Removes the colours of a text.
fn plain(text: &str) -> String {
    anstream::adapter::strip_str(text).to_string()
}

/// Writes a file atomically.
pub fn write(path: &std::path::Path, text: &str) -> Result<(), Failure> {
    hamel_files::write(path, text).map_err(|error| Failure::usage(error.to_string()))
}

/// Writes a file atomically, unless it already has this text.
pub fn update(path: &std::path::Path, text: &str) -> Result<(), Failure> {
    hamel_files::update(path, text).map_err(|error| Failure::usage(error.to_string()))
}
