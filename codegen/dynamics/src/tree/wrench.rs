//! Wrenches on links.

use hamel_algebra::graph::{Edge, Graph, Label};
use hamel_algebra::linear::{Vec3, add3, scale3};

/// Force and torque about the origin of a link, in its axes.
#[derive(Clone, Copy, Debug)]
pub struct Wrench {
    /// Force (N).
    pub force: Vec3,
    /// Torque (N m).
    pub torque: Vec3,
}

impl Wrench {
    /// Returns the sum of two wrenches.
    pub fn plus(&self, graph: &mut Graph, other: &Wrench) -> Self {
        Wrench {
            force: add3(graph, self.force, other.force),
            torque: add3(graph, self.torque, other.torque),
        }
    }

    /// Records in the graph that force and torque are entries of a quantity; nodes that have a label keep it.
    pub fn label(&self, graph: &mut Graph, label: Option<Label>) {
        graph.label(&self.torque, label);
        graph.label(&self.force, label);
    }

    /// Returns k times the wrench.
    pub fn scale(&self, graph: &mut Graph, k: Edge) -> Self {
        Wrench {
            torque: scale3(graph, k, self.torque),
            force: scale3(graph, k, self.force),
        }
    }
}
