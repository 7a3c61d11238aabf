//! Motions of a link that hinges on it could make as well.
//!
//! All that hangs on a hinge moves in the same way whether the hinge turns or the link before turns about the hinge's axis.
//! With the velocities s of that turn, M s = M e on the velocities of what hangs there, e the hinge's own, where that has no
//! armature.

use super::uniform::{along, unit};
use super::{Link, Tree};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, cross, zero3};

/// A turn or a slide, as velocities of the first link.
pub struct Twin {
    /// The velocity of the joint.
    pub of: usize,
    /// The velocities of the first link, and how fast they are.
    pub by: Vec<(usize, Edge)>,
}

impl Tree {
    /// The twins of all joints on first links, where those move freely enough.
    pub fn twins(&self, graph: &mut Graph) -> Vec<Twin> {
        let links = self.links.iter();
        links.filter_map(|link| self.twin(graph, link)).collect()
    }

    fn twin(&self, graph: &mut Graph, link: &Link) -> Option<Twin> {
        let root = &self.links[link.parent?];
        if root.parent.is_some() {
            return None;
        }
        let [freedom] = link.freedoms.as_slice() else {
            return None;
        };
        let &[(of, factor)] = freedom.rate.as_slice() else {
            return None;
        };
        // An armature moves with the joint's own velocity alone.
        if factor != graph.one() || self.armature[of] != graph.zero() {
            return None;
        }
        let omega = link.to_parent_axes(graph, freedom.angular);
        let lever = cross(graph, link.position, omega);
        let slide = link.to_parent_axes(graph, freedom.linear);
        let v: Vec3 = std::array::from_fn(|k| graph.add(lever[k], slide[k]));
        let (mut turns, mut slides) = (omega, v);
        let mut by = Vec::new();
        let zero = graph.zero();
        for freedom in &root.freedoms {
            let &[(i, factor)] = freedom.rate.as_slice() else {
                return None;
            };
            let place = match (along(graph, freedom), unit(graph, freedom.angular)) {
                (Some(axis), _) => &mut slides[axis],
                (None, Some(axis)) if freedom.linear == zero3(graph) => &mut turns[axis],
                _ => return None,
            };
            let rate = std::mem::replace(place, zero);
            if factor != graph.one() || !graph.is_free(rate.node()) {
                return None;
            }
            if rate != zero {
                by.push((i, rate));
            }
        }
        // What is left the first link cannot do.
        let whole = turns.iter().chain(&slides).all(|&rest| rest == zero);
        whole.then_some(Twin { of, by })
    }
}
