//! What free links do not feel: a velocity and an acceleration that everything has in common.
//!
//! Where nothing holds the first links of a tree, their velocities v need no force by themselves, and what weighs is an
//! acceleration of all links alike. So with the proper acceleration ξ̇ + ω × v − Rᵀ g in the place of v̇ the equations of motion
//! have neither v nor g in them.

use super::inverse::motions;
use super::{Freedom, Tree};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, zero3};

/// The motion that everything has in common.
pub struct Uniform {
    /// ξ without the velocities of the first links.
    pub xi: Vec<Edge>,
    /// What ξ̇ is more than the proper acceleration, −ω × v + Rᵀ g.
    pub rates: Vec<Edge>,
    /// Whose velocities are left out.
    pub common: Vec<usize>,
}

impl Tree {
    /// What its links have in common; `None` where a first link is held, or its velocity is not plain.
    pub fn uniform(&self, graph: &mut Graph, xi: &[Edge], gravity: Vec3) -> Option<Uniform> {
        let zero = graph.zero();
        let still = vec![zero; xi.len()];
        let motions = motions(graph, self, xi, &still, gravity);
        let mut uniform = Uniform {
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
                if let Some(axis) = along(graph, freedom) {
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

/// The axis of the link that a freedom moves it along without turning it.
pub fn along(graph: &Graph, freedom: &Freedom) -> Option<usize> {
    unit(graph, freedom.linear).filter(|_| freedom.angular == zero3(graph))
}

/// The axis that a vector is the unit vector of.
pub fn unit(graph: &Graph, v: Vec3) -> Option<usize> {
    let (zero, one) = (graph.zero(), graph.one());
    (0..3).find(|&k| (0..3).all(|i| v[i] == if i == k { one } else { zero }))
}
