//! Dimensions of vectors and matrices, entry by entry.

use super::form::Term;
use crate::shapes::Shape;

/// The dimensions of a value. Those of a pose are fixed: numbers in its rotation, lengths in its position.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Value {
    /// Shape of the value.
    pub shape: Shape,
    /// Dimensions of the entries, by rows; a single one if all entries have the same.
    entries: Vec<Term>,
}

impl Value {
    /// Creates a value whose entries all have one dimension.
    pub fn uniform(shape: Shape, term: Term) -> Self {
        let entries = vec![term];
        Value { shape, entries }
    }

    /// Creates a value from the dimensions of its entries.
    pub fn of(shape: Shape, entries: Vec<Term>) -> Self {
        let same = entries.windows(2).all(|pair| pair[0] == pair[1]);
        match entries.first() {
            Some(first) if same => Value::uniform(shape, first.clone()),
            Some(_) => Value { shape, entries },
            None => Value::uniform(shape, Term::one()),
        }
    }

    /// Creates a scalar.
    pub fn scalar(term: Term) -> Self {
        Value::uniform(Shape::Scalar, term)
    }

    /// Returns the number of entries that have to be looked at: 1 if all of them have the same dimension.
    pub fn distinct(&self) -> usize {
        self.entries.len()
    }

    /// Returns the number of entries.
    pub fn len(&self) -> usize {
        match self.shape {
            Shape::Scalar | Shape::Pose => 1,
            Shape::Vector(n) => n,
            Shape::Matrix(rows, columns) => rows * columns,
        }
    }

    /// Returns the dimension of an entry.
    pub fn at(&self, place: usize) -> &Term {
        self.entries.get(place).unwrap_or(&self.entries[0])
    }

    /// Returns the same shape with a function applied to the dimensions of all entries.
    pub fn map(&self, f: impl FnMut(&Term) -> Term) -> Self {
        Value::of(self.shape, self.entries.iter().map(f).collect())
    }

    /// Returns the dimensions of both values' entries, combined entry by entry, in the shape of this value.
    pub fn zip(&self, other: &Value, mut f: impl FnMut(&Term, &Term) -> Term) -> Self {
        let count = self.distinct().max(other.distinct());
        let entries = (0..count).map(|place| f(self.at(place), other.at(place)));
        Value::of(self.shape, entries.collect())
    }
}
