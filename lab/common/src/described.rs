//! Descriptions that request their linearisation, for build scripts of benches.

use hamel_codegen::urdf::{self, Options};
use std::error::Error;
use std::path::Path;

/// Returns the description of a robot.
pub fn imported(robot: &Path, floating: bool) -> Result<String, Box<dyn Error>> {
    let options = Options {
        floating,
        ..Options::default()
    };
    let text = std::fs::read_to_string(robot)?;
    let imported = urdf::import(&text, &options)
        .map_err(|problems| urdf::errors(&problems, &robot.to_string_lossy(), &text, false))?;
    Ok(imported.text())
}

/// Adds the request for the linearisation to a description.
pub fn linearised(description: &str) -> Result<String, Box<dyn Error>> {
    let body = description.trim_end().strip_suffix('}').ok_or("no end")?;
    Ok(format!("{body}    generate all, linearize;\n}}\n"))
}
