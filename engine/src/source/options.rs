//! Options for reading descriptions and robots.

use hamel_codegen::urdf::{Mimic, Options, TOLERANCE};
use std::path::Path;

/// Options for robots in URDF, and for descriptions.
#[derive(Clone, Debug, Default)]
pub struct OpenOptions {
    /// Whether the base of a robot moves freely.
    pub floating: bool,
    /// Joints of a robot that do not move, with their angles (rad) or lengths (m) as texts.
    pub locks: Vec<(String, String)>,
    /// Whether masses, centres of mass and inertias of a robot are run-time parameters.
    pub params: bool,
    /// Motion of a robot's joints that mimic another one.
    pub mimic: Option<Mimic>,
    /// Name of the system of a robot; by default the robot's.
    pub name: Option<String>,
    /// Angles (rad) and parts of vectors that are smaller are rounded away in robots.
    pub rounding: Option<f64>,
    /// Other values of constants of a description.
    pub constants: Vec<(String, String)>,
}

impl OpenOptions {
    /// Returns whether an option for robots is set.
    pub(super) fn are_for_robots(&self) -> bool {
        self.floating
            || !self.locks.is_empty()
            || self.params
            || self.mimic.is_some()
            || self.name.is_some()
            || self.rounding.is_some()
    }

    /// Returns the options of an import.
    pub(super) fn import(&self, path: &str) -> Options {
        let file = Path::new(path).file_name();
        Options {
            file: file.map_or_else(|| path.to_string(), |file| file.to_string_lossy().into()),
            name: self.name.clone(),
            floating: self.floating,
            locks: self.locks.clone(),
            params: self.params,
            mimic: self.mimic.unwrap_or(Mimic::Follow),
            tolerance: self.rounding.unwrap_or(TOLERANCE),
        }
    }
}
