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
pub mod link;
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
pub mod wrench;

use super::calculus::Calculus;
use hamel_algebra::linear::apply_transposed;
use hamel_language::model::Model;
use link::TensorRoute;
pub use link::{Freedom, Link, Tree};

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
            Placement::Parallel => tree.with_shared_axes(&mut model.graph).0,
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
}
