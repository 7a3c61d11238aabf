//! The front end for robots in URDF. `hamel_import` converts them to descriptions; errors about such a
//! description are shown at the place in the URDF from which its line was made.

mod idle;

use crate::diagnostics::Diagnostic;
use crate::functions::Needs;
use crate::render::{Level, Note, notes, render, span_bytes};
pub use hamel_import::{Imported, Mimic, Options, TOLERANCE, Undecoded, decode};
use std::ops::Range;
use std::path::Path;

/// Whether a path has the extension of a URDF file.
pub fn is_urdf(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("urdf"))
}

/// Converts a robot to a description, without redundant equations of its closing joints. Errors are shown with the text
/// underlined, under the name `path`.
pub fn import(text: &str, options: &Options, path: &str, color: bool) -> Result<Imported, String> {
    hamel_import::import(text, options)
        .map(|imported| idle::without_idle(text, options, imported))
        .map_err(|problems| shown(&problems, Level::Error, path, text, color))
}

/// Shows legal but suspicious parts of a robot, with the text underlined; empty if there are none.
pub fn warnings(imported: &Imported, path: &str, text: &str, color: bool) -> String {
    match imported.warnings.as_slice() {
        [] => String::new(),
        problems => shown(problems, Level::Warning, path, text, color),
    }
}

fn shown(
    problems: &[hamel_import::Problem],
    level: Level,
    path: &str,
    text: &str,
    color: bool,
) -> String {
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

/// Shows errors about the description at their places in the URDF; those without a place there are shown
/// in the text of the description.
pub fn refused(
    errors: &[Diagnostic],
    imported: &Imported,
    path: &str,
    text: &str,
    color: bool,
) -> String {
    let mut placed = Vec::new();
    let mut rest = Vec::new();
    for error in errors {
        let Some((origin, line)) = origin(error, imported) else {
            rest.push(error.clone());
            continue;
        };
        let help = match error.lacking {
            Some(Needs::Inertia) => vec![BARE.to_string()],
            _ => {
                let help = error.help.iter().cloned();
                let line = format!("the description made from it contains `{line}`");
                help.chain([line]).collect()
            }
        };
        placed.push(Note {
            range: origin,
            message: error.message.clone(),
            help,
        });
    }
    let mut rendered = String::new();
    if !placed.is_empty() {
        rendered.push_str(&notes(&placed, Level::Error, path, text, color));
    }
    if !rest.is_empty() {
        let name = format!("{path}, as a description");
        rendered.push_str(&render(&rest, &name, &imported.text, color));
    }
    rendered
}

/// Returns the byte range in the URDF from which an error's line was made, and that line.
fn origin(error: &Diagnostic, imported: &Imported) -> Option<(Range<usize>, String)> {
    let place = span_bytes(error.span, &imported.text)?;
    let before = imported.text.get(..place.start)?;
    let number = before.matches('\n').count();
    let origin = imported.origins.get(number)?.clone()?;
    let line = imported.text.lines().nth(number)?.trim().to_string();
    Some((origin, line))
}
