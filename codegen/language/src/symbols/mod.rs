//! Name resolution. All names of a description are resolved once, without any algebra; the result is valid for every
//! graph that is built from the description.
//!
//! A symbol table holds every name with its kind and its place. The names in statements are looked up in the order in
//! which a description becomes known: constants, tables, declarations, then named expressions and frames, first those
//! that need no rates of coordinates, then the others. All errors about names are reported here and nowhere else.

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

/// The resolved names of a description without components and joints, and the order in which its named expressions and
/// frames become known.
#[derive(Clone, Debug)]
pub struct Resolved<'a> {
    /// Symbol table.
    pub symbols: Symbols<'a>,
    /// Order of named expressions and frames.
    pub order: Order<'a>,
    /// Names that statements mention, other than those that they declare.
    pub used: BTreeSet<String>,
}

/// Resolves all names of a description and reports all errors about them.
pub fn resolve<'a>(system: &'a System, report: &mut Report) -> Resolved<'a> {
    let symbols = declare::declare(system, report);
    let (names, errors) = statements::read(system, symbols);
    errors.into_iter().for_each(|error| report.push(error));
    names
}
