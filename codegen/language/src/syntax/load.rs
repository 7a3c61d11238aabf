//! Parsing of forces, torques and wrenches.

use proc_macro2::Delimiter;

use super::ast::{Components, Expr, ItemKind, Load};
use super::cursor::{Cursor, Parsed};
use super::element::ends;
use super::expression::expression;
use super::path;

/// `force F [at p] on f in body`, or `force F from p on f to q on g`
pub(super) fn force(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let force = expression(cursor)?;
    if cursor.is_word("from") {
        let (from, to) = ends(cursor)?;
        return Ok(ItemKind::Push { force, from, to });
    }
    let at = at(cursor)?;
    applied(cursor, Load::Force { force, at })
}

/// `torque t on f in body`
pub(super) fn torque(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let torque = expression(cursor)?;
    applied(cursor, Load::Torque { torque })
}

/// `wrench (F, t) [at p] on f in body`
pub(super) fn wrench(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    if !cursor.eat_open(Delimiter::Parenthesis) {
        return Err(cursor.unexpected("`(`"));
    }
    let force = expression(cursor)?;
    cursor.expect_punct(',')?;
    let torque = expression(cursor)?;
    cursor.expect_close(Delimiter::Parenthesis, false)?;
    let at = at(cursor)?;
    applied(cursor, Load::Wrench { force, torque, at })
}

fn at(cursor: &mut Cursor<'_>) -> Parsed<Option<Expr>> {
    if cursor.eat_word("at") {
        expression(cursor).map(Some)
    } else {
        Ok(None)
    }
}

/// `on f [from g] in body`
fn applied(cursor: &mut Cursor<'_>, load: Load) -> Parsed<ItemKind> {
    cursor.expect_word("on")?;
    let frame = path::path(cursor, "a frame")?;
    let from = if cursor.eat_word("from") {
        Some(path::path(cursor, "a frame")?)
    } else {
        None
    };
    cursor.expect_word("in")?;
    if !cursor.is_any_word() {
        return Err(cursor.unexpected("`body`, `world` or the name of a frame"));
    }
    let axes = if cursor.eat_word("body") {
        Components::Body
    } else if cursor.eat_word("world") {
        Components::World
    } else {
        Components::Frame(path::path(cursor, "a frame")?)
    };
    Ok(ItemKind::Load {
        load,
        frame,
        from,
        axes,
    })
}
