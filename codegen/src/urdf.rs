//! The front end for robots in URDF: `hamel_import` makes a description of them, and errors about that
//! description are shown at the place in the URDF that its lines are made from.

mod idle;

use crate::diagnostics::Diagnostic;
use crate::functions::Needs;
use crate::render::{Level, Note, notes, render, span_bytes};
pub use hamel_import::{Imported, Mimic, Options, TOLERANCE, Undecoded, decode};
use std::ops::Range;
use std::path::Path;

/// Whether a path is that of a URDF file.
pub fn is_urdf(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("urdf"))
}

/// Makes a description, whose closing joints have the equations that say something; errors are underlined in the text, which is
/// named `path`.
pub fn import(text: &str, options: &Options, path: &str, color: bool) -> Result<Imported, String> {
    hamel_import::import(text, options)
        .map(|imported| idle::without_idle(text, options, imported))
        .map_err(|problems| shown(&problems, Level::Error, path, text, color))
}

/// What is legal and still looks wrong, underlined; empty where there is nothing.
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

/// What to do about a robot without masses.
const BARE: &str = "no link of the robot that moves has mass: give the links their `<inertial>`";

/// Errors about the description, at their places in the URDF; those that have none there are shown
/// in the description's own text.
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
                let line = format!("the description made from it has `{line}`");
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

/// The bytes of the URDF behind the line that an error is about, and that line.
fn origin(error: &Diagnostic, imported: &Imported) -> Option<(Range<usize>, String)> {
    let place = span_bytes(error.span, &imported.text)?;
    let before = imported.text.get(..place.start)?;
    let number = before.matches('\n').count();
    let origin = imported.origins.get(number)?.clone()?;
    let line = imported.text.lines().nth(number)?.trim().to_string();
    Some((origin, line))
}
