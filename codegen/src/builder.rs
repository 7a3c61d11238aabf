//! The build script's door: `.eom` files in, formatted `.rs` files in `OUT_DIR`.
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), hamel_codegen::BuildError> {
//!     hamel_codegen::Builder::new().file("models/free_body.eom").generate()
//! }
//! ```
//!
//! and in the crate `include!(concat!(env!("OUT_DIR"), "/free_body.rs"));`.

use crate::diagnostics::Diagnostic;
use crate::emit;
use crate::generate::from_text;
use crate::render::render;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

/// Generates files in a build script.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    files: Vec<PathBuf>,
    out_dir: Option<PathBuf>,
}

/// Why nothing, or not everything, was generated; shows every error with its place in the source.
pub struct BuildError(String);

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

// A build script that returns the error prints its `Debug` form: that must be readable too.
impl fmt::Debug for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\n{}", self.0)
    }
}

impl std::error::Error for BuildError {}

impl Builder {
    /// A builder without files.
    pub fn new() -> Self {
        Builder::default()
    }

    /// Adds a description, by its path from the package's folder.
    pub fn file(mut self, path: impl Into<PathBuf>) -> Self {
        self.files.push(path.into());
        self
    }

    /// The folder to write to; `OUT_DIR` where it is not set.
    pub fn out_dir(mut self, path: impl Into<PathBuf>) -> Self {
        self.out_dir = Some(path.into());
        self
    }

    /// Generates `stem.rs` for every `stem.eom`. All files are read before anything is reported;
    /// files whose bytes would not change are not touched.
    pub fn generate(self) -> Result<(), BuildError> {
        let out_dir = match self
            .out_dir
            .clone()
            .or_else(|| std::env::var_os("OUT_DIR").map(PathBuf::from))
        {
            Some(folder) => folder,
            None => return Err(BuildError(
                "OUT_DIR is not set: call this in a build script, or name a folder with `out_dir`"
                    .into(),
            )),
        };
        let mut errors = Vec::new();
        let mut stems: BTreeMap<String, PathBuf> = BTreeMap::new();
        for path in &self.files {
            println!("cargo:rerun-if-changed={}", path.display());
            let stem = path
                .file_stem()
                .map(|stem| stem.to_string_lossy().into_owned())
                .unwrap_or_default();
            if let Some(other) = stems.insert(stem.clone(), path.clone()) {
                errors.push(format!(
                    "{} and {} would both be written to {stem}.rs; rename one of them",
                    other.display(),
                    path.display()
                ));
                continue;
            }
            if let Err(error) = generate_file(path, &out_dir.join(format!("{stem}.rs"))) {
                errors.push(error);
            }
        }
        if errors.is_empty() {
            Ok(())
        } else {
            Err(BuildError(errors.join("\n")))
        }
    }
}

fn generate_file(path: &Path, target: &Path) -> Result<(), String> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    let name = path
        .file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default();
    let code = source(&text, &name)
        .map_err(|errors| render(&errors, &path.display().to_string(), &text, false))?;
    if std::fs::read_to_string(target).is_ok_and(|known| known == code) {
        return Ok(());
    }
    std::fs::write(target, code)
        .map_err(|error| format!("cannot write {}: {error}", target.display()))
}

/// The generated file of a description; `name` stands in the command that its header shows.
pub fn source(text: &str, name: &str) -> Result<String, Vec<Diagnostic>> {
    let generated = from_text(text)?;
    let options = emit::Options {
        source_hash: generated.hash,
        command: format!("hamel emit {name}"),
        ..Default::default()
    };
    Ok(emit::file(&generated.program, &options))
}
