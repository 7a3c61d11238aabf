//! `hamel emit`: writes the generated Rust, C99 or Python.

use crate::failure::{Failure, print, update};
use crate::outputs;
use crate::robot::RobotOptions;
use crate::source;
use clap::{Args, ValueEnum};
use hamel_codegen::builder;
use hamel_codegen::emit::c::{CFiles, Precision, is_includable};
use hamel_codegen::emit::trace::AnnotatedStatement;
use hamel_codegen::generate::Generated;
use hamel_codegen::trace::Places;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Writes the generated Rust, C99 or Python.
///
/// The output is byte for byte the same as that of a build script.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel emit heavy_top.eom                          to the terminal
  hamel emit heavy_top.eom -o src/heavy_top.rs      to a file
  hamel emit heavy_top.eom -o src/heavy_top.rs --check    in CI: is the file up to date?
  hamel emit heavy_top.eom -o src/heavy_top.rs --trace heavy_top.json    and what each statement is
  hamel emit --language c heavy_top.eom -o src/heavy_top  C99: src/heavy_top.h and src/heavy_top.c
  hamel emit --language c --precision float drone.eom -o drone    the same with `float`
  hamel emit --language python heavy_top.eom -o heavy_top.py      for arrays of NumPy or JAX
C on the terminal is the header and the source in one, which compiles alone.")]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Output file; default: standard output. For C the files are OUT.h and OUT.c; an extension `.h` or `.c` of OUT
    /// is dropped.
    #[arg(short, long, value_name = "OUT")]
    out: Option<PathBuf>,
    /// Write nothing; exit with status 1 if OUT differs from what would be written.
    #[arg(long, requires = "out")]
    check: bool,
    /// Language of the output.
    #[arg(long, value_enum, default_value_t = Language::Rust)]
    language: Language,
    /// Number type of C: `double` or `float`; default: `double`. Rust is generic over it.
    #[arg(long, value_name = "NUMBERS")]
    precision: Option<Precision>,
    /// Also writes every statement of the code as JSON: name, expression, quantity, equation, and line and column of
    /// the description.
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    trace: Option<PathBuf>,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Language of the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Language {
    /// A Rust type, in one file.
    Rust,
    /// C99, also valid as C++17, in a header and a source file.
    C,
    /// A Python class whose methods take arrays of NumPy, JAX or another module.
    Python,
}

/// Writes the code, or compares it with the file.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.precision.is_some() {
        let why = match arguments.language {
            Language::C => None,
            Language::Rust => Some("the Rust is generic over its numbers"),
            Language::Python => Some("Python has the numbers of the arrays that it is given"),
        };
        if let Some(why) = why {
            return Err(Failure::usage(format!(
                "`--precision` is for `--language c`: {why}"
            )));
        }
    }
    let stem = match (arguments.language, &arguments.out) {
        (Language::C, Some(out)) => Some(stem(out)?),
        _ => None,
    };
    let source = source::open(&arguments.file, &arguments.robot)?;
    let trace = arguments.trace.as_deref();
    if trace.is_some() {
        let beside = source.files()?;
        let read = std::iter::once(&arguments.file).chain(&beside);
        outputs::apart(
            [("-o", arguments.out.as_deref()), ("--trace", trace)],
            read.map(|path| Some(path.as_path())),
        )?;
    }
    if let Some(out) = arguments.out.as_deref().filter(|_| !arguments.check) {
        let out = match &stem {
            Some(stem) => [".h", ".c"].map(|ending| out.with_file_name(format!("{stem}{ending}"))),
            None => [out.to_path_buf(), out.to_path_buf()],
        };
        let beside = source.files()?;
        for out in &out {
            let read = std::iter::once(&arguments.file).chain(&beside);
            outputs::apart(
                [("-o", Some(out.as_path()))],
                read.map(|path| Some(path.as_path())),
            )?;
        }
    }
    let name = arguments
        .file
        .file_name()
        .map_or_else(|| "-".into(), PathBuf::from);
    // `hamel import` writes the description of a robot, as the first lines of that description say.
    let name = match source.robot {
        Some(_) => name.with_extension("eom"),
        None => name,
    };
    let name = name.to_string_lossy();
    let generated = source.derive()?;
    if let Some(trace) = trace {
        let written = source
            .robot
            .as_ref()
            .map_or(&source.text, |robot| &robot.urdf);
        update(trace, &traced(&generated, written, &source.path))?;
    }
    match arguments.language {
        Language::Rust => {
            let code = builder::written(&generated, &name)
                .map_err(|errors| source.description_error(&errors))?;
            match &arguments.out {
                Some(out) => write(arguments, out, &code),
                None => print(&code),
            }
        }
        Language::C => {
            let precision = arguments.precision.unwrap_or_default();
            let files = builder::written_in_c(&generated, &name, stem.as_deref(), precision)
                .map_err(|errors| source.description_error(&errors))?;
            write_c(arguments, &files, stem.as_deref())
        }
        Language::Python => {
            let out = arguments.out.as_ref().and_then(|out| out.file_name());
            let out = out.map(|name| name.to_string_lossy());
            let code = builder::written_in_python(&generated, &name, out.as_deref())
                .map_err(|errors| source.description_error(&errors))?;
            match &arguments.out {
                Some(out) => write(arguments, out, &code),
                None => print(&code),
            }
        }
    }
}

/// Returns the statements of all functions as JSON. `text` and `path` are those of the description, or of the robot's
/// file.
fn traced(generated: &Generated, text: &str, path: &str) -> String {
    let mut places = Places::of(generated, text);
    let mut statement = |traced: &AnnotatedStatement| {
        let mut value = json!({ "name": traced.name, "expression": traced.expression });
        if let Some(origin) = &traced.origin {
            value["quantity"] = json!(origin.quantity);
            value["equation"] = json!(origin.equation);
        }
        if let Some(place) = places.place(traced) {
            value["line"] = json!(place.line);
            value["column"] = json!(place.column);
            if let Some(file) = place.file {
                value["file"] = json!(file);
            }
        }
        value
    };
    let functions = generated.trace().into_iter().map(|function| {
        let statements = function.statements.iter().map(&mut statement);
        let statements: Vec<Value> = statements.collect();
        json!({ "name": function.function, "statements": statements })
    });
    let functions: Vec<Value> = functions.collect();
    let all = json!({ "description": path, "functions": functions });
    format!("{all:#}\n")
}

/// Writes header and source to their files, or both as one source to the terminal.
fn write_c(arguments: &Arguments, files: &CFiles, stem: Option<&str>) -> Result<(), Failure> {
    let (Some(out), Some(stem)) = (&arguments.out, stem) else {
        return print(&format!("{}\n{}", files.header, files.rest));
    };
    let header = write(
        arguments,
        &out.with_file_name(format!("{stem}.h")),
        &files.header,
    );
    let source = write(
        arguments,
        &out.with_file_name(format!("{stem}.c")),
        &files.source,
    );
    match (header, source) {
        (Err(first), Err(second)) => Err(first.and(second)),
        (header, source) => header.and(source),
    }
}

/// Returns the name of the C files without extension, which `#include` contains as well.
fn stem(out: &Path) -> Result<String, Failure> {
    let name = out.file_name().and_then(|name| name.to_str());
    let stem = name.map(|name| {
        let stem = name.strip_suffix(".h").or_else(|| name.strip_suffix(".c"));
        stem.unwrap_or(name)
    });
    match stem {
        Some(stem) if is_includable(stem) => Ok(stem.into()),
        _ => Err(Failure::usage(format!(
            "{}: not a name that C can include, or the name of a C header; give it without the extension, as in `-o src/arm`",
            out.display()
        ))),
    }
}

/// Writes a file, or compares it with the code.
fn write(arguments: &Arguments, out: &Path, code: &str) -> Result<(), Failure> {
    if !arguments.check {
        return update(out, code);
    }
    match hamel_files::holds(out, code) {
        Ok(true) => Ok(()),
        Ok(false) => {
            let language = match arguments.language {
                Language::Rust => "",
                Language::C => "--language c ",
                Language::Python => "--language python ",
            };
            let precision = match arguments.precision {
                Some(precision) => format!("--precision {precision} "),
                None => String::new(),
            };
            Err(Failure::failed(format!(
                "{} is out of date; regenerate it with `hamel emit {language}{precision}{} -o {}`",
                out.display(),
                arguments.file.display(),
                arguments.out.as_deref().unwrap_or(out).display()
            )))
        }
        Err(error) => Err(Failure::usage(format!(
            "cannot read {}: {error}",
            out.display()
        ))),
    }
}
