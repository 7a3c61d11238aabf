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
use crate::generate::{Generated, from_file, from_text, text_of};
use crate::render::{render, warnings};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
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

/// Bytes of stack: enough for what nests as deep as is allowed in a build that optimises nothing. Windows gives the main thread
/// 1 MB.
const STACK: usize = 8 << 20;

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

    /// Writes C99 as well: `stem.h` and `stem.c` for every file, into this folder, which exists. The names of functions
    /// begin with that of their system, so that no two systems of a program may have one name.
    pub fn c_files(mut self, folder: impl Into<PathBuf>, precision: Precision) -> Self {
        self.c = Some((folder.into(), precision));
        self
    }

    /// Generates `stem.rs` for every `stem.eom` or `stem.urdf`. All files are read before anything is reported, and
    /// before anything is written; files whose bytes would not change are not touched, and none that was read is
    /// written over. What a description declares and does not use becomes a warning of the package.
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
        let mut made = Made::default();
        for (path, kind) in &self.files {
            let stem = self.stem(path, &mut stems);
            let done = stem.and_then(|stem| self.make(path, kind, &stem, &mut made));
            errors.extend(done.err());
        }
        let mut missing = BTreeSet::new();
        for (file, text) in &made.files {
            let file = out_dir.join(file);
            let folder = file.parent().filter(|folder| *folder != Path::new(""));
            match folder.filter(|folder| !folder.is_dir()) {
                None => errors.extend(made.write(&file, text).err()),
                Some(folder) if missing.insert(folder.to_owned()) => errors.push(format!(
                    "there is no folder {} to write to; make it first",
                    folder.display()
                )),
                Some(_) => {}
            }
        }
        if errors.is_empty() {
            Ok(())
        } else {
            Err(BuildError(errors.join("\n")))
        }
    }

    /// What the files that are made from a path are called before their endings: no two are called the same.
    fn stem(&self, path: &Path, stems: &mut BTreeMap<String, PathBuf>) -> Result<String, String> {
        let shown = path.display();
        let Some(stem) = path.file_stem() else {
            return Err(format!(
                "`{shown}` names no file: give the path of a description, such as `models/arm.eom`"
            ));
        };
        let stem = stem.to_string_lossy().into_owned();
        if self.c.is_some() && !emit::c::includable(&stem) {
            return Err(format!(
                "{shown}: C cannot include `{stem}.h`, or has such a header; rename it, without quotes, `?`, `\\` and line breaks"
            ));
        }
        if let Some(other) = stems.get(&stem) {
            return Err(
                match place(path).is_some_and(|file| place(other) == Some(file)) {
                    true => format!(
                        "{shown} is given twice, and has one {stem}.rs; leave it out, or write it to another folder by a `Builder` of its own"
                    ),
                    false => format!(
                        "{} and {shown} would both be written to {stem}.rs; rename one of them",
                        other.display()
                    ),
                },
            );
        }
        stems.insert(stem.clone(), path.to_owned());
        Ok(stem)
    }
}

/// What was read and derived.
#[derive(Default)]
struct Made {
    /// All files that were read.
    read: Vec<PathBuf>,
    /// Names below the folder of the Rust, or whole paths, and texts.
    files: Vec<(PathBuf, String)>,
    /// The functions in C, each with the file that it comes from.
    named: BTreeMap<String, String>,
}

impl Made {
    /// Reads a file; Cargo runs the build script again when it changes.
    fn open(&mut self, path: &Path) -> io::Result<String> {
        watch(path)?;
        let text = text_of(path)?;
        self.read.extend(place(path));
        Ok(text)
    }

    /// The same of a file that may be a robot, in any encoding that robots have.
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

    fn write(&self, file: &Path, text: &str) -> Result<(), String> {
        if place(file).is_some_and(|file| self.read.contains(&file)) {
            return Err(format!(
                "cannot write {}: this file is read; write to another folder, or rename it",
                file.display()
            ));
        }
        hamel_files::update(file, text).map_err(|error| error.to_string())
    }
}

/// What a path stands for, whatever way leads there; nothing where there is no such file.
fn place(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}

fn name(path: &Path) -> String {
    path.file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default()
}

/// Has Cargo run the build script again when a file changes. What the script itself writes below `OUT_DIR` is newer than
/// the script's start, and would have it run in every build.
fn watch(path: &Path) -> io::Result<()> {
    let folder = std::env::var_os("OUT_DIR").map(PathBuf::from);
    let written = folder.is_some_and(|folder| match (place(&folder), place(path)) {
        (Some(folder), Some(path)) => path.starts_with(folder),
        _ => path.starts_with(folder),
    });
    if written {
        return Ok(());
    }
    // Cargo reads lines, and takes blanks from their ends.
    let said = |path: &&str| !path.contains(['\n', '\r']) && path.trim_end() == *path;
    let Some(path) = path.to_str().filter(said) else {
        return Err(io::Error::other(
            "Cargo cannot be told of a path that has a line break, ends in a blank or is not UTF-8; rename it",
        ));
    };
    writeln!(io::stdout(), "cargo:rerun-if-changed={path}")
        .map_err(|error| io::Error::other(format!("Cargo cannot be told to watch it: {error}")))
}

impl Builder {
    /// Reads a file, and makes the texts that are to be written.
    fn make(&self, path: &Path, kind: &Kind, stem: &str, made: &mut Made) -> Result<(), String> {
        let shown = path.display().to_string();
        let text = made.open_as(path, kind).map_err(|error| {
            let here = match std::env::current_dir() {
                Ok(folder) if path.is_relative() && error.kind() == io::ErrorKind::NotFound => {
                    format!("; its path starts at {}", folder.display())
                }
                _ => String::new(),
            };
            format!("cannot read {shown}: {error}{here}")
        })?;
        match kind {
            Kind::Description => {
                if text
                    .trim_start_matches(['\u{feff}', ' ', '\t', '\r', '\n'])
                    .starts_with('<')
                {
                    return Err(format!("{shown} is no description: {ROBOTS}"));
                }
                let refused = |errors: Vec<Diagnostic>| render(&errors, &shown, &text, false);
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
                use crate::urdf::{import, refused, warnings};
                let imported = import(&text, options, &shown, false)?;
                warn(&warnings(&imported, &shown, &text, false));
                let description = name(&path.with_extension("eom"));
                let refused =
                    |errors: Vec<Diagnostic>| refused(&errors, &imported, &shown, &text, false);
                let (generated, left_out) = available_in(&imported.text).map_err(refused)?;
                // That there are no masses was said above.
                if let Some(left_out) = left_out.filter(|_| imported.has_masses) {
                    warn(&format!("{shown}: {}", left_out.said()));
                }
                let texts = self.texts(&generated, &description, stem, &shown, &mut made.named);
                made.files.extend(texts.map_err(refused)?);
            }
        }
        Ok(())
    }

    /// The files of what was derived: names below the folder of the Rust, or whole paths, and texts.
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
            // The Rust stands elsewhere.
            let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
            let c = written_in_c(generated, name, Some(stem), *precision)?;
            apart(generated, shown, named).map_err(|error| vec![error])?;
            files.push((folder.join(format!("{stem}.h")), c.header));
            files.push((folder.join(format!("{stem}.c")), c.source));
        }
        Ok(files)
    }
}

/// Refuses functions in C that are called as those of another file: a linker may take one of them for the other.
fn apart(
    generated: &Generated,
    shown: &str,
    named: &mut BTreeMap<String, String>,
) -> Result<(), Diagnostic> {
    let names = emit::c::functions(&generated.program);
    if let Some((name, other)) = names.iter().find_map(|name| named.get_key_value(name)) {
        let message = format!("`{name}` in C would be a function of {other}, too");
        return Err(Diagnostic::new(generated.model.span, message)
            .help("give one of the two systems another name"));
    }
    named.extend(names.into_iter().map(|name| (name, shown.to_owned())));
    Ok(())
}

/// What is said of XML in the place of a description.
#[cfg(feature = "urdf")]
const ROBOTS: &str = "a robot in URDF has a name that ends in `.urdf`, or is added by `urdf`";
#[cfg(not(feature = "urdf"))]
const ROBOTS: &str = "robots in URDF need the feature `urdf` of hamel-codegen";

/// Cargo shows these lines as warnings of the package. With one colon, it does for packages of any `rust-version`.
fn warn(text: &str) {
    for line in text.lines() {
        // Where nobody listens, nobody misses a warning.
        let _ = writeln!(io::stdout(), "cargo:warning={line}");
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
        command: format!("hamel emit {}", quoted(name)),
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
    let out = stem.map_or_else(String::new, |stem| format!(" -o {}", quoted(stem)));
    let name = quoted(name);
    let options = emit::c::Options {
        source_hash: generated.hash,
        command: format!("hamel emit --language c{numbers} {name}{out}"),
        header: format!("{}.h", stem.unwrap_or_default()),
        precision,
    };
    Ok(emit::c::files(&generated.program, &options))
}

/// A word of a command, as a shell reads it.
fn quoted(name: &str) -> String {
    let plain = |letter: char| letter.is_alphanumeric() || "-_./+,:@%".contains(letter);
    match name.is_empty() || name.contains(|letter| !plain(letter)) {
        true => format!("'{}'", name.replace('\'', r"'\''")),
        false => name.to_owned(),
    }
}
