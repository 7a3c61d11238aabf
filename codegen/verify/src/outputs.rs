//! Outputs and their slopes at a point modulo p, as the description has them.

use super::kernel::applied;
use super::states::slopes_of;
use hamel_algebra::fp::Fp;
use hamel_algebra::lane::Lane;
use hamel_algebra::numeric::evaluate_at;
use hamel_language::functions::SLOPES;
use hamel_language::model::Model;
use hamel_program::Program;

/// What is broken where they differ.
pub(super) const WHAT: &str = "the slopes of an output";

/// Whether the emitted outputs have the values of the description; the lane is one of the model's symbols.
pub(super) fn values_hold(model: &Model, program: &Program, lane: &Lane) -> Option<bool> {
    for (name, value) in &model.outputs {
        let Some(function) = program.function(name) else {
            continue;
        };
        let expected = evaluate_at(&model.graph, &value.entries(), &mut lane.clone())?;
        if evaluate_at(&program.graph, &function.outputs, &mut lane.clone())? != expected {
            return Some(false);
        }
    }
    Some(true)
}

/// Whether the emitted [C D] are the slopes along a direction in the symbols, in which ξ̇ moves by δξ̇; `columns` is
/// the same direction as (h, δξ, δz, δu).
pub(super) fn slopes_hold(
    model: &Model,
    program: &Program,
    motion: (&[Fp], &[Fp]),
    lane: &Lane,
    (direction, columns): (&[Fp], &[Fp]),
) -> Option<bool> {
    for (name, value) in &model.outputs {
        let Some(function) = program.function(format!("{name}{SLOPES}")) else {
            continue;
        };
        let table = evaluate_at(&program.graph, &function.outputs, &mut lane.clone())?;
        let expected = slopes_of(model, &value.entries(), motion, lane, direction)?;
        if applied(expected.len(), &table, columns) != expected {
            return Some(false);
        }
    }
    Some(true)
}
