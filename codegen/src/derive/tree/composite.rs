//! M by composite bodies: each freedom moves all that hangs on its joint as one body, whose wrench
//! is felt by the joints before (Walker and Orin 1982).

use super::Tree;
use super::inverse::{Wrench, carried};
use super::mass::Mass;
use crate::algebra::graph::{Edge, Graph};

/// M, n rows of n.
pub fn mass_matrix(graph: &mut Graph, tree: &Tree, n: usize) -> Vec<Vec<Edge>> {
    let mut composite: Vec<Mass> = tree.links.iter().map(|link| link.mass).collect();
    for (index, link) in tree.links.iter().enumerate().rev() {
        if let Some(parent) = link.parent {
            let moved = composite[index].carried(graph, link);
            composite[parent] = composite[parent].plus(graph, &moved);
        }
    }
    let mut matrix = vec![vec![graph.zero(); n]; n];
    for (index, link) in tree.links.iter().enumerate() {
        for (place, freedom) in link.freedoms.iter().enumerate() {
            let (force, torque) = composite[index].wrench(graph, freedom.angular, freedom.linear);
            let mut wrench = Wrench { force, torque };
            let mut at = Some(index);
            while let Some(here) = at {
                let link = &tree.links[here];
                let others = if here == index {
                    &link.freedoms[..=place]
                } else {
                    &link.freedoms[..]
                };
                for (other_place, other) in others.iter().enumerate() {
                    let entry = other.felt(graph, &wrench);
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
                    wrench = carried(graph, link, &wrench);
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
