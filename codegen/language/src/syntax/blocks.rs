//! Parsing of braces with fields, and of doc comments.

use proc_macro2::Delimiter;

use super::ast::Span;
use super::cursor::{Cursor, MAX_ERRORS, Parsed};
use super::tokens::Kind;
use crate::diagnostics::Diagnostic;

/// Parses the fields up to the closing brace, each with `field`. Faulty fields are reported and skipped.
pub(super) fn fields(
    cursor: &mut Cursor<'_>,
    mut field: impl FnMut(&mut Cursor<'_>) -> Parsed<()>,
) -> Parsed<()> {
    while cursor.errors.len() < MAX_ERRORS {
        let mut mark = cursor.mark();
        let parsed = docs(cursor).and_then(|_| {
            mark = cursor.mark();
            if cursor.is_end() {
                Ok(false)
            } else {
                field(cursor).map(|()| true)
            }
        });
        match parsed {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => {
                cursor.errors.push(error);
                cursor.recover(mark);
            }
        }
    }
    cursor.expect_close(Delimiter::Brace, false)
}

/// Parses the doc comments at the cursor into lines.
pub(super) fn docs(cursor: &mut Cursor<'_>) -> Parsed<Vec<String>> {
    let mut lines = Vec::new();
    while cursor.is_punct('#') {
        let start = cursor.here();
        cursor.bump();
        if cursor.is_punct('!') {
            return Err(
                Diagnostic::new(start, "inner doc comments are not part of the language")
                    .help("comments are written `// …`, and docs of what follows `/// …`"),
            );
        }
        if !cursor.is_open(Delimiter::Bracket) {
            return Err(Diagnostic::new(start, "no statement begins with `#`")
                .help("a comment is written `// …`"));
        }
        let opened = cursor.eat_open(Delimiter::Bracket);
        let documents = opened && cursor.eat_word("doc") && cursor.eat_punct('=');
        let text = cursor.peek();
        if !documents || text.kind != Kind::Doc {
            return Err(Diagnostic::new(
                start.to(cursor.here()),
                "attributes are not part of the language",
            )
            .help("remove it; docs are written `/// …`"));
        }
        cursor.bump();
        cursor.expect_close(Delimiter::Bracket, false)?;
        lines.extend(
            undecorated(&text.text)
                .into_iter()
                .map(|line| line.strip_prefix(' ').unwrap_or(line).to_owned()),
        );
        if text.text.is_empty() {
            lines.push(String::new());
        }
    }
    Ok(lines)
}

/// Returns the lines of a doc comment. The stars at the line beginnings of `/** … */` are removed, since they would
/// read as list items.
fn undecorated(text: &str) -> Vec<&str> {
    let lines: Vec<&str> = text.lines().collect();
    let Some((first, rest)) = lines.split_first() else {
        return lines;
    };
    // The end of the comment is on a line of its own.
    let rest = match rest.split_last() {
        Some((last, before)) if last.trim().is_empty() => before,
        _ => rest,
    };
    let starred = |line: &&str| line.trim_start().starts_with('*');
    if rest.is_empty() || !rest.iter().all(starred) {
        return lines;
    }
    let first = Some(*first).filter(|line| !line.trim().is_empty());
    let rest = rest.iter().map(|line| &line.trim_start()[1..]);
    first.into_iter().chain(rest).collect()
}

/// Returns the region from a first token to the one before the cursor.
pub(super) fn since(start: Span, cursor: &Cursor<'_>) -> Span {
    start.to(cursor.before())
}
