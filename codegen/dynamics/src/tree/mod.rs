//! Kinematic trees: inverse dynamics, mass matrix M and forward dynamics by recursion.
//!
//! A link comprises everything that moves rigidly together. The generator chooses the frames of the
//! links itself, independently of the frames in the description. The inertia of a link is stored as
//! mass m, first moment h and second moment S; the part of it that does not affect the motion of
//! the joint is moved to the parent link. Sources: Featherstone, *Rigid Body Dynamics Algorithms*
//! (2008), chapters 5-7; Khalil and Kleinfinger (1987) for customised recursions and base inertial
//! parameters.

pub mod articulated;
pub mod composite;
pub(crate) mod draft;
pub mod equivalent_motion;
pub mod inverse;
pub mod mass;
pub mod momentum;
mod parallel;
mod reframe;
mod regroup;
mod revolute;
mod rounding_limits;
pub mod slopes;
pub mod turn;
pub mod uniform;

use super::calculus::Calculus;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, apply_transposed};
use hamel_language::model::Model;
use inverse::{TensorRoute, Wrench};
use mass::LinkInertia;
use turn::RotationFactor;

/// One column of a joint's motion subspace S.
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

    /// Returns the rate Σ k vⁱ for the velocities v.
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

/// Where the frames of the links are placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// Where the recursions are cheapest, with regrouped inertias.
    Chosen,
    /// As `Chosen`, but with axes shared by parallel hinges.
    Parallel,
    /// Where the description has them, each inertia staying with its own link.
    Described,
}

impl Tree {
    /// Builds the tree of a model.
    ///
    /// Returns `None` unless all of its inertia is that of armatures and of bodies and particles
    /// that are fixed to frames.
    pub fn of(model: &mut Model, calculus: &mut Calculus, placement: Placement) -> Option<Tree> {
        let mut draft = draft::draft_links(model, calculus)?;
        let limits = rounding_limits::RoundingLimits::of(model, &draft);
        match placement {
            Placement::Chosen | Placement::Parallel => {
                reframe::reframe(&mut model.graph, &mut draft, &limits);
                regroup::regroup(&mut model.graph, &mut draft);
            }
            Placement::Described => reframe::keep_frames(&mut model.graph, &mut draft, &limits),
        }
        let links = draft.into_iter().map(|link| link.finish(&mut model.graph));
        let tree = Tree {
            links: links.collect(),
            armature: model.armature.clone(),
            tensors: TensorRoute::Each,
        };
        Some(match placement {
            Placement::Parallel => tree.sharing_axes(&mut model.graph).0,
            Placement::Chosen | Placement::Described => tree,
        })
    }

    /// Builds the tree with the frames of the description, and returns for each link the frame that
    /// its joint carries.
    ///
    /// If `moved`, the origins are shifted along the hinges. Returns `None` as [`Tree::of`] does.
    pub fn with_frames(
        model: &mut Model,
        calculus: &mut Calculus,
        moved: bool,
    ) -> Option<(Tree, Vec<draft::JointFrame>)> {
        let (mut draft, mut joint_frames) = draft::draft_links_with_frames(model, calculus)?;
        let limits = rounding_limits::RoundingLimits::of(model, &draft);
        let graph = &mut model.graph;
        if moved {
            let distances = reframe::keep_frames_shifted(graph, &mut draft, &limits);
            for (joint_frame, distance) in joint_frames.iter_mut().zip(distances) {
                let along = [graph.zero(), graph.zero(), distance];
                joint_frame.origin = apply_transposed(graph, &joint_frame.axes, along);
            }
        } else {
            reframe::keep_frames(graph, &mut draft, &limits);
        }
        let links = draft.into_iter().map(|link| link.finish(&mut model.graph));
        let tree = Tree {
            links: links.collect(),
            armature: model.armature.clone(),
            tensors: TensorRoute::Each,
        };
        Some((tree, joint_frames))
    }

    /// Computes the inertias of all links about their hinges in the graph.
    ///
    /// Rotations to shared axes do not change them. Once the graph knows their values, it does not
    /// compute them again from rotated entries.
    pub fn register_polar_moments(&self, graph: &mut Graph) {
        for link in &self.links {
            link.unshared.polar(graph);
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
