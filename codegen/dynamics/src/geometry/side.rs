//! Left- or right-invariance: whether the ∂ᵢ of a block of γ move a frame with constant twists in body axes or in
//! world axes.

use super::super::calculus::Calculus;
use crate::tables::EquationTables;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Mat3, Vec3, add3, apply_transposed, apply3, cross, zero3};
use hamel_language::model::Model;
use hamel_language::syntax::ast::CoordKind;

/// Invariance of the vector fields that move a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Rᵀ∂ᵢp and Rᵀ∂ᵢR are constant: velocities are in body axes, and γ are the structure constants.
    Left,
    /// (∂ᵢR)Rᵀ and ∂ᵢp − ωᵢ × p are constant: velocities are in world axes, and γ have the opposite sign.
    Right,
}

impl Side {
    /// Returns the side as text, such as `left-invariant (body)`.
    pub fn text(self) -> &'static str {
        match self {
            Side::Left => "left-invariant (body)",
            Side::Right => "right-invariant (world)",
        }
    }
}

/// Returns the side of a block of velocities, from the first frame turned by them that is moved with constant
/// twists on exactly one side; `None` if there is no such frame.
///
/// If no velocity of the block moves the frame's origin (a product of rotations and translations), the rotation
/// alone decides.
pub fn side(geometry: &mut EquationTables, block: &[usize]) -> Option<Side> {
    let zero = geometry.model.graph.zero().node();
    let vanishes = |edges: &[Edge]| edges.iter().all(|edge| edge.node() == zero);
    for (rotation, position) in poses(&geometry.model) {
        let (graph, calculus) = (&mut geometry.model.graph, &mut geometry.calculus);
        let spins = calculus.spin_jacobian(graph, &rotation);
        let moves = calculus.point_jacobian(graph, position);
        let member = |all: &[Vec3]| -> Vec<Vec3> {
            block.iter().filter_map(|&i| all.get(i).copied()).collect()
        };
        let (spins, moves) = (member(&spins), member(&moves));
        if spins.iter().all(|spin| vanishes(spin)) {
            continue;
        }
        let fixed = moves.iter().all(|moved| vanishes(moved));
        let (mut left, mut right) = (true, true);
        for (&spin, &moved) in spins.iter().zip(&moves) {
            let turned = apply3(graph, &rotation, spin);
            left &= are_constant(graph, calculus, &spin);
            right &= are_constant(graph, calculus, &turned);
            if !fixed {
                let local = apply_transposed(graph, &rotation, moved);
                let lever = cross(graph, position, turned);
                let velocity = add3(graph, moved, lever);
                left &= are_constant(graph, calculus, &local);
                right &= are_constant(graph, calculus, &velocity);
            }
        }
        match (left, right) {
            (true, false) => return Some(Side::Left),
            (false, true) => return Some(Side::Right),
            _ => {}
        }
    }
    None
}

/// Returns the poses of all frames, and of coordinates that are rotations or poses themselves.
fn poses(model: &Model) -> Vec<(Mat3, Vec3)> {
    let frames = model.frames.iter();
    let mut poses: Vec<(Mat3, Vec3)> = frames
        .map(|frame| (frame.rotation, frame.position))
        .collect();
    for coordinate in &model.coordinates {
        let entries = model.x.get(coordinate.offset..).unwrap_or_default();
        match (coordinate.kind, entries) {
            (CoordKind::SO3, &[a, b, c, d, e, f, g, h, i, ..]) => {
                let origin = zero3(&model.graph);
                poses.push(([[a, b, c], [d, e, f], [g, h, i]], origin));
            }
            (CoordKind::SE3, &[x, y, z, a, b, c, d, e, f, g, h, i, ..]) => {
                poses.push(([[a, b, c], [d, e, f], [g, h, i]], [x, y, z]));
            }
            _ => {}
        }
    }
    poses
}

fn are_constant(graph: &mut Graph, calculus: &mut Calculus, edges: &[Edge]) -> bool {
    edges.iter().all(|&edge| is_constant(graph, calculus, edge))
}

/// Returns whether all ∂ᵢ of an expression are 0.
pub fn is_constant(graph: &mut Graph, calculus: &mut Calculus, edge: Edge) -> bool {
    let zero = graph.zero().node();
    (0..calculus.n()).all(|i| calculus.along(graph, i, edge).node() == zero)
}
