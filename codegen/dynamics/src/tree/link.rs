//! Links and joints of a kinematic tree.

use super::mass::LinkInertia;
use super::turn::RotationFactor;
use super::wrench::Wrench;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::Vec3;

/// One column of a joint's motion subspace S, with its rate as a linear combination of ξ.
///
/// This is the twist of a link relative to its parent, per unit of the column's rate.
#[derive(Clone, Debug)]
pub struct Freedom {
    /// Angular velocity in the axes of the link.
    pub angular: Vec3,
    /// Velocity of the link's origin in the axes of the link.
    pub linear: Vec3,
    /// Rate of this column, Σ k ξⁱ with constant k, as pairs (i, k).
    pub rate: Vec<(usize, Edge)>,
}

impl Freedom {
    /// Returns whether the rate is prescribed, that is, consists of the velocities in `given` only.
    pub fn is_given(&self, given: &[usize]) -> bool {
        self.rate.iter().all(|(i, _)| given.contains(i))
    }

    /// Returns the rate Σ k vⁱ of the freedom for velocities v in place of ξ.
    pub fn rate_of(&self, graph: &mut Graph, v: &[Edge]) -> Edge {
        let terms: Vec<Edge> = self.rate.iter().map(|&(i, k)| graph.mul(k, v[i])).collect();
        graph.sum(&terms)
    }

    /// Returns Sᵀ f, the generalised force of a wrench on the link (its power at unit rate).
    pub fn force_of(&self, graph: &mut Graph, wrench: &Wrench) -> Edge {
        let (angular, linear) = (
            graph.dot(&self.angular, &wrench.torque),
            graph.dot(&self.linear, &wrench.force),
        );
        graph.add(angular, linear)
    }

    /// Adds this generalised force to the entries of `forces` for the velocities that make up the
    /// rate.
    pub fn add_force(&self, graph: &mut Graph, wrench: &Wrench, forces: &mut [Edge]) {
        let force = self.force_of(graph, wrench);
        for &(i, k) in &self.rate {
            let share = graph.mul(k, force);
            forces[i] = graph.add(forces[i], share);
        }
    }
}

/// A link, which moves relative to its parent by a joint.
#[derive(Clone, Debug)]
pub struct Link {
    /// Index of the frame of the description that its joint carries.
    pub frame: usize,
    /// Index of the parent link, which is smaller than that of the link; `None` for the world.
    pub parent: Option<usize>,
    /// Factors of the rotation matrix whose columns are the axes of this link in those of its
    /// parent.
    pub turns: Vec<RotationFactor>,
    /// Origin of this link relative to its parent's, in the axes of the parent.
    pub position: Vec3,
    /// Columns of the motion subspace of its joint.
    pub freedoms: Vec<Freedom>,
    /// Velocity-product acceleration of the joint, Ṡ times its rates: (angular, linear).
    pub velocity_product: (Vec3, Vec3),
    /// Inertia about the origin of the link.
    pub mass: LinkInertia,
    /// The same inertia in the link's own axes, where the link uses axes shared with other links.
    pub unshared: LinkInertia,
}

impl Link {
    /// Adds the generalised forces that a wrench on the link exerts at its joint.
    pub fn add_forces(&self, graph: &mut Graph, wrench: &Wrench, forces: &mut [Edge]) {
        for freedom in &self.freedoms {
            freedom.add_force(graph, wrench, forces);
        }
    }

    /// Transforms a vector from the axes of the link to those of its parent.
    pub fn to_parent_axes(&self, graph: &mut Graph, v: Vec3) -> Vec3 {
        self.turns
            .iter()
            .rev()
            .fold(v, |v, turn| turn.rotate(graph, v))
    }

    /// Transforms a vector from the axes of the parent to those of the link.
    pub fn from_parent_axes(&self, graph: &mut Graph, v: Vec3) -> Vec3 {
        self.turns
            .iter()
            .fold(v, |v, turn| turn.rotate_back(graph, v))
    }
}

/// A kinematic tree, in which each link follows its parent.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The links.
    pub links: Vec<Link>,
    /// Armatures (rotor inertias) J, one for each velocity, which add J ξ̇ⁱ to its generalised
    /// force.
    pub armature: Vec<Edge>,
    /// How U = α̂ + ω̂ ω̂ of the links is computed.
    pub tensors: TensorRoute,
}

/// How U = α̂ + ω̂ ω̂ of the links is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TensorRoute {
    /// From ω and α of each link.
    Each,
    /// If the hinge is along a coordinate axis of the link and of its parent, the column of U along
    /// it is taken from the parent.
    Carried,
    /// U is updated from that of the parent link if their axes differ only in sign and order;
    /// otherwise as `Carried`.
    Chained,
}

impl Tree {
    /// Computes the inertias of all links about their hinges in the graph.
    ///
    /// Rotations to shared axes do not change them. Once the graph knows their values, it does not
    /// compute them again from rotated entries.
    pub fn register_polar_moments(&self, graph: &mut Graph) {
        for link in &self.links {
            link.unshared.polar_moment(graph);
        }
    }

    /// Returns whether the rate of each freedom is a velocity ξⁱ of its own, unless it is
    /// prescribed.
    pub fn is_plain(&self, graph: &Graph, n: usize, given: &[usize]) -> bool {
        let mut seen = vec![false; n];
        self.links.iter().flat_map(|link| &link.freedoms).all(|freedom| {
            freedom.is_given(given) || matches!(freedom.rate.as_slice(), &[(i, k)] if k == graph.one() && !std::mem::replace(&mut seen[i], true))
        })
    }
}
