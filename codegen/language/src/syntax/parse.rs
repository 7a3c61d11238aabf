//! Parsing of a system, statement after statement.

use super::ast::{Item, Origins, Remarks, System};
use super::blocks::docs;
use super::cursor::{Cursor, MAX_ERRORS, Parsed, quoted};
use super::reuse::items;
use super::tokens::{Kind, Token};
use crate::diagnostics::Diagnostic;
use proc_macro2::Delimiter;

/// Syntax of a description, for messages.
const SYSTEM: &str = "a description is written `system Name { … }`";

/// Parses exactly one system.
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
        // If the largest number of errors was reached, the closing brace was not.
        Err(_) if errors.len() >= MAX_ERRORS => {}
        Err(error) => errors.push(with_form(error, SYSTEM)),
    }
    Err(errors)
}

/// Parses everything up to the opening brace.
fn header(cursor: &mut Cursor<'_>) -> Parsed<System> {
    let docs = docs(cursor)?;
    let public = cursor.eat_word("pub");
    if public && cursor.is_open(Delimiter::Parenthesis) {
        return Err(
            Diagnostic::new(cursor.here(), "a system is `pub` or private")
                .help("write `pub system Name { … }`, and restrict it by its enclosing module"),
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
        origins: Origins::default(),
        remarks: Remarks::default(),
        shows_frames: false,
        starts_anywhere: false,
    })
}

fn nothing_else(cursor: &Cursor<'_>) -> Parsed<()> {
    if cursor.peek().kind == Kind::End {
        return Ok(());
    }
    let error = |message: String| Diagnostic::new(cursor.here(), message);
    Err(
        if cursor.is_word("system") || cursor.is_word("pub") || cursor.is_punct('#') {
            error("there is more than one description".to_owned())
                .help("write one system per macro, and one per file")
        } else {
            error(format!(
                "expected the end of the input, found {}",
                quoted(cursor.peek())
            ))
            .help("write statements inside the braces of the system")
        },
    )
}

/// Adds the syntax of the statement to an error that has no better help.
fn with_form(error: Diagnostic, form: &str) -> Diagnostic {
    if error.help.is_some() {
        error
    } else {
        error.help(form)
    }
}

/// Parses statements without a system around them, as in an included text.
pub(super) fn statements(tokens: &[Token]) -> Result<Vec<Item>, Vec<Diagnostic>> {
    let mut cursor = Cursor::new(tokens);
    if cursor.is_word("system") || cursor.is_word("pub") {
        let error = Diagnostic::new(cursor.here(), "an included file is a whole description");
        return Err(vec![error.help(
            "an included file has only statements: remove `system … {` and its `}`",
        )]);
    }
    let items = items(&mut cursor);
    match cursor.errors.is_empty() {
        true => Ok(items),
        false => Err(cursor.errors),
    }
}
