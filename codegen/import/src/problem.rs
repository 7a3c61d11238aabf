//! Errors and warnings about a robot's file, with place, message and remedy.

use std::fmt;
use std::ops::Range;

/// One error or warning, placed in the URDF text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Range of bytes that the problem is about.
    pub range: Range<usize>,
    /// Line of the first byte, from 1.
    pub line: usize,
    /// Column of the first byte in characters, from 1.
    pub column: usize,
    /// Description of the problem, in one sentence.
    pub message: String,
    /// Suggested remedy.
    pub help: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Problem {
            line,
            column,
            message,
            help,
            ..
        } = self;
        write!(f, "{line}:{column}: {message}; {help}")
    }
}

impl std::error::Error for Problem {}

/// Problems found so far, not yet in the order of the text.
#[derive(Debug)]
pub(crate) struct Problems<'a> {
    text: &'a str,
    list: Vec<Problem>,
}

impl<'a> Problems<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        Problems {
            text,
            list: Vec::new(),
        }
    }

    /// Adds a problem at a range of bytes.
    pub(crate) fn push(
        &mut self,
        range: &Range<usize>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        let (line, column) = place(self.text, range.start);
        self.list.push(Problem {
            range: range.clone(),
            line,
            column,
            message: message.into(),
            help: help.into(),
        });
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Returns all problems in the order of the text.
    pub(crate) fn sorted(mut self) -> Vec<Problem> {
        self.list
            .sort_by_key(|problem| (problem.range.start, problem.range.end));
        self.list
    }
}

/// Returns line and column of a byte, both from 1.
pub(crate) fn place(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let column = before.get(start..).unwrap_or("").chars().count() + 1;
    (line, column)
}
