//! Derives a description and prints every identity with its verdict, like `hamel check`; the exit status is 1 if one
//! fails.
//!
//! The command line would link machine code, tables and pictures again for every mutant. Therefore the copy of the
//! generator contains this program, which calls the same functions.

use hamel_codegen::functions::Asked;
use hamel_codegen::generate::{Generated, at_some_point};
use hamel_codegen::proof::check::{Verdict, check};
use hamel_codegen::render::render;
use hamel_codegen::syntax::parse_text;
use std::process::ExitCode;

fn main() -> ExitCode {
    let path = std::env::args().nth(1).expect("a description");
    let text = std::fs::read_to_string(&path).expect("a text");
    let derived = parse_text(&text).and_then(|system| {
        at_some_point(&system, |mut model| {
            model.asked = Asked::everything();
            Generated::available(model, 0)
        })
    });
    let generated = match derived {
        Ok((generated, _)) => generated,
        Err(errors) => {
            println!("{}", render(&errors, &path, &text, false));
            return ExitCode::FAILURE;
        }
    };
    let mut sound = true;
    for identity in check(&generated.model, &generated.program) {
        let verdict = match &identity.verdict {
            Verdict::Proved => "proved".to_string(),
            Verdict::Checked(confidence) => confidence.to_string(),
            Verdict::Failed(why) => format!("FAILED: {why}"),
        };
        sound &= !matches!(identity.verdict, Verdict::Failed(_));
        println!("{}  {}  {verdict}", identity.label, identity.equation);
    }
    if sound {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
