//! The columns of Y for the inertia of links: what a unit of each parameter needs, about the origin and in the axes of
//! the frame that the link's joint carries, with ω, α and the acceleration a of its origin, less gravity:
//! m: a; m s: force U s with U = α̂ + ω̂ω̂, torque s × a; Θ: torque Θ α + ω × Θ ω.

use super::parameters::{ENTRIES, Link};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Vec3, add3, apply_transposed, apply3, cross, identity3, zero3};
use crate::derive::tree::Tree;
use crate::derive::tree::inverse::{LinkMotion, Wrench, carried, motions};
use crate::model::Model;
use crate::program::count::count;

/// How the force of a wrench at the joints before is computed.
#[derive(Clone, Copy, Debug)]
enum Route {
    /// The wrench is carried from link to link.
    Carried,
    /// The freedoms of all joints before are carried to the link, and see what has no force.
    Seen,
    /// They see everything.
    AllSeen,
}

/// The columns of all links, ten of each.
pub fn inertial(model: &mut Model, tree: &Tree, links: &[Link]) -> Vec<Vec<Edge>> {
    let motions = motions_of(model, tree);
    let graph = &mut model.graph;
    let all = links.iter().zip(&motions).enumerate();
    all.flat_map(|(index, (link, motion))| {
        let all: Vec<usize> = (0..10).collect();
        of_link(graph, tree, index, (link, motion), &all, Route::Carried)
    })
    .collect()
}

/// The same with those that are kept at the least cost: of each link by the cheapest route.
pub fn cheapest(model: &mut Model, tree: &Tree, links: &[Link], kept: &[usize]) -> Vec<Vec<Edge>> {
    let motions = motions_of(model, tree);
    let graph = &mut model.graph;
    let mut columns: Vec<Option<Vec<Edge>>> = vec![None; 10 * links.len()];
    let mut roots: Vec<Edge> = Vec::new();
    for (index, link) in links.iter().zip(&motions).enumerate() {
        let own: Vec<usize> = (0..10)
            .filter(|k| kept.contains(&(10 * index + k)))
            .collect();
        let routes = [Route::Carried, Route::Seen, Route::AllSeen];
        let tried = routes.map(|route| {
            let mut graph = graph.clone();
            let found = of_link(&mut graph, tree, index, link, &own, route);
            let all = [&roots[..], &found.concat()].concat();
            (count(&graph, &all).weight(), graph, found)
        });
        let best = tried.into_iter().min_by_key(|(cost, ..)| *cost);
        if let Some((_, with, found)) = best {
            *graph = with;
            roots.extend(found.iter().flatten());
            for (k, column) in own.iter().zip(found) {
                columns[10 * index + k] = Some(column);
            }
        }
    }
    let all = columns.into_iter().enumerate();
    all.map(|(k, column)| {
        column.unwrap_or_else(|| {
            let (index, own) = (k / 10, [k % 10]);
            let link = (&links[index], &motions[index]);
            of_link(graph, tree, index, link, &own, Route::Carried).concat()
        })
    })
    .collect()
}

fn motions_of(model: &mut Model, tree: &Tree) -> Vec<LinkMotion> {
    let (xi, xi_dot, gravity) = (model.xi.clone(), model.xi_dot.clone(), model.gravity);
    motions(&mut model.graph, tree, &xi, &xi_dot, gravity)
}

/// The columns of some parameters of a link.
fn of_link(
    graph: &mut Graph,
    tree: &Tree,
    index: usize,
    (link, motion): (&Link, &LinkMotion),
    own: &[usize],
    route: Route,
) -> Vec<Vec<Edge>> {
    let n = tree.armature.len();
    let [omega, alpha, a] =
        [motion.omega, motion.alpha, motion.a].map(|v| apply_transposed(graph, &link.axes, v));
    let wrenches = unit_wrenches(graph, omega, alpha, a);
    let wrenches = own.iter().map(|&k| wrenches[k]);
    let wrenches: Vec<Wrench> = wrenches
        .map(|wrench| Wrench {
            force: apply3(graph, &link.axes, wrench.force),
            torque: apply3(graph, &link.axes, wrench.torque),
        })
        .collect();
    let zero = zero3(graph);
    wrenches
        .into_iter()
        .map(|wrench| match route {
            Route::AllSeen => seen(graph, tree, index, wrench, n),
            Route::Seen if wrench.force == zero => seen(graph, tree, index, wrench, n),
            Route::Seen | Route::Carried => felt(graph, tree, index, wrench, n),
        })
        .collect()
}

/// The generalised force of a wrench on a link: the power at the freedoms of all joints before, carried to the link.
fn seen(graph: &mut Graph, tree: &Tree, link: usize, wrench: Wrench, n: usize) -> Vec<Edge> {
    let mut forces = vec![graph.zero(); n];
    let mut path = vec![link];
    while let Some(parent) = path.last().and_then(|&index| tree.links[index].parent) {
        path.push(parent);
    }
    for (place, &before) in path.iter().enumerate() {
        for freedom in &tree.links[before].freedoms {
            let mut twist = freedom.clone();
            for &after in path[..place].iter().rev() {
                let link = &tree.links[after];
                if wrench.force != zero3(graph) {
                    let lever = cross(graph, twist.angular, link.position);
                    let linear = add3(graph, twist.linear, lever);
                    twist.linear = link.back(graph, linear);
                }
                twist.angular = link.back(graph, twist.angular);
            }
            let force = twist.felt(graph, &wrench);
            for &(i, k) in &freedom.rate {
                let share = graph.mul(k, force);
                forces[i] = graph.add(forces[i], share);
            }
        }
    }
    forces
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
