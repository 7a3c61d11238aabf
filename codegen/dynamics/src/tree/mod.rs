//! Trees of links: inverse dynamics, M and forward dynamics by recursion.
//!
//! Links are what moves rigidly together; their frames are the generator's choice, whatever frames
//! the description has. A link's inertia is kept as m, h, S, and the part of it on which the
//! joint's motion has no effect is moved to the link before. Sources: Featherstone, *Rigid Body Dynamics Algorithms* (2008), chapters
//! 5-7; Khalil and Kleinfinger (1987) for customised recursions and base inertial parameters.

pub mod articulated;
pub mod composite;
pub(crate) mod draft;
pub mod inverse;
pub mod mass;
pub mod momentum;
mod parallel;
mod reframe;
mod regroup;
mod revolute;
mod safe;
pub mod slopes;
pub mod turn;
pub mod twin;
pub mod uniform;

use super::calculus::Calculus;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, apply_transposed};
use hamel_language::model::Model;
use inverse::{Tensors, Wrench};
use mass::Mass;
use turn::Turn;

/// One column of a joint's motion subspace S: the twist of a link relative to the one before, per unit of its rate.
#[derive(Clone, Debug)]
pub struct Freedom {
    /// Angular velocity, axes of the link.
    pub angular: Vec3,
    /// Velocity of the link's origin, axes of the link.
    pub linear: Vec3,
    /// Its rate is Σ k ξⁱ, k constant: pairs (i, k).
    pub rate: Vec<(usize, Edge)>,
}

impl Freedom {
    /// Whether its rate is known ahead.
    pub fn is_given(&self, given: &[usize]) -> bool {
        self.rate.iter().all(|(i, _)| given.contains(i))
    }

    /// Σ k vⁱ.
    pub fn rate_of(&self, graph: &mut Graph, v: &[Edge]) -> Edge {
        let terms: Vec<Edge> = self.rate.iter().map(|&(i, k)| graph.mul(k, v[i])).collect();
        graph.sum(&terms)
    }

    /// Sᵀ f, the generalised force of a wrench on the link: its power at a unit of the rate.
    pub fn force_of(&self, graph: &mut Graph, wrench: &Wrench) -> Edge {
        let (angular, linear) = (
            graph.dot(&self.angular, &wrench.torque),
            graph.dot(&self.linear, &wrench.force),
        );
        graph.add(angular, linear)
    }

    /// Adds this force to those of the velocities that make its rate.
    pub fn add_force(&self, graph: &mut Graph, wrench: &Wrench, forces: &mut [Edge]) {
        let force = self.force_of(graph, wrench);
        for &(i, k) in &self.rate {
            let share = graph.mul(k, force);
            forces[i] = graph.add(forces[i], share);
        }
    }
}

/// A link: what moves against the link before by a joint.
#[derive(Clone, Debug)]
pub struct Link {
    /// The link before, which has a smaller index; the world where absent.
    pub parent: Option<usize>,
    /// The axes of this link in those of the one before: the product of these turns.
    pub turns: Vec<Turn>,
    /// The origin of this link, axes of the one before.
    pub position: Vec3,
    /// The freedoms of its joint.
    pub freedoms: Vec<Freedom>,
    /// The velocity-product acceleration of the joint, Ṡ times its rates: angular, linear.
    pub velocity_product: (Vec3, Vec3),
    /// Its inertia about its origin.
    pub mass: Mass,
    /// The same in the axes that it would have alone, where it shares those of other links.
    pub unshared: Mass,
}

impl Link {
    /// Adds the generalised forces of a wrench on the link at its joint.
    pub fn add_forces(&self, graph: &mut Graph, wrench: &Wrench, forces: &mut [Edge]) {
        for freedom in &self.freedoms {
            freedom.add_force(graph, wrench, forces);
        }
    }

    /// A vector in the axes of the link before.
    pub fn to_parent_axes(&self, graph: &mut Graph, v: Vec3) -> Vec3 {
        self.turns
            .iter()
            .rev()
            .fold(v, |v, turn| turn.rotate(graph, v))
    }

    /// A vector of the link before in the axes of this one.
    pub fn from_parent_axes(&self, graph: &mut Graph, v: Vec3) -> Vec3 {
        self.turns
            .iter()
            .fold(v, |v, turn| turn.rotate_back(graph, v))
    }
}

/// The links, each after the one that it hangs on.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The links.
    pub links: Vec<Link>,
    /// Armatures: J of the force J ξ̇ⁱ that a velocity needs besides.
    pub armature: Vec<Edge>,
    /// How U of its links is computed.
    pub tensors: Tensors,
}

/// Where the frames of links are put.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// Where the recursions are cheapest, inertias regrouped.
    Chosen,
    /// The same, in axes that parallel hinges share.
    Parallel,
    /// Where the description has them, inertias with the links that they are of.
    Described,
}

impl Tree {
    /// The tree of a model; `None` where not all of its inertia is that of armatures, and of bodies and
    /// particles that are fixed to frames.
    pub fn of(model: &mut Model, calculus: &mut Calculus, placement: Placement) -> Option<Tree> {
        let mut draft = draft::draft(model, calculus)?;
        let safe = safe::Safe::of(model, &draft);
        match placement {
            Placement::Chosen | Placement::Parallel => {
                reframe::reframe(&mut model.graph, &mut draft, &safe);
                regroup::regroup(&mut model.graph, &mut draft);
            }
            Placement::Described => reframe::keep(&mut model.graph, &mut draft, &safe),
        }
        let links = draft.into_iter().map(|link| link.finish(&mut model.graph));
        let tree = Tree {
            links: links.collect(),
            armature: model.armature.clone(),
            tensors: Tensors::Each,
        };
        Some(match placement {
            Placement::Parallel => tree.sharing_axes(&mut model.graph).0,
            Placement::Chosen | Placement::Described => tree,
        })
    }

    /// The tree with the frames of the description, their origins moved along the hinges if that is asked for, and for each
    /// link the frame that its joint carries; `None` as above.
    pub fn with_frames(
        model: &mut Model,
        calculus: &mut Calculus,
        moved: bool,
    ) -> Option<(Tree, Vec<draft::Carrier>)> {
        let (mut draft, mut carriers) = draft::draft_with_carriers(model, calculus)?;
        let safe = safe::Safe::of(model, &draft);
        let graph = &mut model.graph;
        if moved {
            let distances = reframe::slide_all(graph, &mut draft, &safe);
            for (carrier, distance) in carriers.iter_mut().zip(distances) {
                let along = [graph.zero(), graph.zero(), distance];
                carrier.origin = apply_transposed(graph, &carrier.axes, along);
            }
        } else {
            reframe::keep(graph, &mut draft, &safe);
        }
        let links = draft.into_iter().map(|link| link.finish(&mut model.graph));
        let tree = Tree {
            links: links.collect(),
            armature: model.armature.clone(),
            tensors: Tensors::Each,
        };
        Some((tree, carriers))
    }

    /// Enters the inertias of all links about their hinges into a graph. Turns to shared axes leave them alone: what is known
    /// without them is not computed from turned entries.
    pub fn know_polars(&self, graph: &mut Graph) {
        for link in &self.links {
            link.unshared.polar(graph);
        }
    }

    /// Whether every ξⁱ is the rate of one freedom of its own, but for those that are given ahead.
    pub fn is_plain(&self, graph: &Graph, n: usize, given: &[usize]) -> bool {
        let mut seen = vec![false; n];
        self.links.iter().flat_map(|link| &link.freedoms).all(|freedom| {
            freedom.is_given(given) || matches!(freedom.rate.as_slice(), &[(i, k)] if k == graph.one() && !std::mem::replace(&mut seen[i], true))
        })
    }
}
