//! The front end for robots in URDF. `hamel_import` converts them to descriptions, whose statements have their places
//! in the URDF.

mod idle;

use crate::diagnostics::Diagnostic;
use crate::functions::Needs;
use crate::render::{Level, Note, notes, render};
use crate::syntax::ast::Texts;
pub use hamel_import::{Imported, Mimic, Options, Problem, TOLERANCE, Undecoded, decode};
use std::path::Path;

/// Whether a path has the extension of a URDF file.
pub fn is_urdf(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("urdf"))
}

/// Converts a robot to a description, without redundant equations of its closing joints.
///
/// # Errors
/// Each with its place in the text; [`errors`] shows them with the text underlined.
pub fn import(text: &str, options: &Options) -> Result<Imported, Vec<Problem>> {
    let imported = hamel_import::import(text, options)?;
    Ok(idle::without_idle(text, options, imported))
}

/// Shows the errors of a robot, with the text underlined.
pub fn errors(problems: &[Problem], path: &str, text: &str, color: bool) -> String {
    shown(problems, Level::Error, path, text, color)
}

/// Shows legal but suspicious parts of a robot, with the text underlined; empty if there are none.
pub fn warnings(imported: &Imported, path: &str, text: &str, color: bool) -> String {
    match imported.warnings.as_slice() {
        [] => String::new(),
        problems => shown(problems, Level::Warning, path, text, color),
    }
}

fn shown(problems: &[Problem], level: Level, path: &str, text: &str, color: bool) -> String {
    let list: Vec<Note> = problems
        .iter()
        .map(|problem| Note {
            range: problem.range.clone(),
            message: problem.message.clone(),
            help: vec![problem.help.clone()],
        })
        .collect();
    notes(&list, level, path, text, color)
}

/// Help for a robot without masses.
const BARE: &str = "no moving link of the robot has mass: give the links an `<inertial>`";

/// Shows errors about the description of a robot, each at the part of the URDF from which the statement was made, under
/// the name `path`.
pub fn refused(errors: &[Diagnostic], path: &str, text: &str, color: bool) -> String {
    let errors: Vec<Diagnostic> = errors.iter().cloned().map(about_the_robot).collect();
    render(&errors, path, text, color)
}

/// Replaces help about statements, which the user has not written, where the robot lacks masses.
fn about_the_robot(mut error: Diagnostic) -> Diagnostic {
    if error.lacking == Some(Needs::Inertia) {
        error.help = Some(BARE.to_string());
        error.texts = Texts::default();
    }
    error
}
