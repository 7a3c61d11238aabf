//! Options and results of an import.

use crate::problem::Problem;
use hamel_language::expression::shifted;
use hamel_language::syntax::ast::{Ident, Item, ItemKind, System};
use hamel_language::syntax::print;

/// Default of [`Options::tolerance`], for numbers that are rounded in the file.
///
/// An angle within this distance (rad) of a multiple of π/2 is read as that multiple. An entry of a vector or matrix
/// is read as 0 if it is at most this fraction of the largest entry, and so is a length (m) of at most a millionth of
/// the tolerance.
pub const TOLERANCE: f64 = 1e-9;

/// How joints with `<mimic>` move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mimic {
    /// They follow the joint that they mimic and have no coordinate of their own.
    #[default]
    Follow,
    /// They move independently and have a coordinate of their own.
    Free,
}

/// Options of an import.
#[derive(Clone, Debug)]
pub struct Options {
    /// Name of the file, for the header of the description.
    pub file: String,
    /// Name of the system; by default the robot's name.
    pub name: Option<String>,
    /// Whether the base floats; otherwise it is fixed to the world.
    pub floating: bool,
    /// Locked joints: their names, and the angle (rad) or length (m) at which they stand, as a decimal.
    pub locks: Vec<(String, String)>,
    /// Whether masses, centres of mass and inertias become run-time parameters; otherwise they are exact constants.
    pub params: bool,
    /// How joints with `<mimic>` move.
    pub mimic: Mimic,
    /// Tolerance for rounded numbers, see [`TOLERANCE`]; 0 keeps every digit.
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

/// A robot that was imported: its description, and the names in it.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The description. An error about a statement of it has the place in the URDF from which the statement was made.
    pub system: System,
    /// Joints with coordinates of their own: name in the URDF and name in the description.
    pub joints: Vec<(String, String)>,
    /// Links that are frames of the description: name in the URDF and name in the description.
    pub links: Vec<(String, String)>,
    /// The link that is fixed to the world unless the base floats: its name in the URDF, and a free name for its
    /// frame.
    pub ground: Option<(String, String)>,
    /// Whether any moving link has mass; otherwise the system is kinematic only.
    pub has_masses: bool,
    /// Numbers that were changed because they look rounded, one sentence each.
    pub cleaned: Vec<String>,
    /// Warnings about input that is legal but looks wrong.
    pub warnings: Vec<Problem>,
    /// Indices of the statements that are equations of loop-closing joints.
    pub equations: Vec<usize>,
}

impl Imported {
    /// Returns the name of the system.
    pub fn name(&self) -> &str {
        &self.system.name.name
    }

    /// Declares the link that is fixed to the world as a frame, if there is one.
    pub fn add_ground_frame(&mut self) {
        let Some(link) = self.ground.take() else {
            return;
        };
        let span = self.system.name.span;
        let name = Ident {
            name: link.1.clone(),
            span,
        };
        let kind = ItemKind::Frame {
            name,
            on: None,
            pose: shifted([0, 0, 0]),
        };
        self.system.items.push(Item { kind, span });
        self.links.push(link);
    }

    /// Prints the description as an `.eom` text, with comments: changed numbers, warnings, and what was left out.
    pub fn text(&self) -> String {
        print::print_description(&self.system)
    }
}

/// Why an equation of a loop-closing joint is redundant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Idle {
    /// It holds in every configuration of the tree.
    Holds,
    /// It follows from the other equations in every configuration of the tree.
    Follows,
}
