//! Origins of statements that do not stand in the description itself: included texts, copies of statements, and
//! statements made from a file in another language.
//!
//! Places are numbers. Those of the description come first. Each included text, and each copy of statements made by a
//! part or by one round of a `for`, has a region of its own after them. A place alone is therefore enough to locate an
//! error: [`Origins::located`] finds the text that it belongs to and the statements that led there.

use super::Span;
use crate::diagnostics::Diagnostic;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

/// Largest number of notes per error that name a statement which made a copy.
const MOST_NOTES: usize = 4;

/// Regions of places after those of a description, or of the file that it was made from. They are ignored in comparisons for equality.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    /// First free place.
    next: usize,
    /// Regions in the order of their places.
    regions: Vec<Region>,
    /// Map from internal names to the names as written.
    written: Arc<BTreeMap<String, String>>,
}

impl PartialEq for Origins {
    fn eq(&self, _: &Origins) -> bool {
        true
    }
}

/// A range of consecutive places.
#[derive(Clone, Debug)]
struct Region {
    range: Range<usize>,
    origin: Origin,
}

#[derive(Clone, Debug)]
enum Origin {
    /// An included text.
    Text(Arc<Included>),
    /// A copy, made by the statement `by`, of the text that starts at place `of`.
    Copy { of: usize, by: Span, label: String },
    /// A statement made from the part of another file that starts at place `of`.
    Import { of: usize, statement: String },
}

/// A text that a description includes.
#[derive(Clone, Debug)]
pub struct Included {
    /// Path relative to the description.
    pub name: String,
    /// Contents.
    pub text: String,
    /// Statement that includes it.
    pub by: Span,
    /// Place of the first byte.
    start: usize,
}

impl Included {
    /// Returns the line and the column of a byte, both counted from 1.
    pub fn line(&self, at: usize) -> (usize, usize) {
        let before = self.text.get(..at).unwrap_or(&self.text);
        let start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        (line, before[start..].chars().count() + 1)
    }
}

/// Texts, in addition to the description, that an error refers to.
#[derive(Clone, Debug, Default)]
pub struct Texts(Vec<Text>);

#[derive(Clone, Debug)]
enum Text {
    /// An included text that a place of the error lies in.
    Included(Arc<Included>),
    /// The statement at fault. Its place is that of the part of another file, such as a URDF file, from which it was
    /// made.
    Statement(String),
}

impl Texts {
    /// Returns the included text that contains a region, and the byte range in that text.
    pub fn find(&self, span: Span) -> Option<(&Included, Range<usize>)> {
        let range = span.range()?;
        let inside = |text: &&Arc<Included>| {
            (text.start..=text.start + text.text.len()).contains(&range.start)
        };
        let mut included = self.0.iter().filter_map(|text| match text {
            Text::Included(text) => Some(text),
            Text::Statement(_) => None,
        });
        let text = included.find(inside)?;
        let local = range.start - text.start..range.end - text.start;
        Some((text, local))
    }

    /// Returns the statement at fault, if its place is that of the part of another file from which it was made.
    pub fn statement(&self) -> Option<&str> {
        self.0.iter().find_map(|text| match text {
            Text::Included(_) => None,
            Text::Statement(statement) => Some(statement.as_str()),
        })
    }
}

impl Origins {
    /// Creates an empty set of regions after a description with this many places.
    pub fn behind(places: usize) -> Origins {
        Origins {
            next: places + 1,
            ..Origins::default()
        }
    }

    /// Reserves a region of `len` places and returns its first place, or `None` if no places are left.
    fn room(&mut self, len: usize, origin: Origin) -> Option<usize> {
        let start = self.next;
        let range = start..start + len + 1;
        Span::new(range.clone()).range()?;
        self.next = range.end + 1;
        self.regions.push(Region { range, origin });
        Some(start)
    }

    /// Reserves a region for an included text and returns its first place, or `None` if no places are left.
    pub fn include(&mut self, name: &str, text: &str, by: Span) -> Option<usize> {
        let included = Included {
            name: name.to_owned(),
            text: text.to_owned(),
            by,
            start: self.next,
        };
        self.room(text.len(), Origin::Text(Arc::new(included)))
    }

    /// Reserves a region for a copy of `of`, and returns the offset from the places of the original to those of the
    /// copy. Returns 0 if no places are left.
    pub fn copy(&mut self, of: Span, by: Span, label: String) -> usize {
        let Some(range) = of.range() else {
            return 0;
        };
        let of = range.start;
        let room = self.room(range.len(), Origin::Copy { of, by, label });
        room.map_or(0, |start| start - of)
    }

    /// Reserves a region for a statement that was made from a part of another file, and returns its places. Each such
    /// statement has places of its own, also where several are made from one part. If no places are left, returns those
    /// of the part.
    pub fn import(&mut self, of: Range<usize>, statement: String) -> Span {
        let (start, len) = (of.start, of.len());
        let origin = Origin::Import {
            of: start,
            statement,
        };
        match self.room(len, origin) {
            Some(start) => Span::new(start..start + len),
            None => Span::new(of),
        }
    }

    /// Sets the map from internal names to names as the user wrote them.
    pub fn name(&mut self, written: BTreeMap<String, String>) {
        self.written = Arc::new(written);
    }

    /// Returns a name as the user wrote it, if it differs from the internal name.
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

    /// Returns whether a place is in an included text.
    pub fn is_included(&self, span: Span) -> bool {
        let region = self.region(self.source(span));
        region.is_some_and(|region| matches!(region.origin, Origin::Text(_)))
    }

    /// Returns the place where a statement, possibly a copy, was written.
    pub fn source(&self, span: Span) -> Span {
        self.unwound(span, &mut Vec::new())
    }

    /// Returns the statement that a place is in, if it was made from a part of another file.
    fn imported(&self, span: Span) -> Option<&str> {
        match &self.region(span)?.origin {
            Origin::Import { statement, .. } => Some(statement),
            Origin::Text(_) | Origin::Copy { .. } => None,
        }
    }

    /// Returns the place where a region was written, and collects the copies on the way there.
    fn unwound<'a>(&'a self, mut span: Span, copies: &mut Vec<(Span, &'a str)>) -> Span {
        while let (Some(range), Some(region)) = (span.range(), self.region(span)) {
            let of = match &region.origin {
                Origin::Text(_) => break,
                Origin::Copy { of, by, label } => {
                    copies.push((*by, label));
                    of
                }
                Origin::Import { of, .. } => of,
            };
            let back = region.range.start - of;
            span = Span::new(range.start - back..range.end - back);
        }
        span
    }

    /// Returns the span in the text that a place was written in, and the included text with the bytes in it, unless that
    /// is the description itself.
    pub fn written_at(&self, span: Span) -> (Span, Option<(&Included, Range<usize>)>) {
        let span = self.source(span);
        let included = self.region(span).and_then(|region| match &region.origin {
            Origin::Text(text) => {
                let range = span.range()?;
                Some((&**text, range.start - text.start..range.end - text.start))
            }
            Origin::Copy { .. } | Origin::Import { .. } => None,
        });
        (span, included)
    }

    /// Moves an error to the place where it was written, with notes at the statements that led there.
    pub fn located(&self, mut error: Diagnostic) -> Diagnostic {
        if self.regions.is_empty() && self.written.is_empty() {
            return error;
        }
        let mut copies = Vec::new();
        for (span, label) in &mut error.notes {
            *span = self.source(*span);
            *label = self.in_words(label);
        }
        let statement = self.imported(error.span).map(str::to_owned);
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
        error.texts.0.extend(statement.map(Text::Statement));
        error
    }

    /// Attaches to an error the included texts that it refers to, with a note at each statement that includes one.
    fn attach(&self, error: &mut Diagnostic) {
        let text = |span: Span| match &self.region(span)?.origin {
            Origin::Text(text) => Some(text.clone()),
            Origin::Copy { .. } | Origin::Import { .. } => None,
        };
        let mut next = text(error.span);
        while let Some(found) = next {
            error.notes.push((found.by, "included here".to_owned()));
            next = text(found.by);
        }
        let spans = [error.span].into_iter();
        let spans = spans.chain(error.notes.iter().map(|(span, _)| *span));
        error.texts = Texts(spans.filter_map(text).map(Text::Included).collect());
    }

    /// Locates all errors. Errors that are the same for several copies are kept once.
    pub fn located_all(&self, errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
        let mut seen = BTreeSet::new();
        let mut all = Vec::new();
        for error in errors {
            let region = self.region(error.span);
            let copied = region.is_some_and(|region| matches!(region.origin, Origin::Copy { .. }));
            // Quoted names, and numbers, may differ between copies.
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

    /// Replaces internal names in a sentence by the names as written.
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
