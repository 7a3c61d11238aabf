//! Motions of a first link that have the same effect as a joint on it.
//!
//! Everything that hangs on a hinge moves in the same way whether the hinge turns or its parent
//! link turns about the axis of the hinge. If s are the velocities of that turn and e is the unit
//! vector of the hinge's own velocity, then M s and M e agree in the rows of the velocities of the
//! hinge's subtree, provided that the hinge has no armature.

use super::link::{Link, Tree};
use super::uniform::{axis_of_unit_vector, translation_axis};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, cross, zero3};

/// Velocities of the first link that move a joint's subtree as the joint itself does.
pub struct EquivalentMotion {
    /// Index of the joint's velocity.
    pub of: usize,
    /// Velocities of the first link and their values per unit of the joint's velocity.
    pub by: Vec<(usize, Edge)>,
}

impl Tree {
    /// Returns, for all joints on first links, the velocities of the first link that move the subtree alike, if the
    /// first link has the freedoms needed.
    pub fn equivalent_motions(&self, graph: &mut Graph) -> Vec<EquivalentMotion> {
        let links = self.links.iter();
        links
            .filter_map(|link| self.equivalent_motion(graph, link))
            .collect()
    }

    fn equivalent_motion(&self, graph: &mut Graph, link: &Link) -> Option<EquivalentMotion> {
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
        // An armature is moved by the joint's own velocity alone.
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
            let place = match (
                translation_axis(graph, freedom),
                axis_of_unit_vector(graph, freedom.angular),
            ) {
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
        // A remainder is motion for which the first link has no freedom.
        let whole = turns.iter().chain(&slides).all(|&rest| rest == zero);
        whole.then_some(EquivalentMotion { of, by })
    }
}
