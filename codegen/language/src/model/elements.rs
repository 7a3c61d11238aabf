//! Wrenches; springs, dampers and forces along lines.

use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::Vec3;
use crate::syntax::ast::Axes;

/// A wrench on a frame, acting at a point fixed to it.
#[derive(Clone, Debug)]
pub struct Wrench {
    /// Index of the frame.
    pub frame: usize,
    /// Point of application, frame axes (m).
    pub at: Vec3,
    /// Force (N).
    pub force: Vec3,
    /// Torque (N m).
    pub torque: Vec3,
    /// Axes in which force and torque are given.
    pub axes: Axes,
}

/// The distance or scalar along which a spring, damper or force acts.
#[derive(Clone, Debug)]
pub enum Along {
    /// The line between two points, in world axes (m), with its length if that was needed.
    Line {
        /// The first point.
        from: Vec3,
        /// The second point.
        to: Vec3,
        /// Distance ℓ between the points.
        length: Option<Edge>,
    },
    /// A scalar function of the configuration; for a damper, a rate.
    Scalar(Edge),
}

/// A spring, V = ½ k (ℓ − l)², or a cable, whose k is 0 while ℓ ≤ l.
#[derive(Clone, Debug)]
pub struct Spring {
    /// Stiffness k (N/m, N m/rad).
    pub stiffness: Edge,
    /// Free length l.
    pub length: Edge,
    /// Defines ℓ.
    pub along: Along,
    /// Forces of the spring, if it acts along a line.
    pub wrenches: Vec<Wrench>,
}

/// A damper, D = ½ c ℓ̇².
#[derive(Clone, Debug)]
pub struct Damper {
    /// Coefficient c (N s/m, N m s/rad).
    pub coefficient: Edge,
    /// Defines ℓ.
    pub along: Along,
}

/// A force F along a line; positive F pushes the points apart.
#[derive(Clone, Debug)]
pub struct Push {
    /// Force F (N).
    pub force: Edge,
    /// Line of action.
    pub along: Along,
}

/// Springs, dampers and forces along lines as they were given, and the other statements about energies and forces.
/// The fields of the model hold the sums of all; these are kept so that the sums can be proved by an independent
/// derivation.
#[derive(Clone, Debug)]
pub struct Elements {
    /// Springs.
    pub springs: Vec<Spring>,
    /// Dampers.
    pub dampers: Vec<Damper>,
    /// Forces along lines.
    pub pushes: Vec<Push>,
    /// Sum of the `potential` statements alone.
    pub potential: Edge,
    /// Sum of the `dissipation` statements alone.
    pub dissipation: Edge,
    /// Sums of the `generalized force` statements alone.
    pub generalized: Vec<Edge>,
    /// The `force`, `torque` and `wrench` statements on frames alone.
    pub wrenches: Vec<Wrench>,
    /// V without springs along lines, which act through their wrenches.
    pub scalar_potential: Edge,
    /// D without dampers along lines, which act through their wrenches.
    pub scalar_dissipation: Edge,
}

impl Elements {
    /// Returns a collection without any elements.
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
