//! Parsing of joints: `joint j: revolute [0, 0, 1] on f at P moves g follows e { damping d; }`.

use proc_macro2::Delimiter;

use super::ast::{Expr, Ident, Joint, JointField, JointKind, Span};
use super::blocks::fields;
use super::cursor::{Cursor, Parsed, quoted, shown};
use super::expression::expression;
use super::path;
use super::suggest::closest;
use crate::diagnostics::Diagnostic;

/// Kinds of joints, each with its number of axes and its syntax.
const KINDS: [(&str, JointKind, usize, &str); 9] = [
    ("revolute", JointKind::Revolute, 1, "revolute [0, 0, 1]"),
    (
        "continuous",
        JointKind::Continuous,
        1,
        "continuous [0, 0, 1]",
    ),
    ("prismatic", JointKind::Prismatic, 1, "prismatic [0, 0, 1]"),
    (
        "spherical",
        JointKind::Spherical,
        0,
        "spherical` or `spherical S3",
    ),
    ("free", JointKind::Free, 0, "free"),
    ("planar", JointKind::Planar, 1, "planar [0, 0, 1]"),
    (
        "universal",
        JointKind::Universal,
        2,
        "universal [1, 0, 0], [0, 1, 0]",
    ),
    (
        "cylindrical",
        JointKind::Cylindrical,
        1,
        "cylindrical [0, 0, 1]",
    ),
    ("fixed", JointKind::Fixed, 0, "fixed"),
];

/// Fields of a joint, each with a sentence that shows its syntax.
const FIELDS: [(&str, JointField, &str); 8] = [
    (
        "damping",
        JointField::Damping,
        "viscous friction is written `damping d;`",
    ),
    (
        "armature",
        JointField::Armature,
        "the inertia of a drive is written `armature J;`",
    ),
    (
        "stiffness",
        JointField::Stiffness,
        "a spring is written `stiffness k;`, or `stiffness k; rest q0;`",
    ),
    (
        "rest",
        JointField::Rest,
        "the rest position of a spring is written `rest q0;`",
    ),
    (
        "force",
        JointField::Force,
        "a force or torque of the joint is written `force u;`",
    ),
    (
        "limit",
        JointField::Limit,
        "limits are written `limit -pi to pi;`",
    ),
    (
        "max_speed",
        JointField::MaxSpeed,
        "the largest speed is written `max_speed 2;`",
    ),
    (
        "max_force",
        JointField::MaxForce,
        "the largest force is written `max_force 100;`",
    ),
];

/// Returns the names of the kinds.
pub(crate) fn kinds() -> impl Iterator<Item = &'static str> {
    KINDS.into_iter().map(|(name, ..)| name)
}

/// Returns the names of the fields, each with a sentence that shows its syntax.
pub(crate) fn fields_of() -> impl Iterator<Item = (&'static str, &'static str)> {
    FIELDS.into_iter().map(|(name, _, form)| (name, form))
}

/// Returns the name of a field.
pub fn field_name(field: JointField) -> &'static str {
    FIELDS
        .iter()
        .find(|(_, known, _)| *known == field)
        .map_or("", |(name, ..)| name)
}

/// Returns the name of a kind.
pub fn kind_name(kind: JointKind) -> &'static str {
    KINDS
        .iter()
        .find(|(_, known, ..)| *known == kind)
        .map_or("spherical", |(name, ..)| name)
}

/// Returns the suffixes that form the names of a joint's coordinates and of its velocities from the name of the joint.
pub(crate) fn endings(joint: &Joint) -> (&'static [&'static str], &'static [&'static str]) {
    match joint.kind.0 {
        JointKind::Fixed => (&[], &[]),
        _ if joint.follows.is_some() => (&[], &[]),
        JointKind::Free => (&["_r", "_R"], &["_v", "_w"]),
        JointKind::Planar => (&["_r", ""], &["_r_dot", "_dot"]),
        JointKind::Universal => (&["_1", "_2"], &["_1_dot", "_2_dot"]),
        JointKind::Cylindrical => (&["", "_d"], &["_dot", "_d_dot"]),
        _ => (&[""], &["_dot"]),
    }
}

/// `j: revolute [0, 0, 1] on f at P moves g follows e { damping d; }`
pub(super) fn joint(cursor: &mut Cursor<'_>) -> Parsed<Joint> {
    let name = path::declared(cursor, "a joint")?;
    cursor.expect_punct(':')?;
    let (kind, axes) = kind(cursor)?;
    let on = if cursor.eat_word("on") {
        Some(path::path(cursor, "a frame")?)
    } else {
        None
    };
    let at = if cursor.eat_word("at") {
        Some(expression(cursor)?)
    } else {
        None
    };
    if !cursor.eat_word("moves") {
        return Err(cursor
            .unexpected("`moves` and the frame that the joint carries")
            .help(format!(
                "write `moves g` after the place of the joint; `g` is a new frame, on which bodies stand: `joint {}: … moves g;`",
                shown(&name.name)
            )));
    }
    let moves = path::declared(cursor, "a frame")?;
    let follows = if cursor.eat_word("follows") {
        Some(expression(cursor)?)
    } else {
        None
    };
    let mut given = Vec::new();
    if cursor.eat_open(Delimiter::Brace) {
        fields(cursor, |cursor| field(cursor, &mut given))?;
        cursor.eat_punct(';');
    } else {
        cursor.end(follows.is_some())?;
    }
    Ok(Joint {
        name,
        kind,
        axes,
        on,
        at,
        moves,
        follows,
        fields: given,
    })
}

/// `revolute [0, 0, 1]`, `spherical S3`, `universal [1, 0, 0], [0, 1, 0]`
fn kind(cursor: &mut Cursor<'_>) -> Parsed<((JointKind, Span), Vec<Expr>)> {
    let Ident { name, span } = cursor.word("the kind of the joint")?;
    let Some(&(_, kind, count, form)) = KINDS.iter().find(|(kind, ..)| *kind == name) else {
        let error = Diagnostic::new(span, format!("unknown kind of joint `{}`", shown(&name)));
        return Err(match closest(&name, KINDS.map(|(kind, ..)| kind)) {
            Some(close) => error.help(format!("did you mean `{close}`?")),
            None => {
                let all = KINDS.map(|(kind, ..)| format!("`{kind}`"));
                error.help(format!("the kinds are {}", all.join(", ")))
            }
        });
    };
    let kind = match kind {
        JointKind::Spherical if cursor.eat_word("S3") => JointKind::SphericalS3,
        JointKind::Spherical if cursor.eat_word("SO3") => kind,
        _ => kind,
    };
    let mut axes = Vec::new();
    while axes.len() < count {
        if axes.len() == 1 {
            cursor.expect_punct(',').map_err(|error| {
                error.help("a universal joint has two axes: `universal [1, 0, 0], [0, 1, 0]`")
            })?;
        }
        if at_end(cursor) {
            return Err(Diagnostic::new(
                span,
                format!(
                    "a {name} joint has an axis, found {}",
                    quoted(cursor.peek())
                ),
            )
            .help(format!("write `{form}`")));
        }
        axes.push(expression(cursor)?);
    }
    if !at_end(cursor) {
        let error = cursor.unexpected("`on`, `at` or `moves`");
        return Err(if count == 0 && error.help.is_none() {
            error.help(format!("a {name} joint has no axis: write `{form}`"))
        } else {
            error
        });
    }
    Ok(((kind, span), axes))
}

/// Returns whether the list of axes has ended.
fn at_end(cursor: &Cursor<'_>) -> bool {
    ["on", "at", "moves", "follows"]
        .iter()
        .any(|word| cursor.is_word(word))
        || cursor.is_punct(';')
        || cursor.is_open(Delimiter::Brace)
        || cursor.is_end()
}

/// Parses one field of `{ damping d; limit a to b; }`. Fields come in any order, each at most once.
fn field(cursor: &mut Cursor<'_>, fields: &mut Vec<(JointField, Span, Vec<Expr>)>) -> Parsed<()> {
    let span = cursor.here();
    let Some(&(name, field, form)) = FIELDS.iter().find(|(name, ..)| cursor.is_word(name)) else {
        return Err(unknown(cursor));
    };
    cursor.bump();
    let values = values(cursor, field).map_err(|error| {
        if error.help.is_some() {
            error
        } else {
            error.help(form)
        }
    })?;
    if let Some((_, first, _)) = fields.iter().find(|(known, ..)| *known == field) {
        return Err(
            Diagnostic::new(span, format!("`{name}` is given twice for one joint"))
                .help("remove one of them, or write their sum")
                .note(*first, "first given here"),
        );
    }
    fields.push((field, span, values));
    Ok(())
}

/// Parses the value of a field, or the two values of a limit, with the `;`.
fn values(cursor: &mut Cursor<'_>, field: JointField) -> Parsed<Vec<Expr>> {
    let mut values = vec![expression(cursor)?];
    if field == JointField::Limit {
        cursor.expect_word("to")?;
        values.push(expression(cursor)?);
    }
    cursor.end(true)?;
    Ok(values)
}

fn unknown(cursor: &Cursor<'_>) -> Diagnostic {
    if cursor.is_punct(';') {
        return Diagnostic::new(cursor.here(), "a `;` without a statement").help("remove it");
    }
    let found = cursor.peek();
    let all = || {
        let names = FIELDS.map(|(name, ..)| format!("`{name}`"));
        format!("a joint can have {}", names.join(", "))
    };
    if !cursor.is_any_word() {
        let message = format!("expected a property of the joint, found {}", quoted(found));
        return Diagnostic::new(cursor.here(), message).help(all());
    }
    let message = format!("a joint has no `{}`", shown(&found.text));
    let error = Diagnostic::new(cursor.here(), message);
    match closest(&found.text, FIELDS.map(|(name, ..)| name)) {
        Some(close) => error.help(format!("did you mean `{close}`?")),
        None => error.help(all()),
    }
}
