//! Wrenches (N, N m) that a unit of each moment of a link needs, about the link's origin: the origin of the frame
//! that its joint carries, or another point of the joint's axis.
//!
//! Let U = α̂ + ω̂ ω̂ and let a be the acceleration of the origin minus gravity. A mass at the origin needs the
//! force a; a first moment along e needs the force U e and the torque e × a; a second moment ∫ r rᵀ dm = e eᵀ needs
//! the torque e × U e; and e fᵀ + f eᵀ needs the torque e × U f + f × U e. These vectors may be written in any axes
//! in which U and e are given: those of the link's frame, or those that the link has before it turns. In the
//! latter, U is that of the previous link plus a few terms of the joint's rate.

use super::parameters::{INERTIA_ENTRIES, Link};
use crate::tree::Tree;
use crate::tree::inverse::{LinkMotion, RotationalMotion, motions};
use crate::tree::link::TensorRoute;
use crate::tree::turn::RotationFactor;
use crate::tree::wrench::Wrench;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{
    Mat3, Vec3, add3, apply_transposed, apply3, cross, identity3, multiply3, transpose3, zero3,
};
use hamel_language::model::Model;

/// Axes in which wrenches are computed, and the way to compute U.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrenchAxes {
    /// Axes of each link; columns of U are carried from link to link.
    Own,
    /// Axes shared by parallel hinges, and by the last link of a chain with the previous one; columns of U are
    /// carried as in `Own`.
    Shared,
    /// Axes as in `Shared`; all of U is computed step by step from link to link.
    Stepwise,
}

/// All choices of axes.
pub const ALL_AXES: [WrenchAxes; 3] = [WrenchAxes::Own, WrenchAxes::Shared, WrenchAxes::Stepwise];

/// Velocities and accelerations of all links in some axes, from which the wrenches of unit parameters follow.
pub struct LinkMotions {
    /// Links in these axes.
    pub tree: Tree,
    /// Rotation of a link's own axes relative to these, if they differ.
    lags: Vec<Option<RotationFactor>>,
    motions: Vec<LinkMotion>,
}

impl LinkMotions {
    /// Computes the motion of the model's links.
    pub(super) fn new(model: &mut Model, tree: &Tree, axes: WrenchAxes) -> Self {
        let (xi, xi_dot, gravity) = (model.xi.clone(), model.xi_dot.clone(), model.gravity);
        let graph = &mut model.graph;
        let (mut tree, lags) = match axes {
            WrenchAxes::Own => (tree.clone(), vec![None; tree.links.len()]),
            WrenchAxes::Shared | WrenchAxes::Stepwise => tree.with_shared_axes(graph),
        };
        tree.tensors = match axes {
            WrenchAxes::Own | WrenchAxes::Shared => TensorRoute::Carried,
            WrenchAxes::Stepwise => TensorRoute::Chained,
        };
        let motions = motions(graph, &tree, &xi, &xi_dot, gravity);
        LinkMotions {
            tree,
            lags,
            motions,
        }
    }

    /// Returns the wrenches of a link's ten parameters, in the axes of the tree.
    pub(super) fn wrenches(&self, graph: &mut Graph, index: usize, link: &Link) -> Vec<Wrench> {
        let motion = &self.motions[index];
        match &self.lags[index] {
            None => in_own_axes(graph, motion, &link.axes),
            Some(lag) => in_shared_axes(graph, motion, lag, &link.axes),
        }
    }
}

/// Computes wrenches in the axes of the frame, which are given in those of the link, and returns them in the axes
/// of the link.
fn in_own_axes(graph: &mut Graph, motion: &LinkMotion, axes: &Mat3) -> Vec<Wrench> {
    let a = apply_transposed(graph, axes, motion.a);
    let is_kept = |entry: &Edge| *entry == graph.zero() || entry.abs() == graph.one();
    let (u, differences) = if axes.iter().flatten().all(is_kept) {
        let u = multiply3(graph, &motion.u, axes);
        let u = multiply3(graph, &transpose3(axes), &u);
        let place = |i: usize| (0..3).find(|&row| axes[row][i] != graph.zero());
        let places = [0, 1, 2].map(|i| place(i).unwrap_or(i));
        let difference = |i: usize| motion.difference(places[(i + 2) % 3], places[(i + 1) % 3]);
        (u, [0, 1, 2].map(difference))
    } else {
        let [omega, alpha] = [motion.omega, motion.alpha].map(|v| apply_transposed(graph, axes, v));
        let turning = RotationalMotion::of(graph, omega, alpha);
        (turning.u, turning.differences)
    };
    let mut torques = [[zero3(graph); 3]; 3];
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        torques[i][i][j] = -u[k][i];
        torques[i][i][k] = u[j][i];
        // Of the product j, k: the component along i is U_kk − U_jj.
        torques[j][k][i] = differences[i];
        torques[j][k][j] = u[i][j];
        torques[j][k][k] = -u[i][k];
        torques[k][j] = torques[j][k];
    }
    let forces = transpose3(&u);
    let units = identity3(graph);
    let wrenches = in_parameter_order(graph, &torques, &forces, &units, a);
    let turned = wrenches.into_iter().map(|wrench| Wrench {
        force: apply3(graph, axes, wrench.force),
        torque: apply3(graph, axes, wrench.torque),
    });
    turned.collect()
}

/// Computes wrenches in shared axes, relative to which the link is turned about the third axis.
///
/// The torque along this axis is computed in the link's own axes, where it takes fewer operations: U_xx + U_yy and
/// U_yx − U_xy are the same in both.
fn in_shared_axes(
    graph: &mut Graph,
    motion: &LinkMotion,
    lag: &RotationFactor,
    axes: &Mat3,
) -> Vec<Wrench> {
    let LinkMotion { u, a, .. } = motion;
    let own = transpose3(axes);
    let units = own.map(|e| lag.rotate(graph, e));
    let forces = units.map(|e| apply3(graph, u, e));
    let [x, y] = [0, 1].map(|k| lag.rotate(graph, identity3(graph)[k]));
    let by_x = apply3(graph, u, x);
    let last = [u[0][2], u[1][2], u[2][2]];
    let (trace, twist) = (graph.add(u[0][0], u[1][1]), graph.sub(u[1][0], u[0][1]));
    let (xx, yx) = (graph.dot(&x, &by_x), graph.dot(&y, &by_x));
    let yy = graph.sub(trace, xx);
    let xy = graph.sub(yx, twist);
    let first = [xx, xy, graph.dot(&x, &last)];
    let second = [yx, yy, graph.dot(&y, &last)];
    let of = |graph: &mut Graph, i: usize, j: usize| {
        let mut torque = cross(graph, units[i], forces[j]);
        let (along_y, along_x) = (graph.dot(&second, &own[j]), graph.dot(&first, &own[j]));
        let (left, right) = (graph.mul(own[i][0], along_y), graph.mul(own[i][1], along_x));
        torque[2] = graph.sub(left, right);
        torque
    };
    let mut torques = [[zero3(graph); 3]; 3];
    for (i, j) in INERTIA_ENTRIES {
        let torque = of(graph, i, j);
        torques[i][j] = if i == j {
            torque
        } else {
            let other = of(graph, j, i);
            add3(graph, torque, other)
        };
    }
    in_parameter_order(graph, &torques, &forces, &units, *a)
}

/// Returns the wrenches in the order of the parameters, from the torques of second moments and the forces of first
/// moments.
fn in_parameter_order(
    graph: &mut Graph,
    torques: &[[Vec3; 3]; 3],
    forces: &[Vec3; 3],
    units: &[Vec3; 3],
    a: Vec3,
) -> Vec<Wrench> {
    let zero = zero3(graph);
    let second = INERTIA_ENTRIES.iter().map(|&(i, j)| Wrench {
        force: zero,
        // Products of inertia are second moments with the opposite sign.
        torque: if i == j {
            torques[i][i]
        } else {
            torques[i][j].map(|entry| -entry)
        },
    });
    let mut wrenches: Vec<Wrench> = second.collect();
    for (&unit, &force) in units.iter().zip(forces) {
        let torque = cross(graph, unit, a);
        wrenches.push(Wrench { force, torque });
    }
    wrenches.push(Wrench {
        force: a,
        torque: zero,
    });
    wrenches
}
