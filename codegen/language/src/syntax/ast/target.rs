//! What statements are about: `R`, `X.p`, `w[3]`.

use super::{Ident, Span};

/// A name or one of its parts on the left of `rate` and `start`: `R`, `X.p`, `w[3]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// The coordinate or velocity.
    pub name: Ident,
    /// The part of it: `R` or `p` of an SE3, `c` or `s` of an S1.
    pub field: Option<Ident>,
    /// The indices of an entry of it, from 1; none where the whole is meant. Until it is known what the name stands
    /// for, they are a part of the name.
    pub entry: Vec<i64>,
}

impl Target {
    /// Whether something belongs to both of two targets.
    pub fn overlaps(&self, other: &Target) -> bool {
        let both = self.entry.iter().zip(&other.entry);
        let field = |target: &Target| target.field.as_ref().map(|field| field.name.clone());
        let apart = field(self).zip(field(other)).is_some_and(|(a, b)| a != b);
        self.name.name == other.name.name && !apart && both.into_iter().all(|(a, b)| a == b)
    }

    /// The place of an entry among those of a vector of some length.
    pub fn place(&self, length: usize) -> Option<usize> {
        let [index] = self.entry.as_slice() else {
            return None;
        };
        let place = usize::try_from(*index).ok()?.checked_sub(1)?;
        (place < length).then_some(place)
    }

    /// The region of the whole target.
    pub fn span(&self) -> Span {
        match &self.field {
            Some(field) => self.name.span.to(field.span),
            None => self.name.span,
        }
    }
}
