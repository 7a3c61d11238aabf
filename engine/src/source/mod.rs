//! Reads and derives descriptions and robots, with errors and warnings at their places in the text.

pub mod added_outputs;
mod constants;
mod options;
mod robot;

pub use constants::ConstantProblem;
pub use options::OpenOptions;
pub use robot::{Robot, UnknownLink};

use crate::error::Error;
use crate::reporter::{Reporter, Warning};
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::functions::{Asked, FunctionId, Jacobian};
use hamel_codegen::generate::{
    Generated, LeftOut, at_some_point, available_in, from_file, text_of,
};
use hamel_codegen::lower;
use hamel_codegen::model::Model;
use hamel_codegen::syntax::path::plain;
use hamel_codegen::syntax::{self, ast::System};
use hamel_codegen::urdf;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Name of standard input in messages.
const STDIN: &str = "<stdin>";
/// Text of the spinner during a derivation.
const DERIVING: &str = "deriving";

/// Text of a description, or of a robot in URDF, with its origin.
pub struct Source {
    /// The path as given, or `<stdin>`.
    pub path: String,
    /// The text of the description.
    pub text: String,
    /// The robot from which the description was made, if any.
    pub robot: Option<Robot>,
    /// Number of warnings shown: those of reading come first, then those of deriving.
    warned: AtomicUsize,
    /// Whether functions in Rust must have values, from their stand-ins.
    evaluated: bool,
    /// Whether all frames count as results.
    shows_frames: bool,
    /// Receiver of warnings and progress.
    reporter: Arc<dyn Reporter>,
}

impl Source {
    /// Takes a text, with its name for messages.
    pub fn new(path: String, text: String, reporter: Arc<dyn Reporter>) -> Self {
        Source {
            reporter,
            path,
            text,
            robot: None,
            warned: AtomicUsize::new(0),
            evaluated: false,
            shows_frames: false,
        }
    }

    /// Reads a file, or standard input if the path is `-`.
    pub fn read(path: &Path, reporter: Arc<dyn Reporter>) -> Result<Self, Error> {
        let stdin = path.as_os_str() == "-";
        let name = if stdin {
            STDIN.to_string()
        } else {
            path.display().to_string()
        };
        let bytes = if stdin {
            let mut bytes = Vec::new();
            std::io::stdin()
                .lock()
                .read_to_end(&mut bytes)
                .map(|_| bytes)
        } else {
            std::fs::read(path)
        };
        let bytes = bytes.map_err(|source| Error::Read {
            path: name.clone(),
            source,
        })?;
        decoded(&name, bytes).map(|text| Source::new(name, text, reporter))
    }

    /// Reads another file; `what` describes it in the error if both are standard input.
    pub fn read_related(&self, path: &Path, what: &'static str) -> Result<Source, Error> {
        if path.as_os_str() == "-" && self.is_stdin() {
            return Err(Error::StandardInputTwice(what));
        }
        Source::read(path, Arc::clone(&self.reporter))
    }

    /// Returns the receiver of warnings and progress.
    pub fn reporter(&self) -> &dyn Reporter {
        &*self.reporter
    }

    /// Returns whether the text was read from standard input.
    pub fn is_stdin(&self) -> bool {
        self.path == STDIN
    }

    /// Returns the text whose line numbers messages give: empty for a robot, whose description was not written by the
    /// user.
    pub fn shown(&self) -> &str {
        match &self.robot {
            Some(_) => "",
            None => &self.text,
        }
    }

    /// Returns whether the text is a robot in URDF, judging by the file name or the beginning of the text.
    pub fn is_urdf(&self) -> bool {
        urdf::is_urdf(Path::new(&self.path))
            || self
                .text
                .trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}')
                .starts_with('<')
    }

    /// Returns the joints of a robot by their names in its file and in the description; empty for a description.
    pub fn joints(&self) -> &[(String, String)] {
        match &self.robot {
            Some(robot) => &robot.imported.joints,
            None => &[],
        }
    }

    /// Reads a description, or a robot in URDF.
    pub fn open(
        path: &Path,
        options: &OpenOptions,
        reporter: Arc<dyn Reporter>,
    ) -> Result<Self, Error> {
        Source::read(path, reporter)?.interpret(options)
    }

    /// Interprets the text as a description or as a robot in URDF.
    pub fn interpret(self, options: &OpenOptions) -> Result<Self, Error> {
        let mut source = self;
        if source.is_urdf() {
            if !options.constants.is_empty() {
                return Err(Error::ConstantOfRobot { path: source.path });
            }
            return source.robot(options);
        }
        for (name, value) in &options.constants {
            source.text =
                constants::given(&source.text, name, value).map_err(|problem| Error::Constant {
                    name: name.clone(),
                    value: value.clone(),
                    problem,
                })?;
        }
        if options.are_for_robots() {
            return Err(Error::RobotOptions { path: source.path });
        }
        Ok(source)
    }

    /// Prepares the source for evaluation: functions in Rust get their stand-ins.
    pub fn for_evaluation(self) -> Self {
        Source {
            evaluated: true,
            ..self
        }
    }

    /// Treats frames as results, so that there are no warnings of unused frames.
    pub fn showing_frames(self) -> Self {
        Source {
            shows_frames: true,
            ..self
        }
    }

    /// Returns the requested frames, each with its name in the description; for a robot they are its links, by their
    /// names in its file or in the description, and a link that is fixed in the world becomes a frame if it is
    /// requested.
    pub fn frames(&mut self, asked: &[String]) -> Result<Vec<(String, String)>, Error> {
        let Some(robot) = &mut self.robot else {
            let both = asked.iter().map(|name| (name.clone(), plain(name)));
            return Ok(both.collect());
        };
        let mut frames: Vec<(String, String)> = Vec::new();
        let mut unknown = Vec::new();
        for name in asked {
            match robot.frame(name) {
                Ok(frame) if frames.iter().all(|(known, _)| known != name) => {
                    frames.push((name.clone(), frame));
                }
                Ok(_) => {}
                Err(why) => unknown.push(why),
            }
        }
        self.text = robot.imported.text();
        match unknown.is_empty() {
            true => Ok(frames),
            false => Err(Error::Links {
                path: self.path.clone(),
                unknown,
            }),
        }
    }

    /// Converts the text from URDF into a description.
    pub fn robot(self, options: &OpenOptions) -> Result<Self, Error> {
        let robot = Robot::from_urdf(self.text, &self.path, options, &*self.reporter)?;
        Ok(Source {
            text: robot.imported.text(),
            robot: Some(robot),
            ..self
        })
    }

    /// Returns the text of a file that the description refers to, relative to the description.
    fn file(&self, name: &str) -> std::io::Result<String> {
        let folder = Path::new(&self.path).parent();
        text_of(&folder.unwrap_or(Path::new("")).join(name))
    }

    /// Returns the other files from which the description takes statements or numbers.
    pub fn files(&self) -> Result<Vec<PathBuf>, Error> {
        let mut files = Vec::new();
        if self.robot.is_some() {
            return Ok(files);
        }
        let folder = Path::new(&self.path).parent().unwrap_or(Path::new(""));
        let read = syntax::parse_text(&self.text).and_then(|mut system| {
            syntax::read_files(&mut system, &mut |name| {
                files.push(folder.join(name));
                self.file(name)
            })
        });
        read.map_err(|errors| self.description_error(&errors))?;
        Ok(files)
    }

    /// Returns the parsed description including its other files, and the texts of these.
    fn parsed(&self) -> Result<(System, Vec<String>), Vec<Diagnostic>> {
        let (mut system, texts) = match &self.robot {
            Some(robot) => (robot.imported.system.clone(), Vec::new()),
            None => {
                let mut system = syntax::parse_text(&self.text)?;
                let texts = syntax::read_files(&mut system, &mut |name| self.file(name))?;
                (system, texts)
            }
        };
        if self.evaluated {
            system.evaluate();
        }
        system.shows_frames = self.shows_frames;
        Ok((system, texts))
    }

    fn system(&self) -> Result<System, Error> {
        let parsed = self
            .parsed()
            .map_err(|errors| self.description_error(&errors))?;
        Ok(parsed.0)
    }

    /// Returns the texts of the other files from which the description takes statements or numbers.
    pub fn texts(&self) -> Result<Vec<String>, Error> {
        let parsed = self
            .parsed()
            .map_err(|errors| self.description_error(&errors))?;
        Ok(parsed.1)
    }

    /// Replaces the text by an extended one.
    pub fn with_text(&self, text: String) -> Self {
        Source {
            path: self.path.clone(),
            text,
            robot: None,
            warned: AtomicUsize::new(usize::MAX),
            evaluated: self.evaluated,
            shows_frames: self.shows_frames,
            reporter: Arc::clone(&self.reporter),
        }
    }

    /// Returns the model of the description, before derivation.
    pub fn model(&self) -> Result<Model, Error> {
        let model = lower::build(&self.system()?);
        let model = model.map_err(|errors| self.description_error(&errors))?;
        self.warn(&model);
        Ok(model)
    }

    /// Derives the positions and poses for a picture, regardless of the description's `generate`. No claim about the
    /// motion is proved.
    pub fn derive_places(&self) -> Result<Generated, Error> {
        self.derived(|mut model| {
            model.asked = Asked::only(&[]);
            model.invariants.clear();
            Generated::of(model, 0)
        })
    }

    /// Derives these functions, regardless of the description's `generate`; those that contain M⁻¹ are left out, with a
    /// warning, if M is not positive definite, and all that need inertia if there is none.
    pub fn derive_only(
        &self,
        functions: &[FunctionId],
        frames: &[Jacobian],
    ) -> Result<Generated, Error> {
        self.available(Asked {
            jacobians: frames.to_vec(),
            ..Asked::only(functions)
        })
    }

    /// Derives the requested functions, regardless of the description's `generate`.
    pub fn derive_asked(&self, asked: &Asked) -> Result<Generated, Error> {
        let generated = self.derived(|mut model| {
            model.asked = asked.clone();
            Generated::of(model, 0)
        })?;
        self.warn(&generated.model);
        Ok(generated)
    }

    /// Returns an error, with help, if no part of the system has inertia.
    pub fn check_inertia(&self, generated: &Generated) -> Result<(), Error> {
        match generated.model.has_inertia {
            true => Ok(()),
            false => {
                let motion = Asked::only(&[FunctionId::Accel]);
                self.derive_asked(&motion).map(drop)
            }
        }
    }

    /// Reports the beginning and the end of a derivation.
    fn during<T>(&self, derive: impl FnOnce() -> T) -> T {
        self.reporter.begin(DERIVING);
        let done = derive();
        self.reporter.end();
        done
    }

    /// Derives from the model and shows its warnings.
    fn derived<T>(&self, derive: impl Fn(Model) -> Result<T, Vec<Diagnostic>>) -> Result<T, Error> {
        let system = self.system()?;
        let derived = self.during(|| {
            at_some_point(&system, |model| {
                self.warn(&model);
                derive(model)
            })
        });
        derived.map_err(|errors| self.description_error(&errors))
    }

    fn available(&self, asked: Asked) -> Result<Generated, Error> {
        let (generated, left_out) = self.derived(|mut model| {
            let unknown: Vec<Diagnostic> = unknown_frames(&model, &asked.jacobians);
            if !unknown.is_empty() {
                return Err(unknown);
            }
            model.asked = asked.clone();
            Generated::available(model, 0)
        })?;
        self.warn(&generated.model);
        self.warn_of(left_out);
        Ok(generated)
    }

    /// Warns that M has no inverse or that there is no inertia; for a robot without masses, reading has warned already.
    fn warn_of(&self, left_out: Option<LeftOut>) {
        if let Some(left_out) = left_out.filter(|_| self.has_masses()) {
            self.reporter.warn(&Warning::LeftOut {
                path: &self.path,
                left_out: &left_out,
            });
        }
    }

    /// Returns whether the source is a description or a robot with masses.
    fn has_masses(&self) -> bool {
        let robot = self.robot.as_ref();
        robot.is_none_or(|robot| robot.imported.has_masses)
    }

    /// Derives the functions that the description requests; for a robot, which requests none, all that exist.
    pub fn derive(&self) -> Result<Generated, Error> {
        if let Some(robot) = &self.robot {
            let derived = self.during(|| available_in(&robot.imported.system));
            let (generated, left_out) =
                derived.map_err(|errors| self.description_error(&errors))?;
            self.warn_of(left_out);
            return Ok(generated);
        }
        let derived = self.during(|| from_file(&self.text, &mut |name| self.file(name)));
        let derived = derived.map_err(|errors| self.description_error(&errors))?;
        self.warn(&derived.model);
        Ok(derived)
    }

    /// Like [`derive_default_functions`](Self::derive_default_functions), but returns the errors without showing them.
    pub fn try_derive_default_functions(&self) -> Result<Generated, Vec<Diagnostic>> {
        let (system, _) = self.parsed()?;
        self.during(|| at_some_point(&system, with_default_functions))
    }

    /// Like [`derive_linearized`](Self::derive_linearized), but returns the errors without showing them.
    pub fn try_derive_linearized(&self) -> Result<Generated, Vec<Diagnostic>> {
        let (system, _) = self.parsed()?;
        self.during(|| at_some_point(&system, linearized))
    }

    /// Derives the functions that a description without `generate` gets, whatever its `generate` says: all except those
    /// that must be requested by name, such as `linearize` and `regressor`.
    pub fn derive_default_functions(&self) -> Result<Generated, Error> {
        self.derived(with_default_functions)
    }

    /// Derives those of these default functions that exist, and the kinematics of frames: those that contain M⁻¹ are left out, with a
    /// warning, if M is not positive definite, and all that need inertia if there is none.
    pub fn derive_available(&self, frames: &[Jacobian]) -> Result<Generated, Error> {
        self.available(Asked {
            jacobians: frames.to_vec(),
            ..Asked::everything()
        })
    }

    /// Derives the default functions and the linearisation; for a robot without masses or without an inverse of M, those that
    /// exist.
    pub fn derive_counted(&self) -> Result<Generated, Error> {
        let (generated, left_out) = self.derived(|mut model| {
            let errors = match Generated::all(model.clone(), 0) {
                Ok(generated) => return Ok((generated, None)),
                Err(errors) => errors,
            };
            let lacking = errors.iter().all(|error| error.lacking.is_some());
            if self.robot.is_none() || !lacking {
                return Err(errors);
            }
            model.asked = Asked::everything();
            Generated::available(model, 0)
        })?;
        self.warn(&generated.model);
        self.warn_of(left_out);
        Ok(generated)
    }

    /// Derives the default functions, the linearisation and the derivatives of outputs, regardless of the description's
    /// `generate`.
    pub fn derive_linearized(&self) -> Result<Generated, Error> {
        let generated = self.derived(linearized)?;
        self.warn(&generated.model);
        Ok(generated)
    }

    /// Reports the warnings, each once. The text of a robot is the importer's, not the user's.
    fn warn(&self, model: &Model) {
        if self.robot.is_some() {
            return;
        }
        let all = &model.warnings;
        let shown = self.warned.fetch_max(all.len(), Ordering::Relaxed);
        if let Some(new) = all.get(shown..).filter(|new| !new.is_empty()) {
            self.reporter.warn(&Warning::Description {
                path: &self.path,
                text: &self.text,
                diagnostics: new,
            });
        }
    }

    /// Creates the error of a description with these errors.
    pub fn description_error(&self, errors: &[Diagnostic]) -> Error {
        let (path, diagnostics) = (self.path.clone(), errors.to_vec());
        match &self.robot {
            Some(robot) => Error::Robot {
                path,
                urdf: robot.urdf.clone(),
                diagnostics,
            },
            None => Error::Description {
                path,
                text: self.text.clone(),
                diagnostics,
            },
        }
    }
}

/// Decodes the bytes of a file to text, in any encoding that robots may have.
pub fn decoded(name: &str, bytes: Vec<u8>) -> Result<String, Error> {
    urdf::decode(bytes).map_err(|source| Error::Decode {
        path: name.into(),
        source,
    })
}

fn with_default_functions(mut model: Model) -> Result<Generated, Vec<Diagnostic>> {
    model.asked = Asked::everything();
    Generated::of(model, 0)
}

/// Derives all functions, the linearisation and the derivatives of outputs.
fn linearized(mut model: Model) -> Result<Generated, Vec<Diagnostic>> {
    model.asked = Asked::everything();
    model.asked.functions.push(FunctionId::Linearize);
    // Rates of functions in Rust have no derivatives.
    let outputs = model.outputs.iter();
    let smooth = outputs.filter(|(_, value)| {
        let rate = model.graph.find_external(&value.entries(), 1);
        rate.is_none()
    });
    model.asked.slopes = smooth.map(|(name, _)| name.clone()).collect();
    Generated::of(model, 0)
}

/// Returns an error for each unknown frame.
fn unknown_frames(model: &Model, asked: &[Jacobian]) -> Vec<Diagnostic> {
    let known = |name: &str| model.frames.iter().any(|frame| frame.name == name);
    let mut names: Vec<&str> = asked.iter().map(|one| one.frame.as_str()).collect();
    names.dedup();
    let unknown = names.into_iter().filter(|name| !known(name));
    let frames: Vec<&str> = model
        .frames
        .iter()
        .map(|frame| frame.name.as_str())
        .collect();
    let error = |name: &str| {
        let message = format!("no frame is called `{name}`");
        Diagnostic::new(model.span, message).help(match frames.as_slice() {
            [] => "the description has no frames".into(),
            frames => format!("the frames are {}", frames.join(", ")),
        })
    };
    unknown.map(error).collect()
}
