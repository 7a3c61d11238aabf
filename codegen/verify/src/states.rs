//! Rates of states of first order at a point, from the description with ξ̇ inserted.

use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::{Edge, Node};
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::tangent::tangent_at;
use hamel_algebra::transplant::{rebuild, substitute};
use hamel_language::model::{Model, class};
use hamel_program::{FunctionId, Program};

/// Name of the rates of states in messages.
pub(super) const SUBJECT: &str = "ż of the states";

/// Returns the model with the emitted ξ̇ substituted for its symbols in the rates of states and in outputs.
///
/// This is done only if a function is applied to an expression in ξ̇: modulo p, a function of a symbol may differ from
/// the function of a sum or number that has the same value.
pub(super) fn with_rates(model: &Model, program: &Program) -> Model {
    let mut model = model.clone();
    let Some(accel) = program.function(FunctionId::Accel) else {
        return model;
    };
    let mut expressions = model.state_rates.clone();
    expressions.extend(model.outputs.iter().flat_map(|(_, value)| value.entries()));
    let moves = |edge: Edge| model.graph.class(edge.node()) & class::ACCEL != 0;
    let reached = model.graph.reachable(&expressions);
    let is_applied = reached.iter().any(|&id| match model.graph.node(id) {
        Node::Apply(_, a) => moves(a),
        Node::Atan2(y, x) => moves(y) || moves(x),
        Node::Select(c, ..) => moves(c),
        Node::External(_, list) => moves(list),
        _ => false,
    });
    if is_applied {
        let places = model.graph.symbol_places(&model.xi_dot);
        let n = model.n();
        let emitted = rebuild(&program.graph, &mut model.graph, &accel.outputs[..n]);
        let set: Vec<(usize, Edge)> = places.into_iter().zip(emitted).collect();
        let graph = &mut model.graph;
        model.state_rates = substitute(graph, &model.state_rates, &set);
        for (_, value) in &mut model.outputs {
            *value = value.map(|entry| substitute(graph, &[entry], &set)[0]);
        }
    }
    model
}

/// Returns ż for given rates ξ̇ of the velocities; `point` assigns values to the model's symbols.
pub(super) fn rates(
    model: &Model,
    xi_dot: &[ResiduePair],
    point: &FieldPoint,
) -> Option<Vec<ResiduePair>> {
    let mut point = point.clone();
    for (symbol, &value) in model.xi_dot.iter().zip(xi_dot) {
        point.set_symbol(model.graph.as_symbol(*symbol)?, value);
    }
    evaluate_at(&model.graph, &model.state_rates, &mut point)
}

/// Returns δż along a direction in the symbols; `motion` is ξ̇, and the δξ̇ by which ξ̇ changes along it.
pub(super) fn slopes(
    model: &Model,
    motion: (&[ResiduePair], &[ResiduePair]),
    point: &FieldPoint,
    direction: &[ResiduePair],
) -> Option<Vec<ResiduePair>> {
    slopes_of(model, &model.state_rates, motion, point, direction)
}

/// Returns the derivatives of any expressions of the model, as [`slopes`] does of ż.
pub(super) fn slopes_of(
    model: &Model,
    expressions: &[Edge],
    (xi_dot, change): (&[ResiduePair], &[ResiduePair]),
    point: &FieldPoint,
    direction: &[ResiduePair],
) -> Option<Vec<ResiduePair>> {
    let mut point = point.clone();
    let mut direction = direction.to_vec();
    for ((symbol, &value), &slope) in model.xi_dot.iter().zip(xi_dot).zip(change) {
        let place = model.graph.as_symbol(*symbol)?;
        point.set_symbol(place, value);
        direction[place] = slope;
    }
    let duals = tangent_at(&model.graph, expressions, &mut point, &direction)?;
    Some(duals.into_iter().map(|dual| dual.1).collect())
}
