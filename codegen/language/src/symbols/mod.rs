//! What the names of a description stand for. All of this is found once, without any algebra, and holds in every graph
//! that the description is read in.
//!
//! A table of symbols has every name with its kind and its place. Names in statements are looked up there, in the
//! order in which a description becomes known: constants, tables, what is declared, then named expressions and frames,
//! first those that need no rates, then the others. What is wrong with a name is an error here, and nowhere else.

mod check;
mod declare;
mod order;
mod statements;
mod table;
pub mod words;

use crate::diagnostics::Report;
use crate::syntax::ast::System;
use std::collections::BTreeSet;

pub use order::{Order, Relation, Step};
pub use table::{Kind, Symbols};

/// The names of a description without components and joints, and the order in which its named expressions and frames
/// become known.
#[derive(Clone, Debug)]
pub struct Resolved<'a> {
    /// What each name stands for.
    pub symbols: Symbols<'a>,
    /// The order of named expressions and frames.
    pub order: Order<'a>,
    /// The names that statements mention, but for what they declare.
    pub used: BTreeSet<String>,
}

/// Resolves all names of a description; all that is wrong with them is reported.
pub fn resolve<'a>(system: &'a System, report: &mut Report) -> Resolved<'a> {
    let symbols = declare::declare(system, report);
    let (names, errors) = statements::read(system, symbols);
    errors.into_iter().for_each(|error| report.push(error));
    names
}
