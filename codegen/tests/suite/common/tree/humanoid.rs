//! A tree of the size of a humanoid robot.

use super::{Kind, Link, Random};
use Kind::{Continuous, Free, Quaternion, Revolute, Spherical, Universal};

/// The joints of legs, arms and head, each with its parent: the trunk (0) or the waist (1).
const LIMBS: [(usize, &[Kind]); 5] = [
    (0, &[Universal, Revolute, Revolute, Universal]),
    (0, &[Universal, Revolute, Revolute, Universal]),
    (1, &[Quaternion, Revolute, Continuous, Revolute, Revolute]),
    (1, &[Quaternion, Revolute, Continuous, Revolute, Revolute]),
    (1, &[Revolute, Revolute, Revolute]),
];

/// Returns a floating trunk with a waist, two legs, two arms and a head: 38 degrees of freedom.
pub fn humanoid() -> Vec<Link> {
    let mut random = Random::new(0x38);
    let mut links: Vec<Link> = Vec::new();
    let mut add = |kind: Kind, parent: Option<usize>| {
        // Without links to follow, so that there are 38 degrees of freedom.
        let mut link = Link::on(&mut random, &[], kind, parent);
        link.follows = None;
        links.push(link);
        links.len() - 1
    };
    let trunk = add(Free, None);
    add(Spherical, Some(trunk));
    for (root, joints) in LIMBS {
        let mut parent = root;
        for &joint in joints {
            parent = add(joint, Some(parent));
        }
    }
    links
}
