//! Parsing of generated text, which finds defects of the generator, and formatting for files.

use super::docs::escape_bidi_controls;
use std::fmt;

/// The generated text is not valid Rust: a defect of the generator, whatever the description is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InvalidRust {
    /// Message of the parser.
    pub why: String,
    /// The offending line, if known.
    pub line: Option<String>,
}

impl fmt::Display for InvalidRust {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the generated text is no Rust: {}", self.why)?;
        match &self.line {
            Some(line) => write!(f, ", in `{}`", line.trim()),
            None => Ok(()),
        }
    }
}

impl std::error::Error for InvalidRust {}

/// Parses generated text as a Rust file.
///
/// # Errors
/// If the text is not valid Rust.
pub fn parse_file(text: &str) -> Result<syn::File, InvalidRust> {
    syn::parse_file(text).map_err(|error| InvalidRust {
        why: error.to_string(),
        line: line_of(&error, text),
    })
}

/// Start of a doc comment that stands for a plain comment, which parsing would drop. Doc comments of generated items
/// have a space there.
const HEADING: &str = "///~";

/// Returns a line that [`format_file`] turns into a comment above the next statement.
pub fn heading_marker(text: &str) -> String {
    format!("{HEADING} {}\n", escape_bidi_controls(text))
}

/// Formats generated Rust for a file, with headings as comments.
///
/// # Errors
/// If the text is not valid Rust.
#[cfg(feature = "files")]
pub fn format_file(text: &str) -> Result<String, InvalidRust> {
    let text = prettyplease::unparse(&parse_file(text)?);
    let lines = text.split_inclusive('\n').map(|line| {
        let indent = line.len() - line.trim_start().len();
        match line[indent..].strip_prefix(HEADING) {
            Some(rest) => [&line[..indent], "//", rest],
            None => [line, "", ""],
        }
    });
    Ok(lines.flatten().collect())
}

/// Line of an error, if its position is known.
#[cfg(feature = "files")]
fn line_of(error: &syn::Error, text: &str) -> Option<String> {
    let line = error.span().start().line;
    text.lines().nth(line.checked_sub(1)?).map(str::to_string)
}

#[cfg(not(feature = "files"))]
fn line_of(_: &syn::Error, _: &str) -> Option<String> {
    None
}

#[cfg(all(test, feature = "files"))]
mod tests {
    use super::{InvalidRust, format_file};

    #[test]
    fn text_that_is_no_rust_is_refused() {
        for text in [
            "/// Nothing is documented.\n",
            "#[must_use]\n",
            "#[allow(a, reason = \"b)]\nfn f() {}\n",
            "fn (",
            "fn f() {\nlet a = no value for node 3;\n}\n",
            "fn f() -> A {\n[a, k[3]\n}\n",
            "fn f() -> A {\nlet a = b;\n[[a, b], [c, type]]\n}\n",
        ] {
            assert!(format_file(text).is_err(), "{text}");
        }
    }

    #[test]
    fn faults_name_their_line() {
        let text = "fn f() {\nlet a = 1;\nlet b = a c;\n}\n";
        let Err(InvalidRust { line, .. }) = format_file(text) else {
            panic!("refused");
        };
        assert_eq!(line.as_deref(), Some("let b = a c;"));
    }
}
