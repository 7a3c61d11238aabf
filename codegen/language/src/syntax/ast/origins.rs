//! Where statements come from that do not stand in the description itself: included texts, and copies of statements.
//!
//! Places are numbers. Those of the description come first; each included text, and each copy that a part or a round of
//! a `for` is, has a region of its own behind them. So whatever is found later needs its place alone, and
//! [`Origins::located`] says in which text that is, and which statements led there.

use super::Span;
use crate::diagnostics::Diagnostic;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

/// Notes of one error that say which statement made a copy.
const MOST_NOTES: usize = 4;

/// The regions behind a description; they take no part in equality.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    /// The first place that is free.
    next: usize,
    /// In the order of their places.
    regions: Vec<Region>,
    /// Names as they are written, by those that stand for them.
    written: Arc<BTreeMap<String, String>>,
}

impl PartialEq for Origins {
    fn eq(&self, _: &Origins) -> bool {
        true
    }
}

/// Consecutive places.
#[derive(Clone, Debug)]
struct Region {
    range: Range<usize>,
    origin: Origin,
}

#[derive(Clone, Debug)]
enum Origin {
    /// An included text.
    Text(Arc<Included>),
    /// A copy of what stands from a place on, made by a statement.
    Copy { of: usize, by: Span, label: String },
}

/// A text that a description includes.
#[derive(Clone, Debug)]
pub struct Included {
    /// Its path from the description.
    pub name: String,
    /// What it says.
    pub text: String,
    /// The statement that includes it.
    pub by: Span,
    /// The place of its first byte.
    start: usize,
}

impl Included {
    /// The line and the column at a byte, from 1.
    pub fn line(&self, at: usize) -> (usize, usize) {
        let before = self.text.get(..at).unwrap_or(&self.text);
        let start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        (line, before[start..].chars().count() + 1)
    }
}

/// The included texts that an error is about.
#[derive(Clone, Debug, Default)]
pub struct Texts(Vec<Arc<Included>>);

impl Texts {
    /// The included text in which a region is, and its bytes there.
    pub fn find(&self, span: Span) -> Option<(&Included, Range<usize>)> {
        let range = span.range()?;
        let inside = |text: &&Arc<Included>| {
            (text.start..=text.start + text.text.len()).contains(&range.start)
        };
        let text = self.0.iter().find(inside)?;
        let local = range.start - text.start..range.end - text.start;
        Some((text, local))
    }
}

impl Origins {
    /// Behind a description with as many places.
    pub fn behind(places: usize) -> Origins {
        Origins {
            next: places + 1,
            ..Origins::default()
        }
    }

    /// Makes room for as many places; `None` where there is none left.
    fn room(&mut self, len: usize, origin: Origin) -> Option<usize> {
        let start = self.next;
        let range = start..start + len + 1;
        Span::new(range.clone()).range()?;
        self.next = range.end + 1;
        self.regions.push(Region { range, origin });
        Some(start)
    }

    /// The first place of an included text.
    pub fn include(&mut self, name: &str, text: &str, by: Span) -> Option<usize> {
        let included = Included {
            name: name.to_owned(),
            text: text.to_owned(),
            by,
            start: self.next,
        };
        self.room(text.len(), Origin::Text(Arc::new(included)))
    }

    /// By how much the places of a copy are beyond those of what it is a copy of; nothing where no room is left.
    pub fn copy(&mut self, of: Span, by: Span, label: String) -> usize {
        let Some(range) = of.range() else {
            return 0;
        };
        let of = range.start;
        let room = self.room(range.len(), Origin::Copy { of, by, label });
        room.map_or(0, |start| start - of)
    }

    /// Says how names are written that stand in the description under others.
    pub fn name(&mut self, written: BTreeMap<String, String>) {
        self.written = Arc::new(written);
    }

    /// How a name is written, where that differs.
    pub fn written(&self, name: &str) -> Option<&str> {
        self.written.get(name).map(String::as_str)
    }

    fn region(&self, span: Span) -> Option<&Region> {
        let at = span.range()?.start;
        let after = self
            .regions
            .partition_point(|region| region.range.start <= at);
        let region = self.regions.get(after.checked_sub(1)?)?;
        region.range.contains(&at).then_some(region)
    }

    /// Whether a place is in an included text.
    pub fn is_included(&self, span: Span) -> bool {
        let region = self.region(self.source(span));
        region.is_some_and(|region| matches!(region.origin, Origin::Text(_)))
    }

    /// Where a statement was written that may be a copy.
    pub fn source(&self, span: Span) -> Span {
        self.unwound(span, &mut Vec::new())
    }

    /// Where a region was written, and what the copies on the way to it are.
    fn unwound<'a>(&'a self, mut span: Span, copies: &mut Vec<(Span, &'a str)>) -> Span {
        while let (Some(range), Some(region)) = (span.range(), self.region(span)) {
            let Origin::Copy { of, by, label } = &region.origin else {
                break;
            };
            copies.push((*by, label));
            let back = region.range.start - of;
            span = Span::new(range.start - back..range.end - back);
        }
        span
    }

    /// An error at the place where it was written, with notes at the statements that led there.
    pub fn located(&self, mut error: Diagnostic) -> Diagnostic {
        if self.regions.is_empty() && self.written.is_empty() {
            return error;
        }
        let mut copies = Vec::new();
        for (span, label) in &mut error.notes {
            *span = self.source(*span);
            *label = self.in_words(label);
        }
        error.span = self.unwound(error.span, &mut copies);
        let mut noted = 0;
        let mut seen = BTreeSet::new();
        while noted < copies.len() && noted < MOST_NOTES {
            let (by, label) = copies[noted];
            noted += 1;
            let last = noted == copies.len();
            let mut further = Vec::new();
            let place = self.unwound(by, &mut further);
            if seen.insert(label) {
                error.notes.push((place, label.to_owned()));
            }
            if last {
                copies.extend(further);
            }
        }
        error.message = self.in_words(&error.message);
        error.help = error.help.map(|help| self.in_words(&help));
        self.attach(&mut error);
        error
    }

    /// Gives an error the included texts that it is about, with a note at the statements that include them.
    fn attach(&self, error: &mut Diagnostic) {
        let text = |span: Span| match &self.region(span)?.origin {
            Origin::Text(text) => Some(text.clone()),
            Origin::Copy { .. } => None,
        };
        let mut next = text(error.span);
        while let Some(found) = next {
            error.notes.push((found.by, "included here".to_owned()));
            next = text(found.by);
        }
        let spans = [error.span].into_iter();
        let spans = spans.chain(error.notes.iter().map(|(span, _)| *span));
        error.texts = Texts(spans.filter_map(text).collect());
    }

    /// All errors at their places, those once that are the same for several copies.
    pub fn located_all(&self, errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
        let mut seen = BTreeSet::new();
        let mut all = Vec::new();
        for error in errors {
            let copied = self.source(error.span).range() != error.span.range();
            // What is quoted, and numbers, may differ between copies.
            let said: String = error.message.split('`').step_by(2).collect();
            let shape = said.replace(|c: char| c.is_ascii_digit(), "");
            let error = self.located(error);
            let place = error.span.range().map(|range| (range.start, range.end));
            if !copied || seen.insert((place, shape)) {
                all.push(error);
            }
        }
        all
    }

    /// A sentence with names as they are written.
    fn in_words(&self, text: &str) -> String {
        if self.written.is_empty() {
            return text.to_owned();
        }
        let mut words = String::new();
        let mut rest = text;
        let part = |c: char| c.is_alphanumeric() || c == '_';
        while let Some(start) = rest.find(part) {
            let (before, from) = rest.split_at(start);
            let end = from.find(|c| !part(c)).unwrap_or(from.len());
            let (word, after) = from.split_at(end);
            words.push_str(before);
            words.push_str(self.written.get(word).map_or(word, String::as_str));
            rest = after;
        }
        words + rest
    }
}
