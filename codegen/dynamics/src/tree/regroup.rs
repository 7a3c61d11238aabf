//! Base inertial parameters: the part of a link's inertia that its joint cannot feel is moved to
//! the parent link (Gautier and Khalil 1990; Khalil and Kleinfinger 1987).
//!
//! For a hinge along z, the parts m, h_z and S_zz are those of masses on the axis, at rest in the
//! parent link. A prismatic joint does not rotate its link, so that all of S is moved; a ball joint
//! passes on m.

use super::draft::{JointMotion, LinkDraft};
use super::mass::LinkInertia;
use super::turn::RotationFactor;
use hamel_algebra::graph::Graph;
use hamel_algebra::linear::zero3;

/// Regroups the inertias of all links, from the last to the first.
pub fn regroup(graph: &mut Graph, links: &mut [LinkDraft]) {
    for j in (0..links.len()).rev() {
        let zero = graph.zero();
        let mut moved = LinkInertia::zero(graph);
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
            // A link that only translates keeps the axes that its parent had before those were
            // rotated.
            JointMotion::Other(..) => vec![RotationFactor::By(links[j].base)],
        };
        links[j].mass = left;
        if let Some(parent) = links[j].parent {
            for turn in turns.iter().rev() {
                moved = moved.rotate_axes(graph, turn);
            }
            // A position varies only for prismatic joints; these pass on S alone, which needs no
            // shift.
            if !varies {
                moved = moved.shift_origin(graph, links[j].position);
            }
            links[parent].mass = links[parent].mass.plus(graph, &moved);
        }
    }
}
