//! Joints of a description, with their coordinates and velocities.

use crate::syntax::ast::JointKind;

/// A joint of the description.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name as written.
    pub name: String,
    /// Type of joint.
    pub kind: JointKind,
    /// Name of the frame that it moves.
    pub frame: String,
    /// Unit vectors of its axes in the axes of its place (-): none, one, or the two of a universal joint.
    pub axes: Vec<[f64; 3]>,
    /// Names of its coordinates; none if it follows other joints.
    pub coordinates: Vec<String>,
    /// Names of its velocities.
    pub velocities: Vec<String>,
    /// Smallest and largest value of its coordinate (rad, m).
    pub limit: Option<[f64; 2]>,
    /// Largest speed (rad/s, m/s).
    pub max_speed: Option<f64>,
    /// Largest magnitude of its torque or force (N m, N).
    pub max_force: Option<f64>,
}
