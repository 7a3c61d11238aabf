//! Entries of tables, before and after they are written as expressions.

use super::expression::Term;
use hamel_algebra::graph::Edge;

/// An entry of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Indices, counted from 1.
    pub index: Vec<usize>,
    /// Name of the entry, if it has one in addition to its indices: that of an output or a rate.
    pub label: String,
    /// Its value.
    pub value: Term,
    /// The equation as written in the description, for a row of φ.
    pub reads: String,
}

/// Entries that have the same value up to sign.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The value.
    pub value: Term,
    /// Indices of the entries with this value.
    pub plus: Vec<Vec<usize>>,
    /// Indices of the entries with the negative of this value.
    pub minus: Vec<Vec<usize>>,
}

/// A named subexpression.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// Its name.
    pub name: String,
    /// Its value, in terms of symbols and earlier temporaries.
    pub value: Term,
}

/// A cell of a table, zero or not.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Indices, counted from 1.
    pub index: Vec<usize>,
    /// See [`Entry::label`].
    pub label: String,
    /// See [`Entry::reads`].
    pub reads: String,
    /// Its value.
    pub edge: Edge,
}

impl Cell {
    /// Returns the entry for this cell, with its value as an expression.
    pub fn entry(&self, value: Term) -> Entry {
        let (index, label, reads) = (self.index.clone(), self.label.clone(), self.reads.clone());
        Entry {
            index,
            label,
            value,
            reads,
        }
    }
}
