//! Parsing of statements that expand into others: `include`, `component`, `part` and `for`.

use proc_macro2::Delimiter;

use super::ast::{
    Argument, Component, Counter, Expr, ExprKind, Ident, Item, ItemKind, Parameter, Part, Repeat,
};
use super::blocks::{docs, since};
use super::cursor::{Cursor, MAX_ERRORS, Parsed};
use super::declaration::shape;
use super::expression::expression;
use super::path;
use super::statement::statement;
use super::table::quoted;
use super::words::form;
use crate::diagnostics::Diagnostic;

/// Parses statements up to a closing brace or the end. Faulty statements are reported and skipped.
pub(super) fn items(cursor: &mut Cursor<'_>) -> Vec<Item> {
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
            Ok(list) => items.extend(list),
            Err(error) => {
                cursor.errors.push(match form(&word.text) {
                    Some(form) if error.help.is_none() => error.help(form),
                    _ => error,
                });
                cursor.recover(mark);
            }
        }
    }
    items
}

/// `"leg.eom"`
pub(super) fn include(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let span = cursor.here();
    Ok(ItemKind::Include(quoted(cursor)?, span))
}

/// `i in 1..n { … }`
pub(super) fn repeat(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let counter = counter(cursor)?;
    let items = block(cursor, "a `for`")?;
    Ok(ItemKind::Repeat(Repeat { counter, items }))
}

/// `i in 1..n`
fn counter(cursor: &mut Cursor<'_>) -> Parsed<Counter> {
    let name = cursor.name("a counter")?;
    cursor.expect_word("in")?;
    let first = expression(cursor)?;
    const HELP: &str = "a range is written `1..n`, both ends included";
    for _ in 0..2 {
        if !cursor.eat_punct('.') {
            return Err(cursor.unexpected("`..`").help(HELP));
        }
    }
    if cursor.is_punct('=') {
        let error = Diagnostic::new(cursor.here(), "`..=` is not an operator");
        return Err(error.help(HELP));
    }
    let last = expression(cursor)?;
    Ok(Counter { name, first, last })
}

/// Parses `{ … }`, the statements of a component or a `for`.
fn block(cursor: &mut Cursor<'_>, of: &str) -> Parsed<Vec<Item>> {
    if !cursor.eat_open(Delimiter::Brace) {
        return Err(cursor.unexpected("`{`"));
    }
    let items = items(cursor);
    if cursor.errors.len() < MAX_ERRORS {
        cursor.expect_close(Delimiter::Brace, false)?;
    }
    cursor.eat_punct(';');
    for item in &items {
        let what = match item.kind {
            ItemKind::Include(..) => "an `include`",
            ItemKind::Component(_) => "a `component`",
            ItemKind::Generate(_) => "a `generate`",
            ItemKind::Time(_) => "the `time`",
            ItemKind::Gravity(_) => "`gravity`",
            _ => continue,
        };
        let message = format!("{what} cannot be inside {of}");
        let error = Diagnostic::new(item.span, message);
        cursor
            .errors
            .push(error.help("write it once, among the statements of the system"));
    }
    Ok(items)
}

/// `Leg(mount: frame, side = 1) { … }`
pub(super) fn component(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let name = cursor.name("a component")?;
    let mut parameters: Vec<Parameter> = Vec::new();
    if cursor.eat_open(Delimiter::Parenthesis) {
        while !cursor.is_end() {
            let next = parameter(cursor)?;
            let twice = parameters.iter().find(|p| p.name.name == next.name.name);
            if let Some(first) = twice {
                let message = format!("parameter `{}` is declared twice", next.name.name);
                cursor.errors.push(
                    Diagnostic::new(next.name.span, message)
                        .help("give it another name")
                        .note(first.name.span, "the first one"),
                );
            }
            parameters.push(next);
            if !cursor.eat_punct(',') {
                break;
            }
        }
        cursor.expect_close(Delimiter::Parenthesis, true)?;
    }
    let items = block(cursor, "a component")?;
    Ok(ItemKind::Component(Component {
        name,
        parameters,
        items,
    }))
}

/// Kinds of parameters, for messages.
const PARAMETERS: &str = "a parameter of a component is a frame, `mount: frame`, a value of a shape, `hip: vec3`, or any expression, `side` or `side = 1`";

/// `mount: frame`, `hip: vec3`, `side = 1`
fn parameter(cursor: &mut Cursor<'_>) -> Parsed<Parameter> {
    let name = cursor.name("a parameter")?;
    let shaped = cursor.eat_punct(':');
    let frame = shaped && cursor.eat_word("frame");
    let shape = match shaped && !frame {
        true => Some(shape(cursor).map_err(|error| error.help(PARAMETERS))?),
        false => None,
    };
    let default = match cursor.eat_punct('=') {
        true => Some(expression(cursor)?),
        false => None,
    };
    Ok(Parameter {
        name,
        frame,
        shape,
        default,
    })
}

/// `left = Leg(hip, side = -1)`, `leg[i in 1..6] = Leg(mount[i])`
pub(super) fn part(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let (name, counter) = part_name(cursor)?;
    cursor.assign()?;
    let component = cursor.name("a component")?;
    let mut arguments = Vec::new();
    if !cursor.eat_open(Delimiter::Parenthesis) {
        return Err(cursor.unexpected("`(` and the arguments of the part"));
    }
    while !cursor.is_end() {
        let name = match cursor.is_any_word() && cursor.is_followed_by(&['='], &[]) {
            true => Some(cursor.name("a parameter")?),
            false => None,
        };
        if name.is_some() {
            cursor.assign()?;
        }
        let value = expression(cursor)?;
        arguments.push(Argument { name, value });
        if !cursor.eat_punct(',') {
            break;
        }
    }
    cursor.expect_close(Delimiter::Parenthesis, true)?;
    cursor.end(false)?;
    Ok(ItemKind::Part(Part {
        name,
        counter,
        component,
        arguments,
    }))
}

/// `left`, `leg[2]`, `leg[i in 1..6]`
fn part_name(cursor: &mut Cursor<'_>) -> Parsed<(Ident, Option<Counter>)> {
    if !cursor.starts_array() {
        return Ok((path::declared(cursor, "a part")?, None));
    }
    let name = cursor.name("a part")?;
    cursor.eat_open(Delimiter::Bracket);
    let counter = counter(cursor)?;
    cursor.expect_close(Delimiter::Bracket, false)?;
    Ok((name, Some(counter)))
}

/// Returns the item of a statement that ends with its braces, or whose `;` has been parsed.
pub(super) fn ended(kind: ItemKind, start: super::ast::Span, cursor: &Cursor<'_>) -> Vec<Item> {
    let span = since(start, cursor);
    vec![Item { kind, span }]
}

/// Returns whether an expression is a name with indices or parts.
pub(super) fn is_name(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Name(_) => true,
        ExprKind::Field(base, _) | ExprKind::Index(base, _) => is_name(base),
        _ => false,
    }
}
