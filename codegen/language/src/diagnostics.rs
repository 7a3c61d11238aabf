//! Errors and warnings with their places in the source. Errors are collected so that one build reports all of them.

use crate::functions::Needs;
pub use crate::syntax::ast::Span;
use crate::syntax::ast::Texts;
use std::panic::Location;

/// One error or warning: its place, the problem, and a suggestion.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// Place of the problem.
    pub span: Span,
    /// The problem, in one sentence.
    pub message: String,
    /// Suggested fix.
    pub help: Option<String>,
    /// Other places involved, each with a short label.
    pub notes: Vec<(Span, String)>,
    /// Included texts that contain the places of this error, and the statement that it is about if that is not in the
    /// text with the places.
    pub texts: Texts,
    /// Inertia that the system lacks, if only the functions that need it are at fault and all others can be derived.
    pub lacking: Option<Needs>,
    /// Whether a proof failed. The cause is a fault of the generator, or an unlucky choice of the evaluation point.
    pub unproved: bool,
    /// Location in the generator's source that creates the error. The book has an example for every such location.
    pub site: &'static Location<'static>,
}

impl Diagnostic {
    /// Creates an error at a place.
    #[track_caller]
    pub fn new(span: Span, message: impl Into<String>) -> Self {
        Diagnostic {
            span,
            message: message.into(),
            help: None,
            notes: Vec::new(),
            texts: Texts::default(),
            lacking: None,
            unproved: false,
            site: Location::caller(),
        }
    }

    /// Marks the error as a failed proof.
    pub fn about_proof(mut self) -> Self {
        self.unproved = true;
        self
    }

    /// Records that only functions that need this much inertia are at fault, so that the others can still be generated.
    pub fn lacking(mut self, needs: Needs) -> Self {
        self.lacking = Some(needs);
        self
    }

    /// Adds a suggested fix.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds another place with a label.
    pub fn note(mut self, span: Span, label: impl Into<String>) -> Self {
        self.notes.push((span, label.into()));
        self
    }

    /// Adds the function call that contains the error, unless [`MOST_CALLS`] notes exist already.
    pub(crate) fn in_call(self, span: Span) -> Self {
        match self.notes.len() < MOST_CALLS {
            true => self.note(span, "in this call"),
            false => self,
        }
    }
}

/// Largest number of enclosing calls that are shown with an error.
const MOST_CALLS: usize = 4;

/// The errors of one description, in the order in which they were found.
#[derive(Debug, Default)]
pub struct Report {
    errors: Vec<Diagnostic>,
}

impl Report {
    /// Creates an empty report.
    pub fn new() -> Self {
        Report::default()
    }

    /// Adds an error.
    pub fn push(&mut self, error: Diagnostic) {
        self.errors.push(error);
    }

    /// Returns whether the report already has an error with this message at this place.
    pub fn has(&self, error: &Diagnostic) -> bool {
        let same = |known: &Diagnostic| {
            known.message == error.message && known.span.range() == error.span.range()
        };
        self.errors.iter().any(same)
    }

    /// Adds an error unless the report already has one with the same message at the same place.
    pub fn push_once(&mut self, error: Diagnostic) {
        if !self.has(&error) {
            self.errors.push(error);
        }
    }

    /// Records the error of a result and returns its value.
    pub fn keep<T>(&mut self, result: Result<T, Diagnostic>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => {
                self.push(error);
                None
            }
        }
    }

    /// Returns the number of errors.
    pub fn len(&self) -> usize {
        self.errors.len()
    }

    /// Returns whether the report has no errors.
    pub fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// Ends a stage: returns `Ok` if there are no errors, and all errors otherwise.
    pub fn finish(self) -> Result<(), Vec<Diagnostic>> {
        if self.errors.is_empty() {
            Ok(())
        } else {
            Err(self.errors)
        }
    }
}

/// Formats a number with four significant digits, for messages that say how far something is off: `3`, `-0.62`,
/// `1.556e-7`.
pub fn rough(value: f64) -> String {
    let text = format!("{value:.3e}");
    let exponent = text
        .split_once('e')
        .and_then(|(_, e)| e.parse::<i32>().ok());
    match (exponent, text.parse::<f64>()) {
        (Some(exponent @ -3..=3), Ok(rounded)) => {
            let digits = (3 - exponent).unsigned_abs() as usize;
            let plain = format!("{rounded:.digits$}");
            match plain.contains('.') {
                true => plain.trim_end_matches('0').trim_end_matches('.').into(),
                false => plain,
            }
        }
        _ => text,
    }
}
