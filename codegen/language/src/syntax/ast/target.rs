//! Targets of statements: `R`, `X.p`, `w[3]`.

use super::{Ident, Span};

/// A coordinate or velocity, or a part or entry of one, on the left side of statements such as `rate` and `start`: `R`,
/// `X.p`, `w[3]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// The coordinate or velocity.
    pub name: Ident,
    /// Part: `R` or `p` of an SE3, `c` or `s` of an S1.
    pub field: Option<Ident>,
    /// Indices of an entry, from 1; empty if the whole is meant. Until names are resolved, indices are part of the name
    /// instead.
    pub entry: Vec<i64>,
}

impl Target {
    /// Returns whether two targets have an entry in common.
    pub fn overlaps(&self, other: &Target) -> bool {
        let both = self.entry.iter().zip(&other.entry);
        let field = |target: &Target| target.field.as_ref().map(|field| field.name.clone());
        let apart = field(self).zip(field(other)).is_some_and(|(a, b)| a != b);
        self.name.name == other.name.name && !apart && both.into_iter().all(|(a, b)| a == b)
    }

    /// Returns the position, from 0, of the entry in a vector of the given length. Returns `None` if there is no single
    /// index or it is out of range.
    pub fn place(&self, length: usize) -> Option<usize> {
        let [index] = self.entry.as_slice() else {
            return None;
        };
        let place = usize::try_from(*index).ok()?.checked_sub(1)?;
        (place < length).then_some(place)
    }

    /// Returns the span of the whole target.
    pub fn span(&self) -> Span {
        match &self.field {
            Some(field) => self.name.span.to(field.span),
            None => self.name.span,
        }
    }
}
