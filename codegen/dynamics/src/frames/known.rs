//! Models whose graph already contains useful expressions: of two expressions with the same value, a graph keeps
//! the first.
//!
//! One kind are sines and cosines of sums of angles about parallel axes: with R(a) R(b) = R(a + b), a pose behind
//! joints with parallel axes takes a single rotation. The other kind are the vectors from frames of a chain to the
//! last one, which the columns of its Jacobian need and which are parts of its position.

use super::{by_velocities, chain, relative};
use crate::calculus::Calculus;
use hamel_algebra::graph::{Edge, Function, Graph};
use hamel_algebra::linear::{Mat3, Vec3, add3, apply3, identity3, multiply3, transpose3, zero3};
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;

/// Order in which poses along a chain are multiplied, once sums of angles are known.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ProductOrder {
    /// As in the description, from the world outwards.
    Given,
    /// As R₀ (R₁ R₂): frames that turn about parallel axes are combined first.
    Outwards,
    /// Like `Outwards`, but from the frame towards the world.
    Inwards,
    /// Only the vectors to the frame, from the frame towards the world.
    Ways,
}

/// Runs of consecutive joints with parallel axes on the chain to a frame.
struct ParallelRuns {
    /// Signs and coordinates of the joints of each run.
    joints: Vec<Vec<(bool, usize)>>,
    /// Frames that begin a run or another kind of rotation.
    begins: Vec<usize>,
}

/// Returns the model in several graphs that contain useful expressions from the start, so that every expression
/// equal to one of them becomes the same node.
///
/// These expressions are the sines and cosines of sums of angles about parallel axes, if the chain to the frame has
/// such axes, or the vectors to the frame.
pub fn with_known_expressions(model: &Model, index: usize) -> Vec<Model> {
    let runs = find_runs(model, index);
    let orders: &[ProductOrder] = match runs.joints.is_empty() {
        true => &[ProductOrder::Ways],
        false => &[
            ProductOrder::Given,
            ProductOrder::Outwards,
            ProductOrder::Inwards,
            ProductOrder::Ways,
        ],
    };
    let orders = orders.iter();
    orders
        .map(|&order| model_with_known(model, index, &runs, order))
        .collect()
}

/// Finds the runs of joints with parallel axes.
fn find_runs(model: &Model, index: usize) -> ParallelRuns {
    let mut graph = model.graph.clone();
    let mut calculus = Calculus::new(model);
    let mut runs: Vec<Vec<(bool, usize)>> = Vec::new();
    let mut begins = Vec::new();
    let mut last: Option<Vec3> = None;
    for at in chain(model, index) {
        let frame = &model.frames[at];
        let moved = relative(&mut graph, &mut calculus, frame);
        let none = zero3(&graph);
        let joints = by_velocities(model, &mut graph, moved);
        let mut turning = joints
            .iter()
            .enumerate()
            .filter(|(_, (_, turn))| *turn != none);
        let (first, second) = (turning.next(), turning.next());
        let Some((velocity, (_, turn))) = first else {
            continue;
        };
        let coordinate = model
            .rate
            .iter()
            .position(|rate| *rate == model.xi[velocity]);
        let (None, Some(coordinate)) = (second, coordinate) else {
            last = None;
            begins.push(at);
            continue;
        };
        let axis = apply3(&mut graph, &frame.rotation, *turn);
        let same = last == Some(axis);
        match (runs.last_mut(), last) {
            (Some(run), Some(before)) if same || axis.map(|entry| -entry) == before => {
                let sign = run.last().is_some_and(|(sign, _)| *sign);
                run.push((sign == same, coordinate));
            }
            _ => {
                runs.push(vec![(false, coordinate)]);
                begins.push(at);
            }
        }
        last = Some(axis);
    }
    runs.retain(|run| run.len() > 1);
    ParallelRuns {
        joints: runs,
        begins,
    }
}

/// Returns the model in a graph with known expressions.
fn model_with_known(
    model: &Model,
    index: usize,
    runs: &ParallelRuns,
    order: ProductOrder,
) -> Model {
    let mut known = model.graph.empty_copy();
    let symbols = model.graph.symbols().iter().enumerate();
    let mut reals = Vec::new();
    for (place, symbol) in symbols {
        let value = model.graph.value(Edge::of(symbol.node));
        known.symbol(&symbol.name, symbol.class, value);
        reals.push(model.graph.reals(place));
    }
    known.set_reals(reals);
    for run in &runs.joints {
        for first in 0..run.len() {
            let angles = run[first..].iter().map(|&(sign, coordinate)| {
                let symbol = known.symbols()[model.points.first + coordinate].node;
                Edge::of(symbol).signed(sign != run[first].0)
            });
            let mut sum = known.zero();
            for angle in angles.collect::<Vec<Edge>>() {
                sum = known.add(sum, angle);
                known.apply(Function::Sin, sum);
                known.apply(Function::Cos, sum);
            }
        }
    }
    let graph = &mut known;
    let mut poses: Vec<(bool, Pose)> = Vec::new();
    for at in chain(model, index) {
        let (rotation, position) = &model.frames[at].relative;
        let entries = [rotation.concat(), position.to_vec()].concat();
        let entries = rebuild(&model.graph, graph, &entries);
        let rotation: Mat3 = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entries[3 * i + j]));
        let position: Vec3 = [9, 10, 11].map(|i| entries[i]);
        poses.push((runs.begins.contains(&at), (rotation, position)));
    }
    let identity: Pose = (identity3(graph), zero3(graph));
    let (mut base, mut inner) = (identity, identity);
    match order {
        ProductOrder::Given => {}
        ProductOrder::Outwards => {
            for (begins, pose) in &poses {
                if *begins {
                    base = compose_poses(graph, &base, &inner);
                    inner = identity;
                }
                inner = compose_poses(graph, &inner, pose);
                compose_poses(graph, &base, &inner);
            }
        }
        ProductOrder::Inwards => {
            for (begins, (rotation, position)) in poses.iter().rev() {
                let back = transpose3(rotation);
                let moved = apply3(graph, &back, *position);
                inner = compose_poses(graph, &inner, &(back, moved.map(|entry| -entry)));
                let whole = compose_poses(graph, &base, &inner);
                if *begins {
                    (base, inner) = (whole, identity);
                }
            }
        }
        ProductOrder::Ways => {
            let mut way = zero3(graph);
            for (_, (rotation, position)) in poses.iter().rev() {
                let turned = apply3(graph, rotation, way);
                way = add3(graph, *position, turned);
            }
        }
    }
    model.transplanted(known, rebuild)
}

/// Rotation matrix (axes as columns) and origin.
type Pose = (Mat3, Vec3);

/// Returns the pose `on` of something placed on a frame, in the axes in which the frame's pose is given.
fn compose_poses(graph: &mut Graph, frame: &Pose, on: &Pose) -> Pose {
    let moved = apply3(graph, &frame.0, on.1);
    (
        multiply3(graph, &frame.0, &on.0),
        add3(graph, frame.1, moved),
    )
}
