//! Advice in messages on how to write the rate of a coordinate.

use crate::syntax::ast::{CoordKind, Expr, ExprKind, ShapeKind};

/// Returns advice on how to write the rate of a coordinate, with the name of a velocity.
pub fn rate_help(name: &str, kind: CoordKind, velocity: &str) -> String {
    match kind {
        CoordKind::Real => format!("write `rate {name} = {velocity};` with a scalar velocity"),
        CoordKind::Euclidean(n) => {
            format!("write `rate {name} = {velocity};` with a velocity of shape vec{n}")
        }
        CoordKind::S1 => {
            format!("write `rate {name} = {velocity};` with the angular velocity {velocity}")
        }
        CoordKind::S3 => format!(
            "write `rate {name} = qmul({name}, [0, {velocity}[1], {velocity}[2], {velocity}[3]]) / 2;` with the angular velocity {velocity} in body axes"
        ),
        CoordKind::SO3 => format!(
            "write `rate {name} = {name} * hat({velocity});` with the angular velocity {velocity} in body axes, or `hat({velocity}) * {name}` in world axes"
        ),
        CoordKind::SE3 => format!(
            "write `rate {name}.p = {name}.R * v;` and `rate {name}.R = {name}.R * hat({velocity});`"
        ),
    }
}

/// Guesses the velocity that moves a coordinate, among those of fitting shape: one that the given rate mentions, else
/// the first one or (for a rotation or an angle) the last one, else a conventional name.
pub fn velocity_for<'a>(
    kind: CoordKind,
    rate: Option<&Expr>,
    velocities: impl Iterator<Item = (&'a str, ShapeKind)>,
) -> &'a str {
    let (shape, otherwise) = match kind {
        CoordKind::Real => (ShapeKind::Scalar, "u"),
        CoordKind::S1 => (ShapeKind::Scalar, "w"),
        CoordKind::Euclidean(n) => (ShapeKind::Vector(n), "v"),
        CoordKind::S3 | CoordKind::SO3 | CoordKind::SE3 => (ShapeKind::Vector(3), "w"),
    };
    let fits = velocities.filter(|(_, found)| *found == shape);
    let fits: Vec<&str> = fits.map(|(name, _)| name).collect();
    let mut mentioned = Vec::new();
    if let Some(rate) = rate {
        names_in(rate, &mut mentioned);
    }
    let found = fits.iter().find(|name| mentioned.contains(*name));
    let likely = match kind {
        CoordKind::Real | CoordKind::Euclidean(_) => fits.first(),
        _ => fits.last(),
    };
    found.or(likely).copied().unwrap_or(otherwise)
}

fn names_in<'a>(expr: &'a Expr, names: &mut Vec<&'a str>) {
    if let ExprKind::Name(name) = &expr.kind {
        names.push(name);
    }
    let parts = expr.parts().into_iter();
    parts.for_each(|part| names_in(part, names));
}
