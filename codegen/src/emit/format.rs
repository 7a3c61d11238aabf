//! Layout of files: the short lines are laid out as the printer would, which prints the rest.

use super::lines::{Line, NotRust, WIDTH, entries, row, run, skeleton};
use super::plain;

/// The text as it is written to files.
///
/// # Errors
/// Where it is no Rust.
pub fn formatted(text: &str) -> Result<String, NotRust> {
    let skeleton = skeleton(text)?;
    let mut whole = String::with_capacity(2 * text.len());
    for line in prettyplease::unparse(&skeleton.file).lines() {
        let statement = line.trim_start();
        match run(statement).and_then(|number| skeleton.taken.get(number)) {
            Some(run) => {
                let indent = line.len() - statement.len();
                for line in run {
                    line.write(&mut whole, indent)?;
                }
            }
            None => {
                whole.push_str(line);
                whole.push('\n');
            }
        }
    }
    Ok(whole)
}

impl Line<'_> {
    fn write(&self, text: &mut String, indent: usize) -> Result<(), NotRust> {
        match self {
            Line::Plain(line) => push(text, indent, &[line]),
            Line::Docs(line) => push(text, indent, &[line.trim_end_matches(' ')]),
            Line::Attribute(before, list, after) => {
                write_attribute(text, indent, before, list, after);
            }
            Line::Guard(condition, statement) => {
                push(text, indent, &[condition, " {"]);
                push(text, indent + 4, &[statement]);
                push(text, indent, &["}"]);
            }
            Line::List(before, list, after) => {
                let start = text.len();
                write_list(text, indent, before, list, after);
                // A list is taken apart, so what is left is parsed again.
                if !plain::is_value(&text[start..]) {
                    return Err(NotRust {
                        why: "a list was laid out wrongly".into(),
                        line: Some(format!("{before}{list}{after}")),
                    });
                }
            }
        }
        Ok(())
    }
}

/// An attribute in one line, or an entry a line.
fn write_attribute(text: &mut String, indent: usize, before: &str, list: &str, after: &str) {
    if indent + before.len() + list.len() + after.len() <= WIDTH {
        return push(text, indent, &[before, list, after]);
    }
    push(text, indent, &[before]);
    let mut rest = entries(list).peekable();
    while let Some(entry) = rest.next() {
        let comma = if rest.peek().is_some() { "," } else { "" };
        push(text, indent + 4, &[entry, comma]);
    }
    push(text, indent, &[after]);
}

/// A list in one line, or an entry a line; rows that are too long likewise.
fn write_list(text: &mut String, indent: usize, before: &str, list: &str, after: &str) {
    let width = before.len() + list.len() + after.len();
    if indent + width <= WIDTH {
        return push(text, indent, &[before, list, after]);
    }
    push(text, indent, &[before]);
    let mut rest = entries(list).peekable();
    while let Some(entry) = rest.next() {
        // The comma of the last entry is written only if the list is broken.
        let comma = usize::from(rest.peek().is_some());
        match row(entry) {
            Some(row) if indent + 4 + entry.len() + comma > WIDTH => {
                push(text, indent + 4, &["["]);
                for entry in entries(row) {
                    push(text, indent + 8, &[entry, ","]);
                }
                push(text, indent + 4, &["],"]);
            }
            _ => push(text, indent + 4, &[entry, ","]),
        }
    }
    push(text, indent, &[after]);
}

/// One line.
fn push(text: &mut String, indent: usize, parts: &[&str]) {
    text.extend(std::iter::repeat_n(' ', indent));
    parts.iter().for_each(|part| text.push_str(part));
    text.push('\n');
}
