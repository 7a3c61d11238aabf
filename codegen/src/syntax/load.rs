//! Forces, torques and wrenches.

use proc_macro2::Delimiter;

use super::ast::{Axes, Expr, ItemKind, Load};
use super::cursor::{Cursor, Parsed};
use super::expression::expression;

/// `force F [at p] on f in body`
pub(super) fn force(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let force = expression(cursor)?;
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

/// `on f in body`
fn applied(cursor: &mut Cursor<'_>, load: Load) -> Parsed<ItemKind> {
    cursor.expect_word("on")?;
    let frame = cursor.name("a frame")?;
    cursor.expect_word("in")?;
    for (word, axes) in [("body", Axes::Body), ("world", Axes::World)] {
        if cursor.eat_word(word) {
            return Ok(ItemKind::Load { load, frame, axes });
        }
    }
    Err(cursor.unexpected("`body` or `world`"))
}
