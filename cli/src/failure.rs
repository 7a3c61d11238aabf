//! Failures of commands: how they are shown, and their exit statuses.

#[cfg(feature = "command")]
use crate::series::SeriesError;
use hamel_codegen::render::{render, warnings};
use hamel_codegen::urdf;
use hamel_engine::{Error, Warning};
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Failure of a command.
#[derive(Debug)]
pub enum Failure {
    /// An error of the engine.
    Engine(Error),
    /// A description or a check failed: status 1.
    Failed(String),
    /// Wrong usage, unreadable files: status 2.
    Usage(String),
    /// Several things are wrong with one input: status 2.
    Usages {
        /// The input.
        about: String,
        /// The messages.
        messages: Vec<String>,
    },
    /// The words of the command line are wrong, in the words of its parser: status 2.
    CommandLine(String),
    /// Several failures.
    Several(Vec<Failure>),
    /// The reader of standard output has gone, as in `hamel … | head`: nothing is left to do.
    Closed,
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Failure::Engine(error)
    }
}

#[cfg(feature = "command")]
impl From<SeriesError> for Failure {
    fn from(error: SeriesError) -> Self {
        Failure::usage(error.to_string())
    }
}

impl Failure {
    /// Creates a failure of the request from one message.
    pub fn failed(message: impl Into<String>) -> Self {
        Failure::Failed(message.into())
    }

    /// Creates a failure of unusable input from one message.
    pub fn usage(message: impl Into<String>) -> Self {
        Failure::Usage(message.into())
    }

    /// Creates a failure from several messages about the same input.
    pub fn usages(about: &str, messages: &[String]) -> Self {
        Failure::Usages {
            about: about.into(),
            messages: messages.to_vec(),
        }
    }

    /// Renders the failure as one or more lines.
    pub fn render(&self, color: bool) -> String {
        let format_error = |message: &str| match color {
            true => format!("\x1b[1;31merror\x1b[0m: {message}\n"),
            false => format!("error: {message}\n"),
        };
        let list = |about: &str, messages: &[String]| {
            let lines = messages.iter().map(|message| format!("{about}: {message}"));
            let mut text: String = lines.map(|line| format_error(&line)).collect();
            if messages.len() > 1 {
                text.push_str(&format!("{} errors\n", messages.len()));
            }
            text
        };
        match self {
            Failure::Engine(error) => match (underlined(error, color), error.list()) {
                (Some(text), _) => text,
                (None, Some((about, messages))) => list(&about, &messages),
                (None, None) => format_error(&error.to_string()),
            },
            Failure::Failed(message) | Failure::Usage(message) => format_error(message),
            Failure::Usages { about, messages } => list(about, messages),
            Failure::CommandLine(text) => text.clone(),
            Failure::Several(all) => all.iter().map(|failure| failure.render(color)).collect(),
            Failure::Closed => String::new(),
        }
    }

    /// Returns the exit status of a command that ends with this failure.
    fn status(&self) -> u8 {
        match self {
            Failure::Engine(error) => 1 + u8::from(error.is_misuse()),
            Failure::Failed(_) => 1,
            Failure::Usage(_) | Failure::Usages { .. } | Failure::CommandLine(_) => 2,
            Failure::Several(all) => all.iter().map(Failure::status).max().unwrap_or(0),
            Failure::Closed => 0,
        }
    }

    /// Writes the failure to standard error, and returns the exit status.
    pub fn report(self) -> u8 {
        // If standard error is closed, the message cannot be delivered.
        let _ = anstream::stderr().write_all(self.render(true).as_bytes());
        self.status()
    }

    /// Combines two failures.
    pub fn and(self, other: Failure) -> Failure {
        match (self, other) {
            (Failure::Closed, other) => other,
            (this, Failure::Closed) => this,
            (this, other) => Failure::Several(vec![this, other]),
        }
    }
}

/// Renders an error that has places in a text, with these underlined; `None` for other errors.
fn underlined(error: &Error, color: bool) -> Option<String> {
    Some(match error {
        Error::Description {
            path,
            text,
            diagnostics,
        } => render(diagnostics, path, text, color),
        Error::Robot {
            path,
            urdf,
            diagnostics,
        } => urdf::refused(diagnostics, path, urdf, color),
        Error::Import {
            path,
            urdf,
            problems,
        } => urdf::errors(problems, path, urdf, color),
        Error::Argument {
            option,
            text,
            diagnostics,
        } => render(diagnostics, option, text, color),
        _ => return None,
    })
}

/// Shows a warning of the engine on standard error.
pub fn warn_of(warning: &Warning<'_>) {
    warn(&match *warning {
        Warning::Description {
            path,
            text,
            diagnostics,
        } => warnings(diagnostics, path, text, true),
        Warning::Robot {
            path,
            urdf,
            imported,
        } => urdf::warnings(imported, path, urdf, true),
        Warning::LeftOut { .. } => warning.to_string(),
    });
}

/// Writes what does not end the command to standard error.
pub fn warn(text: &str) {
    // If standard error is closed, the message cannot be delivered.
    let _ = anstream::stderr().write_all(text.as_bytes());
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

/// Writes a file atomically.
pub fn write(path: &Path, text: &str) -> Result<(), Failure> {
    hamel_files::write(path, text).map_err(|error| Failure::usage(error.to_string()))
}

/// Writes a file atomically, unless it already has this text.
pub fn update(path: &Path, text: &str) -> Result<(), Failure> {
    hamel_files::update(path, text).map_err(|error| Failure::usage(error.to_string()))
}
