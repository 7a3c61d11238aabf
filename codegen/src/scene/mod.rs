//! Descriptions as data: read from text, or built in Rust.
//!
//! A [`Scene`] describes a mechanical system before any algebra: it is a list of statements, with their names and exact
//! numbers. It can be cloned, compared, sent to other threads, and printed as text that reads back as an equal
//! scene. A program can build everything that a text can express, and the same checks apply:
//!
//! ```
//! use hamel_codegen::scene::{Body, Joint, Scene, diagonal};
//!
//! # fn main() -> Result<(), hamel_codegen::scene::SceneError> {
//! let mut arm = Scene::builder("Pendulum");
//! let (m, l) = (arm.param("m", 1.2), arm.param("l", 0.4));
//! let torque = arm.input("u");
//! let rod = arm.joint(
//!     Joint::revolute("hinge", [0, 1, 0])
//!         .moves("rod")
//!         .damping(0.01)
//!         .force(torque),
//! );
//! arm.body(
//!     Body::on(&rod)
//!         .mass(&m)
//!         .com([0.into(), 0.into(), -&l / 2])
//!         .inertia_about_com(diagonal([&m * l.pow(2) / 12, &m * l.pow(2) / 12, 0.into()])),
//! );
//! arm.gravity([0.0, 0.0, -9.81]);
//! let scene = arm.build()?;
//!
//! println!("{scene}"); // the description, as an `.eom` file has it
//! let generated = scene.generate()?;
//! println!("{}", scene.rust(&generated)?);
//! # assert_eq!(Scene::parse(&scene.to_string())?, scene);
//! # Ok(())
//! # }
//! ```

mod build;
mod check;
mod claim;
mod parts;
mod reuse;
mod units;

use crate::diagnostics::Diagnostic;
use crate::emit;
use crate::generate::{Generated, of_system};
use crate::render::render;
use crate::syntax::ast::System;
use crate::syntax::parse_text;
use std::fmt;

pub use crate::syntax::ast::{
    Between as Interpolation, Beyond as Extrapolation, Comparison, CoordKind, Expr, ShapeKind,
};
pub use build::SceneBuilder;
pub use claim::Claim;
pub use hamel_language::expression::{
    call, choice, cos, diagonal, if_less, in_axes, pose, shifted, sin, sqrt,
};
pub use parts::{Between, Body, Element, Frame, Joint, Load, Point, WORLD};
pub use reuse::Parameter;

/// A description of a mechanical system.
///
/// Two scenes are equal if they have the same statements; comments, layout and source positions do not count.
#[derive(Clone, Debug)]
pub struct Scene {
    system: System,
    text: String,
}

impl PartialEq for Scene {
    fn eq(&self, other: &Scene) -> bool {
        self.system == other.system
    }
}

impl Scene {
    /// Starts to build a scene; `name` becomes the name of the generated type.
    pub fn builder(name: &str) -> SceneBuilder {
        SceneBuilder::new(name)
    }

    /// Reads a scene from text, such as that of an `.eom` file.
    ///
    /// # Errors
    /// All parts of the text that are not valid in a description.
    pub fn parse(text: &str) -> Result<Scene, SceneError> {
        match parse_text(text) {
            Ok(system) => Ok(Scene {
                system,
                text: text.to_string(),
            }),
            Err(errors) => Err(SceneError::new(errors, text)),
        }
    }

    /// Name of the generated type.
    pub fn name(&self) -> &str {
        &self.system.name.name
    }

    /// Text of the description: as it was read, with comments, or as printed if the scene was built.
    pub fn source(&self) -> &str {
        &self.text
    }

    /// Derives the equations of motion, and proves them.
    ///
    /// # Errors
    /// Everything that is wrong with the description; each error names the statement that it is about.
    pub fn generate(&self) -> Result<Generated, SceneError> {
        of_system(&self.system, &self.text).map_err(|errors| SceneError::new(errors, &self.text))
    }

    /// Returns Rust code for the result of [`generate`](Self::generate): the file that a build script would write.
    ///
    /// # Errors
    /// If the generated text is not valid Rust, which is a defect of hamel itself.
    pub fn rust(&self, generated: &Generated) -> Result<String, SceneError> {
        let options = emit::Options {
            source_hash: generated.hash,
            ..Default::default()
        };
        emit::rust_file(&generated.program, &options)
            .map_err(|error| SceneError::new(vec![generated.fault(&error)], &self.text))
    }
}

/// Prints the description in the language, one statement per line.
impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&crate::syntax::print::print_description(&self.system))
    }
}

impl std::str::FromStr for Scene {
    type Err = SceneError;
    fn from_str(text: &str) -> Result<Scene, SceneError> {
        Scene::parse(text)
    }
}

/// The errors of a scene, each with the statement that it is about.
#[derive(Clone)]
pub struct SceneError {
    /// The errors, with their positions in `text`.
    pub errors: Vec<Diagnostic>,
    /// The text of the scene.
    pub text: String,
}

impl SceneError {
    fn new(errors: Vec<Diagnostic>, text: &str) -> SceneError {
        SceneError {
            errors,
            text: text.to_string(),
        }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&render(&self.errors, "scene", &self.text, false))
    }
}

// A program that returns the error from `main` prints its `Debug` form, which must be readable, too.
impl fmt::Debug for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\n{self}")
    }
}

impl std::error::Error for SceneError {}
