//! Joints as they were written, and what they became.

use crate::syntax::ast::JointKind;

/// A joint of the description.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name as written.
    pub name: String,
    /// Kind.
    pub kind: JointKind,
    /// The name of the frame that it carries.
    pub frame: String,
    /// Unit vectors along its axes, in the axes of its place (-): none, one, or the two of a universal joint.
    pub axes: Vec<[f64; 3]>,
    /// The names of its coordinates; none where it follows others.
    pub coordinates: Vec<String>,
    /// The names of its velocities.
    pub velocities: Vec<String>,
    /// The smallest and the largest value of its coordinate (rad, m).
    pub limit: Option<[f64; 2]>,
    /// The largest size of its velocity (rad/s, m/s).
    pub max_speed: Option<f64>,
    /// The largest size of its force (N m, N).
    pub max_force: Option<f64>,
}
