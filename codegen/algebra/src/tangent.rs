//! Directional derivatives modulo p by dual numbers: value and slope of every node, without ever writing a
//! derivative as an expression.

use super::dual::{Duals, ForwardMode};
use super::field_point::FieldPoint;
use super::graph::{Edge, Graph};
use super::residue_pair::ResiduePair;
use super::walk::evaluate;

/// A value and its slope.
pub type Dual = (ResiduePair, ResiduePair);

/// Returns dual numbers modulo p along a direction, which has one entry for each symbol, 0 beyond its end.
pub(super) fn duals(
    point: &FieldPoint,
    direction: &[ResiduePair],
) -> Duals<FieldPoint, ForwardMode<impl Fn(usize) -> ResiduePair>> {
    Duals {
        numbers: point.clone(),
        slopes: ForwardMode(|index: usize| {
            direction.get(index).copied().unwrap_or(ResiduePair::ZERO)
        }),
    }
}

/// Evaluates the expressions and their slopes along `direction` at a point; `None` if something has no
/// value there.
pub fn tangent_at(
    graph: &Graph,
    roots: &[Edge],
    point: &mut FieldPoint,
    direction: &[ResiduePair],
) -> Option<Vec<Dual>> {
    let mut duals = duals(point, direction);
    let values = evaluate(graph, roots, &mut duals)?;
    (!duals.numbers.has_missing_root()).then_some(values)
}
