//! Links in axes before their hinges turn: the third axis along the hinge still, the other two as the link before has
//! them.
//!
//! All equations of the recursions hold between vectors and tensors, in any axes that they have at an instant. In axes of the
//! link before, nothing of a hinge's own has to be turned: the turn goes on to what hangs on the link, and only what the link
//! itself weighs is turned by it. Hinges that are parallel share one pair of axes, so that nothing is turned between them at
//! all, and masses are turned by sums of angles.

use super::turn::Turn;
use super::{Link, Tree};
use crate::algebra::graph::{Edge, Graph};

impl Tree {
    /// The same links, those of hinges in axes that do not turn with them.
    pub fn proximal(&self, graph: &mut Graph) -> Tree {
        let mut lags: Vec<Option<Plane>> = Vec::with_capacity(self.links.len());
        let mut links = Vec::with_capacity(self.links.len());
        for link in &self.links {
            let before = link.parent.and_then(|parent| lags[parent]);
            let mut moved = link.clone();
            if let Some(lag) = before {
                moved.position = lag.turn().out(graph, link.position);
            }
            let (fixed, angle) = match hinge(graph, link) {
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
                moved.mass = link.mass.turned(graph, &lag.turn());
            }
            lags.push(lag);
            links.push(moved);
        }
        Tree {
            links,
            armature: self.armature.clone(),
        }
    }
}

/// The turns before a hinge's own, and its angle.
fn hinge<'a>(graph: &Graph, link: &'a Link) -> Option<(&'a [Turn], Plane)> {
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

/// Whether the third axis stays.
fn is_level(graph: &Graph, turn: &Turn) -> bool {
    match *turn {
        Turn::About { axis: 2, .. } => true,
        Turn::About { cos, sin, .. } => sin.abs() == graph.zero() && cos == graph.one(),
        Turn::By(_) => false,
    }
}

/// An angle about the third axis.
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

    fn of(turn: &Turn) -> Option<Self> {
        match *turn {
            Turn::About { axis: 2, cos, sin } => Some(Plane { cos, sin }),
            _ => None,
        }
    }

    fn turn(self) -> Turn {
        Turn::About {
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
