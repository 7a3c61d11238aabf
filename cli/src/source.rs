//! A description's file: reading and deriving it, with errors and warnings shown in its text.

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

/// The path of standard input in messages.
const STDIN: &str = "<stdin>";
/// What is shown while a derivation takes its time.
const DERIVING: &str = "deriving";

/// A text and where it comes from.
pub struct Source {
    /// The path as given, or `<stdin>`.
    pub path: String,
    /// The text of the description.
    pub text: String,
    /// The robot that the description is made from, if it is.
    pub robot: Option<Robot>,
    /// How many of the warnings were shown: those of reading come first, then those of deriving.
    warned: AtomicUsize,
    /// Whether functions in Rust have to have values, by their stand-ins.
    evaluated: bool,
    /// Whether all frames are results.
    shows_frames: bool,
}

impl Source {
    /// A text, and what messages call it.
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

    /// Reads a file, or standard input where the path is `-`.
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

    /// Reads a file beside this description; `what` it holds is said where both are standard input.
    pub fn beside(&self, path: &Path, what: &str) -> Result<Source, Failure> {
        if path.as_os_str() == "-" && self.is_stdin() {
            return Err(Failure::usage(format!(
                "description and {what} cannot both be read from standard input"
            )));
        }
        Source::read(path)
    }

    /// Whether it was standard input.
    pub fn is_stdin(&self) -> bool {
        self.path == STDIN
    }

    /// The text that messages give lines of: none for a robot, whose description its user has not written.
    pub fn shown(&self) -> &str {
        match &self.robot {
            Some(_) => "",
            None => &self.text,
        }
    }

    /// Whether the text is that of a robot in URDF, by the name of its file or by how it begins.
    pub fn is_urdf(&self) -> bool {
        urdf::is_urdf(Path::new(&self.path))
            || self
                .text
                .trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}')
                .starts_with('<')
    }

    /// The joints of a robot by their names in its file and in the description; none of a description.
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

    /// The description, or robot in URDF, that a text is.
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

    /// The same for who wants numbers: of functions in Rust, the stand-ins.
    pub fn in_numbers(self) -> Self {
        Source {
            evaluated: true,
            ..self
        }
    }

    /// The same where frames are what is asked for: nothing is said of one that no other statement uses.
    pub fn showing_frames(self) -> Self {
        Source {
            shows_frames: true,
            ..self
        }
    }

    /// The frames that are asked for, each with its name in the description; those of a robot are its links, by their
    /// names in its file or in the description, and the link that stands in the world becomes a frame where it is asked
    /// for.
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
        self.text = robot.imported.text();
        match unknown.is_empty() {
            true => Ok(frames),
            false => Err(Failure::failed(format!(
                "{}: {}",
                self.path,
                unknown.join("; ")
            ))),
        }
    }

    /// The text is a robot in URDF: it becomes a description.
    pub fn robot(self, options: &RobotOptions) -> Result<Self, Failure> {
        let robot = Robot::read(self.text, &self.path, options)?;
        Ok(Source {
            path: self.path,
            text: robot.imported.text(),
            robot: Some(robot),
            warned: self.warned,
            evaluated: self.evaluated,
            shows_frames: self.shows_frames,
        })
    }

    /// The text of a file that the description names, by its path from there.
    fn file(&self, name: &str) -> std::io::Result<String> {
        let folder = Path::new(&self.path).parent();
        text_of(&folder.unwrap_or(Path::new("")).join(name))
    }

    /// Other files that the description has statements or numbers of.
    pub fn files(&self) -> Result<Vec<PathBuf>, Failure> {
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
        read.map_err(|errors| self.refused(&errors))?;
        Ok(files)
    }

    /// The description with what it has in other files, and the texts of these.
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

    fn system(&self) -> Result<System, Failure> {
        let parsed = self.parsed().map_err(|errors| self.refused(&errors))?;
        Ok(parsed.0)
    }

    /// The texts of other files that the description has statements or numbers of.
    pub fn texts(&self) -> Result<Vec<String>, Failure> {
        let parsed = self.parsed().map_err(|errors| self.refused(&errors))?;
        Ok(parsed.1)
    }

    /// The same description with another text, which says more.
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

    /// What the description says, not derived yet.
    pub fn model(&self) -> Result<Model, Failure> {
        let model = lower::build(&self.system()?);
        let model = model.map_err(|errors| self.refused(&errors))?;
        self.warn(&model);
        Ok(model)
    }

    /// Derives what a picture is made of: places, whatever the description's `generate` says. No claim about the motion is
    /// proved.
    pub fn derive_places(&self) -> Result<Generated, Failure> {
        self.derived(|mut model| {
            model.asked = Asked::only(&[]);
            model.invariants.clear();
            Generated::of(model, 0)
        })
    }

    /// Derives these functions, whatever the description's `generate` says; those with M⁻¹ in them are
    /// left out, with a warning, where M is not positive definite, and all that need inertia where there is none.
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

    /// Derives what is asked for by name, whatever the description's `generate` says.
    pub fn derive_asked(&self, asked: &Asked) -> Result<Generated, Failure> {
        let generated = self.derived(|mut model| {
            model.asked = asked.clone();
            Generated::of(model, 0)
        })?;
        self.warn(&generated.model);
        Ok(generated)
    }

    /// An error where nothing of the system has inertia, with what there is to do.
    pub fn moves(&self, generated: &Generated) -> Result<(), Failure> {
        match generated.model.has_inertia {
            true => Ok(()),
            false => {
                let motion = Asked::only(&[FunctionId::Accel]);
                self.derive_asked(&motion).map(drop)
            }
        }
    }

    /// What is derived of the model, with its warnings.
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

    /// Says that M has no inverse, or that there is no inertia; of a robot without masses that was said when it was read.
    fn warn_of(&self, left_out: Option<LeftOut>) {
        if let Some(left_out) = left_out.filter(|_| self.has_masses()) {
            let said = left_out.said();
            failure::warn(&format!("warning: {}: {said}\n", self.path));
        }
    }

    /// Whether this is no robot without masses.
    fn has_masses(&self) -> bool {
        let robot = self.robot.as_ref();
        robot.is_none_or(|robot| robot.imported.has_masses)
    }

    /// Derives the functions that the description asks for; for a robot, which asks for nothing by itself, all
    /// that exist.
    pub fn derive(&self) -> Result<Generated, Failure> {
        if let Some(robot) = &self.robot {
            let derived = progress::during(DERIVING, || available_in(&robot.imported.system));
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

    /// As [`derive_all`](Self::derive_all), with what is wrong as it was found.
    pub fn try_derive_all(&self) -> Result<Generated, Vec<Diagnostic>> {
        let (system, _) = self.parsed()?;
        progress::during(DERIVING, || {
            at_some_point(&system, |mut model| {
                model.asked = Asked::everything();
                Generated::of(model, 0)
            })
        })
    }

    /// Derives all functions, whatever the description's `generate` says.
    pub fn derive_all(&self) -> Result<Generated, Failure> {
        self.derived(|mut model| {
            model.asked = Asked::everything();
            Generated::of(model, 0)
        })
    }

    /// Derives all functions that exist, and the kinematics of frames: those with M⁻¹ in them are left out, with a
    /// warning, where M is not positive definite, and all that need inertia where there is none.
    pub fn derive_available(&self, frames: &[Jacobian]) -> Result<Generated, Failure> {
        self.available(Asked {
            jacobians: frames.to_vec(),
            ..Asked::everything()
        })
    }

    /// Derives all functions and the linearisation, of a robot without an inverse of M, or without masses, what
    /// exists.
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

    /// Derives all functions, the linearisation and the slopes of outputs, whatever the description's `generate` says.
    pub fn derive_linearized(&self) -> Result<Generated, Failure> {
        let generated = self.derived(|mut model| {
            model.asked = Asked::everything();
            model.asked.functions.push(FunctionId::Linearize);
            // Rates of functions in Rust have no slopes.
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

    /// Shows the warnings on standard error, each once. The text of a robot is the importer's, not the user's.
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

    /// The errors with their source underlined.
    pub fn refused(&self, errors: &[Diagnostic]) -> Failure {
        failure::mark(errors, true);
        Failure::Failed(match &self.robot {
            Some(robot) => urdf::refused(errors, &self.path, &robot.urdf, true),
            None => render(errors, &self.path, &self.text, true),
        })
    }
}

/// The text that the bytes of a file are, in any encoding that robots have.
pub fn decoded(name: &str, bytes: Vec<u8>) -> Result<String, Failure> {
    urdf::decode(bytes).map_err(|error| Failure::usage(format!("cannot read {name}: {error}")))
}

/// An error for each frame that a model does not have.
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
