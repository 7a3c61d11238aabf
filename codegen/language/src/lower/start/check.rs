//! Checks that the start is on X, and suggests what to write if it is not.

use crate::algebra::graph::Node;
use crate::algebra::numeric::evaluate;
use crate::algebra::residual_scale::relative_residuals;
use crate::diagnostics::{Diagnostic, Report, rough};
use crate::lower::configuration_manifold::{ConfigurationManifold, Origin};
use crate::lower::declare::Declared;
use crate::model::nearest::Nearest;
use crate::syntax::ast::{CoordKind, ItemKind, Span, System};

/// Largest violation of φ at the start, relative to the size of φ, that counts as rounding of the given numbers.
const ROUNDING: f64 = 1e-9;

/// Checks φ(x) = 0 at the start.
pub fn check(
    system: &System,
    manifold: &ConfigurationManifold,
    declared: &Declared,
    defaults: &[f64],
    x: &[f64],
    report: &mut Report,
) {
    if defaults.iter().any(|number| number.is_nan()) {
        return;
    }
    let mut numbers = vec![std::f64::consts::PI];
    numbers.extend(defaults.iter().chain(x));
    numbers.resize(manifold.points.symbols, 0.0);
    let rows: Vec<_> = manifold.phi.iter().map(|(edge, _)| *edge).collect();
    let residuals = evaluate(&manifold.points.free, &rows, &numbers);
    let parts = relative_residuals(
        &manifold.points.free,
        &rows,
        &numbers,
        manifold.points.places(),
    );
    let mut reported: Vec<Origin> = Vec::new();
    let mut nearest = None;
    for (row, &residual) in residuals.iter().enumerate() {
        let origin = manifold.origins[row];
        if parts[row].abs() <= ROUNDING || reported.contains(&origin) {
            continue;
        }
        reported.push(origin);
        let mut error = violation(system, manifold, declared, row, residual);
        if let Origin::Statement(_) = origin {
            let found = nearest.get_or_insert_with(|| {
                crate::model::nearest::nearest(&manifold.points, &manifold.phi, &numbers, x)
            });
            advise(&mut error, found, manifold, declared, row);
        }
        report.push(error);
    }
    if reported.is_empty() {
        reflections(system, declared, x, report);
    }
}

/// Reports reflections, which satisfy R.T * R = 1, too, but are reached by no motion.
fn reflections(system: &System, declared: &Declared, x: &[f64], report: &mut Report) {
    for coordinate in &declared.coordinates {
        let first = match coordinate.kind {
            CoordKind::SO3 => coordinate.offset,
            CoordKind::SE3 => coordinate.offset + 3,
            _ => continue,
        };
        let [a, b, c, d, e, f, g, h, i] = x[first..first + 9] else {
            continue;
        };
        let determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
        if determinant >= 0.0 || determinant.is_nan() {
            continue;
        }
        let given = given(system, &[&coordinate.name]);
        let message = format!(
            "the start of `{}` is a reflection: its determinant is -1",
            coordinate.name
        );
        report.push(
            Diagnostic::new(given.unwrap_or(coordinate.span), message)
                .help("build the rotation by `rotx(angle)`, `rpy(…)`, `axis_angle(…)`"),
        );
    }
}

/// Returns where the start of one of these coordinates is given last.
fn given(system: &System, names: &[&str]) -> Option<Span> {
    system.items.iter().rev().find_map(|item| match &item.kind {
        ItemKind::Start { target, value } | ItemKind::Guess { target, value } => names
            .contains(&target.name.name.as_str())
            .then_some(value.span),
        _ => None,
    })
}

fn violation(
    system: &System,
    manifold: &ConfigurationManifold,
    declared: &Declared,
    row: usize,
    residual: f64,
) -> Diagnostic {
    let text = &manifold.phi[row].1;
    let names = coordinates_of(manifold, declared, row);
    let given = given(system, &names);
    let difference = format!("the difference is {}", rough(residual));
    match manifold.origins[row] {
        Origin::Coordinate(index) => {
            let coordinate = &declared.coordinates[index];
            let text = text.split(", entry").next().unwrap_or(text);
            let message = format!("the start violates {text}: {difference}");
            let error = Diagnostic::new(given.unwrap_or(coordinate.span), message);
            error.help(match coordinate.kind {
                CoordKind::S1 => format!("give the angle: `start {} = 0.3;`", coordinate.name),
                CoordKind::S3 => "divide the quaternion by its length".into(),
                _ => "build the rotation by `rotx(angle)`, `rpy(…)`, `axis_angle(…)`".into(),
            })
        }
        Origin::Statement(item) => {
            let place = match &system.items[item].kind {
                ItemKind::Constraint { left, right } => left.span.to(right.span),
                _ => system.items[item].span,
            };
            let list: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
            let message = format!("the start violates this constraint: {difference}");
            let Some(given) = given else {
                return Diagnostic::new(place, message).help(format!(
                    "give a `start` of {}; coordinates and velocities without one start at 0",
                    list.join(", ")
                ));
            };
            Diagnostic::new(given, message.replace("this constraint", "a constraint"))
                .help(format!(
                    "give {} a start that satisfies it, or a guess: `start {} ~ …;`",
                    list.join(", "),
                    names.first().map_or("", |name| name)
                ))
                .note(place, "this constraint")
        }
    }
}

/// Adds where the nearest configuration is, or that none was found.
fn advise(
    error: &mut Diagnostic,
    found: &Nearest,
    manifold: &ConfigurationManifold,
    declared: &Declared,
    row: usize,
) {
    let x = match found {
        Nearest::Found(x) => x,
        Nearest::Nowhere(least) => {
            error
                .message
                .push_str(", and no real configuration was found near it");
            error.help = Some(format!(
                "check the lengths: the constraints are violated by at least {}; or start closer to a configuration that satisfies them",
                rough(*least)
            ));
            return;
        }
    };
    let names = coordinates_of(manifold, declared, row);
    let starts: Option<Vec<String>> = declared
        .coordinates
        .iter()
        .filter(|coordinate| names.contains(&coordinate.name.as_str()))
        .map(|coordinate| {
            let x = &x[coordinate.offset..];
            let value = match coordinate.kind {
                CoordKind::Real => short(x[0]),
                CoordKind::S1 => short(x[1].atan2(x[0])),
                CoordKind::Euclidean(n) => {
                    let entries: Vec<String> = x[..n].iter().map(|&x| short(x)).collect();
                    format!("[{}]", entries.join(", "))
                }
                CoordKind::S3 | CoordKind::SO3 | CoordKind::SE3 => return None,
            };
            Some(format!("`start {} = {value};`", coordinate.name))
        })
        .collect();
    if let (Some(starts), Some(help)) = (starts, &mut error.help) {
        help.push_str(&format!("; the nearest is {}", starts.join(" ")));
    }
}

/// Writes a number with as many digits as a start needs.
fn short(number: f64) -> String {
    let text = format!("{number:.12}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}

/// Returns the names of the coordinates in a row of φ.
fn coordinates_of<'a>(
    manifold: &ConfigurationManifold,
    declared: &'a Declared,
    row: usize,
) -> Vec<&'a str> {
    let free = &manifold.points.free;
    let first = manifold.points.first;
    let mut names = Vec::new();
    for id in free.reachable(&[manifold.phi[row].0]) {
        if let Node::Symbol(index) = free.node(id)
            && let Some(alpha) = (index as usize).checked_sub(first)
            && alpha < declared.x.len()
            && let Some(coordinate) = declared.coordinates.iter().rfind(|c| c.offset <= alpha)
            && !names.contains(&coordinate.name.as_str())
        {
            names.push(coordinate.name.as_str());
        }
    }
    names
}
