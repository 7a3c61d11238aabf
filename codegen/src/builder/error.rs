//! Errors of a build.

use crate::diagnostics::Diagnostic;
use crate::render::render;
use hamel_files::Unwritten;
use std::error::Error;
use std::fmt;
use std::io;
use std::path::PathBuf;

/// Errors of a build, in which nothing or not everything was generated. Shows every error with its place in the source.
pub struct BuildError {
    /// The errors, in the order of the files.
    pub problems: Vec<BuildProblem>,
}

/// Error of a build.
#[derive(Debug)]
pub enum BuildProblem {
    /// There is no folder to write to.
    NoOutDir,
    /// The path of an input does not end in the name of a file.
    NoFileName(PathBuf),
    /// The name of the header is not possible in C.
    NotIncludable {
        /// Path of the input.
        path: PathBuf,
        /// Name of the output files, without extension.
        stem: String,
    },
    /// An input was given twice.
    Repeated {
        /// Path of the input.
        path: PathBuf,
        /// Name of the output files, without extension.
        stem: String,
    },
    /// Two inputs have the same output file.
    SameOutput {
        /// Path of the earlier input.
        other: PathBuf,
        /// Path of the input.
        path: PathBuf,
        /// Name of the output files, without extension.
        stem: String,
    },
    /// An input cannot be read.
    Unreadable {
        /// Path of the input.
        path: PathBuf,
        /// Reason.
        source: io::Error,
        /// Folder at which a relative path starts, if there is no such file.
        start: Option<PathBuf>,
    },
    /// An input is XML, not a description.
    Xml(PathBuf),
    /// A description has errors.
    Description {
        /// Path of the description.
        path: PathBuf,
        /// Its text.
        text: String,
        /// The errors, with their places in the text.
        diagnostics: Vec<Diagnostic>,
    },
    /// A file of a robot has errors.
    #[cfg(feature = "urdf")]
    Import {
        /// Path of the robot.
        path: PathBuf,
        /// Its text.
        text: String,
        /// The errors, with their places in the text.
        problems: Vec<crate::urdf::Problem>,
    },
    /// The description made from a robot has errors.
    #[cfg(feature = "urdf")]
    Robot {
        /// Path of the robot.
        path: PathBuf,
        /// Its text.
        text: String,
        /// The errors, with their places in the text of the robot.
        diagnostics: Vec<Diagnostic>,
    },
    /// The folder of an output file does not exist.
    NoFolder(PathBuf),
    /// An output file is also an input.
    Overwrites(PathBuf),
    /// An output file cannot be written.
    Unwritten(Unwritten),
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let problems: Vec<String> = self.problems.iter().map(ToString::to_string).collect();
        f.write_str(&problems.join("\n"))
    }
}

// A build script that returns the error prints its `Debug` form, which must be readable, too.
impl fmt::Debug for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\n{self}")
    }
}

impl Error for BuildError {}

/// Hint for XML in place of a description.
#[cfg(feature = "urdf")]
const ROBOTS: &str = "a robot in URDF has a name that ends in `.urdf`, or is added by `urdf`";
#[cfg(not(feature = "urdf"))]
const ROBOTS: &str = "robots in URDF need the feature `urdf` of hamel-codegen";

impl fmt::Display for BuildProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BuildProblem::NoOutDir => f.write_str(
                "OUT_DIR is not set: call this in a build script, or name a folder with `out_dir`",
            ),
            BuildProblem::NoFileName(path) => write!(
                f,
                "`{}` is not the path of a file: give the path of a description, such as `models/arm.eom`",
                path.display()
            ),
            BuildProblem::NotIncludable { path, stem } => write!(
                f,
                "{}: C cannot include `{stem}.h`, or has a header of this name; rename it, without quotes, `?`, `\\` and line breaks",
                path.display()
            ),
            BuildProblem::Repeated { path, stem } => write!(
                f,
                "{} is given twice, but has only one {stem}.rs; remove it, or write it to another folder with another `Builder`",
                path.display()
            ),
            BuildProblem::SameOutput { other, path, stem } => write!(
                f,
                "{} and {} would both be written to {stem}.rs; rename one of them",
                other.display(),
                path.display()
            ),
            BuildProblem::Unreadable {
                path,
                source,
                start,
            } => {
                write!(f, "cannot read {}: {source}", path.display())?;
                match start {
                    Some(folder) => write!(f, "; its path starts at {}", folder.display()),
                    None => Ok(()),
                }
            }
            BuildProblem::Xml(path) => {
                write!(f, "{} is not a description: {ROBOTS}", path.display())
            }
            BuildProblem::Description {
                path,
                text,
                diagnostics,
            } => f.write_str(&render(diagnostics, &path.to_string_lossy(), text, false)),
            #[cfg(feature = "urdf")]
            BuildProblem::Import {
                path,
                text,
                problems,
            } => {
                let path = path.to_string_lossy();
                f.write_str(&crate::urdf::errors(problems, &path, text, false))
            }
            #[cfg(feature = "urdf")]
            BuildProblem::Robot {
                path,
                text,
                diagnostics,
            } => {
                let path = path.to_string_lossy();
                f.write_str(&crate::urdf::refused(diagnostics, &path, text, false))
            }
            BuildProblem::NoFolder(folder) => write!(
                f,
                "the folder {} does not exist; create it first",
                folder.display()
            ),
            BuildProblem::Overwrites(file) => write!(
                f,
                "cannot write {}: this file is an input; write to another folder, or rename it",
                file.display()
            ),
            BuildProblem::Unwritten(error) => error.fmt(f),
        }
    }
}

impl Error for BuildProblem {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            BuildProblem::Unreadable { source, .. } => Some(source),
            BuildProblem::Unwritten(error) => error.source(),
            _ => None,
        }
    }
}
