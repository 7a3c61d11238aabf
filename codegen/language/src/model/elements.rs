//! Springs, dampers and forces along lines.

use super::Wrench;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::Vec3;

/// What a spring or damper acts along.
#[derive(Clone, Debug)]
pub enum Along {
    /// The line between two points, world axes (m); its length where it was needed.
    Line {
        /// The first point.
        from: Vec3,
        /// The second point.
        to: Vec3,
        /// Their distance ℓ.
        length: Option<Edge>,
    },
    /// A scalar of the configuration, or for a damper a rate.
    Scalar(Edge),
}

/// V = ½ k (ℓ − l)².
#[derive(Clone, Debug)]
pub struct Spring {
    /// Stiffness k (N/m, N m/rad).
    pub stiffness: Edge,
    /// Length l without force.
    pub length: Edge,
    /// What ℓ is.
    pub along: Along,
    /// The forces of a spring along a line.
    pub wrenches: Vec<Wrench>,
}

/// D = ½ c ℓ̇².
#[derive(Clone, Debug)]
pub struct Damper {
    /// Coefficient c (N s/m, N m s/rad).
    pub coefficient: Edge,
    /// What ℓ is.
    pub along: Along,
}

/// A force F along a line, positive apart.
#[derive(Clone, Debug)]
pub struct Push {
    /// F (N).
    pub force: Edge,
    /// The line.
    pub along: Along,
}

/// Springs, dampers and forces along lines as they were given, and what was given beside them. The
/// sums of all are in the fields of the model; these are for proofs on another route.
#[derive(Clone, Debug)]
pub struct Elements {
    /// Springs.
    pub springs: Vec<Spring>,
    /// Dampers.
    pub dampers: Vec<Damper>,
    /// Forces along lines.
    pub pushes: Vec<Push>,
    /// The `potential` statements alone.
    pub potential: Edge,
    /// The `dissipation` statements alone.
    pub dissipation: Edge,
    /// The `generalized force` statements alone.
    pub generalized: Vec<Edge>,
    /// The `force`, `torque` and `wrench` statements on frames alone.
    pub wrenches: Vec<Wrench>,
    /// V without springs along lines, which act by their wrenches.
    pub scalar_potential: Edge,
    /// D without dampers along lines, which act by their wrenches.
    pub scalar_dissipation: Edge,
}

impl Elements {
    /// None yet.
    pub fn none(graph: &Graph, n: usize) -> Self {
        let zero = graph.zero();
        Elements {
            springs: Vec::new(),
            dampers: Vec::new(),
            pushes: Vec::new(),
            potential: zero,
            dissipation: zero,
            generalized: vec![zero; n],
            wrenches: Vec::new(),
            scalar_potential: zero,
            scalar_dissipation: zero,
        }
    }
}
