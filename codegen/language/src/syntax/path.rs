//! Names with indices and parts, as they are written: `left.knee`, `link[i-1]`, `leg[3].j[2]_dot`.
//!
//! A suffix after the index of a joint names one of its coordinates or velocities: just as `j_dot` is the velocity of
//! `j`, `j[2]_dot` is the velocity of `j[2]`.

use proc_macro2::{Delimiter, TokenStream};

use super::ast::{Expr, ExprKind, Ident, Span};
use super::cursor::{Cursor, Parsed};
use super::expression::{expression as value, indices};
use super::tokens::{Kind, of_stream};
use super::written::written;
use crate::diagnostics::Diagnostic;

/// One component of a name.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A word.
    Name(String),
    /// `[i]`, `[i, j]`
    Index(Vec<Expr>),
    /// Suffix after an index: `_dot`.
    Ending(String),
}

/// Parses a name that a statement declares: `link`, `link[i]`.
pub(super) fn declared(cursor: &mut Cursor<'_>, of: &str) -> Parsed<Ident> {
    let mut name = cursor.name(of)?;
    index(cursor, &mut name)?;
    Ok(name)
}

/// Parses a name that is declared elsewhere: `left.knee`, `leg[3].foot`.
pub(super) fn path(cursor: &mut Cursor<'_>, of: &str) -> Parsed<Ident> {
    let mut name = cursor.name(of)?;
    while index(cursor, &mut name)? || part(cursor, &mut name)? {}
    Ok(name)
}

/// Parses an index and the suffix after it, if an index is next, and appends them to `name`.
fn index(cursor: &mut Cursor<'_>, name: &mut Ident) -> Parsed<bool> {
    if !cursor.is_open(Delimiter::Bracket) {
        return Ok(false);
    }
    for index in indices(cursor)?.entries {
        check(&index)?;
        let first = !name.name.ends_with(',');
        name.name.push_str(if first { "[" } else { "" });
        name.name.push_str(&spelled(&index));
        name.name.push(',');
    }
    name.name.pop();
    name.name.push(']');
    if let Some(ending) = cursor.ending() {
        name.name.push_str(ending);
    }
    name.span = name.span.to(cursor.before());
    Ok(true)
}

fn part(cursor: &mut Cursor<'_>, name: &mut Ident) -> Parsed<bool> {
    if !cursor.is_punct('.') || cursor.is_followed_by(&['.'], &[]) {
        return Ok(false);
    }
    cursor.eat_punct('.');
    let part = cursor.word("the name of a part")?;
    name.name = format!("{}.{}", name.name, part.name);
    name.span = name.span.to(part.span);
    Ok(true)
}

/// Returns the spelling of an expression within a name, which has no blanks.
fn spelled(expr: &Expr) -> String {
    written(expr).replace(' ', "")
}

/// Refuses an index of a name unless it consists of names, numbers and operators.
fn check(index: &Expr) -> Parsed<()> {
    match &index.kind {
        ExprKind::Number(_) | ExprKind::Name(_) | ExprKind::Neg(_) | ExprKind::Binary(..) => {
            index.parts().into_iter().try_for_each(check)
        }
        _ => Err(Diagnostic::new(index.span, "this cannot be part of an index of a name")
            .help("an index is made of counters of `for`, constants and whole numbers, as in `link[i - 1]`")),
    }
}

/// Returns the expression as a name with indices and parts, if it is one.
pub fn of_expression(expr: &Expr) -> Option<Ident> {
    let named = match &expr.kind {
        ExprKind::Name(_) => true,
        ExprKind::Field(base, _) => of_expression(base).is_some(),
        ExprKind::Index(base, list) => {
            of_expression(base).is_some() && list.iter().all(|index| check(index).is_ok())
        }
        _ => false,
    };
    let (name, span) = (spelled(expr), expr.span);
    named.then_some(Ident { name, span })
}

/// Normalizes the spelling of a name with indices or parts. Returns any other text unchanged.
pub fn spelling(name: &str) -> String {
    if !name.contains('[') {
        return name.to_owned();
    }
    let parsed = read(name, |cursor| path(cursor, "anything"));
    parsed.map_or_else(|| name.to_owned(), |name| name.name)
}

/// Parses a name with indices or parts as an expression. Returns `None` for a plain name and for any other text.
pub fn expression(name: &str) -> Option<Expr> {
    if !name.contains(['[', '.']) {
        return None;
    }
    let expr = read(name, value)?;
    of_expression(&expr).map(|_| expr)
}

/// Parses a whole text with `one`. Returns `None` on an error or if something is left over.
fn read<T>(text: &str, one: impl FnOnce(&mut Cursor<'_>) -> Parsed<T>) -> Option<T> {
    let mut tokens = of_stream(text.parse().ok()?).0;
    tokens
        .iter_mut()
        .for_each(|token| token.span = Span::NOWHERE);
    let mut cursor = Cursor::new(&tokens);
    let parsed = one(&mut cursor).ok()?;
    (cursor.peek().kind == Kind::End).then_some(parsed)
}

/// Splits a name into its components, each with the span of the whole name. Returns an empty list for a malformed name.
pub fn steps(name: &Ident) -> Vec<Step> {
    let plain = |text: &str| !text.contains(['[', '.']);
    if plain(&name.name) {
        return vec![Step::Name(name.name.clone())];
    }
    let Ok(stream) = name.name.parse::<TokenStream>() else {
        return Vec::new();
    };
    let mut tokens = of_stream(stream).0;
    for token in &mut tokens {
        token.span = name.span;
    }
    let mut cursor = Cursor::new(&tokens);
    let mut steps = Vec::new();
    loop {
        let token = cursor.peek();
        match token.kind {
            Kind::Word => {
                let text = token.text.clone();
                cursor.bump();
                let ending = matches!(steps.last(), Some(Step::Index(_)));
                steps.push(if ending {
                    Step::Ending(text)
                } else {
                    Step::Name(text)
                });
            }
            Kind::Open(Delimiter::Bracket, _) => {
                cursor.bump();
                let mut list = Vec::new();
                while !cursor.is_end() {
                    let Ok(index) = value(&mut cursor) else {
                        return Vec::new();
                    };
                    list.push(index);
                    if !cursor.eat_punct(',') {
                        break;
                    }
                }
                cursor.bump();
                steps.push(Step::Index(list));
            }
            Kind::Punct('.') => {
                cursor.bump();
                let Kind::Word = cursor.peek().kind else {
                    return Vec::new();
                };
                steps.push(Step::Name(cursor.bump().text.clone()));
            }
            Kind::End => return steps,
            _ => return Vec::new(),
        }
    }
}

/// Returns the plain name that generated code uses for a name with indices and parts: `leg_3_knee` for `leg[3].knee`,
/// `j_2_dot` for `j[2]_dot`. Blanks are ignored.
pub fn plain(name: &str) -> String {
    let mut plain = String::new();
    for c in name.chars().filter(|c| !c.is_whitespace()) {
        match c {
            '[' | '.' | ',' => plain.push('_'),
            ']' => {}
            c => plain.push(c),
        }
    }
    plain
}

/// Appends a suffix to an expression that is a name, as in `j[2]_dot`. `end` is the span of the suffix.
pub(super) fn with_ending(base: &Expr, ending: &str, end: Span) -> Option<Expr> {
    let name = of_expression(base)?;
    Some(Expr {
        kind: ExprKind::Name(name.name + ending),
        span: name.span.to(end),
    })
}
