//! Parsing of tables of values: `table thrust = [(0, 0), (0.2, 1.1)] linear extrapolate hold;`.

use super::ast::{Between, Beyond, Expr, Source, Span, Table};
use super::cursor::{Cursor, Parsed};
use super::expression::expression;
use super::tokens::Kind;
use crate::diagnostics::Diagnostic;
use proc_macro2::{Delimiter, Literal, TokenStream};

/// Parses what follows `table`.
pub(super) fn table(cursor: &mut Cursor<'_>) -> Parsed<Table> {
    let name = cursor.name("a table")?;
    let source = match cursor.eat_word("from") {
        true => file(cursor)?,
        false => points(cursor)?,
    };
    let between = one_of(cursor, &Between::ALL.map(Between::word))?;
    cursor.expect_word("extrapolate")?;
    let beyond = one_of(cursor, &Beyond::ALL.map(Beyond::word))?;
    Ok(Table {
        name,
        source,
        between: Between::ALL[between],
        beyond: Beyond::ALL[beyond],
    })
}

/// `= [(a, b), …]`
fn points(cursor: &mut Cursor<'_>) -> Parsed<Source> {
    cursor.assign()?;
    let start = cursor.here();
    if !cursor.eat_open(Delimiter::Bracket) {
        return Err(cursor.unexpected("`[` and the points of the table"));
    }
    let mut points = Vec::new();
    while !cursor.is_end() {
        points.push(point(cursor)?);
        if !cursor.eat_punct(',') {
            break;
        }
    }
    cursor.expect_close(Delimiter::Bracket, true)?;
    Ok(Source::Points(points, start.to(cursor.before())))
}

/// `(a, b)`
fn point(cursor: &mut Cursor<'_>) -> Parsed<(Expr, Expr)> {
    const HELP: &str = "a point of a table is written `(argument, value)`";
    if !cursor.eat_open(Delimiter::Parenthesis) {
        return Err(cursor.unexpected("`(`").help(HELP));
    }
    let argument = expression(cursor)?;
    if !cursor.eat_punct(',') {
        return Err(cursor.unexpected("`,`").help(HELP));
    }
    let value = expression(cursor)?;
    if cursor.is_punct(',') {
        return Err(cursor.unexpected("`)`").help(HELP));
    }
    cursor.expect_close(Delimiter::Parenthesis, false)?;
    Ok((argument, value))
}

/// `"file.csv"`
fn file(cursor: &mut Cursor<'_>) -> Parsed<Source> {
    let span = cursor.here();
    Ok(Source::File(quoted(cursor)?, span))
}

/// Parses a file name in quotes.
pub(super) fn quoted(cursor: &mut Cursor<'_>) -> Parsed<String> {
    let token = cursor.peek();
    let literal = (token.kind == Kind::Literal).then(|| token.text.parse::<Literal>().ok());
    let text = literal.flatten().and_then(|literal| {
        let tokens = TokenStream::from(proc_macro2::TokenTree::Literal(literal));
        syn::parse2::<syn::LitStr>(tokens).ok()
    });
    let Some(text) = text else {
        return Err(cursor.unexpected("the name of a file in quotes"));
    };
    cursor.bump();
    Ok(text.value())
}

/// Parses one of the words in a list and returns its index.
fn one_of(cursor: &mut Cursor<'_>, words: &[&str]) -> Parsed<usize> {
    match words.iter().position(|word| cursor.eat_word(word)) {
        Some(place) => Ok(place),
        None => {
            let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
            let expected = match quoted.split_last() {
                Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
                _ => quoted.concat(),
            };
            Err(cursor.unexpected(&expected))
        }
    }
}

/// Reads the points of a table from a text, with one pair of numbers per line. All points get the span of the file's
/// name. Skips empty lines, lines that begin with `#`, and a first line of column names.
pub(super) fn read(text: &str, name: &str, span: Span) -> Parsed<Vec<(Expr, Expr)>> {
    let mut points = Vec::new();
    let mut first = true;
    for (line, text) in (1..).zip(text.lines()) {
        let text = text.trim();
        if text.is_empty() || text.starts_with('#') {
            continue;
        }
        let separators = |c: char| c == ',' || c == ';' || c.is_whitespace();
        let entries = text.split(separators).filter(|entry| !entry.is_empty());
        let entries: Vec<Option<Expr>> = entries.map(|entry| signed(entry, span)).collect();
        match &entries[..] {
            [Some(argument), Some(value)] => points.push((argument.clone(), value.clone())),
            _ if first && entries.iter().all(Option::is_none) => {}
            _ => {
                let message = format!("line {line} of `{name}` is not a pair of numbers");
                return Err(Diagnostic::new(span, message)
                    .help("a line of a table has an argument and a value, as in `0.2, 1.1`"));
            }
        }
        first = false;
    }
    Ok(points)
}

/// Parses a decimal number with an optional sign.
fn signed(text: &str, span: Span) -> Option<Expr> {
    use super::ast::ExprKind;
    let (negative, digits) = match text.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let number = super::number::value(digits, digits).ok()?;
    let kind = ExprKind::Number(number.into());
    let number = Expr { kind, span };
    Some(match negative {
        false => number,
        true => Expr {
            kind: ExprKind::Neg(Box::new(number)),
            span,
        },
    })
}
