//! Parsing of springs, cables, dampers and inerters, and of the two points that they act between.

use super::ast::{Acting, End, ItemKind};
use super::cursor::{Cursor, Parsed};
use super::expression::expression;
use super::path;

/// First words of these statements.
const WORDS: [&str; 4] = ["spring", "cable", "damper", "inerter"];

/// Returns whether a word starts one of these statements.
pub(super) fn is_one(word: &str) -> bool {
    WORDS.contains(&word)
}

/// Parses the rest of a statement after its first word.
pub(super) fn element(word: &str, cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    match word {
        "spring" => spring(cursor),
        "cable" => cable(cursor),
        "damper" => damper(cursor),
        _ => inerter(cursor),
    }
}

/// `stiffness k [length l] from … to …`, or `… on q2 - q1`
fn spring(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    cursor.expect_word("stiffness")?;
    let stiffness = expression(cursor)?;
    let length = if cursor.eat_word("length") {
        Some(expression(cursor)?)
    } else {
        None
    };
    Ok(ItemKind::Spring {
        stiffness,
        length,
        acting: acting(cursor)?,
    })
}

/// `stiffness k length l from … to …`
fn cable(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    cursor.expect_word("stiffness")?;
    let stiffness = expression(cursor)?;
    cursor.expect_word("length")?;
    let length = expression(cursor)?;
    let (from, to) = ends(cursor)?;
    Ok(ItemKind::Cable {
        stiffness,
        length,
        from,
        to,
    })
}

/// `coefficient c from … to …`, or `… on w2 - w1`
fn damper(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    cursor.expect_word("coefficient")?;
    let coefficient = expression(cursor)?;
    Ok(ItemKind::Damper {
        coefficient,
        acting: acting(cursor)?,
    })
}

/// `inertance b from … to …`, or `… on w2 - w1`
fn inerter(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    cursor.expect_word("inertance")?;
    let inertance = expression(cursor)?;
    Ok(ItemKind::Inerter {
        inertance,
        acting: acting(cursor)?,
    })
}

fn acting(cursor: &mut Cursor<'_>) -> Parsed<Acting> {
    if cursor.eat_word("on") {
        return Ok(Acting::On(expression(cursor)?));
    }
    if !cursor.is_word("from") {
        return Err(cursor.unexpected("`from` and two points, or `on` and a scalar"));
    }
    let (from, to) = ends(cursor)?;
    Ok(Acting::Between(from, to))
}

/// `from [p on] f to [q on] g`
pub(super) fn ends(cursor: &mut Cursor<'_>) -> Parsed<(End, End)> {
    cursor.expect_word("from")?;
    let from = end(cursor)?;
    cursor.expect_word("to")?;
    Ok((from, end(cursor)?))
}

fn end(cursor: &mut Cursor<'_>) -> Parsed<End> {
    let point = expression(cursor)?;
    if cursor.eat_word("on") {
        return Ok(End {
            at: Some(point),
            frame: path::path(cursor, "a frame")?,
        });
    }
    match path::of_expression(&point) {
        Some(frame) => Ok(End { at: None, frame }),
        None => Err(cursor.unexpected("`on` and the frame of this point")),
    }
}
