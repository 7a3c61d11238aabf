//! Parsing of statements that declare names: parameters, coordinates, velocities, inputs.

use super::ast::{CoordKind, Declaration, External, Function, Ident, Shape, ShapeKind, Span};
use super::cursor::{Cursor, Parsed, shown};
use super::expression::expression;
use super::path;
use super::tokens::Kind;
use super::unit;
use crate::diagnostics::Diagnostic;
use crate::units::Unit;
use proc_macro2::Delimiter;

/// Largest size of a vector, matrix or Euclidean coordinate.
const MAX_SIZE: usize = 64;

/// `m = 1.3, s: vec3 = [0, 0, 1]`
pub(super) fn values(cursor: &mut Cursor<'_>, of: &str) -> Parsed<Vec<Declaration>> {
    separated(cursor, |cursor| {
        let any = matches!(of, "a parameter" | "a constant");
        let (name, shape, unit) = head(cursor, of, any)?;
        cursor.assign()?;
        let mut declaration = Declaration {
            name,
            shape,
            unit,
            value: Some(expression(cursor)?),
        };
        unit::converted(&mut declaration)?;
        Ok(declaration)
    })
}

/// `v: vec3, u`, each with a row of Y if rates define the velocity: `w = q.c * rate(q.s)`
pub(super) fn velocities(cursor: &mut Cursor<'_>) -> Parsed<Vec<Declaration>> {
    separated(cursor, |cursor| {
        let (name, shape, unit) = head(cursor, "a velocity", false)?;
        let value = match cursor.eat_punct('=') {
            true => Some(expression(cursor)?),
            false => None,
        };
        Ok(Declaration {
            name,
            shape,
            unit,
            value,
        })
    })
}

/// `F: vec3, u`
pub(super) fn inputs(cursor: &mut Cursor<'_>) -> Parsed<Vec<Declaration>> {
    const HELP: &str = "inputs are given at run time; a fixed value is a `param`";
    separated(cursor, |cursor| without_value(cursor, "an input", HELP))
}

fn without_value(cursor: &mut Cursor<'_>, of: &str, help: &str) -> Parsed<Declaration> {
    let (name, shape, unit) = head(cursor, of, false)?;
    if cursor.is_punct('=') {
        return Err(
            Diagnostic::new(cursor.here(), format!("{of} is declared without a value")).help(help),
        );
    }
    Ok(Declaration {
        name,
        shape,
        unit,
        value: None,
    })
}

/// `r: R3, R: SO3, q`
pub(super) fn coordinates(
    cursor: &mut Cursor<'_>,
) -> Parsed<Vec<(Ident, CoordKind, Option<Unit>)>> {
    separated(cursor, |cursor| {
        let name = path::declared(cursor, "a coordinate")?;
        let annotated = cursor.eat_punct(':');
        let kind = match annotated && !cursor.is_open(Delimiter::Bracket) {
            true => coordinate_kind(cursor)?,
            false => CoordKind::Real,
        };
        let unit = match annotated && cursor.is_open(Delimiter::Bracket) {
            true => Some(unit::kept(cursor, &name)?),
            false => None,
        };
        if cursor.is_punct('=') {
            return Err(
                Diagnostic::new(cursor.here(), "a coordinate is declared without a value")
                    .help("an initial value is written `start r = [0, 0, 1];`"),
            );
        }
        Ok((name, kind, unit))
    })
}

/// `drag(v: vec3, c) = -c * norm(v) * v`
pub(super) fn function(cursor: &mut Cursor<'_>) -> Parsed<Function> {
    let name = cursor.name("a function")?;
    if !cursor.eat_open(Delimiter::Parenthesis) {
        return Err(cursor.unexpected("`(` and the names of its parameters"));
    }
    let parameters = separated(cursor, |cursor| {
        let name = cursor.name("a parameter")?;
        let shape = after(cursor, &name)?;
        Ok((name, shape))
    })?;
    cursor.expect_close(Delimiter::Parenthesis, false)?;
    cursor.assign()?;
    Ok(Function {
        name,
        parameters,
        value: expression(cursor)?,
    })
}

/// Parses what follows `extern`: `fn lift(alpha, mach) -> 2`, and optionally a substitute after `=`.
pub(super) fn external(cursor: &mut Cursor<'_>) -> Parsed<External> {
    cursor.expect_word("fn")?;
    let name = cursor.name("a function")?;
    if !cursor.eat_open(Delimiter::Parenthesis) {
        return Err(cursor.unexpected("`(` and the names of its arguments"));
    }
    let parameters = separated(cursor, |cursor| {
        let name = cursor.name("an argument")?;
        match cursor.is_punct(':') {
            true => Err(cursor.unexpected("`,` or `)`").help(
                "arguments of a function in Rust are numbers: pass the entries of a vector one by one",
            )),
            false => Ok(name),
        }
    })?;
    cursor.expect_close(Delimiter::Parenthesis, false)?;
    const HELP: &str = "write how many numbers it returns after an arrow: `-> 2`";
    for part in ['-', '>'] {
        if !cursor.eat_punct(part) {
            return Err(cursor.unexpected("`->`").help(HELP));
        }
    }
    let span = cursor.here();
    let token = cursor.peek();
    let count = token
        .text
        .parse()
        .ok()
        .filter(|_| token.kind == Kind::Literal);
    let Some(count) = count else {
        return Err(cursor.unexpected("a whole number").help(HELP));
    };
    cursor.bump();
    let stand_in = match cursor.eat_punct('=') {
        true => Some(expression(cursor)?),
        false => None,
    };
    Ok(External {
        name,
        parameters,
        components: (count, span),
        stand_in,
        evaluated: false,
    })
}

/// Parses one or more elements separated by commas.
fn separated<T>(
    cursor: &mut Cursor<'_>,
    one: impl Fn(&mut Cursor<'_>) -> Parsed<T>,
) -> Parsed<Vec<T>> {
    let mut all = vec![one(cursor)?];
    while cursor.eat_punct(',') {
        all.push(one(cursor)?);
    }
    Ok(all)
}

/// Parses a name with its shape, which is a scalar if none is written, and its unit, if one is written. `any` says
/// whether the unit may be one from which values are converted to SI.
fn head(cursor: &mut Cursor<'_>, of: &str, any: bool) -> Parsed<(Ident, Shape, Option<Unit>)> {
    let name = path::declared(cursor, of)?;
    let scalar = cursor.is_punct(':') && cursor.is_indexed() && cursor.eat_punct(':');
    let shape = after(cursor, &name)?;
    let annotated = scalar || shape.kind != ShapeKind::Scalar;
    let unit = match annotated && cursor.is_open(Delimiter::Bracket) {
        true if any => Some(unit::unit(cursor)?),
        true => Some(unit::kept(cursor, &name)?),
        false => None,
    };
    Ok((name, shape, unit))
}

/// Parses the shape after a name, which is a scalar if none is written.
fn after(cursor: &mut Cursor<'_>, name: &Ident) -> Parsed<Shape> {
    match cursor.eat_punct(':') {
        true => shape(cursor),
        false => Ok(Shape {
            kind: ShapeKind::Scalar,
            span: name.span,
        }),
    }
}

pub(super) fn shape(cursor: &mut Cursor<'_>) -> Parsed<Shape> {
    let Ident { name, span } = cursor.word("a shape")?;
    let (family, size) = family(&name);
    let kind: fn(usize) -> ShapeKind = match family {
        "vec" => ShapeKind::Vector,
        "mat" => ShapeKind::Matrix,
        "sym" => ShapeKind::Symmetric,
        _ => {
            let error = Diagnostic::new(span, format!("unknown shape `{}`", shown(&name)));
            return Err(error.help(match (family, name.as_str()) {
                (_, "scalar" | "real" | "f64" | "f32") => "a scalar is written without a shape".to_owned(),
                ("R", _) if !size.is_empty() => format!("a vector is written `vec{size}`; `R{size}` is for coordinates"),
                _ => "the shapes are `vec3`, `mat3` and `sym3`, of any size; a scalar is written without".to_owned(),
            }));
        }
    };
    match number(size) {
        Some(size) => Ok(Shape {
            kind: kind(size),
            span,
        }),
        None => Err(bad_size(&name, span).help(format!("a size is written `{family}3`"))),
    }
}

fn coordinate_kind(cursor: &mut Cursor<'_>) -> Parsed<CoordKind> {
    let Ident { name, span } = cursor.word("the kind of the coordinate")?;
    match name.as_str() {
        "S1" => return Ok(CoordKind::S1),
        "S3" => return Ok(CoordKind::S3),
        "SO3" => return Ok(CoordKind::SO3),
        "SE3" => return Ok(CoordKind::SE3),
        _ => {}
    }
    let (family, size) = family(&name);
    if family == "R" && !size.is_empty() {
        return match number(size) {
            Some(size) => Ok(CoordKind::Euclidean(size)),
            None => Err(bad_size(&name, span).help("a vector is written `R3`")),
        };
    }
    Err(Diagnostic::new(span, format!("unknown kind of coordinate `{}`", shown(&name))).help(match family {
        "vec" if !size.is_empty() => format!("a vector among the coordinates is written `R{size}`"),
        "R" | "real" | "scalar" => "a real coordinate is written without a kind".to_owned(),
        _ => "the kinds are `R3` and other sizes, `S1`, `S3`, `SO3` and `SE3`; a real is written without".to_owned(),
    }))
}

/// Splits a name into its letters and the digits at its end.
fn family(name: &str) -> (&str, &str) {
    let family = name.trim_end_matches(|c: char| c.is_ascii_digit());
    (family, &name[family.len()..])
}

/// Parses a size. Returns `None` if it is out of bounds or has leading zeros.
fn number(size: &str) -> Option<usize> {
    if size.starts_with('0') {
        return None;
    }
    size.parse().ok().filter(|size| *size <= MAX_SIZE)
}

fn bad_size(shape: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        span,
        format!(
            "the size of `{}` is not between 1 and {MAX_SIZE}",
            shown(shape)
        ),
    )
}
