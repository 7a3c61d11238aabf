//! Momenta by recursion: that of everything, and ∂ᵢT − γᵢⱼᵏ ξʲ pₖ, which turns p = M ξ where no force acts,
//! KR18 (30a).
//!
//! pᵢ = Sᵢ · h, with the freedom's twist Sᵢ and the momentum h = (k about the link's origin, l) of all that
//! hangs on its joint. Forces change h; what is left of ṗᵢ is Ṡᵢ · h with Ṡᵢ = V × Sᵢ, where V = (ω, v) is the
//! twist of the link and Sᵢ is constant in its axes. As a wrench on the link that is
//! (torque k × ω + l × v, force l × ω).

use super::Tree;
use super::inverse::{LinkMotion, Wrench, collect_with, motions, to_parent, wrench};
use super::mass::Mass;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, add3, cross, zero3};

/// The momentum of each link about its origin, in its axes, and the twists of the links.
fn momenta(graph: &mut Graph, tree: &Tree, xi: &[Edge]) -> (Vec<Wrench>, Vec<LinkMotion>) {
    // As accelerations from rest the rates give twists, and the wrenches that go with them are momenta.
    let (none, still) = (zero3(graph), vec![graph.zero(); xi.len()]);
    let twists = motions(graph, tree, &still, xi, none);
    let links = tree.links.iter().zip(&twists);
    let momenta = links.map(|(link, twist)| wrench(graph, &link.mass, twist));
    (momenta.collect(), twists)
}

/// The momentum of everything, linear and about the origin of the world, in its axes.
pub fn total(graph: &mut Graph, tree: &Tree, xi: &[Edge]) -> (Vec3, Vec3) {
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

/// The momentum of everything for a unit of each velocity alone, linear and about the origin of the world, in its
/// axes: that of what hangs on the joint, as one body.
pub fn columns(graph: &mut Graph, tree: &Tree, n: usize) -> Vec<(Vec3, Vec3)> {
    let mut composite: Vec<Mass> = tree.links.iter().map(|link| link.mass).collect();
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
                let part = momentum.scaled(graph, k);
                columns[i].0 = add3(graph, columns[i].0, part.force);
                columns[i].1 = add3(graph, columns[i].1, part.torque);
            }
        }
    }
    columns
}

/// The part of ṗ that is quadratic in ξ; `None` where a freedom's twist varies in the axes of its link.
pub fn quadratic_rate(graph: &mut Graph, tree: &Tree, xi: &[Edge]) -> Option<Vec<Edge>> {
    // Twists may vary without any drift: those of angular velocities in axes of the world do.
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
    Some(collect_with(graph, tree, &momenta, xi.len(), turned))
}
