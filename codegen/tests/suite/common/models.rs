//! The models of the tests, with the functions that a test requests.

use hamel_codegen::generate::{Generated, from_file};
use hamel_codegen::render::render;
use std::path::{Path, PathBuf};

/// Lists all models of a folder.
pub fn models(folder: &Path) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|kind| kind == "eom"))
        .collect();
    found.sort();
    found
}

/// Generates only these functions of a model; returns the errors if it is refused.
pub fn asked_for(path: &Path, asked: &str) -> Result<Generated, String> {
    let text = std::fs::read_to_string(path).expect("a text");
    let kept = text
        .lines()
        .filter(|line| !line.trim().starts_with("generate"));
    let kept = kept.collect::<Vec<_>>().join("\n");
    let (kept, _) = kept.rsplit_once('}').expect("an end");
    let text = format!("{kept}\n    generate {asked};\n}}\n");
    let mut open = |name: &str| std::fs::read_to_string(path.with_file_name(name));
    let name = path.display().to_string();
    from_file(&text, &mut open)
        .map_err(|errors| format!("{name}:\n{}", render(&errors, &name, &text, false)))
}
