//! Placed errors, collected so that one build reports all of them; placed warnings have the same form.

use crate::functions::Needs;
use crate::syntax::ast::{Span, Texts};
use std::panic::Location;

/// One error or warning: where, what is wrong, and what to do about it.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// The place it is about.
    pub span: Span,
    /// What is wrong, in one sentence.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
    /// Other places involved, each with a short label.
    pub notes: Vec<(Span, String)>,
    /// The included texts that these places are in.
    pub texts: Texts,
    /// What the system lacks, where only functions that need it are in the way: all else can be derived.
    pub lacking: Option<Needs>,
    /// Whether a proof failed: a fault of the generator, or of the point that was read at.
    pub unproved: bool,
    /// Where the generator makes it: the book has an example for every such place.
    pub site: &'static Location<'static>,
}

impl Diagnostic {
    /// An error at a place.
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

    /// It is about a proof that failed.
    pub fn about_proof(mut self) -> Self {
        self.unproved = true;
        self
    }

    /// Says that only functions that need this are in the way.
    pub fn lacking(mut self, needs: Needs) -> Self {
        self.lacking = Some(needs);
        self
    }

    /// Adds what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds another place.
    pub fn note(mut self, span: Span, label: impl Into<String>) -> Self {
        self.notes.push((span, label.into()));
        self
    }

    /// Adds the call of the function that it is in.
    pub(crate) fn in_call(self, span: Span) -> Self {
        match self.notes.len() < MOST_CALLS {
            true => self.note(span, "in this call"),
            false => self,
        }
    }
}

/// Calls around an error that are shown with it.
const MOST_CALLS: usize = 4;

/// The errors of one description, in the order they were found.
#[derive(Debug, Default)]
pub struct Report {
    errors: Vec<Diagnostic>,
}

impl Report {
    /// An empty report.
    pub fn new() -> Self {
        Report::default()
    }

    /// Adds an error.
    pub fn push(&mut self, error: Diagnostic) {
        self.errors.push(error);
    }

    /// Whether the same is said of the same place already.
    pub fn has(&self, error: &Diagnostic) -> bool {
        let same = |known: &Diagnostic| {
            known.message == error.message && known.span.range() == error.span.range()
        };
        self.errors.iter().any(same)
    }

    /// Adds an error, unless the same is said of the same place already.
    pub fn push_once(&mut self, error: Diagnostic) {
        if !self.has(&error) {
            self.errors.push(error);
        }
    }

    /// Keeps the error of a result and hands on its value.
    pub fn keep<T>(&mut self, result: Result<T, Diagnostic>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => {
                self.push(error);
                None
            }
        }
    }

    /// How many errors there are.
    pub fn len(&self) -> usize {
        self.errors.len()
    }

    /// Whether nothing was reported.
    pub fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// A checkpoint: `Ok` where nothing was reported, all errors otherwise.
    pub fn finish(self) -> Result<(), Vec<Diagnostic>> {
        if self.errors.is_empty() {
            Ok(())
        } else {
            Err(self.errors)
        }
    }
}

/// A number with four digits, as messages show how far something is off: `3`, `-0.62`, `1.556e-7`.
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
