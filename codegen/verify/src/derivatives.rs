//! Derivatives of inverse dynamics, and of ξ̇ by parameters, at a point modulo p.
//!
//! They are compared with dual numbers along random directions in the functions that they are derivatives of, which
//! have proofs of their own. None of the generator's derivatives is used.

use super::kernel::multiply;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_algebra::tangent::tangent_at;
use hamel_language::model::Model;
use hamel_program::{FunctionId, Program};

/// Name of these derivatives in messages.
pub(super) const SUBJECT: &str = "the slopes of inverse dynamics, or of ξ̇ by parameters";

/// Returns whether the emitted derivatives hold. A of the full model is evaluated at `point`, the emitted functions at
/// `inner`.
pub(super) fn hold(
    full: &Model,
    program: &Program,
    [point, inner]: [&FieldPoint; 2],
) -> Option<bool> {
    let emitted = |id: FunctionId| program.function(id).is_some();
    if !(emitted(FunctionId::InverseDynamicsSlopes) || emitted(FunctionId::ParameterSlopes)) {
        return Some(true);
    }
    let [params, x, xi, u, ..] = program.symbols();
    let a = evaluate_at(&full.graph, &full.a.concat(), &mut point.clone())?;
    let time = full.clock.map(|clock| clock.xi);
    let displaced: Vec<usize> = (0..full.n()).filter(|&i| Some(i) != time).collect();
    let n = displaced.len();
    let mut seed = 1u64;
    for entry in &a {
        seed = seed.rotate_left(7) ^ entry.bits();
    }
    let mut random = Random::new(seed);
    let mut numbers =
        |count: usize| -> Vec<ResiduePair> { (0..count).map(|_| random.element()).collect() };
    // (h, δξ), and A h.
    let motion = numbers(n + u - xi);
    let (h, changes) = motion.split_at(n);
    let moved = (0..full.nu()).map(|row| {
        let terms = displaced.iter().zip(h);
        terms.fold(ResiduePair::ZERO, |sum, (&i, &h)| {
            sum + a[row * full.n() + i] * h
        })
    });
    let mut direction = vec![ResiduePair::ZERO; program.graph.symbols().len()];
    for (place, value) in (x..xi).zip(moved) {
        direction[place] = value;
    }
    direction[xi..u].copy_from_slice(changes);
    let inverse = [
        FunctionId::InverseDynamicsSlopes,
        FunctionId::InverseDynamics,
    ];
    if !are_slopes(program, inverse, (&motion, &direction), inner)? {
        return Some(false);
    }
    let motion = numbers(x - params);
    direction.fill(ResiduePair::ZERO);
    direction[params..x].copy_from_slice(&motion);
    let rates = [FunctionId::ParameterSlopes, FunctionId::Accel];
    are_slopes(program, rates, (&motion, &direction), inner)
}

/// Returns whether one function has the derivatives of another along a direction, given as columns and in the symbols.
fn are_slopes(
    program: &Program,
    [slopes, of]: [FunctionId; 2],
    (columns, direction): (&[ResiduePair], &[ResiduePair]),
    point: &FieldPoint,
) -> Option<bool> {
    let Some(slopes) = program.function(slopes) else {
        return Some(true);
    };
    let Some(of) = program.function(of) else {
        return Some(false);
    };
    let table = evaluate_at(&program.graph, &slopes.outputs, &mut point.clone())?;
    let duals = tangent_at(&program.graph, &of.outputs, &mut point.clone(), direction)?;
    let expected: Vec<ResiduePair> = duals.into_iter().map(|dual| dual.1).collect();
    Some(multiply(expected.len(), &table, columns) == expected)
}
