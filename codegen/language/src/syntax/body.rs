//! Parsing of bodies and particles.

use proc_macro2::Delimiter;

use super::ast::{About, Body, ItemKind, Span};
use super::blocks::fields;
use super::cursor::{Cursor, Parsed, quoted, shown};
use super::expression::expression;
use super::path;
use super::suggest::closest;
use crate::diagnostics::Diagnostic;

/// Fields of a body, each with a sentence that shows its syntax.
const FIELDS: [(&str, &str); 3] = [
    ("mass", "a mass is written `mass m;`"),
    ("com", "a centre of mass is written `com [0, 0, l];`"),
    (
        "inertia",
        "an inertia is written `inertia J about com;` or `about origin;`",
    ),
];

/// Returns the fields of a body, each with a sentence that shows its syntax.
pub(crate) fn fields_of() -> impl Iterator<Item = (&'static str, &'static str)> {
    FIELDS.into_iter()
}

/// `particle mass m at p [on f]`
pub(super) fn particle(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    cursor.expect_word("mass")?;
    let mass = expression(cursor)?;
    cursor.expect_word("at")?;
    let at = expression(cursor)?;
    let on = if cursor.eat_word("on") {
        Some(path::path(cursor, "a frame")?)
    } else {
        None
    };
    Ok(ItemKind::Particle { mass, at, on })
}

/// `on f { mass m; com s; inertia J about origin; }`, with the fields in any order and each at most once.
pub(super) fn body(cursor: &mut Cursor<'_>) -> Parsed<Body> {
    cursor.expect_word("on")?;
    let frame = path::path(cursor, "a frame")?;
    if !cursor.eat_open(Delimiter::Brace) {
        return Err(cursor.unexpected("`{`"));
    }
    let mut given = Fields {
        body: Body {
            frame,
            mass: None,
            com: None,
            inertia: None,
        },
        seen: [None; 3],
    };
    fields(cursor, |cursor| given.parse(cursor))?;
    Ok(given.body)
}

/// A body whose fields are being parsed.
struct Fields {
    body: Body,
    /// Span of each field of [`FIELDS`] that has been given.
    seen: [Option<Span>; 3],
}

impl Fields {
    fn parse(&mut self, cursor: &mut Cursor<'_>) -> Parsed<()> {
        let word = cursor.peek();
        let span = cursor.here();
        let Some(index) = FIELDS.iter().position(|(field, _)| cursor.is_word(field)) else {
            return Err(unknown(cursor));
        };
        cursor.bump();
        let (name, form) = FIELDS[index];
        self.value(name, cursor)
            .and_then(|()| cursor.end(true))
            .map_err(|error| {
                if error.help.is_some() {
                    error
                } else {
                    error.help(form)
                }
            })?;
        if let Some(first) = self.seen[index].replace(span) {
            return Err(Diagnostic::new(
                span,
                format!("`{}` is given twice for one body", word.text),
            )
            .help("remove one of them; one frame may carry several bodies")
            .note(first, "first given here"));
        }
        Ok(())
    }

    fn value(&mut self, name: &str, cursor: &mut Cursor<'_>) -> Parsed<()> {
        let value = expression(cursor)?;
        match name {
            "mass" => self.body.mass = Some(value),
            "com" => self.body.com = Some(value),
            _ => {
                let about = if cursor.eat_word("about") {
                    Some(about(cursor)?)
                } else {
                    None
                };
                self.body.inertia = Some((value, about));
            }
        }
        Ok(())
    }
}

fn about(cursor: &mut Cursor<'_>) -> Parsed<About> {
    for (word, about) in [("com", About::Com), ("origin", About::Origin)] {
        if cursor.eat_word(word) {
            return Ok(about);
        }
    }
    Err(cursor.unexpected("`com` or `origin`"))
}

fn unknown(cursor: &Cursor<'_>) -> Diagnostic {
    const KNOWN: &str = "a body has `mass`, `com` and `inertia`";
    let found = cursor.peek();
    if cursor.is_punct(';') {
        return Diagnostic::new(cursor.here(), "a `;` without a statement").help("remove it");
    }
    if !cursor.is_any_word() {
        return Diagnostic::new(
            cursor.here(),
            format!("expected a property of the body, found {}", quoted(found)),
        )
        .help(KNOWN);
    }
    let error = Diagnostic::new(
        cursor.here(),
        format!("a body has no `{}`", shown(&found.text)),
    );
    match closest(&found.text, FIELDS.map(|(field, _)| field)) {
        Some(close) => error.help(format!("did you mean `{close}`?")),
        None => error.help(KNOWN),
    }
}
