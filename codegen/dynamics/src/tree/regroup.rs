//! Base inertial parameters: what a joint cannot feel of a link's inertia is given to the link
//! before (Gautier and Khalil 1990; Khalil and Kleinfinger 1987).
//!
//! About a hinge along z the parts m, h_z and S_zz are those of masses on the axis, at rest in the
//! link before. A slider does not turn, so that S goes as a whole; a ball joint leaves m.

use super::draft::{Draft, JointMotion};
use super::mass::Mass;
use super::turn::Turn;
use hamel_algebra::graph::Graph;
use hamel_algebra::linear::zero3;

/// Regroups from the last link to the first.
pub fn regroup(graph: &mut Graph, links: &mut [Draft]) {
    for j in (0..links.len()).rev() {
        let zero = graph.zero();
        let mut moved = Mass::none(graph);
        let own = links[j].mass;
        let mut left = own;
        match &links[j].motion {
            JointMotion::Hinge { .. } => {
                moved.mass = own.mass;
                moved.first[2] = own.first[2];
                moved.second[2][2] = own.second[2][2];
                left.mass = zero;
                left.first[2] = zero;
                left.second[2][2] = zero;
            }
            JointMotion::Other(rotation, freedoms, _) => {
                let none = zero3(graph);
                if rotation.is_none() && freedoms.iter().all(|f| f.angular == none) {
                    moved.second = own.second;
                    left.second = [none; 3];
                } else if freedoms.iter().all(|f| f.linear == none) {
                    moved.mass = own.mass;
                    left.mass = zero;
                } else {
                    continue;
                }
            }
        }
        let varies = links[j].position.iter().any(|p| !graph.is_free(p.node()));
        let turns = match &links[j].motion {
            JointMotion::Hinge { turns, .. } => turns.clone(),
            // What slides keeps the axes that the link before had, before those were turned.
            JointMotion::Other(..) => vec![Turn::By(links[j].base)],
        };
        links[j].mass = left;
        if let Some(parent) = links[j].parent {
            for turn in turns.iter().rev() {
                moved = moved.turned(graph, turn);
            }
            // What slides has given no mass away.
            if !varies {
                moved = moved.shifted(graph, links[j].position);
            }
            links[parent].mass = links[parent].mass.plus(graph, &moved);
        }
    }
}
