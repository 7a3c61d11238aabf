//! Parsing of units: `[kg*m^2/s]` after a number, or after the `:` of a declaration.

use super::ast::{Declaration, Expr, ExprKind, Ident, Quantity};
use super::cursor::{Cursor, Parsed, shown};
use super::suggest::closest;
use super::tokens::Kind;
use crate::diagnostics::Diagnostic;
use crate::units::{MOST_POWER, Unit, names, suggestions};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;
use proc_macro2::Delimiter;

/// Largest number of factors of a unit.
const MOST_FACTORS: usize = 12;

/// Returns whether a unit is next: a bracket with a word, or with `1/`.
pub(super) fn is_next(cursor: &Cursor<'_>) -> bool {
    let (first, second) = cursor.inside();
    cursor.is_open(Delimiter::Bracket)
        && (first.kind == Kind::Word || first.text == "1" && second.kind == Kind::Punct('/'))
}

/// Parses a unit with its brackets.
pub(super) fn unit(cursor: &mut Cursor<'_>) -> Parsed<Unit> {
    let open = cursor.here();
    if !cursor.eat_open(Delimiter::Bracket) {
        return Err(cursor.unexpected("a unit in brackets, such as `[kg*m^2/s]`"));
    }
    let mut unit = Unit::one();
    unit.text.clear();
    let mut sign = 1;
    for count in 1.. {
        if count > MOST_FACTORS {
            let message = format!("a unit of more than {MOST_FACTORS} factors");
            let error = Diagnostic::new(cursor.here(), message);
            return Err(error.help("write it in other units, such as `J` for `kg*m^2/s^2`"));
        }
        factor(cursor, &mut unit, sign)?;
        sign = match () {
            () if cursor.eat_punct('*') => 1,
            () if cursor.eat_punct('/') => -1,
            () => break,
        };
        unit.text.push(if sign > 0 { '*' } else { '/' });
    }
    if cursor.peek().kind == Kind::Word {
        let error = cursor.unexpected("`*`, `/` or `]`");
        return Err(error.help("factors of a unit are joined by `*` and `/`: `[N*m/rad]`"));
    }
    cursor.expect_close(Delimiter::Bracket, false)?;
    unit.span = open.to(cursor.before());
    Ok(unit)
}

/// Parses `m`, `s^2`, `m^-1`, `m^(1/2)` or `1`, and multiplies the unit by it or by its reciprocal.
fn factor(cursor: &mut Cursor<'_>, unit: &mut Unit, sign: i32) -> Parsed<()> {
    let token = cursor.peek();
    let span = cursor.here();
    if token.text == "1" {
        cursor.bump();
        unit.text.push('1');
        return Ok(());
    }
    if token.kind != Kind::Word {
        return Err(cursor.unexpected("a unit such as `kg`"));
    }
    let Some(named) = Unit::named(&token.text) else {
        return Err(unknown(&token.text, span));
    };
    cursor.bump();
    unit.text.push_str(&token.text);
    let mut exponent = BigRational::one();
    if cursor.eat_punct('^') {
        unit.text.push('^');
        let fraction = cursor.eat_open(Delimiter::Parenthesis);
        unit.text.push_str(if fraction { "(" } else { "" });
        exponent = whole(cursor, unit)?;
        if fraction {
            if cursor.eat_punct('/') {
                unit.text.push('/');
                exponent /= whole(cursor, unit)?;
            }
            cursor.expect_close(Delimiter::Parenthesis, false)?;
            unit.text.push(')');
        }
    }
    let exponent = exponent * BigRational::from_integer(sign.into());
    let span = span.to(cursor.before());
    unit.multiply(&named, &exponent).ok_or_else(|| {
        let message = format!("a root of `{}` has no exact value in SI", named.text);
        Diagnostic::new(span, message).help("write it in units of SI, such as `m^(1/2)`")
    })
}

/// Parses the exponent of a unit, a whole number.
fn whole(cursor: &mut Cursor<'_>, unit: &mut Unit) -> Parsed<BigRational> {
    let start = cursor.here();
    let negative = cursor.eat_punct('-');
    let token = cursor.peek();
    let power = token.text.parse::<u32>().ok();
    let Some(power) = power.filter(|power| (1..=MOST_POWER).contains(power)) else {
        let message = format!("the exponent of a unit is a whole number from 1 to {MOST_POWER}");
        let error = Diagnostic::new(start.to(cursor.here()), message);
        return Err(error.help("write `m^2`, `s^-1`, or a root such as `m^(1/2)`"));
    };
    cursor.bump();
    unit.text.push_str(if negative { "-" } else { "" });
    unit.text.push_str(&power.to_string());
    let power = BigRational::from_integer(BigInt::from(power));
    Ok(if negative { -power } else { power })
}

fn unknown(name: &str, span: crate::syntax::ast::Span) -> Diagnostic {
    let error = Diagnostic::new(span, format!("unknown unit `{}`", shown(name)));
    error.help(match closest(name, suggestions()) {
        Some(close) => format!("did you mean `{close}`?"),
        None => {
            let names: Vec<String> = names().map(|name| format!("`{name}`")).collect();
            format!(
                "the units are {}, with prefixes from `f` to `T` before those of SI",
                names.join(", ")
            )
        }
    })
}

/// Parses the unit of a quantity whose values at run time are in SI; other units are refused.
pub(super) fn kept(cursor: &mut Cursor<'_>, name: &Ident) -> Parsed<Unit> {
    let unit = unit(cursor)?;
    if unit.is_si() {
        return Ok(unit);
    }
    let message = format!("`{}` is computed in SI, not in `{}`", name.name, unit.text);
    let help = format!(
        "declare it in [{}]; numbers may have any unit, such as `2 [{}]`",
        si(&unit),
        unit.text
    );
    Err(Diagnostic::new(unit.span, message).help(help))
}

/// Returns the unit that SI has instead of another.
fn si(unit: &Unit) -> String {
    match unit.dimension.is_one() {
        true => "rad".into(),
        false => unit.dimension.to_string(),
    }
}

/// Converts the value of a declaration from its unit to SI. If the unit is not of SI, the value has to consist of
/// numbers.
pub(super) fn converted(declaration: &mut Declaration) -> Parsed<()> {
    let Some(unit) = declaration.unit.as_ref().filter(|unit| !unit.is_si()) else {
        return Ok(());
    };
    let Some(value) = declaration.value.take() else {
        return Ok(());
    };
    if let Some(other) = not_plain(&value) {
        let message = format!(
            "only plain numbers are converted from `{}` to SI",
            unit.text
        );
        let help = format!(
            "declare `{}` in [{}], and write the unit at the numbers: `2 [{}]`",
            declaration.name.name,
            si(unit),
            unit.text
        );
        let error = Diagnostic::new(other.span, message).help(help);
        return Err(error.note(unit.span, "its unit"));
    }
    let span = value.span;
    let kind = ExprKind::Quantity(Box::new(Quantity::of(value, unit.clone())));
    declaration.value = Some(Expr { kind, span });
    Ok(())
}

/// Returns a part of an expression that is neither a number nor made of numbers.
fn not_plain(expr: &Expr) -> Option<&Expr> {
    match &expr.kind {
        ExprKind::Number(_) => None,
        ExprKind::Name(name) if name == "pi" => None,
        ExprKind::Neg(_) | ExprKind::Binary(..) | ExprKind::Array(_) => {
            expr.parts().into_iter().find_map(not_plain)
        }
        _ => Some(expr),
    }
}
