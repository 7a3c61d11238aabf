//! A tree of the size of a humanoid robot.

use super::{Kind, Link, Random};
use Kind::{Continuous, Free, Quaternion, Revolute, Spherical, Universal};

/// What hangs on the trunk (0) and on the waist (1): legs, arms, a head.
const LIMBS: [(usize, &[Kind]); 5] = [
    (0, &[Universal, Revolute, Revolute, Universal]),
    (0, &[Universal, Revolute, Revolute, Universal]),
    (1, &[Quaternion, Revolute, Continuous, Revolute, Revolute]),
    (1, &[Quaternion, Revolute, Continuous, Revolute, Revolute]),
    (1, &[Revolute, Revolute, Revolute]),
];

/// A floating trunk with a waist, two legs, two arms and a head: 38 freedoms.
pub fn humanoid() -> Vec<Link> {
    let mut random = Random::new(0x38);
    let mut links: Vec<Link> = Vec::new();
    let mut add = |kind: Kind, parent: Option<usize>| {
        // Nothing follows here: 38 freedoms.
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
