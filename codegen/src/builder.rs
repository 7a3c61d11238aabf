//! The front end for build scripts: reads `.eom` files, and writes formatted `.rs` files to `OUT_DIR`.
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), hamel_codegen::BuildError> {
//!     hamel_codegen::Builder::new().file("models/free_body.eom").generate()
//! }
//! ```
//!
//! and in the crate `include!(concat!(env!("OUT_DIR"), "/free_body.rs"));`.

mod error;

use crate::diagnostics::Diagnostic;
use crate::emit::{self, c::Precision};
use crate::generate::{Generated, from_file, from_text, text_of};
use crate::render::warnings;
pub use error::{BuildError, BuildProblem};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};

/// Generates files in a build script.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    files: Vec<(PathBuf, Kind)>,
    out_dir: Option<PathBuf>,
    c: Option<(PathBuf, Precision)>,
}

/// Kind of an input file.
#[derive(Clone, Debug)]
enum Kind {
    /// A description.
    Description,
    /// A robot in URDF, and the options of its import.
    #[cfg(feature = "urdf")]
    Urdf(crate::urdf::Options),
}

/// Stack size in bytes: enough for the deepest nesting that is allowed, even in a build without optimization. On
/// Windows, the main thread has only 1 MB.
const STACK: usize = 8 << 20;

impl Builder {
    /// Creates a builder without files.
    pub fn new() -> Self {
        Builder::default()
    }

    /// Adds a description, by its path relative to the package's folder. With the feature `urdf`, files
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

    /// Adds a robot in URDF, with the options of its import. `options.file` is set to the name of the file, which
    /// appears in the generated text.
    #[cfg(feature = "urdf")]
    pub fn urdf(mut self, path: impl Into<PathBuf>, options: crate::urdf::Options) -> Self {
        let path = path.into();
        let file = name(&path);
        let options = crate::urdf::Options { file, ..options };
        self.files.push((path, Kind::Urdf(options)));
        self
    }

    /// Sets the folder to write to; `OUT_DIR` by default.
    pub fn out_dir(mut self, path: impl Into<PathBuf>) -> Self {
        self.out_dir = Some(path.into());
        self
    }

    /// Also writes C99: `stem.h` and `stem.c` for every file, into this folder, which has to exist. The names of
    /// functions begin with the name of their system, so that all systems of a program need different names.
    pub fn c_files(mut self, folder: impl Into<PathBuf>, precision: Precision) -> Self {
        self.c = Some((folder.into(), precision));
        self
    }

    /// Generates `stem.rs` for every `stem.eom` or `stem.urdf`. All files are read before any error is reported and
    /// before anything is written. Files whose bytes would not change are not touched, and no file that was read is
    /// overwritten. Declarations that a description does not use become warnings of the package.
    pub fn generate(self) -> Result<(), BuildError> {
        std::thread::scope(|scope| {
            let deep = std::thread::Builder::new().stack_size(STACK);
            match deep.spawn_scoped(scope, || self.generate_here()) {
                Ok(thread) => thread.join().unwrap_or_else(|panic| resume_unwind(panic)),
                Err(_) => self.generate_here(),
            }
        })
    }

    fn generate_here(&self) -> Result<(), BuildError> {
        let own = self.out_dir.clone();
        let Some(out_dir) = own.or_else(|| std::env::var_os("OUT_DIR").map(PathBuf::from)) else {
            return Err(BuildError {
                problems: vec![BuildProblem::NoOutDir],
            });
        };
        let mut problems = Vec::new();
        let mut stems: BTreeMap<String, PathBuf> = BTreeMap::new();
        let mut made = Made::default();
        for (path, kind) in &self.files {
            let stem = self.stem(path, &mut stems);
            let done = stem.and_then(|stem| self.make(path, kind, &stem, &mut made));
            problems.extend(done.err());
        }
        let mut missing = BTreeSet::new();
        for (file, text) in &made.files {
            let file = out_dir.join(file);
            let folder = file.parent().filter(|folder| *folder != Path::new(""));
            match folder.filter(|folder| !folder.is_dir()) {
                None => problems.extend(made.write(&file, text).err()),
                Some(folder) if missing.insert(folder.to_owned()) => {
                    problems.push(BuildProblem::NoFolder(folder.to_owned()));
                }
                Some(_) => {}
            }
        }
        match problems.is_empty() {
            true => Ok(()),
            false => Err(BuildError { problems }),
        }
    }

    /// Returns the common stem of the output files of a path, and refuses a stem that another path has already.
    fn stem(
        &self,
        path: &Path,
        stems: &mut BTreeMap<String, PathBuf>,
    ) -> Result<String, BuildProblem> {
        let path = path.to_owned();
        let Some(stem) = path.file_stem() else {
            return Err(BuildProblem::NoFileName(path));
        };
        let stem = stem.to_string_lossy().into_owned();
        if self.c.is_some() && !emit::c::is_includable(&stem) {
            return Err(BuildProblem::NotIncludable { path, stem });
        }
        if let Some(other) = stems.get(&stem) {
            let other = other.clone();
            return Err(
                match place(&path).is_some_and(|file| place(&other) == Some(file)) {
                    true => BuildProblem::Repeated { path, stem },
                    false => BuildProblem::SameOutput { other, path, stem },
                },
            );
        }
        stems.insert(stem.clone(), path);
        Ok(stem)
    }
}

/// Files that were read, and texts that were generated.
#[derive(Default)]
struct Made {
    /// All files that were read.
    read: Vec<PathBuf>,
    /// Texts to write, by path: relative to the folder of the Rust files, or absolute.
    files: Vec<(PathBuf, String)>,
    /// Names of the functions in C, each with the file from which it comes.
    named: BTreeMap<String, String>,
}

impl Made {
    /// Reads a file, and has Cargo run the build script again when it changes.
    fn open(&mut self, path: &Path) -> io::Result<String> {
        watch(path)?;
        let text = text_of(path)?;
        self.read.extend(place(path));
        Ok(text)
    }

    /// Reads a file of some kind like `open`; a robot may have any encoding that is usual for robots.
    fn open_as(&mut self, path: &Path, kind: &Kind) -> io::Result<String> {
        match kind {
            Kind::Description => self.open(path),
            #[cfg(feature = "urdf")]
            Kind::Urdf(_) => {
                watch(path)?;
                let text = crate::urdf::decode(std::fs::read(path)?);
                self.read.extend(place(path));
                text.map_err(io::Error::other)
            }
        }
    }

    fn write(&self, file: &Path, text: &str) -> Result<(), BuildProblem> {
        if place(file).is_some_and(|file| self.read.contains(&file)) {
            return Err(BuildProblem::Overwrites(file.to_owned()));
        }
        hamel_files::update(file, text).map_err(BuildProblem::Unwritten)
    }
}

/// Returns the canonical path of a file, whatever path leads there; `None` if there is no such file.
fn place(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}

fn name(path: &Path) -> String {
    path.file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default()
}

/// Has Cargo run the build script again when a file changes. Files below `OUT_DIR` are excluded: the script itself
/// writes them after its start, so that Cargo would run it in every build.
fn watch(path: &Path) -> io::Result<()> {
    let folder = std::env::var_os("OUT_DIR").map(PathBuf::from);
    let written = folder.is_some_and(|folder| match (place(&folder), place(path)) {
        (Some(folder), Some(path)) => path.starts_with(folder),
        _ => path.starts_with(folder),
    });
    if written {
        return Ok(());
    }
    // Cargo reads line by line, and trims white space at the end.
    let said = |path: &&str| !path.contains(['\n', '\r']) && path.trim_end() == *path;
    let Some(path) = path.to_str().filter(said) else {
        return Err(io::Error::other(
            "Cargo cannot watch a path that has a line break, ends in a blank or is not UTF-8; rename it",
        ));
    };
    writeln!(io::stdout(), "cargo:rerun-if-changed={path}")
        .map_err(|error| io::Error::other(format!("Cargo cannot watch it: {error}")))
}

impl Builder {
    /// Reads a file, and generates the texts that are to be written.
    fn make(
        &self,
        path: &Path,
        kind: &Kind,
        stem: &str,
        made: &mut Made,
    ) -> Result<(), BuildProblem> {
        let shown = path.display().to_string();
        let text = made.open_as(path, kind).map_err(|source| {
            let is_astray = path.is_relative() && source.kind() == io::ErrorKind::NotFound;
            BuildProblem::Unreadable {
                path: path.to_owned(),
                start: std::env::current_dir().ok().filter(|_| is_astray),
                source,
            }
        })?;
        match kind {
            Kind::Description => {
                if text
                    .trim_start_matches(['\u{feff}', ' ', '\t', '\r', '\n'])
                    .starts_with('<')
                {
                    return Err(BuildProblem::Xml(path.to_owned()));
                }
                let refused = |diagnostics: Vec<Diagnostic>| BuildProblem::Description {
                    path: path.to_owned(),
                    text: text.clone(),
                    diagnostics,
                };
                let folder = path.parent().unwrap_or(Path::new(""));
                let open = &mut |name: &str| made.open(&folder.join(name));
                let generated = from_file(&text, open).map_err(refused)?;
                warn(&warnings(&generated.model.warnings, &shown, &text, false));
                let texts = self.texts(&generated, &name(path), stem, &shown, &mut made.named);
                made.files.extend(texts.map_err(refused)?);
            }
            #[cfg(feature = "urdf")]
            Kind::Urdf(options) => {
                use crate::generate::available_in;
                use crate::urdf::{import, warnings};
                let imported = import(&text, options).map_err(|problems| BuildProblem::Import {
                    path: path.to_owned(),
                    text: text.clone(),
                    problems,
                })?;
                warn(&warnings(&imported, &shown, &text, false));
                let description = name(&path.with_extension("eom"));
                let refused = |diagnostics: Vec<Diagnostic>| BuildProblem::Robot {
                    path: path.to_owned(),
                    text: text.clone(),
                    diagnostics,
                };
                let (generated, left_out) = available_in(&imported.system).map_err(refused)?;
                // The import has warned already if there are no masses.
                if let Some(left_out) = left_out.filter(|_| imported.has_masses) {
                    warn(&format!("{shown}: {}", left_out.said()));
                }
                let texts = self.texts(&generated, &description, stem, &shown, &mut made.named);
                made.files.extend(texts.map_err(refused)?);
            }
        }
        Ok(())
    }

    /// Returns the output files of a derived system, by path: relative to the folder of the Rust files, or absolute.
    fn texts(
        &self,
        generated: &Generated,
        name: &str,
        stem: &str,
        shown: &str,
        named: &mut BTreeMap<String, String>,
    ) -> Result<Vec<(PathBuf, String)>, Vec<Diagnostic>> {
        let mut files = vec![(format!("{stem}.rs").into(), written(generated, name)?)];
        if let Some((folder, precision)) = &self.c {
            // An absolute path, since a relative one would be taken below the folder of the Rust files.
            let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
            let c = written_in_c(generated, name, Some(stem), *precision)?;
            apart(generated, shown, named).map_err(|error| vec![error])?;
            files.push((folder.join(format!("{stem}.h")), c.header));
            files.push((folder.join(format!("{stem}.c")), c.source));
        }
        Ok(files)
    }
}

/// Refuses C functions with the same names as those of another file: a linker could confuse them.
fn apart(
    generated: &Generated,
    shown: &str,
    named: &mut BTreeMap<String, String>,
) -> Result<(), Diagnostic> {
    let names = emit::c::linker_symbols(&generated.program);
    if let Some((name, other)) = names.iter().find_map(|name| named.get_key_value(name)) {
        let message = format!("`{name}` in C would also be a function of {other}");
        return Err(Diagnostic::new(generated.model.span, message)
            .help("give one of the two systems another name"));
    }
    named.extend(names.into_iter().map(|name| (name, shown.to_owned())));
    Ok(())
}

/// Prints lines that Cargo shows as warnings of the package. The form with one colon works for any `rust-version`.
fn warn(text: &str) {
    for line in text.lines() {
        // If nobody reads the output, a warning that cannot be printed is no loss.
        let _ = writeln!(io::stdout(), "cargo:warning={line}");
    }
}

/// Generates the Rust file of a description; `name` appears in the command that its header shows.
pub fn source(text: &str, name: &str) -> Result<String, Vec<Diagnostic>> {
    written(&from_text(text)?, name)
}

/// Generates the Rust file of a system that is derived already.
pub fn written(generated: &Generated, name: &str) -> Result<String, Vec<Diagnostic>> {
    let options = emit::Options {
        source_hash: generated.hash,
        command: format!("hamel emit {}", quoted(name)),
        description: generated.text.clone(),
        ..Default::default()
    };
    emit::rust_file(&generated.program, &options).map_err(|error| vec![generated.fault(&error)])
}

/// Generates C99 for a system that is derived already. `name` appears in the command that the header shows; `stem` is
/// the name of the files before `.h` and `.c`, if they have one. External functions in Rust are refused.
pub fn written_in_c(
    generated: &Generated,
    name: &str,
    stem: Option<&str>,
    precision: Precision,
) -> Result<emit::c::CFiles, Vec<Diagnostic>> {
    without_externals(generated, "C")?;
    let numbers = match precision {
        Precision::Double => "",
        Precision::Float => " --precision float",
    };
    let out = stem.map_or_else(String::new, |stem| format!(" -o {}", quoted(stem)));
    let name = quoted(name);
    let options = emit::c::Options {
        source_hash: generated.hash,
        command: format!("hamel emit --language c{numbers} {name}{out}"),
        description: generated.text.clone(),
        header: format!("{}.h", stem.unwrap_or_default()),
        precision,
    };
    Ok(emit::c::files(&generated.program, &options))
}

/// Generates a Python module for a system that is derived already. `name` appears in the command that the header shows,
/// with the name of the file `out`, if it has one. External functions in Rust are refused.
pub fn written_in_python(
    generated: &Generated,
    name: &str,
    out: Option<&str>,
) -> Result<String, Vec<Diagnostic>> {
    without_externals(generated, "Python")?;
    let out = out.map_or_else(String::new, |out| format!(" -o {}", quoted(out)));
    let options = emit::python::Options {
        source_hash: generated.hash,
        command: format!("hamel emit --language python {}{out}", quoted(name)),
        description: generated.text.clone(),
    };
    Ok(emit::python::python_module(&generated.program, &options))
}

/// Refuses external functions in Rust, which other languages cannot call.
fn without_externals(generated: &Generated, language: &str) -> Result<(), Vec<Diagnostic>> {
    let refused = generated.model.externals.iter().map(|&place| {
        let message = format!("{language} cannot call a function that is given in Rust");
        Diagnostic::new(place, message).help("write it as an expression, a `fn` or a table")
    });
    let refused: Vec<Diagnostic> = refused.collect();
    match refused.is_empty() {
        true => Ok(()),
        false => Err(refused),
    }
}

/// Quotes a word of a command for a shell, if necessary.
fn quoted(name: &str) -> String {
    let plain = |letter: char| letter.is_alphanumeric() || "-_./+,:@%".contains(letter);
    match name.is_empty() || name.contains(|letter| !plain(letter)) {
        true => format!("'{}'", name.replace('\'', r"'\''")),
        false => name.to_owned(),
    }
}
