//! The blocks and directives of a page.
//!
//! A directive is a comment of its own line; what it stands for is put in its place when the book is built:
//!
//! | directive | what it stands for |
//! |---|---|
//! | `<!-- output -->` | what the block before it prints, one for a shell (`sh`), or one that makes a crate beside a clone (`sh,crates`) |
//! | `<!-- picture: file.svg A description -->` | a picture that a command of the page has made |
//! | `<!-- expressions -->`, `<!-- functions -->`, `<!-- options -->` | the lists of the reference |
//! | `<!-- errors: param -->` | the errors of a statement |
//! | `<!-- all errors -->` | all errors, by statement |
//! | `<!-- gallery -->` | the mechanisms of the gallery |

/// The text of the blocks of a page that begin with a word behind their backticks.
pub fn blocks<'a>(page: &'a str, info: &str) -> Vec<&'a str> {
    let begin = format!("```{info}\n");
    let blocks = page.split(&*begin).skip(1);
    blocks
        .filter_map(|rest| rest.split_once("```").map(|(block, _)| block))
        .collect()
}

/// The info of blocks for a shell that make crates beside a clone: all of what they say is run.
pub const CRATES: &str = "sh,crates";

/// What is run of a block for a shell: the command line, and files that are written for it. Other programs have tests
/// of their own.
pub fn own(block: &str) -> String {
    let mut script = String::new();
    let (mut file, mut goes_on) = (false, false);
    for line in block.lines() {
        let line = line.replace("cargo run --release -- ", "hamel ");
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

/// A directive: its name, and what follows its colon.
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

/// The section of a page below the heading that names a word first: `### `param``.
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
