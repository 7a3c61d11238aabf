//! `hamel report`: the derivation of a mechanism as a document, in HTML or LaTeX.

mod document;
mod html;
mod latex;

use crate::draw;
use crate::failure::{self, Failure, print};
use crate::outputs;
use crate::robot::RobotOptions;
use crate::source;
use clap::Args;
use document::Document;
use hamel_codegen::tables::print::Notation;
use std::path::PathBuf;

/// Writes the derivation of the equations of motion as a document.
///
/// The sections have the order of KR18: coordinates and their constraint, velocities, Hamel coefficients, mass matrix,
/// connection coefficients, forces, constraints, the equations of motion, what was proved, the operation counts, and the
/// description itself. The file name decides about the format: `.html` is a page that needs no other files, with a picture and
/// formulas in MathML; `.tex` is a document for pdfLaTeX, without the picture.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel report heavy_top.eom -o heavy_top.html
  hamel report arm.urdf -o arm.tex && pdflatex arm.tex")]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Output file, `.html` or `.tex`.
    #[arg(short, long, value_name = "F.html")]
    out: PathBuf,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Derives, proves, and writes the document.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let out = arguments.out.as_path();
    let notation = match out.extension().and_then(|ending| ending.to_str()) {
        Some("html") => Notation::MathMl,
        Some("tex") => Notation::Latex,
        _ => {
            return Err(Failure::usage(format!(
                "--out {}: a report is an `.html` or a `.tex` file",
                out.display()
            )));
        }
    };
    outputs::apart([("--out", Some(out))], [Some(arguments.file.as_path())])?;
    let source = source::open(&arguments.file, &arguments.robot)?;
    let generated = source.derive_available(&[])?;
    let document = Document::new(&generated, source.shown(), notation);
    let text = match notation {
        Notation::MathMl => html::write(&document, draw::at_start(source)?.as_ref()),
        Notation::Latex | Notation::Text => latex::write(&document),
    };
    failure::write(out, &text)?;
    print(&format!("wrote {}\n", out.display()))
}
