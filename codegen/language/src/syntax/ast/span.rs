//! Regions of the source.

use std::ops::Range;

/// A region of the source: bytes of a text, or the numbers of tokens in the input of a macro.
///
/// It is plain data, so descriptions and diagnostics can be sent between threads. Spans are ignored in comparisons: all
/// spans are equal, so two descriptions are equal if they say the same.
#[derive(Clone, Copy)]
pub struct Span {
    start: u32,
    end: u32,
}

impl Span {
    /// No region: the span of nodes that a program has created.
    pub const NOWHERE: Span = Span {
        start: u32::MAX,
        end: u32::MAX,
    };

    /// Creates the region of a range; [`Span::NOWHERE`] if its end is beyond 2³² − 2.
    pub fn new(range: Range<usize>) -> Self {
        match (u32::try_from(range.start), u32::try_from(range.end)) {
            (Ok(start), Ok(end)) if end < u32::MAX => Span { start, end },
            _ => Span::NOWHERE,
        }
    }

    /// Returns the range, or `None` for [`Span::NOWHERE`].
    pub fn range(self) -> Option<Range<usize>> {
        let somewhere = self.start != u32::MAX;
        somewhere.then(|| self.start as usize..self.end.max(self.start) as usize)
    }

    /// Returns the region moved `by` places later.
    pub fn later(self, by: usize) -> Self {
        match self.range() {
            Some(range) if by > 0 => Span::new(range.start + by..range.end + by),
            _ => self,
        }
    }

    /// Returns the region from the start of this one to the end of another.
    pub fn to(self, other: Span) -> Self {
        match (self.range(), other.range()) {
            (Some(first), Some(last)) if last.end > first.start => Span::new(first.start..last.end),
            (Some(_), Some(_)) => self,
            (None, _) => other,
            (_, None) => self,
        }
    }
}

impl PartialEq for Span {
    fn eq(&self, _: &Span) -> bool {
        true
    }
}

impl std::fmt::Debug for Span {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.range() {
            Some(range) => write!(f, "{range:?}"),
            None => f.write_str("nowhere"),
        }
    }
}
