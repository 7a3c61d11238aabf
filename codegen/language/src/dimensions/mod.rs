//! Inference of dimensions: if any unit is written in a description, every expression has a dimension, and sums,
//! comparisons, functions and statements are checked.
//!
//! Dimensions are products of rational powers of kg, m, s, A and K; an angle is a number. What has no unit has an unknown
//! dimension, which follows from equations between dimensions: linear ones over the rational numbers, as in A. Kennedy,
//! *Relational parametricity and units of measure*, POPL 1997. A plain number has the dimension that its place asks for
//! where it is a term, a value, or a side of an equation or comparison; as a factor it has none; zero has every dimension.
//!
//! | file | contents |
//! |---|---|
//! | `form`, `unification` | dimensions with unknowns, and their equations |
//! | `value` | dimensions of vectors and matrices, entry by entry |
//! | `walk`, `calls` | dimensions of expressions |
//! | `names`, `statements`, `elements` | dimensions of declarations, and those that statements require |
//! | `mismatch` | errors |

mod calls;
mod elements;
mod form;
mod mismatch;
mod names;
mod statements;
mod unification;
mod value;
mod walk;

use crate::diagnostics::Report;
use crate::shapes;
use crate::symbols::Resolved;
use crate::syntax::ast::visit::{Visit, visit};
use crate::syntax::ast::{Expr, ExprKind, Ident, Item, ItemKind, Span, System, Target};
use std::collections::BTreeMap;
use walk::Walk;

/// Dimensions of the names of a description with units.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Dimensions {
    /// SI units of the declared names whose dimension is known, by name. Vectors with entries of several dimensions have
    /// none.
    pub units: BTreeMap<String, String>,
    /// Number of names with a unit in the text.
    pub declared: usize,
    /// Number of names whose dimension was inferred.
    pub inferred: usize,
    /// Names whose dimension does not follow from the text.
    pub open: Vec<String>,
}

/// Checks the dimensions in a description whose names and shapes are right. Returns `None` if it has no units.
pub(crate) fn check<'a>(
    system: &'a System,
    names: &'a Resolved<'a>,
    report: &mut Report,
) -> Option<Dimensions> {
    if !system.items.iter().any(has_unit) {
        return None;
    }
    let mut walk = Walk::new(system, names, shapes::read(system, names));
    walk.declarations(system, &names.order);
    for item in &system.items {
        walk.statement(item);
    }
    let dimensions = walk.summary(system);
    let errors = walk.report.finish().err().unwrap_or_default();
    errors.into_iter().for_each(|error| report.push(error));
    Some(dimensions)
}

/// Returns whether a statement has a unit.
fn has_unit(item: &Item) -> bool {
    let declared = match &item.kind {
        ItemKind::Param(list)
        | ItemKind::Const(list)
        | ItemKind::Let(list)
        | ItemKind::Velocity(list)
        | ItemKind::Input(list)
        | ItemKind::State(list) => list.iter().any(|one| one.unit.is_some()),
        ItemKind::Coord(list) => list.iter().any(|(_, _, unit)| unit.is_some()),
        ItemKind::Output { unit, .. } => unit.is_some(),
        _ => false,
    };
    let mut numbers = Quantities(false);
    visit(&mut item.clone(), &mut numbers);
    declared || numbers.0
}

/// Whether an expression of a statement has a number with a unit.
struct Quantities(bool);

impl Visit for Quantities {
    fn declares(&mut self, _: &mut Ident, _: bool) {}
    fn uses(&mut self, _: &mut Ident) {}
    fn target(&mut self, _: &mut Target) {}
    fn place(&mut self, _: &mut Span) {}

    fn expr(&mut self, expr: &mut Expr) {
        self.0 |= has_quantity(expr);
    }
}

fn has_quantity(expr: &Expr) -> bool {
    matches!(expr.kind, ExprKind::Quantity(_)) || expr.parts().into_iter().any(has_quantity)
}
