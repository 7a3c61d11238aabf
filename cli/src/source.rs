//! Reads and derives a description, and shows errors and warnings in its text.

use crate::constants;
use crate::failure::{self, Failure};
use crate::progress;
use crate::robot::{Robot, RobotOptions};
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::functions::{Asked, FunctionId, Jacobian};
use hamel_codegen::generate::{
    Generated, LeftOut, at_some_point, available_in, from_file, text_of,
};
use hamel_codegen::lower;
use hamel_codegen::model::Model;
use hamel_codegen::render::{render, warnings};
use hamel_codegen::syntax::path::plain;
use hamel_codegen::syntax::{self, ast::System};
use hamel_codegen::urdf;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Name of standard input in messages.
const STDIN: &str = "<stdin>";
/// Text of the spinner during a derivation.
const DERIVING: &str = "deriving";

/// A text and its origin.
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
}

impl Source {
    /// A text with its name for messages.
    pub fn new(path: String, text: String) -> Self {
        Source {
            path,
            text,
            robot: None,
            warned: AtomicUsize::new(0),
            evaluated: false,
            shows_frames: false,
        }
    }

    /// Reads a file, or standard input if the path is `-`.
    pub fn read(path: &Path) -> Result<Self, Failure> {
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
        let bytes =
            bytes.map_err(|error| Failure::usage(format!("cannot read {name}: {error}")))?;
        decoded(&name, bytes).map(|text| Source::new(name, text))
    }

    /// Reads another file; `what` describes it in the error if both are standard input.
    pub fn beside(&self, path: &Path, what: &str) -> Result<Source, Failure> {
        if path.as_os_str() == "-" && self.is_stdin() {
            return Err(Failure::usage(format!(
                "the the description and {what} cannot both be read from standard input"
            )));
        }
        Source::read(path)
    }

    /// Whether the text was read from standard input.
    pub fn is_stdin(&self) -> bool {
        self.path == STDIN
    }

    /// The text whose line numbers messages give: empty for a robot, whose description was not written by the user.
    pub fn shown(&self) -> &str {
        match &self.robot {
            Some(_) => "",
            None => &self.text,
        }
    }

    /// Whether the text is a robot in URDF, judging by the file name or the beginning of the text.
    pub fn is_urdf(&self) -> bool {
        urdf::is_urdf(Path::new(&self.path))
            || self
                .text
                .trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}')
                .starts_with('<')
    }

    /// The joints of a robot by their names in its file and in the description; empty for a description.
    pub fn joints(&self) -> &[(String, String)] {
        match &self.robot {
            Some(robot) => &robot.imported.joints,
            None => &[],
        }
    }

    /// Reads a description, or a robot in URDF.
    pub fn open(path: &Path, options: &RobotOptions) -> Result<Self, Failure> {
        Source::read(path)?.given(options)
    }

    /// Interprets the text as a description or as a robot in URDF.
    pub fn given(self, options: &RobotOptions) -> Result<Self, Failure> {
        let mut source = self;
        if source.is_urdf() {
            if !options.constants.is_empty() {
                let message = format!("{} is a robot: --const is for descriptions", source.path);
                return Err(Failure::usage(message));
            }
            return source.robot(options);
        }
        for (name, value) in &options.constants {
            source.text = constants::given(&source.text, name, value)
                .map_err(|why| Failure::usage(format!("--const {name}={value}: {why}")))?;
        }
        if options.given() {
            return Err(Failure::usage(format!(
                "{} is a description: --floating, --lock, --params, --mimic, --name and --rounding are for robots in URDF",
                source.path
            )));
        }
        Ok(source)
    }

    /// The same source for evaluation: functions in Rust get their stand-ins.
    pub fn in_numbers(self) -> Self {
        Source {
            evaluated: true,
            ..self
        }
    }

    /// The same source with frames as results: unused frames are not warned about.
    pub fn showing_frames(self) -> Self {
        Source {
            shows_frames: true,
            ..self
        }
    }

    /// The requested frames, each with its name in the description; for a robot they are its links, by their names in
    /// its file or in the description, and a link that is fixed in the world becomes a frame if it is requested.
    pub fn frames(&mut self, asked: &[String]) -> Result<Vec<(String, String)>, Failure> {
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
        self.text.clone_from(&robot.imported.text);
        match unknown.is_empty() {
            true => Ok(frames),
            false => Err(Failure::failed(format!(
                "{}: {}",
                self.path,
                unknown.join("; ")
            ))),
        }
    }

    /// Converts the text from URDF into a description.
    pub fn robot(self, options: &RobotOptions) -> Result<Self, Failure> {
        let robot = Robot::read(self.text, &self.path, options)?;
        Ok(Source {
            path: self.path,
            text: robot.imported.text.clone(),
            robot: Some(robot),
            warned: self.warned,
            evaluated: self.evaluated,
            shows_frames: self.shows_frames,
        })
    }

    /// The text of a file that the description refers to, relative to the description.
    fn file(&self, name: &str) -> std::io::Result<String> {
        let folder = Path::new(&self.path).parent();
        text_of(&folder.unwrap_or(Path::new("")).join(name))
    }

    /// The other files from which the description takes statements or numbers.
    pub fn files(&self) -> Result<Vec<PathBuf>, Failure> {
        let folder = Path::new(&self.path).parent().unwrap_or(Path::new(""));
        let mut files = Vec::new();
        let read = syntax::parse_text(&self.text).and_then(|mut system| {
            syntax::read_files(&mut system, &mut |name| {
                files.push(folder.join(name));
                self.file(name)
            })
        });
        read.map_err(|errors| self.refused(&errors))?;
        Ok(files)
    }

    /// The parsed description including its other files, and the texts of these.
    fn parsed(&self) -> Result<(System, Vec<String>), Vec<Diagnostic>> {
        let mut system = syntax::parse_text(&self.text)?;
        let texts = syntax::read_files(&mut system, &mut |name| self.file(name))?;
        if self.evaluated {
            system.evaluate();
        }
        system.shows_frames = self.shows_frames;
        system.starts_anywhere = self.robot.is_some();
        Ok((system, texts))
    }

    fn system(&self) -> Result<System, Failure> {
        let parsed = self.parsed().map_err(|errors| self.refused(&errors))?;
        Ok(parsed.0)
    }

    /// The texts of the other files from which the description takes statements or numbers.
    pub fn texts(&self) -> Result<Vec<String>, Failure> {
        let parsed = self.parsed().map_err(|errors| self.refused(&errors))?;
        Ok(parsed.1)
    }

    /// The same source with an extended text.
    pub fn saying(&self, text: String) -> Self {
        Source {
            path: self.path.clone(),
            text,
            robot: None,
            warned: AtomicUsize::new(usize::MAX),
            evaluated: self.evaluated,
            shows_frames: self.shows_frames,
        }
    }

    /// The model of the description, before derivation.
    pub fn model(&self) -> Result<Model, Failure> {
        let model = lower::build(&self.system()?);
        let model = model.map_err(|errors| self.refused(&errors))?;
        self.warn(&model);
        Ok(model)
    }

    /// Derives the positions and poses for a picture, regardless of the description's `generate`. No claim about the
    /// motion is proved.
    pub fn derive_places(&self) -> Result<Generated, Failure> {
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
    ) -> Result<Generated, Failure> {
        self.available(Asked {
            jacobians: frames.to_vec(),
            ..Asked::only(functions)
        })
    }

    /// Derives the requested functions, regardless of the description's `generate`.
    pub fn derive_asked(&self, asked: &Asked) -> Result<Generated, Failure> {
        let generated = self.derived(|mut model| {
            model.asked = asked.clone();
            Generated::of(model, 0)
        })?;
        self.warn(&generated.model);
        Ok(generated)
    }

    /// Fails, with help, if no part of the system has inertia.
    pub fn moves(&self, generated: &Generated) -> Result<(), Failure> {
        match generated.model.has_inertia {
            true => Ok(()),
            false => {
                let motion = Asked::only(&[FunctionId::Accel]);
                self.derive_asked(&motion).map(drop)
            }
        }
    }

    /// Derives from the model and shows its warnings.
    fn derived<T>(
        &self,
        derive: impl Fn(Model) -> Result<T, Vec<Diagnostic>>,
    ) -> Result<T, Failure> {
        let system = self.system()?;
        let derived = progress::during(DERIVING, || {
            at_some_point(&system, |model| {
                self.warn(&model);
                derive(model)
            })
        });
        derived.map_err(|errors| self.refused(&errors))
    }

    fn available(&self, asked: Asked) -> Result<Generated, Failure> {
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
            let said = left_out.said();
            failure::warn(&format!("warning: {}: {said}\n", self.path));
        }
    }

    /// Whether the source is a description or a robot with masses.
    fn has_masses(&self) -> bool {
        let robot = self.robot.as_ref();
        robot.is_none_or(|robot| robot.imported.has_masses)
    }

    /// Derives the functions that the description requests; for a robot, which requests none, all that exist.
    pub fn derive(&self) -> Result<Generated, Failure> {
        if self.robot.is_some() {
            let derived = progress::during(DERIVING, || available_in(&self.text));
            let (generated, left_out) = derived.map_err(|errors| self.refused(&errors))?;
            self.warn_of(left_out);
            return Ok(generated);
        }
        let derived = progress::during(DERIVING, || {
            from_file(&self.text, &mut |name| self.file(name))
        });
        let derived = derived.map_err(|errors| self.refused(&errors))?;
        self.warn(&derived.model);
        Ok(derived)
    }

    /// Like [`derive_all`](Self::derive_all), but returns the errors without showing them.
    pub fn try_derive_all(&self) -> Result<Generated, Vec<Diagnostic>> {
        let (system, _) = self.parsed()?;
        progress::during(DERIVING, || {
            at_some_point(&system, |mut model| {
                model.asked = Asked::everything();
                Generated::of(model, 0)
            })
        })
    }

    /// Derives all functions, regardless of the description's `generate`.
    pub fn derive_all(&self) -> Result<Generated, Failure> {
        self.derived(|mut model| {
            model.asked = Asked::everything();
            Generated::of(model, 0)
        })
    }

    /// Derives all functions that exist, and the kinematics of frames: those that contain M⁻¹ are left out, with a
    /// warning, if M is not positive definite, and all that need inertia if there is none.
    pub fn derive_available(&self, frames: &[Jacobian]) -> Result<Generated, Failure> {
        self.available(Asked {
            jacobians: frames.to_vec(),
            ..Asked::everything()
        })
    }

    /// Derives all functions and the linearisation; for a robot without masses or without an inverse of M, those that
    /// exist.
    pub fn derive_counted(&self) -> Result<Generated, Failure> {
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

    /// Derives all functions, the linearisation and the derivatives of outputs, regardless of the description's
    /// `generate`.
    pub fn derive_linearized(&self) -> Result<Generated, Failure> {
        let generated = self.derived(|mut model| {
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
        })?;
        self.warn(&generated.model);
        Ok(generated)
    }

    /// Shows each warning once on standard error. Those of a robot are skipped: its text was written by the importer.
    fn warn(&self, model: &Model) {
        if self.robot.is_some() {
            return;
        }
        let all = &model.warnings;
        let shown = self.warned.fetch_max(all.len(), Ordering::Relaxed);
        if let Some(new) = all.get(shown..).filter(|new| !new.is_empty()) {
            failure::mark(new, false);
            failure::warn(&warnings(new, &self.path, &self.text, true));
        }
    }

    /// The errors, with their source underlined.
    pub fn refused(&self, errors: &[Diagnostic]) -> Failure {
        failure::mark(errors, true);
        Failure::Failed(match &self.robot {
            Some(robot) => urdf::refused(errors, &robot.imported, &self.path, &robot.urdf, true),
            None => render(errors, &self.path, &self.text, true),
        })
    }
}

/// Decodes the bytes of a file, in any encoding that robots may have.
pub fn decoded(name: &str, bytes: Vec<u8>) -> Result<String, Failure> {
    urdf::decode(bytes).map_err(|error| Failure::usage(format!("cannot read {name}: {error}")))
}

/// An error for each unknown frame.
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
