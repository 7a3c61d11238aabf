//! The rates of states of first order at a point, as the description has them: with ξ̇ put in, no other expression.

use hamel_algebra::fp::Fp;
use hamel_algebra::graph::{Edge, Node};
use hamel_algebra::lane::Lane;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::tangent::tangent_at;
use hamel_algebra::transplant::{rebuild, substitute};
use hamel_language::model::{Model, class};
use hamel_program::{FunctionId, Program};

/// What is broken where they differ.
pub(super) const WHAT: &str = "ż of the states";

/// The model, with the emitted ξ̇ in the place of its symbols in rates of states and in outputs whose slopes are taken, where
/// functions are taken of it: f of a symbol with the value of a sum, or of a number, is not f of that sum or number modulo p.
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

/// ż where the velocities have the rates ξ̇; the lane is one of the model's symbols.
pub(super) fn rates(model: &Model, xi_dot: &[Fp], lane: &Lane) -> Option<Vec<Fp>> {
    let mut lane = lane.clone();
    for (symbol, &value) in model.xi_dot.iter().zip(xi_dot) {
        lane.set_symbol(model.graph.as_symbol(*symbol)?, value);
    }
    evaluate_at(&model.graph, &model.state_rates, &mut lane)
}

/// δż along a direction in the symbols, in which ξ̇ moves by δξ̇.
pub(super) fn slopes(
    model: &Model,
    motion: (&[Fp], &[Fp]),
    lane: &Lane,
    direction: &[Fp],
) -> Option<Vec<Fp>> {
    slopes_of(model, &model.state_rates, motion, lane, direction)
}

/// The same of any expressions of the model.
pub(super) fn slopes_of(
    model: &Model,
    expressions: &[Edge],
    (xi_dot, change): (&[Fp], &[Fp]),
    lane: &Lane,
    direction: &[Fp],
) -> Option<Vec<Fp>> {
    let mut lane = lane.clone();
    let mut direction = direction.to_vec();
    for ((symbol, &value), &slope) in model.xi_dot.iter().zip(xi_dot).zip(change) {
        let place = model.graph.as_symbol(*symbol)?;
        lane.set_symbol(place, value);
        direction[place] = slope;
    }
    let duals = tangent_at(&model.graph, expressions, &mut lane, &direction)?;
    Some(duals.into_iter().map(|dual| dual.1).collect())
}
