//! Outputs and their derivatives at a point modulo p, compared with the description.

use super::kernel::multiply;
use super::states::slopes_of;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_language::functions::SLOPES;
use hamel_language::model::Model;
use hamel_program::Program;

/// Name of the derivatives of outputs in messages.
pub(super) const SUBJECT: &str = "the slopes of an output";

/// Returns whether the emitted outputs have the values of the description; `point` assigns values to the model's
/// symbols.
pub(super) fn values_hold(model: &Model, program: &Program, point: &FieldPoint) -> Option<bool> {
    for (name, value) in &model.outputs {
        let Some(function) = program.function(name) else {
            continue;
        };
        let expected = evaluate_at(&model.graph, &value.entries(), &mut point.clone())?;
        if evaluate_at(&program.graph, &function.outputs, &mut point.clone())? != expected {
            return Some(false);
        }
    }
    Some(true)
}

/// Returns whether the emitted [C D] are the derivatives of the outputs along a direction.
///
/// `direction` is the direction in the symbols, `columns` the same direction as (h, δξ, δz, δu); `motion` is ξ̇, and
/// the δξ̇ by which ξ̇ changes along it.
pub(super) fn slopes_hold(
    model: &Model,
    program: &Program,
    motion: (&[ResiduePair], &[ResiduePair]),
    point: &FieldPoint,
    (direction, columns): (&[ResiduePair], &[ResiduePair]),
) -> Option<bool> {
    for (name, value) in &model.outputs {
        let Some(function) = program.function(format!("{name}{SLOPES}")) else {
            continue;
        };
        let table = evaluate_at(&program.graph, &function.outputs, &mut point.clone())?;
        let expected = slopes_of(model, &value.entries(), motion, point, direction)?;
        if multiply(expected.len(), &table, columns) != expected {
            return Some(false);
        }
    }
    Some(true)
}
