//! Checks of output paths: they must differ from each other and from the inputs.

use crate::failure::Failure;
use std::path::{Path, PathBuf};

/// Refuses outputs that would overwrite an input or one another; each is given with its option.
pub fn apart<'a>(
    outputs: impl IntoIterator<Item = (&'a str, Option<&'a Path>)>,
    inputs: impl IntoIterator<Item = Option<&'a Path>>,
) -> Result<(), Failure> {
    let inputs = inputs.into_iter().flatten();
    let read: Vec<PathBuf> = inputs.filter_map(place).collect();
    let mut written: Vec<(&str, PathBuf)> = Vec::new();
    for (option, path) in outputs {
        let Some(path) = path else { continue };
        let Some(place) = place(path) else { continue };
        let shown = path.display();
        if read.contains(&place) {
            return Err(Failure::usage(format!(
                "{option} {shown}: this file is an input and would be overwritten; give the result another name"
            )));
        }
        if let Some((other, _)) = written.iter().find(|(_, other)| *other == place) {
            return Err(Failure::usage(format!(
                "{option} {shown}: {other} already writes this file; use different names"
            )));
        }
        written.push((option, place));
    }
    Ok(())
}

/// Refuses a picture whose name does not end in `.svg`; devices and pipes may have any name.
pub fn svg(option: &str, path: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    if ending.is_some_and(|ending| ending == "svg") || is_stream(path) {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "{option} {}: a picture is written as SVG, so its name has to end in .svg",
        path.display()
    )))
}

/// Returns the canonical path, if it is or may become a file.
fn place(path: &Path) -> Option<PathBuf> {
    if path.as_os_str() == "-" || is_stream(path) {
        return None;
    }
    if let Ok(place) = path.canonicalize() {
        return Some(place);
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.into());
    Some(folder.join(path.file_name()?))
}

/// Returns whether a path exists and is neither a file nor a folder.
fn is_stream(path: &Path) -> bool {
    let known = path.metadata();
    known.is_ok_and(|known| !known.is_file() && !known.is_dir())
}
