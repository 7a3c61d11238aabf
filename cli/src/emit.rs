//! `hamel emit`: the generated Rust, or C99.

use crate::failure::{Failure, print, update};
use crate::outputs;
use crate::robot::RobotOptions;
use crate::source::Source;
use clap::{Args, ValueEnum};
use hamel_codegen::builder;
use hamel_codegen::emit::c::{Files, Precision, includable};
use hamel_codegen::emit::trace::Traced;
use hamel_codegen::generate::Generated;
use hamel_codegen::trace::Places;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Writes the generated Rust, or C99.
///
/// The text is the same, byte for byte, as that of a build script.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel emit heavy_top.eom                          to the terminal
  hamel emit heavy_top.eom -o src/heavy_top.rs      to a file
  hamel emit heavy_top.eom -o src/heavy_top.rs --check    in CI: is the file up to date?
  hamel emit heavy_top.eom -o src/heavy_top.rs --trace heavy_top.json    and what each statement is
  hamel emit --language c heavy_top.eom -o src/heavy_top  C99: src/heavy_top.h and src/heavy_top.c
  hamel emit --language c --precision float drone.eom -o drone    the same of `float`
C to the terminal is the header and what belongs to it in one: a source that compiles alone.")]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Where to write; default standard output. For C the files are OUT.h and OUT.c; where OUT ends in `.h` or `.c`,
    /// the extension is dropped.
    #[arg(short, long, value_name = "OUT")]
    out: Option<PathBuf>,
    /// Write nothing; status 1 where OUT is not what would be written.
    #[arg(long, requires = "out")]
    check: bool,
    /// What to write.
    #[arg(long, value_enum, default_value_t = Language::Rust)]
    language: Language,
    /// The numbers of C: `double` or `float`; default `double`. Rust is generic over them.
    #[arg(long, value_name = "NUMBERS")]
    precision: Option<Precision>,
    /// Also writes every statement of the code as JSON: name, expression, quantity, equation, and line and column of the
    /// description.
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    trace: Option<PathBuf>,
    #[command(flatten)]
    robot: RobotOptions,
}

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Language {
    /// A type of Rust, in one file.
    Rust,
    /// C99, which is C++17 as well, in a header and a source.
    C,
}

/// Emits, or compares.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.language == Language::Rust && arguments.precision.is_some() {
        return Err(Failure::usage(
            "`--precision` is for `--language c`: the Rust is generic over its numbers",
        ));
    }
    let stem = match (arguments.language, &arguments.out) {
        (Language::C, Some(out)) => Some(stem(out)?),
        _ => None,
    };
    let source = Source::open(&arguments.file, &arguments.robot)?;
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
    // A robot's description is written by `hamel import`, as its first lines say.
    let name = match source.robot {
        Some(_) => name.with_extension("eom"),
        None => name,
    };
    let name = name.to_string_lossy();
    let generated = source.derive()?;
    if let Some(trace) = trace {
        update(trace, &traced(&generated, &name))?;
    }
    match arguments.language {
        Language::Rust => {
            let code =
                builder::written(&generated, &name).map_err(|errors| source.refused(&errors))?;
            match &arguments.out {
                Some(out) => write(arguments, out, &code),
                None => print(&code),
            }
        }
        Language::C => {
            let precision = arguments.precision.unwrap_or_default();
            let files = builder::written_in_c(&generated, &name, stem.as_deref(), precision)
                .map_err(|errors| source.refused(&errors))?;
            write_c(arguments, &files, stem.as_deref())
        }
    }
}

/// The statements of all functions as JSON.
fn traced(generated: &Generated, name: &str) -> String {
    let mut places = Places::of(generated);
    let mut statement = |traced: &Traced| {
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
    let all = json!({ "description": name, "functions": functions });
    format!("{all:#}\n")
}

/// Header and source to their files, or both as one source to the terminal.
fn write_c(arguments: &Arguments, files: &Files, stem: Option<&str>) -> Result<(), Failure> {
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

/// What the files of C are called before their endings: it stands in `#include` as well.
fn stem(out: &Path) -> Result<String, Failure> {
    let name = out.file_name().and_then(|name| name.to_str());
    let stem = name.map(|name| {
        let stem = name.strip_suffix(".h").or_else(|| name.strip_suffix(".c"));
        stem.unwrap_or(name)
    });
    match stem {
        Some(stem) if includable(stem) => Ok(stem.into()),
        _ => Err(Failure::usage(format!(
            "{}: no name that C can include, or that of a header of C; name the files without their ending, as in `-o src/arm`",
            out.display()
        ))),
    }
}

/// Writes a file, or tells whether it is what would be written.
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
            };
            let precision = match arguments.precision {
                Some(precision) => format!("--precision {precision} "),
                None => String::new(),
            };
            Err(Failure::failed(format!(
                "{} is stale; write it again with `hamel emit {language}{precision}{} -o {}`",
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
