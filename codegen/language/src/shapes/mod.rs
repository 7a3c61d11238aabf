//! Shape inference: every expression is a scalar, a vector, a matrix or a pose. Shapes are determined once, from the
//! text and the resolved names, without any algebra.
//!
//! The shape of an expression follows from those of its parts. If a shape or an index depends on a number, as in
//! `identity(n)` and `v[k]`, constants are computed exactly. Functions of a description take the shapes of their
//! arguments, and are checked once for each combination of them. All errors about shapes, numbers of arguments, indices
//! and parts are reported here and nowhere else. An expression in error has no shape, and causes no further errors
//! where it is used.

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

pub use arithmetic::LARGEST_PRODUCT;
pub use infer::{Inference, MOST_LEVELS};
pub use rates::{rate_help, velocity_for};
pub use shape::{MOST_ENTRIES, Shape, Shaped};

/// Checks the shapes in a description whose names are resolved, and reports all errors about them.
pub fn check(system: &System, names: &Resolved, report: &mut Report) {
    let errors = read(system, names).report.finish().err();
    errors
        .into_iter()
        .flatten()
        .for_each(|error| report.push(error));
}

/// Determines the shapes of all names, and collects the errors of all statements.
pub(crate) fn read<'a>(system: &'a System, names: &'a Resolved<'a>) -> Inference<'a> {
    let mut inference = Inference::new(system, &names.symbols);
    inference.declarations(system, &names.order);
    for item in &system.items {
        inference.statement(system, item);
    }
    inference
}
