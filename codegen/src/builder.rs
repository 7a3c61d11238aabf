//! The build script's front end: `.eom` files in, formatted `.rs` files in `OUT_DIR`.
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
use crate::emit::{self, c::Precision};
use crate::generate::{Generated, from_file, from_text};
use crate::render::{render, warnings};
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

/// Generates files in a build script.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    files: Vec<(PathBuf, Kind)>,
    out_dir: Option<PathBuf>,
    c: Option<(PathBuf, Precision)>,
}

/// What a file holds.
#[derive(Clone, Debug)]
enum Kind {
    /// A description.
    Description,
    /// A robot, and how it is read.
    #[cfg(feature = "urdf")]
    Urdf(crate::urdf::Options),
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

    /// Adds a description, by its path from the package's folder. With the feature `urdf`, files
    /// that end in `.urdf` are robots.
    pub fn file(mut self, path: impl Into<PathBuf>) -> Self {
        let path = path.into();
        #[cfg(feature = "urdf")]
        if crate::urdf::is_urdf(&path) {
            return self.urdf(path, crate::urdf::Options::default());
        }
        self.files.push((path, Kind::Description));
        self
    }

    /// Adds a robot in URDF with what its import decides; the name of the file stands in the
    /// generated text.
    #[cfg(feature = "urdf")]
    pub fn urdf(mut self, path: impl Into<PathBuf>, options: crate::urdf::Options) -> Self {
        let path = path.into();
        let file = name(&path);
        let options = crate::urdf::Options { file, ..options };
        self.files.push((path, Kind::Urdf(options)));
        self
    }

    /// The folder to write to; `OUT_DIR` where it is not set.
    pub fn out_dir(mut self, path: impl Into<PathBuf>) -> Self {
        self.out_dir = Some(path.into());
        self
    }

    /// Writes C99 as well: `stem.h` and `stem.c` for every file, into this folder, which exists.
    pub fn c_files(mut self, folder: impl Into<PathBuf>, precision: Precision) -> Self {
        self.c = Some((folder.into(), precision));
        self
    }

    /// Generates `stem.rs` for every `stem.eom` or `stem.urdf`. All files are read before anything is reported;
    /// files whose bytes would not change are not touched. What a description declares and does not use becomes
    /// a warning of the package.
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
        for (path, kind) in &self.files {
            watch(path);
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
            if let Err(error) = self.generate_file(path, kind, &out_dir, &stem) {
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

fn name(path: &Path) -> String {
    path.file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default()
}

/// Has Cargo run the build script again when a file changes. What the script itself writes below `OUT_DIR` is newer than
/// the script's start, and would have it run in every build.
fn watch(path: &Path) {
    let written = std::env::var_os("OUT_DIR").is_some_and(|folder| path.starts_with(folder));
    if !written {
        println!("cargo:rerun-if-changed={}", path.display());
    }
}

impl Builder {
    fn generate_file(
        &self,
        path: &Path,
        kind: &Kind,
        out_dir: &Path,
        stem: &str,
    ) -> Result<(), String> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        let shown = path.display().to_string();
        let files = match kind {
            Kind::Description => {
                let refused = |errors: Vec<Diagnostic>| render(&errors, &shown, &text, false);
                let folder = path.parent().unwrap_or(Path::new(""));
                let open = &mut |name: &str| {
                    let file = folder.join(name);
                    watch(&file);
                    std::fs::read_to_string(file)
                };
                let generated = from_file(&text, open).map_err(refused)?;
                warn(&warnings(&generated.model.warnings, &shown, &text, false));
                self.texts(&generated, &name(path), stem).map_err(refused)
            }
            #[cfg(feature = "urdf")]
            Kind::Urdf(options) => {
                use crate::generate::available_in;
                use crate::urdf::{import, refused, warnings};
                let imported = import(&text, options, &shown, false)?;
                warn(&warnings(&imported, &shown, &text, false));
                let description = name(&path.with_extension("eom"));
                let refused =
                    |errors: Vec<Diagnostic>| refused(&errors, &imported, &shown, &text, false);
                let (generated, singular) = available_in(&imported.text).map_err(refused)?;
                if let Some(Diagnostic { message, .. }) = singular {
                    warn(&format!(
                        "{shown}: {message}; what needs its inverse is left out"
                    ));
                }
                self.texts(&generated, &description, stem).map_err(refused)
            }
        }?;
        for (file, text) in files {
            let file = out_dir.join(file);
            hamel_files::update(&file, &text).map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// The files of what was derived: names below the folder of the Rust, or whole paths, and texts.
    fn texts(
        &self,
        generated: &Generated,
        name: &str,
        stem: &str,
    ) -> Result<Vec<(PathBuf, String)>, Vec<Diagnostic>> {
        let mut files = vec![(format!("{stem}.rs").into(), written(generated, name)?)];
        if let Some((folder, precision)) = &self.c {
            // The Rust stands elsewhere.
            let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
            let c = written_in_c(generated, name, Some(stem), *precision)?;
            files.push((folder.join(format!("{stem}.h")), c.header));
            files.push((folder.join(format!("{stem}.c")), c.source));
        }
        Ok(files)
    }
}

/// Cargo shows these lines as warnings of the package.
fn warn(text: &str) {
    for line in text.lines() {
        println!("cargo::warning={line}");
    }
}

/// The generated file of a description; `name` stands in the command that its header shows.
pub fn source(text: &str, name: &str) -> Result<String, Vec<Diagnostic>> {
    written(&from_text(text)?, name)
}

/// The same of what was derived already.
pub fn written(generated: &Generated, name: &str) -> Result<String, Vec<Diagnostic>> {
    let options = emit::Options {
        source_hash: generated.hash,
        command: format!("hamel emit {name}"),
        ..Default::default()
    };
    emit::file(&generated.program, &options).map_err(|error| vec![generated.fault(&error)])
}

/// The C99 of what was derived already; `name` stands in the command that it shows, `stem` is what its files are called
/// before `.h` and `.c`, where they have a name. Functions that are given in Rust are refused.
pub fn written_in_c(
    generated: &Generated,
    name: &str,
    stem: Option<&str>,
    precision: Precision,
) -> Result<emit::c::Files, Vec<Diagnostic>> {
    let refused = generated.model.externals.iter().map(|&place| {
        Diagnostic::new(place, "C has no function that is given in Rust")
            .help("write what it gives as an expression, `fn`, or as a table")
    });
    let refused: Vec<Diagnostic> = refused.collect();
    if !refused.is_empty() {
        return Err(refused);
    }
    let numbers = match precision {
        Precision::Double => "",
        Precision::Float => " --precision float",
    };
    let out = stem.map_or_else(String::new, |stem| format!(" -o {stem}"));
    let options = emit::c::Options {
        source_hash: generated.hash,
        command: format!("hamel emit --language c{numbers} {name}{out}"),
        header: format!("{}.h", stem.unwrap_or_default()),
        precision,
    };
    Ok(emit::c::files(&generated.program, &options))
}
