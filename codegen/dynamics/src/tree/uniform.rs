//! Common velocity and acceleration of all links, which a free tree does not feel.
//!
//! If nothing holds the first links of a tree, their velocities v require no force by themselves,
//! and gravity is an acceleration that all links share. With the proper acceleration
//! ξ̇ + ω × v − Rᵀ g
//! in place of v̇, the equations of motion therefore contain neither v nor g.

use super::inverse::motions;
use super::link::{Freedom, Tree};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, zero3};

/// Velocity and acceleration that all links of a free tree have in common.
pub struct CommonMotion {
    /// ξ with zeros in place of the velocities of the first links.
    pub xi: Vec<Edge>,
    /// Difference between ξ̇ and the proper acceleration, −ω × v + Rᵀ g.
    pub rates: Vec<Edge>,
    /// Indices of the velocities that are left out.
    pub common: Vec<usize>,
}

impl Tree {
    /// Returns the common motion of all links; `None` if a first link is held, or its velocity is
    /// not plain.
    pub fn common_motion(
        &self,
        graph: &mut Graph,
        xi: &[Edge],
        gravity: Vec3,
    ) -> Option<CommonMotion> {
        let zero = graph.zero();
        let still = vec![zero; xi.len()];
        let motions = motions(graph, self, xi, &still, gravity);
        let mut uniform = CommonMotion {
            xi: xi.to_vec(),
            rates: still,
            common: Vec::new(),
        };
        let roots = self.links.iter().zip(&motions);
        for (link, motion) in roots.filter(|(link, _)| link.parent.is_none()) {
            if link.velocity_product != (zero3(graph), zero3(graph)) {
                return None;
            }
            let mut axes = Vec::new();
            for freedom in &link.freedoms {
                if let Some(axis) = translation_axis(graph, freedom) {
                    let &[(i, factor)] = freedom.rate.as_slice() else {
                        return None;
                    };
                    if factor != graph.one() {
                        return None;
                    }
                    uniform.xi[i] = zero;
                    uniform.rates[i] = -motion.a[axis];
                    uniform.common.push(i);
                    axes.push(axis);
                } else if freedom.linear != zero3(graph) {
                    return None;
                }
            }
            axes.sort_unstable();
            if axes != [0, 1, 2] {
                return None;
            }
        }
        Some(uniform)
    }
}

/// Returns the axis of the link along which a freedom translates it without rotation.
pub fn translation_axis(graph: &Graph, freedom: &Freedom) -> Option<usize> {
    axis_of_unit_vector(graph, freedom.linear).filter(|_| freedom.angular == zero3(graph))
}

/// Returns the axis of which a vector is the unit vector.
pub fn axis_of_unit_vector(graph: &Graph, v: Vec3) -> Option<usize> {
    let (zero, one) = (graph.zero(), graph.one());
    (0..3).find(|&k| (0..3).all(|i| v[i] == if i == k { one } else { zero }))
}
