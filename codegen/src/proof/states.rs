//! The rates of states of first order at a point, as the description has them: with ξ̇ put in, no other expression.

use crate::algebra::fp::Fp;
use crate::algebra::graph::{Edge, Node};
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::algebra::tangent::tangent_at;
use crate::model::Model;

/// What is broken where they differ.
pub(super) const WHAT: &str = "ż of the states";

/// ż where the velocities have the rates ξ̇; the lane is one of the model's symbols.
pub(super) fn rates(model: &Model, xi_dot: &[Fp], lane: &Lane) -> Option<Vec<Fp>> {
    let mut lane = lane.clone();
    for (symbol, &value) in model.xi_dot.iter().zip(xi_dot) {
        lane.set_symbol(place(model, symbol)?, value);
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
        let place = place(model, symbol)?;
        lane.set_symbol(place, value);
        direction[place] = slope;
    }
    let duals = tangent_at(&model.graph, expressions, &mut lane, &direction)?;
    Some(duals.into_iter().map(|dual| dual.1).collect())
}

fn place(model: &Model, symbol: &Edge) -> Option<usize> {
    match model.graph.node(symbol.node()) {
        Node::Symbol(index) => Some(index as usize),
        _ => None,
    }
}
