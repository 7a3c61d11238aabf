//! A system, statement after statement.

use proc_macro2::Delimiter;

use super::MAX_ERRORS;
use super::ast::{Item, Span, System};
use super::cursor::{Cursor, Parsed, quoted};
use super::statement::statement;
use super::tokens::{Kind, Token};
use super::words::form;
use crate::diagnostics::Diagnostic;

/// The form of a description.
const SYSTEM: &str = "a description is written `system Name { … }`";

/// Parses one system, and nothing else.
pub(super) fn system(tokens: &[Token]) -> Result<System, Vec<Diagnostic>> {
    let mut cursor = Cursor::new(tokens);
    let parsed = header(&mut cursor).and_then(|mut system| {
        system.items = items(&mut cursor);
        cursor.expect_close(Delimiter::Brace, false)?;
        nothing_else(&cursor)?;
        Ok(system)
    });
    let mut errors = cursor.errors;
    match parsed {
        Ok(system) if errors.is_empty() => return Ok(system),
        Ok(_) => {}
        // With all the errors there are, the closing brace was not reached.
        Err(_) if errors.len() >= MAX_ERRORS => {}
        Err(error) => errors.push(with_form(error, SYSTEM)),
    }
    Err(errors)
}

/// Up to the opening brace.
fn header(cursor: &mut Cursor<'_>) -> Parsed<System> {
    let docs = docs(cursor)?;
    let public = cursor.eat_word("pub");
    if public && cursor.is_open(Delimiter::Parenthesis) {
        return Err(
            Diagnostic::new(cursor.here(), "a system is `pub` or private").help(
                "write `pub system Name { … }`, and restrict it with the module it stands in",
            ),
        );
    }
    cursor.expect_word("system")?;
    let name = cursor.name("the system")?;
    if !cursor.eat_open(Delimiter::Brace) {
        return Err(cursor.unexpected("`{`"));
    }
    Ok(System {
        docs,
        public,
        name,
        items: Vec::new(),
    })
}

/// The statements up to the closing brace; faulty ones are reported and left out.
fn items(cursor: &mut Cursor<'_>) -> Vec<Item> {
    let mut items = Vec::new();
    while cursor.errors.len() < MAX_ERRORS {
        let mark = cursor.mark();
        if let Err(error) = docs(cursor) {
            cursor.errors.push(error);
            cursor.recover(mark);
            continue;
        }
        if cursor.is_end() {
            break;
        }
        let mark = cursor.mark();
        let word = cursor.peek();
        match statement(cursor) {
            Ok(item) => items.push(item),
            Err(error) => {
                cursor.errors.push(match form(&word.text) {
                    Some(form) => with_form(error, form),
                    None => error,
                });
                cursor.recover(mark);
            }
        }
    }
    items
}

/// The fields up to the closing brace, each read by `field`; faulty ones are reported and left out.
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

/// The lines of the doc comments that stand here.
pub(super) fn docs(cursor: &mut Cursor<'_>) -> Parsed<Vec<String>> {
    let mut lines = Vec::new();
    while cursor.is_punct('#') {
        let start = cursor.here();
        cursor.bump();
        if cursor.is_punct('!') {
            return Err(
                Diagnostic::new(start, "a doc comment for what surrounds it")
                    .help("comments are written `// …`, and docs of what follows `/// …`"),
            );
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
            text.text
                .lines()
                .map(|line| line.strip_prefix(' ').unwrap_or(line).to_owned()),
        );
        if text.text.is_empty() {
            lines.push(String::new());
        }
    }
    Ok(lines)
}

fn nothing_else(cursor: &Cursor<'_>) -> Parsed<()> {
    if cursor.peek().kind == Kind::End {
        return Ok(());
    }
    let error = |message: String| Diagnostic::new(cursor.here(), message);
    Err(
        if cursor.is_word("system") || cursor.is_word("pub") || cursor.is_punct('#') {
            error("a second description".to_owned())
                .help("write one system a macro, and one a file")
        } else {
            error(format!(
                "expected the end of the input, found {}",
                quoted(cursor.peek())
            ))
            .help("statements stand inside of the braces of the system")
        },
    )
}

/// Adds the form of the statement to an error that has no better help.
fn with_form(error: Diagnostic, form: &str) -> Diagnostic {
    if error.help.is_some() {
        error
    } else {
        error.help(form)
    }
}

/// The region from a first token to the one before the cursor.
pub(super) fn since(start: Span, cursor: &Cursor<'_>) -> Span {
    start.to(cursor.before())
}
