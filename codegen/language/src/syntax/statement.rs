//! Parsing of statements, selected by their first word.

use super::ast::{Expr, Ident, Item, ItemKind, Span, Target, Wanted};
use super::blocks::since;
use super::cursor::{Cursor, Parsed, quoted, shown};
use super::expression::expression;
use super::suggest::closest;
use super::tokens::Kind;
use super::words::statements;
use super::{body, declaration, element, invariant, joint, load, path, reuse, table, unit};
use crate::diagnostics::Diagnostic;
use proc_macro2::Delimiter;

/// Parses one statement with its `;`. Returns one item, or one for each element of a list.
pub(super) fn statement(cursor: &mut Cursor<'_>) -> Parsed<Vec<Item>> {
    let start = cursor.here();
    let word = cursor.peek();
    if word.kind != Kind::Word {
        return Err(no_statement(cursor));
    }
    let word = word.text.as_str();
    cursor.bump();
    let kind = match word {
        "param" => ItemKind::Param(declaration::values(cursor, "a parameter")?),
        "const" => ItemKind::Const(declaration::values(cursor, "a constant")?),
        "let" => ItemKind::Let(declaration::values(cursor, "an expression")?),
        "fn" => ItemKind::Function(declaration::function(cursor)?),
        "extern" => ItemKind::External(declaration::external(cursor)?),
        "table" => ItemKind::Table(table::table(cursor)?),
        "coord" => ItemKind::Coord(declaration::coordinates(cursor)?),
        "velocity" => ItemKind::Velocity(declaration::velocities(cursor)?),
        "input" => ItemKind::Input(declaration::inputs(cursor)?),
        "state" => ItemKind::State(declaration::values(cursor, "a state")?),
        "constraint" => return list(cursor, start, constraint),
        "rate" => return list(cursor, start, rate),
        "time" => ItemKind::Time(cursor.name("the time")?),
        "prescribe" => return list(cursor, start, prescribe),
        "inactive" => ItemKind::Inactive(expressions(cursor)?),
        "independent" => ItemKind::Independent(expressions(cursor)?),
        "nonholonomic" => return list(cursor, start, nonholonomic),
        "loop" => return list(cursor, start, closed_loop),
        "generalized" => {
            cursor.expect_word("force")?;
            return list(cursor, start, generalized);
        }
        "start" => return list(cursor, start, starting),
        "output" => return list(cursor, start, output),
        "frame" => return list(cursor, start, frame),
        "include" => reuse::include(cursor)?,
        // These end with their braces, or parse their own `;`.
        "component" => {
            let kind = reuse::component(cursor)?;
            return Ok(reuse::ended(kind, start, cursor));
        }
        "for" => {
            let kind = reuse::repeat(cursor)?;
            return Ok(reuse::ended(kind, start, cursor));
        }
        "part" => {
            let kind = reuse::part(cursor)?;
            return Ok(reuse::ended(kind, start, cursor));
        }
        // This ends with its braces.
        "body" => {
            let kind = ItemKind::Body(body::body(cursor)?);
            cursor.eat_punct(';');
            let span = since(start, cursor);
            return Ok(vec![Item { kind, span }]);
        }
        // This ends with its braces, if it has any.
        "joint" => {
            let kind = ItemKind::Joint(Box::new(joint::joint(cursor)?));
            let span = since(start, cursor);
            return Ok(vec![Item { kind, span }]);
        }
        "particle" => body::particle(cursor)?,
        "kinetic" => ItemKind::Kinetic(expression(cursor)?),
        "potential" => ItemKind::Potential(expression(cursor)?),
        "gravity" => ItemKind::Gravity(expression(cursor)?),
        "force" => load::force(cursor)?,
        "torque" => load::torque(cursor)?,
        "wrench" => load::wrench(cursor)?,
        word if element::is_one(word) => element::element(word, cursor)?,
        "dissipation" => ItemKind::Dissipation(expression(cursor)?),
        "invariant" => invariant::invariant(cursor)?,
        "generate" => ItemKind::Generate(functions(cursor)?),
        _ => {
            return Err(unknown(
                cursor,
                &Ident {
                    name: word.to_owned(),
                    span: start,
                },
            ));
        }
    };
    let names = matches!(
        word,
        "coord"
            | "time"
            | "velocity"
            | "input"
            | "force"
            | "torque"
            | "wrench"
            | "generate"
            | "include"
    ) || element::is_one(word);
    cursor.end(!names)?;
    let span = since(start, cursor);
    Ok(vec![Item { kind, span }])
}

/// Parses a list such as `start a = 1, b = 2;` or `rate q = u, s = v;` into one item per element.
fn list(
    cursor: &mut Cursor<'_>,
    start: Span,
    part: fn(&mut Cursor<'_>) -> Parsed<ItemKind>,
) -> Parsed<Vec<Item>> {
    let mut items = Vec::new();
    let mut begin = start;
    loop {
        let kind = part(cursor)?;
        let span = since(begin, cursor);
        items.push(Item { kind, span });
        if !cursor.eat_punct(',') {
            break;
        }
        begin = cursor.here();
    }
    cursor.end(true)?;
    if let [one] = items.as_mut_slice() {
        one.span = since(start, cursor);
    }
    Ok(items)
}

/// Parses one or more expressions separated by commas.
fn expressions(cursor: &mut Cursor<'_>) -> Parsed<Vec<Expr>> {
    let mut list = vec![expression(cursor)?];
    while cursor.eat_punct(',') {
        list.push(expression(cursor)?);
    }
    Ok(list)
}

/// `w = [0.01, 1, 0]`, or a guess: `q ~ 1.2`
fn starting(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let target = target(cursor, "a coordinate or velocity")?;
    let guess = cursor.eat_punct('~');
    if !guess {
        cursor.assign()?;
    }
    let value = expression(cursor)?;
    Ok(match guess {
        true => ItemKind::Guess { target, value },
        false => ItemKind::Start { target, value },
    })
}

/// `a = b`
fn constraint(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let left = expression(cursor)?;
    cursor.assign()?;
    Ok(ItemKind::Constraint {
        left,
        right: expression(cursor)?,
    })
}

/// `r = R * v`
fn rate(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let target = target(cursor, "a coordinate or state")?;
    cursor.assign()?;
    Ok(ItemKind::Rate {
        target,
        value: expression(cursor)?,
    })
}

/// `q = 0.3 * sin(t)`, `rate(v) = a`
fn prescribe(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let (target, rate) = prescribed(cursor)?;
    cursor.assign()?;
    Ok(ItemKind::Prescribe {
        target,
        rate,
        value: expression(cursor)?,
    })
}

/// `a = b [stabilized λ]`, an equation between velocities
fn nonholonomic(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let (left, right, stabilized) = kept(cursor)?;
    Ok(ItemKind::Nonholonomic {
        left,
        right,
        stabilized,
    })
}

/// `a = b [stabilized λ]`, an equation between coordinates
fn closed_loop(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let (left, right, stabilized) = kept(cursor)?;
    Ok(ItemKind::Loop {
        left,
        right,
        stabilized,
    })
}

/// `w = -d * w`
fn generalized(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let target = target(cursor, "a velocity")?;
    cursor.assign()?;
    Ok(ItemKind::Generalized {
        target,
        value: expression(cursor)?,
    })
}

/// `speed = norm(v)`
fn output(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let name = path::declared(cursor, "an output")?;
    let unit = match cursor.eat_punct(':') {
        true => Some(unit::kept(cursor, &name)?),
        false => None,
    };
    cursor.assign()?;
    Ok(ItemKind::Output {
        name,
        unit,
        value: expression(cursor)?,
    })
}

/// `R`, `X.p`, `leg[3].knee`: the last word is stored as the field until names are resolved.
fn target(cursor: &mut Cursor<'_>, of: &str) -> Parsed<Target> {
    let name = path::path(cursor, of)?;
    let last = cursor.before();
    let Ident { name: text, span } = &name;
    Ok(match text.rsplit_once('.') {
        Some((before, field)) if !field.contains('[') => Target {
            name: Ident {
                name: before.to_owned(),
                span: *span,
            },
            field: Some(Ident {
                name: field.to_owned(),
                span: last,
            }),
            entry: Vec::new(),
        },
        _ => Target {
            name,
            field: None,
            entry: Vec::new(),
        },
    })
}

/// `q`, `v`, `rate(v)`
fn prescribed(cursor: &mut Cursor<'_>) -> Parsed<(Target, bool)> {
    if !cursor.is_call() || !cursor.eat_word("rate") {
        return Ok((target(cursor, "a coordinate or velocity")?, false));
    }
    cursor.eat_open(Delimiter::Parenthesis);
    let velocity = target(cursor, "a velocity")?;
    cursor.expect_close(Delimiter::Parenthesis, false)?;
    Ok((velocity, true))
}

/// `a = b [stabilized λ]`
fn kept(cursor: &mut Cursor<'_>) -> Parsed<(Expr, Expr, Option<Expr>)> {
    let left = expression(cursor)?;
    cursor.assign()?;
    let right = expression(cursor)?;
    let stabilized = if cursor.eat_word("stabilized") {
        Some(expression(cursor)?)
    } else {
        None
    };
    Ok((left, right, stabilized))
}

/// `f [on g] = pose(R, p)`, or `f [on g] at [x, y, z]`
fn frame(cursor: &mut Cursor<'_>) -> Parsed<ItemKind> {
    let name = path::declared(cursor, "a frame")?;
    let on = if cursor.eat_word("on") {
        Some(path::path(cursor, "a frame")?)
    } else {
        None
    };
    if !cursor.eat_word("at") {
        cursor.assign()?;
    }
    Ok(ItemKind::Frame {
        name,
        on,
        pose: expression(cursor)?,
    })
}

/// `generate accel, energy`
fn functions(cursor: &mut Cursor<'_>) -> Parsed<Vec<Wanted>> {
    let mut all = vec![wanted(cursor)?];
    while cursor.eat_punct(',') {
        all.push(wanted(cursor)?);
    }
    Ok(all)
}

/// `accel`, `jacobian tip in world`
fn wanted(cursor: &mut Cursor<'_>) -> Parsed<Wanted> {
    let function = function(cursor)?;
    if function.name != "jacobian" || cursor.is_punct(',') || cursor.is_punct(';') {
        return Ok(Wanted::Function(function));
    }
    let frame = path::path(cursor, "a frame")?;
    let axes = match cursor.eat_word("in") {
        true => Some(path::path(cursor, "a frame")?),
        false => None,
    };
    Ok(Wanted::Jacobian { frame, axes })
}

/// `energy`, `leg[3].reach`
fn function(cursor: &mut Cursor<'_>) -> Parsed<Ident> {
    match cursor.is_followed_by(&['.'], &[]) || cursor.is_indexed() {
        true => path::path(cursor, "a function"),
        false => cursor.word("the name of a function"),
    }
}

fn no_statement(cursor: &Cursor<'_>) -> Diagnostic {
    let here = cursor.here();
    if cursor.is_punct(';') {
        return Diagnostic::new(here, "a `;` without a statement").help("remove it");
    }
    Diagnostic::new(
        here,
        format!("expected a statement, found {}", quoted(cursor.peek())),
    )
    .help(known())
}

fn unknown(cursor: &Cursor<'_>, word: &Ident) -> Diagnostic {
    let name = shown(&word.name);
    if word.name == "system" {
        return Diagnostic::new(word.span, "a `system` inside another")
            .help("write what a system has several of as a `component`, with a `part` for each");
    }
    if let Some(close) = closest(&word.name, statements()) {
        return Diagnostic::new(word.span, format!("unknown statement `{name}`"))
            .help(format!("did you mean `{close}`?"));
    }
    if cursor.is_punct('=') || cursor.is_punct(':') {
        return Diagnostic::new(word.span, format!("`{name}` is declared without a keyword"))
            .help("start with `param`, `const` or `let`, or say what moves with `rate`");
    }
    Diagnostic::new(word.span, format!("unknown statement `{name}`")).help(known())
}

/// Lists the existing statements, for messages.
fn known() -> String {
    let words: Vec<String> = statements().map(|word| format!("`{word}`")).collect();
    format!("the statements are {}", words.join(", "))
}
