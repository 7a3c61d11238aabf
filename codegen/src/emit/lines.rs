//! The generated text without the short lines in it, which `syn` would take most of the time for.
//!
//! Most lines are short statements that already look as the printer would leave them, guards,
//! results in one line, and documentation with other attributes. Runs of these are taken out while the
//! rest is parsed; they are parsed by [`plain`], and laid out by `format`.

use super::plain;
use std::fmt;

/// The longest line of the printer.
pub const WIDTH: usize = 89;
/// How far statements of a method are set in.
const INDENT: usize = 8;
/// Longer statements may be broken by the printer.
const SHORT: usize = WIDTH - INDENT - 1;
/// What a run of statements leaves behind, up to its number; the printer keeps it as it is.
const STATEMENT: (&str, &str) = ("let hamel_line_", ";");
/// What a run of attributes leaves behind.
const ATTRIBUTE: (&str, &str) = ("#[hamel_line_", "]");

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

/// A line whose layout is known.
pub enum Line<'a> {
    /// It stays.
    Plain(&'a str),
    /// A condition with one statement.
    Guard(&'a str, &'a str),
    /// What stands before a list, the list, what stands behind it.
    List(&'a str, &'a str, &'a str),
    /// The same, of an attribute.
    Attribute(&'a str, &'a str, &'a str),
    /// Documentation.
    Docs(&'a str),
}

impl Line<'_> {
    /// What a run of such lines leaves behind.
    fn mark(&self) -> (&'static str, &'static str) {
        match self {
            Line::Plain(_) | Line::Guard(..) | Line::List(..) => STATEMENT,
            Line::Attribute(..) | Line::Docs(_) => ATTRIBUTE,
        }
    }
}

/// The number of the run that left a line behind.
pub fn run(line: &str) -> Option<usize> {
    [STATEMENT, ATTRIBUTE].iter().find_map(|(before, after)| {
        let number = line.strip_prefix(before)?.strip_suffix(after)?;
        number.parse().ok()
    })
}

/// A text in two parts, both parsed.
pub struct Skeleton<'a> {
    /// The text with a mark in the place of each run.
    pub file: syn::File,
    /// The runs that were taken out.
    pub taken: Vec<Vec<Line<'a>>>,
}

/// Parses a text.
///
/// # Errors
/// Where it is no Rust.
pub fn skeleton(text: &str) -> Result<Skeleton<'_>, NotRust> {
    let mut taken = Vec::new();
    let mut rest = String::with_capacity(text.len() / 2);
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let Some(first) = line_of(line, lines.peek()) else {
            rest.push_str(line);
            rest.push('\n');
            continue;
        };
        let mark = first.mark();
        rest.push_str(&format!("{}{}{}\n", mark.0, taken.len(), mark.1));
        let mut run = vec![first];
        while let Some(&line) = lines.peek() {
            let mut after = lines.clone();
            after.next();
            let next = line_of(line, after.peek());
            let Some(next) = next.filter(|next| next.mark() == mark) else {
                break;
            };
            run.push(next);
            lines.next();
        }
        taken.push(run);
    }
    match syn::parse_file(&rest) {
        Ok(file) => Ok(Skeleton { file, taken }),
        Err(error) => Err(NotRust {
            why: error.to_string(),
            line: place(&error, &rest),
        }),
    }
}

/// The line of an error, where places are known.
#[cfg(feature = "files")]
fn place(error: &syn::Error, text: &str) -> Option<String> {
    let line = error.span().start().line;
    text.lines().nth(line.checked_sub(1)?).map(str::to_string)
}

#[cfg(not(feature = "files"))]
fn place(_: &syn::Error, _: &str) -> Option<String> {
    None
}

/// How a line is laid out, where that is known without `syn`; `next` is the line behind it.
fn line_of<'a>(line: &'a str, next: Option<&&str>) -> Option<Line<'a>> {
    if is_plain(line) {
        return plain::is_statement(line).then_some(Line::Plain(line));
    }
    if let Some(text) = line.strip_prefix("///") {
        return (!text.starts_with('/') && !text.contains('\r')).then_some(Line::Docs(line));
    }
    if line.starts_with("#[") {
        return attribute(line);
    }
    if let Some((condition, rest)) = line.split_once(" { ")
        && condition.starts_with("if !")
        && is_simple(condition)
        && condition.len() + 2 <= SHORT
        && let Some(statement) = rest.strip_suffix(" }")
        && statement.starts_with("return ::core::result::Result::Err(")
        && statement.ends_with(");")
        && statement.len() + 4 <= SHORT
    {
        return plain::is_statement(line).then_some(Line::Guard(condition, statement));
    }
    // A value ends its function.
    if !next.is_some_and(|next| next.starts_with('}')) {
        return None;
    }
    if line.len() <= SHORT && is_simple(line) && plain::is_sum(line) {
        return Some(Line::Plain(line));
    }
    for (before, after) in [("[", "]"), ("::core::result::Result::Ok([", "])")] {
        if let Some(list) = line.strip_prefix(before)
            && let Some(list) = list.strip_suffix(after)
            && !list.is_empty()
            && entries(list).all(|entry| match row(entry) {
                Some(row) => entries(row).all(is_entry),
                None => is_entry(entry),
            })
        {
            return plain::is_value(line).then_some(Line::List(before, list, after));
        }
    }
    None
}

/// An attribute: a name, or a name with a list of names and of `name = "text"`.
fn attribute(line: &str) -> Option<Line<'_>> {
    if !plain::is_attribute(line) {
        return None;
    }
    let (before, list, after) = match line.split_once('(') {
        Some((before, list)) => (&line[..=before.len()], list.strip_suffix(")]")?, ")]"),
        None => (line, "", ""),
    };
    Some(Line::Attribute(before, list, after))
}

/// The entries of a list, rows and texts in quotes whole.
pub fn entries(list: &str) -> impl Iterator<Item = &str> {
    let mut depth = 0_i32;
    let mut quoted = false;
    let mut after_comma = false;
    let parts = list.split(move |c: char| {
        quoted ^= c == '"';
        let ends = c == ',' && depth == 0 && !quoted;
        depth += i32::from(matches!(c, '[' | '(')) - i32::from(matches!(c, ']' | ')'));
        ends
    });
    parts.map(move |part| {
        let entry = if after_comma {
            part.strip_prefix(' ').unwrap_or(part)
        } else {
            part
        };
        after_comma = true;
        entry
    })
}

/// What stands in an entry that is a row: one bracket on either side is its own, `k[15]` at its end is not.
pub fn row(entry: &str) -> Option<&str> {
    entry.strip_prefix('[')?.strip_suffix(']')
}

/// Whether a line is one short statement in which there is nothing to lay out.
fn is_plain(line: &str) -> bool {
    line.len() <= SHORT && line.strip_suffix(';').is_some_and(is_simple)
}

/// Whether an entry of a list is a value; lists of numbers are laid out in another way.
fn is_entry(text: &str) -> bool {
    text.len() <= SHORT / 2
        && text.starts_with(|c: char| c.is_ascii_alphabetic() || matches!(c, '-' | '_'))
        && is_simple(text)
}

/// Whether there is nothing in an expression that is laid out: no blocks, lists, or operators of types.
fn is_simple(text: &str) -> bool {
    let mut previous = b' ';
    text.bytes().all(|byte| {
        let index =
            byte != b'[' || previous.is_ascii_alphanumeric() || matches!(previous, b'_' | b']');
        previous = byte;
        index && !matches!(byte, b'{' | b'}' | b'|' | b'#' | b'"' | b';')
    })
}
