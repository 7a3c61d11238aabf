//! The blocks and directives of a page.
//!
//! A directive is a comment on a separate line; it is replaced when the book is built:
//!
//! | directive | replacement |
//! |---|---|
//! | `<!-- output -->` | the output of the shell block before it (`sh`), or of a block that makes a crate next to a
//! clone (`sh,crates`) |
//! | `<!-- picture: file.svg A description -->` | a picture that a command of the page has made |
//! | `<!-- expressions -->`, `<!-- functions -->`, `<!-- options -->` | the lists of the reference |
//! | `<!-- errors: param -->` | the errors of a statement |
//! | `<!-- all errors -->` | all errors, by statement |
//! | `<!-- gallery -->` | the mechanisms of the gallery |

/// Returns the contents of the blocks of a page with this info string.
pub fn blocks<'a>(page: &'a str, info: &str) -> Vec<&'a str> {
    let begin = format!("```{info}\n");
    let blocks = page.split(&*begin).skip(1);
    blocks
        .filter_map(|rest| rest.split_once("```").map(|(block, _)| block))
        .collect()
}

/// Info string of shell blocks that make crates next to a clone: every line of these is run.
pub const CRATES: &str = "sh,crates";

/// Extracts the lines of a shell block that are run: calls of the command line, and files written for it. Other
/// programs have separate tests.
pub fn own(block: &str) -> String {
    let mut script = String::new();
    let (mut file, mut goes_on) = (false, false);
    for line in block.lines() {
        let line = line
            .replace("cargo run --release -- ", "hamel ")
            .replace("cargo run --release --all-features -- ", "hamel ");
        let begins = line.starts_with("hamel ") || line.starts_with("cat > ");
        if begins || file || goes_on {
            script.push_str(&line);
            script.push('\n');
            goes_on = line.ends_with('\\');
        }
        file = line.ends_with("<<'END'") || (file && line != "END");
    }
    script
}

/// Parses a directive into its name and the text after the colon.
pub fn directive(line: &str) -> Option<(&str, &str)> {
    let inner = line.trim().strip_prefix("<!-- ")?.strip_suffix(" -->")?;
    let (name, rest) = inner.split_once(": ").unwrap_or((inner, ""));
    let known = [
        "output",
        "picture",
        "expressions",
        "functions",
        "options",
        "errors",
        "all errors",
        "gallery",
    ];
    known.contains(&name).then_some((name, rest))
}

/// Returns the section of a page whose heading begins with a word: `### `param``.
pub fn section<'a>(page: &'a str, word: &str) -> Option<&'a str> {
    let heading = format!("\n### `{word}`");
    let begin = page.find(&heading)?;
    let rest = &page[begin + 1..];
    let end = rest.match_indices('\n').map(|(at, _)| at + 1);
    let mut end = end.filter(|&at| {
        let line = &rest[at..];
        line.starts_with("### ") || line.starts_with("## ") || line.starts_with("# ")
    });
    Some(end.next().map_or(rest, |end| &rest[..end]))
}
