//! Entries of tables, before and after they are written.

use super::expression::Term;
use hamel_algebra::graph::Edge;

/// An entry.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Indices, from 1.
    pub index: Vec<usize>,
    /// What the entry is called, where that is more than its indices: an output, a rate.
    pub label: String,
    /// Its value.
    pub value: Term,
    /// How the description says it: a row of φ.
    pub reads: String,
}

/// Entries with one value.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The value.
    pub value: Term,
    /// Indices of the entries that have it.
    pub plus: Vec<Vec<usize>>,
    /// Indices of those that have its negative.
    pub minus: Vec<Vec<usize>>,
}

/// A temporary.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// Its name.
    pub name: String,
    /// Its value, in symbols and earlier temporaries.
    pub value: Term,
}

/// A cell of a table, zero or not.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Indices, from 1.
    pub index: Vec<usize>,
    /// See [`Entry::label`].
    pub label: String,
    /// See [`Entry::reads`].
    pub reads: String,
    /// Its value.
    pub edge: Edge,
}

impl Cell {
    /// The entry with its value written out.
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
