//! The shapes of all expressions: scalars, vectors, matrices and poses. All of this is found once, from the text and its
//! names, without any algebra.
//!
//! An expression has its shape from its parts; where a shape or an index depends on a number, as in `identity(n)` and
//! `v[k]`, constants are computed exactly. Functions of a description take the shapes of their arguments, and are looked
//! at once for each set of them. What is wrong with a shape, with the number of arguments, with an index or a part is
//! an error here, and nowhere else; an expression in error has no shape, and is no error where it is used.

mod arithmetic;
mod calls;
mod declarations;
mod functions;
mod infer;
mod motions;
mod parts;
mod rates;
mod shape;
mod statements;
mod targets;

use crate::diagnostics::Report;
use crate::symbols::Resolved;
use crate::syntax::ast::System;
use infer::Inference;

pub use arithmetic::LARGEST_PRODUCT;
pub use infer::MOST_LEVELS;
pub use rates::{rate_help, velocity_for};
pub use shape::MOST_ENTRIES;

/// Checks the shapes in a description whose names are resolved; all that is wrong with them is reported.
pub fn check(system: &System, names: &Resolved, report: &mut Report) {
    let errors = read(system, names).report.finish().err();
    errors
        .into_iter()
        .flatten()
        .for_each(|error| report.push(error));
}

/// The shapes of all names, with the errors of all statements.
pub(crate) fn read<'a>(system: &'a System, names: &'a Resolved<'a>) -> Inference<'a> {
    let mut inference = Inference::new(system, &names.symbols);
    inference.declarations(system, &names.order);
    for item in &system.items {
        inference.statement(system, item);
    }
    inference
}
