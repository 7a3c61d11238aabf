//! What an import may decide, and what it gives.

use crate::problem::Problem;
use std::ops::Range;

/// Angles this near to a multiple of π/2 (rad), and entries this small beside the largest of their
/// vector or matrix, are taken for roundings; so are lengths (m) below a millionth of it.
pub const TOLERANCE: f64 = 1e-9;

/// How joints with `<mimic>` move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mimic {
    /// As the joint that they mimic: no coordinate of their own.
    #[default]
    Follow,
    /// By themselves.
    Free,
}

/// What an import may decide.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name of the file, for the header of the description.
    pub file: String,
    /// Name of the system; by default the robot's name.
    pub name: Option<String>,
    /// Whether the base moves freely; else it stands in the world.
    pub floating: bool,
    /// Joints that do not move, by name, with their angle (rad) or length (m) as a decimal.
    pub locks: Vec<(String, String)>,
    /// Whether masses, centres of mass and inertias are run-time parameters; else exact constants.
    pub params: bool,
    /// How joints with `<mimic>` move.
    pub mimic: Mimic,
    /// What is taken for a rounding, see [`TOLERANCE`]; 0 keeps every digit.
    pub tolerance: f64,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            file: "robot.urdf".into(),
            name: None,
            floating: false,
            locks: Vec::new(),
            params: false,
            mimic: Mimic::default(),
            tolerance: TOLERANCE,
        }
    }
}

/// A robot as a description.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The description, an `.eom` text.
    pub text: String,
    /// The name of the system in it.
    pub name: String,
    /// Joints with coordinates of their own: name in the URDF, name in the description.
    pub joints: Vec<(String, String)>,
    /// Links that are frames of the description: name in the URDF, name in the description.
    pub links: Vec<(String, String)>,
    /// The link that stands in the world, where the base does not float, and the name that a frame for it may have.
    pub ground: Option<(String, String)>,
    /// Whether any link that moves has mass; else there are kinematics alone.
    pub has_masses: bool,
    /// What was taken for a rounding, one sentence each.
    pub cleaned: Vec<String>,
    /// What is legal and still looks wrong.
    pub warnings: Vec<Problem>,
    /// For each line of the text, the bytes of the URDF that it is made from.
    pub origins: Vec<Option<Range<usize>>>,
    /// The lines of the text, from 0, on which the equations of closing joints stand.
    pub equations: Vec<usize>,
}

/// Why an equation of a closing joint says nothing that the others do not say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Idle {
    /// Both sides are equal wherever the tree is.
    Holds,
    /// It follows from other equations wherever the tree is.
    Follows,
}
