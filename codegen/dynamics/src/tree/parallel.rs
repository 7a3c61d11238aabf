//! Common axes for links with parallel hinges.
//!
//! The equations of the recursions hold between vectors and tensors, whatever axes they are
//! expressed in at an instant. Links whose hinges are parallel use the axes that the first of them
//! has before it rotates: then no vector has to be rotated between them, and only the inertia of
//! each link is rotated, by the sum of the joint angles. The last link of a chain does the same,
//! since its inertia is the only thing to rotate.

use super::link::{Link, Tree};
use super::turn::RotationFactor;
use hamel_algebra::graph::{Edge, Graph};

impl Tree {
    /// Returns the tree with the same axes for links on parallel hinges, and for each link that has given up its own
    /// axes their rotation relative to the shared ones.
    pub fn with_shared_axes(&self, graph: &mut Graph) -> (Tree, Vec<Option<RotationFactor>>) {
        let shares = self.shares(graph);
        let mut lags: Vec<Option<Plane>> = Vec::with_capacity(self.links.len());
        let mut links = Vec::with_capacity(self.links.len());
        for (link, shares) in self.links.iter().zip(shares) {
            let before = link.parent.and_then(|parent| lags[parent]);
            let mut moved = link.clone();
            if let Some(lag) = before {
                moved.position = lag.turn().rotate(graph, link.position);
            }
            let (fixed, angle) = match hinge(graph, link).filter(|_| shares) {
                Some((fixed, angle)) => (fixed, Some(angle)),
                None => (&link.turns[..], None),
            };
            let level = angle.filter(|_| fixed.iter().all(|turn| is_level(graph, turn)));
            moved.turns.clear();
            if level.is_none() {
                moved.turns.extend(before.map(|lag| lag.turn()));
                moved.turns.extend(fixed);
            }
            let lag = level.map_or(angle, |angle| {
                let planes = fixed.iter().filter_map(Plane::of).chain([angle]);
                Some(
                    planes.fold(before.unwrap_or(Plane::none(graph)), |sum, plane| {
                        sum.plus(graph, plane)
                    }),
                )
            });
            if let Some(lag) = lag {
                moved.mass = link.mass.rotate_axes(graph, &lag.turn());
            }
            lags.push(lag);
            links.push(moved);
        }
        let tree = Tree {
            links,
            armature: self.armature.clone(),
            tensors: self.tensors,
        };
        (tree, lags.iter().map(|lag| lag.map(Plane::turn)).collect())
    }

    /// Returns for each link whether it gives up its own axes: if its hinge is parallel to that of
    /// its parent or a child, or if it is the last of a chain.
    fn shares(&self, graph: &Graph) -> Vec<bool> {
        let mut shares: Vec<bool> = (0..self.links.len())
            .map(|i| !self.links.iter().any(|link| link.parent == Some(i)))
            .collect();
        for (i, link) in self.links.iter().enumerate() {
            if let Some(parent) = self.parallel(graph, link) {
                shares[i] = true;
                shares[parent] = true;
            }
        }
        shares
    }

    /// Returns the parent of a link if the hinges of both are parallel.
    pub(super) fn parallel(&self, graph: &Graph, link: &Link) -> Option<usize> {
        let parent = link.parent?;
        hinge(graph, &self.links[parent])?;
        let (fixed, _) = hinge(graph, link)?;
        fixed
            .iter()
            .all(|turn| is_level(graph, turn))
            .then_some(parent)
    }
}

/// Returns the rotations that precede the one of a hinge itself, and the angle of the hinge.
fn hinge<'a>(graph: &Graph, link: &'a Link) -> Option<(&'a [RotationFactor], Plane)> {
    let (zero, one) = (graph.zero(), graph.one());
    let [freedom] = &link.freedoms[..] else {
        return None;
    };
    if freedom.angular != [zero, zero, one] || freedom.linear != [zero; 3] {
        return None;
    }
    let (last, fixed) = link.turns.split_last()?;
    Some((fixed, Plane::of(last)?))
}

/// Returns whether a rotation keeps the third axis.
fn is_level(graph: &Graph, turn: &RotationFactor) -> bool {
    match *turn {
        RotationFactor::About { axis: 2, .. } => true,
        RotationFactor::About { cos, sin, .. } => sin.abs() == graph.zero() && cos == graph.one(),
        RotationFactor::By(_) => false,
    }
}

/// Rotation about the third axis.
#[derive(Clone, Copy)]
struct Plane {
    cos: Edge,
    sin: Edge,
}

impl Plane {
    fn none(graph: &Graph) -> Self {
        Plane {
            cos: graph.one(),
            sin: graph.zero(),
        }
    }

    fn of(turn: &RotationFactor) -> Option<Self> {
        match *turn {
            RotationFactor::About { axis: 2, cos, sin } => Some(Plane { cos, sin }),
            _ => None,
        }
    }

    fn turn(self) -> RotationFactor {
        RotationFactor::About {
            axis: 2,
            cos: self.cos,
            sin: self.sin,
        }
    }

    fn plus(self, graph: &mut Graph, other: Self) -> Self {
        let (cc, ss) = (
            graph.mul(self.cos, other.cos),
            graph.mul(self.sin, other.sin),
        );
        let (sc, cs) = (
            graph.mul(self.sin, other.cos),
            graph.mul(self.cos, other.sin),
        );
        Plane {
            cos: graph.sub(cc, ss),
            sin: graph.add(sc, cs),
        }
    }
}
