//! Kinematics of frames at a point modulo p.
//!
//! The emitted pose is that of the description; the twist follows from its dual numbers along ẋ, with ω̂ = Ṙ Rᵀ; the
//! columns of J are the derivatives of the twist by ξ, and the bias acceleration is the derivative of the twist along ẋ
//! at ξ̇ = 0. None of the generator's derivatives is used.

use super::kernel::multiply;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Edge;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_algebra::tangent::tangent_at;
use hamel_language::functions::{FrameFunction, Jacobian};
use hamel_language::model::{Frame, Model};
use hamel_program::Program;

/// Name of the functions of frames in messages.
pub(super) const SUBJECT: &str = "pose, twist, Jacobian or bias acceleration of a frame";

/// Returns whether the emitted functions of frames hold; `point` assigns values to the symbols of model and program.
pub(super) fn hold(model: &Model, program: &Program, point: &FieldPoint) -> Option<bool> {
    for jacobian in &model.asked.jacobians {
        let mut frames = model.frames.iter();
        let Some(frame) = frames.find(|frame| frame.name == jacobian.frame) else {
            return Some(false);
        };
        if !frame_holds(model, program, (jacobian, frame), point)? {
            return Some(false);
        }
    }
    Some(true)
}

fn frame_holds(
    model: &Model,
    program: &Program,
    (jacobian, frame): (&Jacobian, &Frame),
    point: &FieldPoint,
) -> Option<bool> {
    let outputs = |of: FrameFunction| -> Option<&[Edge]> {
        let function = program.function(jacobian.name_of(of))?;
        Some(&function.outputs)
    };
    let [Some(pose), Some(twist), Some(rows), Some(bias)] = [
        FrameFunction::Pose,
        FrameFunction::Twist,
        FrameFunction::Jacobian,
        FrameFunction::BiasAcceleration,
    ]
    .map(outputs) else {
        return Some(false);
    };
    let graph = &program.graph;
    let value = |edges: &[Edge]| evaluate_at(graph, edges, &mut point.clone());
    let [_, x, xi, ..] = program.symbols();
    let rate = evaluate_at(&model.graph, &model.rate, &mut point.clone())?;
    let mut moving = vec![ResiduePair::ZERO; xi];
    moving[x..xi].copy_from_slice(&rate);
    // [R p] and its rate.
    let described: Vec<Edge> = (frame.rotation.iter().zip(frame.position))
        .flat_map(|(row, p)| [row[0], row[1], row[2], p])
        .collect();
    let placed = tangent_at(&model.graph, &described, &mut point.clone(), &moving)?;
    let (placed, moved): (Vec<ResiduePair>, Vec<ResiduePair>) = placed.into_iter().unzip();
    let r = |i: usize, j: usize| placed[4 * i + j];
    let spin = |i: usize, j: usize| {
        (0..3).fold(ResiduePair::ZERO, |sum, k| sum + moved[4 * i + k] * r(j, k))
    };
    let speed = [moved[3], moved[7], moved[11]];
    let omega = [spin(2, 1), spin(0, 2), spin(1, 0)];
    let axes = |v: [ResiduePair; 3]| -> [ResiduePair; 3] {
        match jacobian.own {
            true => {
                [0, 1, 2].map(|j| (0..3).fold(ResiduePair::ZERO, |sum, i| sum + r(i, j) * v[i]))
            }
            false => v,
        }
    };
    let expected = [axes(speed), axes(omega)].concat();
    let (eta, turned) = along_velocities(program, &expected);
    let slopes = |direction: &[ResiduePair]| -> Option<Vec<ResiduePair>> {
        let duals = tangent_at(graph, twist, &mut point.clone(), direction)?;
        Some(duals.into_iter().map(|dual| dual.1).collect())
    };
    Some(
        value(pose)? == placed
            && value(twist)? == expected
            && multiply(6, &value(rows)?, &eta) == slopes(&turned)?
            && value(bias)? == slopes(&moving)?,
    )
}

/// Returns a random η, and the direction in the symbols along which ξ changes by η.
pub(super) fn along_velocities(
    program: &Program,
    seeds: &[ResiduePair],
) -> (Vec<ResiduePair>, Vec<ResiduePair>) {
    let seed = seeds.iter().fold(program.n as u64, |seed, value| {
        seed.rotate_left(7) ^ value.bits()
    });
    let mut random = Random::new(seed);
    let eta: Vec<ResiduePair> = (0..program.n).map(|_| random.element()).collect();
    let mut direction = vec![ResiduePair::ZERO; program.symbols()[2]];
    direction.extend(&eta);
    (eta, direction)
}
