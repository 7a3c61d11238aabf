//! Generated text as Rust: parsed, which finds faults of the generator, and laid out for files.

use std::fmt;

/// Text that is no Rust was generated: an error in the generator, whatever the description is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotRust {
    /// What the parser says.
    pub why: String,
    /// The line that is wrong, where it is known.
    pub line: Option<String>,
}

impl fmt::Display for NotRust {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the generated text is no Rust: {}", self.why)?;
        match &self.line {
            Some(line) => write!(f, ", in `{}`", line.trim()),
            None => Ok(()),
        }
    }
}

impl std::error::Error for NotRust {}

/// Parses a text.
///
/// # Errors
/// Where it is no Rust.
pub fn parsed(text: &str) -> Result<syn::File, NotRust> {
    syn::parse_file(text).map_err(|error| NotRust {
        why: error.to_string(),
        line: line_of(&error, text),
    })
}

/// The text as it is written to files.
///
/// # Errors
/// Where it is no Rust.
#[cfg(feature = "files")]
pub fn formatted(text: &str) -> Result<String, NotRust> {
    Ok(prettyplease::unparse(&parsed(text)?))
}

/// The line of an error, where places are known.
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
    use super::{NotRust, formatted};

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
            assert!(formatted(text).is_err(), "{text}");
        }
    }

    #[test]
    fn faults_name_their_line() {
        let text = "fn f() {\nlet a = 1;\nlet b = a c;\n}\n";
        let Err(NotRust { line, .. }) = formatted(text) else {
            panic!("refused");
        };
        assert_eq!(line.as_deref(), Some("let b = a c;"));
    }
}
