//! Parsing of `invariant` statements, which claim that a quantity is constant along the motion.

use super::ast::{Condition, Conserved, Ident, ItemKind};
use super::cursor::{Cursor, Parsed};
use super::expression::expression;
use super::path;
use super::reuse::is_name;
use crate::diagnostics::Diagnostic;

/// Conserved quantities that have a keyword.
const BUILT_IN: [&str; 3] = ["energy", "linear_momentum", "angular_momentum"];
/// Words that may follow such a keyword.
const DETAILS: [&str; 4] = ["of", "about", "along", "when"];

/// `[name =] energy | linear_momentum … | angular_momentum … | expr [when F = 0, tau = 0]`
pub(super) fn invariant(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let (name, conserved) = if is_built_in(cursor) {
        let name = Ident {
            name: cursor.peek().text.clone(),
            span: cursor.here(),
        };
        (name, built_in(cursor)?)
    } else {
        let name = path::declared(cursor, "an invariant")?;
        cursor.assign()?;
        let conserved = if is_built_in(cursor) {
            built_in(cursor)?
        } else {
            Conserved::Value(expression(cursor)?)
        };
        (name, conserved)
    };
    let mut when = Vec::new();
    if cursor.eat_word("when") {
        when.push(condition(cursor)?);
        while cursor.eat_punct(',') {
            when.push(condition(cursor)?);
        }
    }
    Ok(ItemKind::Invariant {
        name,
        conserved,
        when,
    })
}

/// Returns whether a built-in quantity is next, rather than an expression that starts with its name.
fn is_built_in(cursor: &Cursor<'_>) -> bool {
    BUILT_IN.iter().any(|word| cursor.is_word(word)) && cursor.is_followed_by(&[';'], &DETAILS)
}

fn built_in(cursor: &mut Cursor<'_>) -> Parsed<Conserved> {
    let word = cursor.bump().text.as_str();
    if word == "energy" {
        return Ok(Conserved::Energy);
    }
    let of = if cursor.eat_word("of") {
        Some(path::path(cursor, "a frame")?)
    } else {
        None
    };
    if word == "linear_momentum" {
        let along = after(cursor, "along")?;
        return Ok(Conserved::LinearMomentum { of, along });
    }
    let about = after(cursor, "about")?;
    let along = after(cursor, "along")?;
    Ok(Conserved::AngularMomentum { of, about, along })
}

/// Parses the expression after a keyword, if the keyword is next.
fn after(cursor: &mut Cursor<'_>, word: &str) -> Parsed<Option<super::ast::Expr>> {
    if cursor.eat_word(word) {
        expression(cursor).map(Some)
    } else {
        Ok(None)
    }
}

/// `F = 0`, `s[1] = 0`
fn condition(cursor: &mut Cursor<'_>) -> Parsed<Condition> {
    let target = expression(cursor)?;
    if !is_name(&target) {
        return Err(Diagnostic::new(
            target.span,
            "a claim can set only inputs and parameters, or entries of them",
        )
        .help("write `when F = 0` or `when s[1] = 0`"));
    }
    cursor.assign()?;
    Ok(Condition {
        target,
        value: expression(cursor)?,
    })
}
