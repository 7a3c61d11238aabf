//! The start: numbers for x and ξ, on the constraint.

use super::class;
use super::declare::Declared;
use super::expression::Evaluator;
use super::kinematics::{part, written};
use super::layout::{blocks, identity};
use super::nearest::Nearest;
use super::scope::{NameKind, Scope};
use super::value::Value;
use super::variety::{Origin, Variety};
use crate::algebra::graph::{Function, Graph, Node};
use crate::algebra::numeric::evaluate;
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{CoordKind, Expr, ItemKind, Span, System, Target};

/// Largest violation of φ at the start that counts as rounding of the numbers given.
const ROUNDING: f64 = 1e-9;

/// x and ξ so far, and where each entry was given.
pub struct Start {
    pub x: Vec<f64>,
    pub xi: Vec<f64>,
    pub given_x: Vec<Option<Span>>,
    pub given_xi: Vec<Option<Span>>,
}

/// x and ξ from the `start` statements; what is not given is at the identity and at rest.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    defaults: &[f64],
    report: &mut Report,
) -> Option<Start> {
    let kinds = declared
        .coordinates
        .iter()
        .map(|coordinate| coordinate.kind);
    let x: Vec<f64> = kinds.flat_map(blocks).flat_map(identity).collect();
    let xi = vec![0.0; declared.xi.len()];
    let (given_x, given_xi) = (vec![None; x.len()], vec![None; xi.len()]);
    let mut start = Start {
        x,
        xi,
        given_x,
        given_xi,
    };
    let mut symbols = vec![std::f64::consts::PI];
    symbols.extend_from_slice(defaults);
    symbols.resize(graph.symbols().len(), f64::NAN);
    let mut complete = true;
    for item in &system.items {
        let ItemKind::Start { target, value } = &item.kind else {
            continue;
        };
        let evaluator = Evaluator {
            graph,
            scope,
            report,
        };
        complete &= start
            .read(target, value, evaluator, declared, &symbols)
            .is_some();
    }
    complete.then_some(start)
}

impl Start {
    fn read(
        &mut self,
        target: &Target,
        expr: &Expr,
        mut evaluator: Evaluator,
        declared: &Declared,
        symbols: &[f64],
    ) -> Option<()> {
        let name = &target.name.name;
        let value = evaluator.value(expr);
        let (range, wanted, of_x) = place(target, &mut evaluator, declared)?;
        let mut value = value?;
        let is_circle = |c: &&super::Coordinate| c.kind == CoordKind::S1 && c.offset == range.start;
        if let Value::Scalar(angle) = value
            && of_x
            && range.len() == 2
            && declared.coordinates.iter().any(|c| is_circle(&c))
        {
            let graph = &mut *evaluator.graph;
            let (c, s) = (
                graph.apply(Function::Cos, angle),
                graph.apply(Function::Sin, angle),
            );
            value = Value::Vector(vec![c, s]);
        }
        if !value.same_shape(&wanted) {
            let what = format!("the start of `{}`", written(target));
            let kind = declared.coordinates.iter().find(|c| c.name == *name);
            let help = match kind.map(|coordinate| coordinate.kind) {
                Some(CoordKind::S1) if range.len() == 2 => "give the angle, as in `start q = 0.3;`",
                Some(CoordKind::S3) => "give a unit quaternion, scalar first",
                Some(CoordKind::SO3 | CoordKind::SE3) if range.len() >= 9 => {
                    "build the rotation by `rotx(angle)`, `rpy(…)`, `axis_angle(…)`, and a pose by `pose(R, p)`"
                }
                _ => return evaluator.wrong_shape(expr.span, &what, &wanted.shape(), &value),
            };
            let (wanted, found) = (wanted.shape(), value.shape());
            let message = format!("{what} has to be {wanted}, this is {found}");
            return evaluator.error(Diagnostic::new(expr.span, message).help(help));
        }
        let entries = value.entries();
        let class = entries
            .iter()
            .fold(0, |class, e| class | evaluator.graph.class(e.node()));
        if class & !class::PARAM != 0 {
            return evaluator.error(
                Diagnostic::new(expr.span, format!("the start of `{name}` is no number"))
                    .help("a start is made of numbers, constants and parameters"),
            );
        }
        let params = symbols.iter().zip(evaluator.graph.symbols());
        let unknown =
            |(n, s): (&f64, &crate::algebra::graph::Symbol)| s.class == class::PARAM && n.is_nan();
        if class != 0 && params.into_iter().any(unknown) {
            // A default is in error; the start cannot be known.
            return None;
        }
        let numbers = evaluate(evaluator.graph, &entries, symbols);
        if numbers.iter().any(|number| !number.is_finite()) {
            return evaluator.error(
                Diagnostic::new(expr.span, format!("the start of `{name}` is not finite"))
                    .help("write numbers that floating point can hold"),
            );
        }
        let (into, given) = if of_x {
            (&mut self.x, &mut self.given_x)
        } else {
            (&mut self.xi, &mut self.given_xi)
        };
        if let Some(first) = given[range.clone()].iter().flatten().next() {
            return evaluator.error(
                Diagnostic::new(
                    target.span(),
                    format!("the start of `{}` is given twice", written(target)),
                )
                .help("remove one of the two")
                .note(*first, "first given here"),
            );
        }
        given[range.clone()].fill(Some(target.span()));
        into[range].copy_from_slice(&numbers);
        Some(())
    }
}

/// The entries of x or ξ that a start is about, and their value; whether they are of x.
fn place(
    target: &Target,
    evaluator: &mut Evaluator,
    declared: &Declared,
) -> Option<(std::ops::Range<usize>, Value, bool)> {
    let name = &target.name.name;
    if let Some(group) = declared.velocities.iter().find(|group| group.name == *name) {
        if let Some(field) = &target.field {
            return evaluator.error(
                Diagnostic::new(
                    field.span,
                    format!("`{name}` has no part `.{}`", field.name),
                )
                .help(format!("give the whole of it: `start {name} = …;`")),
            );
        }
        return Some((
            group.offset..group.offset + group.len,
            group.value.clone(),
            false,
        ));
    }
    if declared.coordinates.iter().any(|c| c.name == *name) {
        let (range, wanted) = part(target, evaluator, declared)?;
        return Some((range, wanted, true));
    }
    let accept = |kind: NameKind| matches!(kind, NameKind::Coord(_) | NameKind::Velocity);
    if evaluator
        .scope
        .get(name)
        .is_some_and(|entry| accept(entry.kind))
    {
        // Its own definition was in error.
        return None;
    }
    let wanted = Some("coordinate or velocity");
    let error = evaluator
        .scope
        .unknown(target.name.span, name, wanted, accept);
    evaluator.error(error)
}

/// φ(x) = 0 at the start.
pub fn check(
    system: &System,
    variety: &Variety,
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
    numbers.resize(variety.points.symbols, 0.0);
    let rows: Vec<_> = variety.phi.iter().map(|(edge, _)| *edge).collect();
    let residuals = evaluate(&variety.points.free, &rows, &numbers);
    let mut reported: Vec<Origin> = Vec::new();
    let mut nearest = None;
    for (row, &residual) in residuals.iter().enumerate() {
        let origin = variety.origins[row];
        if residual.abs() <= ROUNDING || reported.contains(&origin) {
            continue;
        }
        reported.push(origin);
        let mut error = violation(system, variety, declared, row, residual);
        if let Origin::Statement(_) = origin {
            let found = nearest.get_or_insert_with(|| {
                super::nearest::nearest(&variety.points, &variety.phi, &numbers, x)
            });
            advise(&mut error, found, variety, declared, row);
        }
        report.push(error);
    }
}

fn violation(
    system: &System,
    variety: &Variety,
    declared: &Declared,
    row: usize,
    residual: f64,
) -> Diagnostic {
    let text = &variety.phi[row].1;
    let names = coordinates_of(variety, declared, row);
    let given = system.items.iter().rev().find_map(|item| match &item.kind {
        ItemKind::Start { target, value } => names
            .contains(&target.name.name.as_str())
            .then_some(value.span),
        _ => None,
    });
    let difference = format!("the difference is {residual:.3e}");
    match variety.origins[row] {
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
                    "give a `start` of {}; what has none starts at 0",
                    list.join(", ")
                ));
            };
            Diagnostic::new(given, message.replace("this constraint", "a constraint"))
                .help(format!(
                    "give {} a start that satisfies it",
                    list.join(", ")
                ))
                .note(place, "this constraint")
        }
    }
}

/// Says where the nearest configuration is, or that there seems to be none.
fn advise(
    error: &mut Diagnostic,
    found: &Nearest,
    variety: &Variety,
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
                "check the lengths: the constraints are violated by {least:.3e} at least; or start nearer to a configuration"
            ));
            return;
        }
    };
    let names = coordinates_of(variety, declared, row);
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

/// A number with as many digits as a start needs.
fn short(number: f64) -> String {
    let text = format!("{number:.12}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}

/// The coordinates that a row of φ is about.
fn coordinates_of<'a>(variety: &Variety, declared: &'a Declared, row: usize) -> Vec<&'a str> {
    let free = &variety.points.free;
    let first = variety.points.first;
    let mut names = Vec::new();
    for id in free.reachable(&[variety.phi[row].0]) {
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
