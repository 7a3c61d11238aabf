//! Momenta by recursion: the total momentum, and the force ∂ᵢT − γᵢⱼᵏ ξʲ pₖ, which changes p = M ξ
//! even if no force acts, KR18 (30a).
//!
//! pᵢ = Sᵢ · h, with the freedom's twist Sᵢ and the momentum h = (k about the link's origin, l) of
//! the subtree of its joint. Forces change h; the remaining part of ṗᵢ is Ṡᵢ · h with Ṡᵢ = V × Sᵢ,
//! where V = (ω, v) is the twist of the link and Sᵢ is constant in its axes. As a wrench on the
//! link this is (torque k × ω + l × v, force l × ω).

use super::inverse::{LinkMotion, generalized_forces_with, motions, to_parent, wrench};
use super::link::Tree;
use super::mass::LinkInertia;
use super::wrench::Wrench;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, add3, cross, zero3};

/// Returns the momentum of each link about its origin, in its axes, and the twists of the links.
fn momenta(graph: &mut Graph, tree: &Tree, xi: &[Edge]) -> (Vec<Wrench>, Vec<LinkMotion>) {
    // Used as accelerations from rest, the velocities yield twists, and the wrenches yield momenta.
    let (none, still) = (zero3(graph), vec![graph.zero(); xi.len()]);
    let twists = motions(graph, tree, &still, xi, none);
    let links = tree.links.iter().zip(&twists);
    let momenta = links.map(|(link, twist)| wrench(graph, &link.mass, twist));
    (momenta.collect(), twists)
}

/// Returns the total linear momentum of a tree, and the angular momentum about the origin of the world, in world axes,
/// as expressions.
pub fn total_momentum(graph: &mut Graph, tree: &Tree, xi: &[Edge]) -> (Vec3, Vec3) {
    let (mut momenta, _) = momenta(graph, tree, xi);
    let none = zero3(graph);
    let mut total = Wrench {
        force: none,
        torque: none,
    };
    for (index, link) in tree.links.iter().enumerate().rev() {
        let moved = to_parent(graph, link, &momenta[index]);
        let onto = match link.parent {
            Some(parent) => &mut momenta[parent],
            None => &mut total,
        };
        *onto = onto.plus(graph, &moved);
    }
    (total.force, total.torque)
}

/// Returns the total momentum for a unit of each single velocity: the columns of the momentum
/// matrix.
///
/// Each column is (linear, angular about the origin of the world) in world axes, and is the
/// momentum of the subtree of the joint, moving as one body.
pub fn momentum_columns(graph: &mut Graph, tree: &Tree, n: usize) -> Vec<(Vec3, Vec3)> {
    let mut composite: Vec<LinkInertia> = tree.links.iter().map(|link| link.mass).collect();
    for (index, link) in tree.links.iter().enumerate().rev() {
        if let Some(parent) = link.parent {
            let moved = composite[index].to_parent(graph, link);
            composite[parent] = composite[parent].plus(graph, &moved);
        }
    }
    let none = zero3(graph);
    let mut columns = vec![(none, none); n];
    for (index, link) in tree.links.iter().enumerate() {
        for freedom in &link.freedoms {
            let (force, torque) = composite[index].wrench(graph, freedom.angular, freedom.linear);
            let chain = std::iter::successors(Some(index), |&at| tree.links[at].parent);
            let momentum = chain.fold(Wrench { force, torque }, |momentum, at| {
                to_parent(graph, &tree.links[at], &momentum)
            });
            for &(i, k) in &freedom.rate {
                let part = momentum.scale(graph, k);
                columns[i].0 = add3(graph, columns[i].0, part.force);
                columns[i].1 = add3(graph, columns[i].1, part.torque);
            }
        }
    }
    columns
}

/// Returns the part of ṗ that is quadratic in ξ; `None` if a freedom's twist varies in the axes of
/// its link.
pub fn quadratic_momentum_rate(graph: &mut Graph, tree: &Tree, xi: &[Edge]) -> Option<Vec<Edge>> {
    // The velocity product may vanish although the twists vary: angular velocities in world axes
    // are an example.
    let mut freedoms = tree.links.iter().flat_map(|link| &link.freedoms);
    let varies = |entry: &Edge| !graph.is_free(entry.node());
    if freedoms.any(|freedom| freedom.angular.iter().chain(&freedom.linear).any(varies)) {
        return None;
    }
    let (momenta, twists) = momenta(graph, tree, xi);
    let turned = |graph: &mut Graph, index: usize, h: &Wrench| {
        let (omega, v) = (twists[index].alpha, twists[index].a);
        let spin = cross(graph, h.torque, omega);
        let lever = cross(graph, h.force, v);
        Wrench {
            force: cross(graph, h.force, omega),
            torque: add3(graph, spin, lever),
        }
    };
    Some(generalized_forces_with(
        graph,
        tree,
        &momenta,
        xi.len(),
        turned,
    ))
}
