//! The centre of mass and the momentum about it at a point modulo p, in numbers from their definitions.
//!
//! Rates of centres and of axes are taken by dual numbers along ẋ; the columns of A_G are the derivatives of the
//! momentum by ξ, and the bias is its derivative along ẋ at ξ̇ = 0.

use super::frames::along_velocities;
use super::kernel::multiply;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Edge;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::tangent::tangent_at;
use hamel_dynamics::centroidal::bodies_that_move;
use hamel_language::model::Model;
use hamel_program::{FunctionId, Program};

/// Name of the centre of mass and centroidal momentum in messages.
pub(super) const SUBJECT: &str = "the centre of mass, or the momentum about it";

type V = [ResiduePair; 3];

/// Mass, centre of mass, its velocity, and angular momentum about it, of a body or particle.
struct Part {
    mass: ResiduePair,
    centre: V,
    velocity: V,
    moment: V,
}

/// Returns whether the emitted centre of mass, its velocity and the centroidal momentum have the values of the model at
/// a point modulo p; `point` assigns values to the symbols of both.
pub(super) fn holds(model: &Model, program: &Program, point: &FieldPoint) -> Option<bool> {
    let emitted = |id: FunctionId| program.function(id).map(|f| f.outputs.as_slice());
    if FunctionId::CENTROIDAL
        .iter()
        .all(|&id| emitted(id).is_none())
    {
        return Some(true);
    }
    let [_, x, xi, ..] = program.symbols();
    let rate = evaluate_at(&model.graph, &model.rate, &mut point.clone())?;
    let mut along = vec![ResiduePair::ZERO; xi];
    along[x..xi].copy_from_slice(&rate);
    let value = |edges: &[Edge]| evaluate_at(&program.graph, edges, &mut point.clone());
    let (centre, momentum) = sum_over_bodies(model, point, &along)?;
    let found = emitted(FunctionId::CentreOfMass);
    let mut holds = match found {
        Some(found) => value(found)? == centre,
        None => true,
    };
    // The momentum is emitted together with the other centroidal functions.
    let Some(emitted_momentum) = emitted(FunctionId::CentroidalMomentum) else {
        return Some(holds);
    };
    holds &= value(emitted_momentum)? == momentum;
    let slopes = |direction: &[ResiduePair]| -> Option<Vec<ResiduePair>> {
        let point = &mut point.clone();
        let duals = tangent_at(&program.graph, emitted_momentum, point, direction)?;
        Some(duals.into_iter().map(|dual| dual.1).collect())
    };
    if let Some(found) = emitted(FunctionId::CentroidalMap) {
        let (eta, turned) = along_velocities(program, &rate);
        holds &= multiply(6, &value(found)?, &eta) == slopes(&turned)?;
    }
    if let Some(found) = emitted(FunctionId::CentroidalBias) {
        holds &= value(found)? == slopes(&along)?;
    }
    Some(holds)
}

/// Returns c, and (P, L) about it, by the sums over bodies and particles that move.
fn sum_over_bodies(
    model: &Model,
    point: &FieldPoint,
    along: &[ResiduePair],
) -> Option<(Vec<ResiduePair>, Vec<ResiduePair>)> {
    let mut places = Vec::new();
    let mut fixed = Vec::new();
    for body in &model.bodies {
        let frame = &model.frames[body.frame];
        places.extend(frame.rotation.concat());
        places.extend(frame.position);
        fixed.push(body.mass);
        fixed.extend(body.com);
        fixed.extend(body.inertia_com.concat());
    }
    let particles = model.particles.iter();
    let points: Vec<Edge> = particles.clone().flat_map(|one| one.position).collect();
    let masses: Vec<Edge> = particles.map(|one| one.mass).collect();
    let graph = &model.graph;
    let duals = tangent_at(graph, &places, &mut point.clone(), along)?;
    let points = tangent_at(graph, &points, &mut point.clone(), along)?;
    let fixed = evaluate_at(graph, &fixed, &mut point.clone())?;
    let masses = evaluate_at(graph, &masses, &mut point.clone())?;
    let mut parts: Vec<Part> = Vec::new();
    for (pose, constants) in duals.chunks(12).zip(fixed.chunks(13)) {
        let r = |i: usize, j: usize| pose[3 * i + j].0;
        let turned = |i: usize, j: usize| pose[3 * i + j].1;
        let com = |j: usize| constants[1 + j];
        let sum = |term: &dyn Fn(usize) -> ResiduePair| {
            (0..3).fold(ResiduePair::ZERO, |sum, k| sum + term(k))
        };
        let centre: V = [0, 1, 2].map(|i| pose[9 + i].0 + sum(&|k| r(i, k) * com(k)));
        let velocity: V = [0, 1, 2].map(|i| pose[9 + i].1 + sum(&|k| turned(i, k) * com(k)));
        // Angular velocity in body axes, ω̂ = Rᵀ Ṙ.
        let spin = |i: usize, j: usize| sum(&|k| r(k, i) * turned(k, j));
        let omega = [spin(2, 1), spin(0, 2), spin(1, 0)];
        let own: V = [0, 1, 2].map(|i| sum(&|k| constants[4 + 3 * i + k] * omega[k]));
        let moment: V = [0, 1, 2].map(|i| sum(&|k| r(i, k) * own[k]));
        parts.push(Part {
            mass: constants[0],
            centre,
            velocity,
            moment,
        });
    }
    for (point, &mass) in points.chunks(3).zip(&masses) {
        parts.push(Part {
            mass,
            centre: [0, 1, 2].map(|i| point[i].0),
            velocity: [0, 1, 2].map(|i| point[i].1),
            moment: [ResiduePair::ZERO; 3],
        });
    }
    let moving = parts
        .iter()
        .zip(bodies_that_move(model))
        .filter(|(_, moves)| *moves);
    let moving: Vec<&Part> = moving.map(|(part, _)| part).collect();
    let total = |term: &dyn Fn(&Part) -> ResiduePair| {
        moving
            .iter()
            .fold(ResiduePair::ZERO, |sum, part| sum + term(part))
    };
    let inverse = total(&|part| part.mass).inv()?;
    let centre: V = [0, 1, 2].map(|i| total(&|part| part.mass * part.centre[i]) * inverse);
    let linear = [0, 1, 2].map(|i| total(&|part| part.mass * part.velocity[i]));
    let angular = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        total(&|part| {
            let (c, v) = (&part.centre, &part.velocity);
            let lever = (c[j] - centre[j]) * v[k] - (c[k] - centre[k]) * v[j];
            part.mass * lever + part.moment[i]
        })
    });
    Some((centre.to_vec(), [linear, angular].concat()))
}
