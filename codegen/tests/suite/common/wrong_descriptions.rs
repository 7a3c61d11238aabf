//! Wrong descriptions, which state their errors in comments.

use std::path::{Path, PathBuf};

/// Start of the comments in which a wrong description states its errors.
pub const EXPECTED: &str = "//~";

/// Lists the descriptions in the folders of a folder.
pub fn wrong_descriptions(folder: &Path) -> Vec<PathBuf> {
    let entries = |folder: &Path| {
        let entries = std::fs::read_dir(folder).expect("a folder");
        entries.map(|entry| entry.expect("an entry").path())
    };
    let mut found: Vec<PathBuf> = entries(folder)
        .flat_map(|folder| entries(&folder))
        .collect();
    found.sort();
    found
}

/// Returns a description without the comments that state its errors.
pub fn without_expected(text: &str) -> String {
    let lines = text.split_inclusive('\n');
    lines
        .filter(|line| !line.trim_start().starts_with(EXPECTED))
        .collect()
}
