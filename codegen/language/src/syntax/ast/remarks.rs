//! Comments of a description that a program writes for a reader.

use std::collections::BTreeMap;

/// Comments and empty lines of a printed description, such as the reasons that an import gives.
///
/// The parser drops comments, and comparisons for equality ignore them.
#[derive(Clone, Debug, Default)]
pub struct Remarks {
    /// Comments between the documentation and the head of the system, one string for each line.
    pub head: Vec<String>,
    /// Lines above the statement of each index. Those above the index after the last one end the system.
    above: BTreeMap<usize, Vec<Remark>>,
}

/// A line between statements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remark {
    /// An empty line.
    Blank,
    /// A comment.
    Comment(String),
}

impl PartialEq for Remarks {
    fn eq(&self, _: &Remarks) -> bool {
        true
    }
}

impl Remarks {
    /// Adds a line above the statement of this index, below those that stand there already.
    pub fn add(&mut self, index: usize, remark: Remark) {
        self.above.entry(index).or_default().push(remark);
    }

    /// Returns the lines above the statement of an index.
    pub fn above(&self, index: usize) -> &[Remark] {
        self.above.get(&index).map_or(&[], Vec::as_slice)
    }
}
