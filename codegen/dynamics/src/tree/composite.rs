//! Mass matrix M by the composite-rigid-body algorithm (Walker and Orin 1982).
//!
//! Each freedom moves the whole subtree of its joint as one body; the wrench that this takes acts
//! on the joints of all ancestors.

use super::inverse::to_parent;
use super::link::Tree;
use super::mass::LinkInertia;
use super::wrench::Wrench;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::resubstitute::resubstitute;
use hamel_program::count::count;
use hamel_program::provenance::Quantity;

/// How inertias about hinges are computed.
///
/// A rotation about the hinge leaves them unchanged, so they may be computed separately from the
/// second moments and be known to the graph beforehand (`Apart`), or from the rotated second
/// moments (`OfS`).
#[derive(Clone, Copy, PartialEq, Eq)]
enum PolarMoments {
    Apart,
    OfS,
}

/// A matrix together with the graph that it was built in.
type MatrixInGraph = (Graph, Vec<Vec<Edge>>);

/// Returns the mass matrix M of a tree, n × n, by the composite-body algorithm, in the variant with the fewest
/// operations before resubstitution.
///
/// This is the starting point for computing M⁻¹.
pub fn mass_matrix(graph: &mut Graph, tree: &Tree, n: usize) -> Vec<Vec<Edge>> {
    cheapest_matrix(graph, mass_matrices(graph, tree, n))
}

/// Returns the mass matrix M of a tree by the variant with the fewest operations, resubstituted ones included, for use
/// as M itself.
pub fn mass_matrix_alone(graph: &mut Graph, tree: &Tree, n: usize) -> Vec<Vec<Edge>> {
    let mut ways = mass_matrices(graph, tree, n);
    let polished = |(way, matrix): &MatrixInGraph| {
        let (way, entries) = resubstitute(way, &matrix.concat(), graph)?;
        Some((
            way,
            entries.chunks(n.max(1)).map(<[Edge]>::to_vec).collect(),
        ))
    };
    let polished: Vec<MatrixInGraph> = ways.iter().filter_map(polished).collect();
    ways.extend(polished);
    cheapest_matrix(graph, ways)
}

fn cheapest_matrix(graph: &mut Graph, mut ways: Vec<MatrixInGraph>) -> Vec<Vec<Edge>> {
    let weight = |(graph, matrix): &MatrixInGraph| count(graph, &matrix.concat()).weight();
    let least = (0..ways.len()).min_by_key(|&way| weight(&ways[way]));
    let (chosen, matrix) = ways.swap_remove(least.unwrap_or(0));
    *graph = chosen;
    matrix
}

/// Returns M from second moments alone, the inertias from which the slopes of forces are computed,
/// too.
pub fn mass_matrix_by_second_moments(graph: &mut Graph, tree: &Tree, n: usize) -> Vec<Vec<Edge>> {
    by_composites(graph, tree, n, PolarMoments::OfS)
}

/// Returns M from second moments alone and, if there are parallel hinges, also from inertias about
/// them.
///
/// Each variant is built in its own copy of the graph, since a graph that already knows a value
/// does not compute it again in another way.
pub fn mass_matrices(graph: &Graph, tree: &Tree, n: usize) -> Vec<MatrixInGraph> {
    let mut links = tree.links.iter();
    let parallel = links.any(|link| link.turns.is_empty() || tree.parallel(graph, link).is_some());
    let ways: &[PolarMoments] = match parallel {
        true => &[PolarMoments::OfS, PolarMoments::Apart],
        false => &[PolarMoments::OfS],
    };
    let by = |&way: &PolarMoments| {
        let mut graph = graph.clone();
        let matrix = by_composites(&mut graph, tree, n, way);
        (graph, matrix)
    };
    ways.iter().map(by).collect()
}

/// Returns the composite inertia of each link and its descendants about the origin of the link.
fn composite_inertias(graph: &mut Graph, tree: &Tree, way: PolarMoments) -> Vec<LinkInertia> {
    if way == PolarMoments::Apart {
        tree.register_polar_moments(graph);
    }
    let mut composite: Vec<LinkInertia> = tree.links.iter().map(|link| link.mass).collect();
    for (index, link) in tree.links.iter().enumerate().rev() {
        composite[index].label(graph, Quantity::CompositeInertia.of(link.frame));
        if let Some(parent) = link.parent {
            let mut turned = composite[index];
            for turn in link.turns.iter().rev() {
                if way == PolarMoments::Apart {
                    // Enter the polar moment, which a rotation about the third axis does not
                    // change, before it.
                    turned.polar_moment(graph);
                }
                turned = turned.rotate_axes(graph, turn);
            }
            let moved = turned.shift_origin(graph, link.position);
            if way == PolarMoments::Apart {
                let polar = turned.polar_moment(graph);
                let moments = [turned.first, moved.first];
                let arms = moments.map(|h| graph.dot(&link.position[..2], &h[..2]));
                let polar = arms.iter().fold(polar, |sum, &arm| graph.add(sum, arm));
                let own = composite[parent].polar_moment(graph);
                graph.add(own, polar);
            }
            composite[parent] = composite[parent].plus(graph, &moved);
        }
    }
    composite
}

/// Computes M from the wrenches of the composite bodies.
fn by_composites(graph: &mut Graph, tree: &Tree, n: usize, way: PolarMoments) -> Vec<Vec<Edge>> {
    let composite = composite_inertias(graph, tree, way);
    let mut matrix = vec![vec![graph.zero(); n]; n];
    for (index, link) in tree.links.iter().enumerate() {
        for (place, freedom) in link.freedoms.iter().enumerate() {
            let (force, torque) = composite[index].wrench(graph, freedom.angular, freedom.linear);
            let mut wrench = Wrench { force, torque };
            wrench.label(graph, Quantity::UnitWrench.of(link.frame));
            let mut at = Some(index);
            while let Some(here) = at {
                let link = &tree.links[here];
                let others = if here == index {
                    &link.freedoms[..=place]
                } else {
                    &link.freedoms[..]
                };
                for (other_place, other) in others.iter().enumerate() {
                    let entry = other.force_of(graph, &wrench);
                    let itself = here == index && other_place == place;
                    for &(i, k) in &freedom.rate {
                        for &(j, l) in &other.rate {
                            let factor = graph.mul(k, l);
                            let part = graph.mul(factor, entry);
                            matrix[i][j] = graph.add(matrix[i][j], part);
                            if !itself {
                                matrix[j][i] = graph.add(matrix[j][i], part);
                            }
                        }
                    }
                }
                if link.parent.is_some() {
                    wrench = to_parent(graph, link, &wrench);
                }
                at = link.parent;
            }
        }
    }
    for (i, &armature) in tree.armature.iter().enumerate() {
        matrix[i][i] = graph.add(matrix[i][i], armature);
    }
    matrix
}
