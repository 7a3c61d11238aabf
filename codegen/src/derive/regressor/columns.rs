//! The columns of Y for the inertia of links: what a unit of each parameter needs, about the origin and in the axes of
//! the frame that the link's joint carries, with ω, α and the acceleration a of its origin, less gravity:
//! m: a; m s: force U s with U = α̂ + ω̂ω̂, torque s × a; Θ: torque Θ α + ω × Θ ω.

use super::parameters::{ENTRIES, Link};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Vec3, add3, apply_transposed, apply3, cross, identity3, zero3};
use crate::derive::tree::Tree;
use crate::derive::tree::inverse::{Wrench, carried, motions};
use crate::model::Model;

/// The columns of all links, ten of each.
pub fn inertial(model: &mut Model, tree: &Tree, links: &[Link]) -> Vec<Vec<Edge>> {
    let (xi, xi_dot, gravity) = (model.xi.clone(), model.xi_dot.clone(), model.gravity);
    let graph = &mut model.graph;
    let motions = motions(graph, tree, &xi, &xi_dot, gravity);
    let mut columns = Vec::new();
    for (index, (link, motion)) in links.iter().zip(&motions).enumerate() {
        let [omega, alpha, a] =
            [motion.omega, motion.alpha, motion.a].map(|v| apply_transposed(graph, &link.axes, v));
        for wrench in unit_wrenches(graph, omega, alpha, a) {
            let wrench = Wrench {
                force: apply3(graph, &link.axes, wrench.force),
                torque: apply3(graph, &link.axes, wrench.torque),
            };
            columns.push(felt(graph, tree, index, wrench, xi.len()));
        }
    }
    columns
}

/// What a unit of each of the ten parameters needs.
fn unit_wrenches(graph: &mut Graph, omega: Vec3, alpha: Vec3, a: Vec3) -> Vec<Wrench> {
    let unit = identity3(graph);
    let zero = zero3(graph);
    let mut wrenches = Vec::with_capacity(10);
    for (i, j) in ENTRIES {
        // Θ v of the matrix with ones at (i, j) and (j, i).
        let by = |v: Vec3| {
            let mut product = zero;
            product[i] = v[j];
            product[j] = v[i];
            product
        };
        let gyro = cross(graph, omega, by(omega));
        wrenches.push(Wrench {
            force: zero,
            torque: add3(graph, by(alpha), gyro),
        });
    }
    for axis in unit {
        let sway = cross(graph, alpha, axis);
        let inner = cross(graph, omega, axis);
        let centripetal = cross(graph, omega, inner);
        wrenches.push(Wrench {
            force: add3(graph, sway, centripetal),
            torque: cross(graph, axis, a),
        });
    }
    wrenches.push(Wrench {
        force: a,
        torque: zero,
    });
    wrenches
}

/// The generalised force of a wrench on a link, at all joints before it.
fn felt(graph: &mut Graph, tree: &Tree, link: usize, wrench: Wrench, n: usize) -> Vec<Edge> {
    let mut forces = vec![graph.zero(); n];
    let (mut at, mut wrench) = (Some(link), wrench);
    while let Some(index) = at {
        let link = &tree.links[index];
        for freedom in &link.freedoms {
            let force = freedom.felt(graph, &wrench);
            for &(i, k) in &freedom.rate {
                let share = graph.mul(k, force);
                forces[i] = graph.add(forces[i], share);
            }
        }
        wrench = carried(graph, link, &wrench);
        at = link.parent;
    }
    forces
}
