//! Rates: ẋ = A ξ, linear in ξ and tangent to φ = 0, with as many velocities as dim X.

use super::class;
use super::declare::{Declared, coordinate_value, size};
use super::expression::Evaluator;
use super::points::Points;
use super::scope::{NameKind, Scope};
use super::value::Value;
use crate::algebra::derivation::Derivation;
use crate::algebra::fp::Fp;
use crate::algebra::graph::{Edge, Graph, LANES};
use crate::algebra::lane::Lane;
use crate::algebra::numeric::{evaluate_at, rank};
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{CoordKind, Expr, Ident, ItemKind, Span, System, Target};

/// ẋ and A.
pub struct Kinematics {
    pub rate: Vec<Edge>,
    pub a: Vec<Vec<Edge>>,
}

/// Reads all `rate` statements.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    points: &Points,
    phi: &[(Edge, String)],
    declared: &Declared,
    report: &mut Report,
) -> Option<Kinematics> {
    let mut rate: Vec<Option<(Edge, Span)>> = vec![None; declared.x.len()];
    let mut complete = true;
    for item in &system.items {
        let ItemKind::Rate { target, value } = &item.kind else {
            continue;
        };
        let done = read_rate(target, value, graph, scope, declared, &mut rate, report);
        complete &= done.is_some();
    }
    for coordinate in &declared.coordinates {
        let entries = &rate[coordinate.offset..coordinate.offset + size(coordinate.kind)];
        if complete && entries.iter().any(Option::is_none) {
            complete = false;
            report.push(
                Diagnostic::new(
                    coordinate.span,
                    format!("coordinate `{}` has no rate", coordinate.name),
                )
                .help(rate_help(&coordinate.name, coordinate.kind)),
            );
        }
    }
    if !complete {
        return None;
    }
    let (rate, spans): (Vec<Edge>, Vec<Span>) = rate.into_iter().flatten().unzip();
    let a = linear_part(graph, &rate, &spans, declared, report)?;
    let jacobian = jacobian(points, graph, phi, declared);
    check_tangent(
        graph,
        &a,
        &spans,
        phi,
        jacobian.as_deref(),
        declared,
        report,
    )?;
    check_count(system, graph, &a, jacobian.as_deref(), declared, report)?;
    Some(Kinematics { rate, a })
}

fn read_rate(
    target: &Target,
    value: &Expr,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    rate: &mut [Option<(Edge, Span)>],
    report: &mut Report,
) -> Option<()> {
    let found = part(target, scope, declared, report);
    let value_of = Evaluator {
        graph,
        scope,
        report,
    }
    .value(value);
    let (range, wanted) = found?;
    let mut entries = value_of?;
    // A scalar rate of an S1 coordinate is its angular velocity: (c, s)' = (−s, c) ω.
    if let (Value::Scalar(w), Value::Vector(x)) = (&entries, &wanted)
        && declared
            .coordinates
            .iter()
            .any(|c| c.kind == CoordKind::S1 && c.offset == range.start && x.len() == 2)
    {
        let (c, s) = (x[0], x[1]);
        entries = Value::Vector(vec![-graph.mul(s, *w), graph.mul(c, *w)]);
    }
    if !entries.same_shape(&wanted) {
        report.push(Diagnostic::new(value.span, format!("the rate of `{}` has to be {}, this is {}", target.name.name, wanted.shape(), entries.shape())).help(
            "a rate has the shape of its coordinate; give the parts `.p` and `.R` of an SE3 coordinate their own rates",
        ));
        return None;
    }
    for (place, edge) in range.zip(entries.entries()) {
        if let Some((_, first)) = rate[place] {
            report.push(
                Diagnostic::new(
                    target.span(),
                    format!("the rate of `{}` is given twice", target.name.name),
                )
                .help("remove one of the two")
                .note(first, "first given here"),
            );
            return None;
        }
        rate[place] = Some((edge, value.span));
    }
    Some(())
}

/// The entries of x that a target names, and its value.
pub fn part(
    target: &Target,
    scope: &Scope,
    declared: &Declared,
    report: &mut Report,
) -> Option<(std::ops::Range<usize>, Value)> {
    let name = &target.name;
    let Some(coordinate) = declared.coordinates.iter().find(|c| c.name == name.name) else {
        let error = match scope.get(&name.name) {
            Some(entry) => Diagnostic::new(
                name.span,
                format!(
                    "`{}` is {}, it has no rate of its own",
                    name.name,
                    entry.kind.describe()
                ),
            )
            .help("rates belong to coordinates")
            .note(entry.span, "defined here"),
            None => scope.unknown(name.span, &name.name, "coordinate", |kind| {
                matches!(kind, NameKind::Coord(_))
            }),
        };
        report.push(error);
        return None;
    };
    let entries = &declared.x[coordinate.offset..coordinate.offset + size(coordinate.kind)];
    let whole = coordinate.offset..coordinate.offset + entries.len();
    let at = |from: usize, len: usize| coordinate.offset + from..coordinate.offset + from + len;
    match (&target.field, coordinate.kind) {
        (None, kind) => Some((whole, coordinate_value(kind, entries))),
        (Some(field), CoordKind::SE3) if field.name == "p" => {
            Some((at(0, 3), Value::Vector(entries[..3].to_vec())))
        }
        (Some(field), CoordKind::SE3) if field.name == "R" => {
            Some((at(3, 9), coordinate_value(CoordKind::SO3, &entries[3..])))
        }
        (Some(field), CoordKind::S1) if field.name == "c" => {
            Some((at(0, 1), Value::Scalar(entries[0])))
        }
        (Some(field), CoordKind::S1) if field.name == "s" => {
            Some((at(1, 1), Value::Scalar(entries[1])))
        }
        (Some(field), _) => {
            report.push(no_part(name, field));
            None
        }
    }
}

fn no_part(name: &Ident, field: &Ident) -> Diagnostic {
    Diagnostic::new(
        field.span,
        format!("`{}` has no part `.{}`", name.name, field.name),
    )
    .help("parts are `.p` and `.R` of an SE3 coordinate, `.c` and `.s` of an S1 coordinate")
}

fn rate_help(name: &str, kind: CoordKind) -> String {
    match kind {
        CoordKind::Real => format!("write `rate {name} = u;` with a velocity u"),
        CoordKind::Euclidean(n) => format!("write `rate {name} = v;` with a velocity v: vec{n}"),
        CoordKind::S1 => format!("write `rate {name} = w;` with its angular velocity w"),
        CoordKind::S3 => format!("write `rate {name} = qmul({name}, [0, w[1], w[2], w[3]]) / 2;`"),
        CoordKind::SO3 => format!("write `rate {name} = {name} * hat(w);` with a velocity w: vec3"),
        CoordKind::SE3 => format!(
            "write `rate {name}.p = {name}.R * v;` and `rate {name}.R = {name}.R * hat(w);`"
        ),
    }
}

/// A = ∂ẋ/∂ξ, with ẋ − A ξ = 0 and A free of ξ and u.
fn linear_part(
    graph: &mut Graph,
    rate: &[Edge],
    spans: &[Span],
    declared: &Declared,
    report: &mut Report,
) -> Option<Vec<Vec<Edge>>> {
    let mut a = vec![Vec::new(); rate.len()];
    for &xi in &declared.xi {
        let mut derivation = Derivation::new([(xi.node(), graph.one())]);
        for (row, &entry) in a.iter_mut().zip(rate) {
            row.push(derivation.of(graph, entry));
        }
    }
    let mut bad = false;
    let mut last: Option<Span> = None;
    for ((row, &entry), &span) in a.iter().zip(rate).zip(spans) {
        let whole = graph.dot(row, &declared.xi);
        let class = row
            .iter()
            .fold(0, |class, edge| class | graph.class(edge.node()));
        if whole == entry && class & !(class::PARAM | class::COORD) == 0 {
            continue;
        }
        bad = true;
        // Entries of one statement share its span; one error for them all.
        if last.is_some_and(|last| same(last, span)) {
            continue;
        }
        last = Some(span);
        report.push(
            Diagnostic::new(span, "this rate is not linear in the velocities")
                .help("a rate is A(x) ξ: every term has exactly one velocity as a factor, times coordinates and parameters"),
        );
    }
    (!bad).then_some(a)
}

fn same(a: Span, b: Span) -> bool {
    format!("{:?}{:?}", a.lo, a.hi) == format!("{:?}{:?}", b.lo, b.hi)
}

/// ∂φ/∂x at the lanes' points of X; one matrix a lane.
fn jacobian(
    points: &Points,
    graph: &Graph,
    phi: &[(Edge, String)],
    declared: &Declared,
) -> Option<Vec<Vec<Vec<Fp>>>> {
    let mut free = points.free.clone();
    let nu = declared.x.len();
    let x: Vec<Edge> = (points.first..points.first + nu)
        .map(|i| Edge::of(free.symbols()[i].node))
        .collect();
    let mut entries = Vec::new();
    for &(row, _) in phi {
        for edge in &x {
            let mut derivation = Derivation::new([(edge.node(), free.one())]);
            entries.push(derivation.of(&mut free, row));
        }
    }
    (0..LANES)
        .map(|lane| {
            let mut point = Lane::new(lane as u64);
            for symbol in graph.symbols() {
                point.push_symbol(graph.value(Edge::of(symbol.node))[lane]);
            }
            let values = evaluate_at(&free, &entries, &mut point)?;
            Some(values.chunks(nu).map(<[Fp]>::to_vec).collect())
        })
        .collect()
}

/// (∂φ/∂x) A = 0 on X.
fn check_tangent(
    graph: &Graph,
    a: &[Vec<Edge>],
    spans: &[Span],
    phi: &[(Edge, String)],
    jacobian: Option<&[Vec<Vec<Fp>>]>,
    declared: &Declared,
    report: &mut Report,
) -> Option<()> {
    let Some(jacobian) = jacobian else {
        return Some(());
    };
    let mut bad = false;
    let mut reported: Vec<Span> = Vec::new();
    for (row, (_, text)) in phi.iter().enumerate() {
        for i in 0..declared.xi.len() {
            let leaves = (0..LANES).any(|lane| {
                let sum = a
                    .iter()
                    .enumerate()
                    .fold(Fp::ZERO, |sum, (alpha, entries)| {
                        sum + jacobian[lane][row][alpha] * graph.value(entries[i])[lane]
                    });
                !sum.is_zero()
            });
            if !leaves {
                continue;
            }
            bad = true;
            // The first coordinate that the row is about carries the place.
            let Some(alpha) =
                (0..declared.x.len()).find(|&alpha| !jacobian[0][row][alpha].is_zero())
            else {
                continue;
            };
            let span = spans[alpha];
            if reported.iter().any(|&known| same(known, span)) {
                continue;
            }
            reported.push(span);
            let coordinate = declared.coordinates.iter().rfind(|c| c.offset <= alpha);
            let velocity = graph
                .symbols()
                .iter()
                .find(|s| s.node == declared.xi[i].node())
                .map_or("", |s| s.name.as_str());
            let help = coordinate.map_or(String::new(), |c| match c.kind {
                CoordKind::Real | CoordKind::Euclidean(_) => {
                    "choose rates whose motion keeps the constraint: (∂φ/∂x) A = 0".into()
                }
                kind => rate_help(&c.name, kind),
            });
            report.push(Diagnostic::new(span, format!("this rate leaves the constraint {text}: a motion along `{velocity}` changes it")).help(help));
        }
    }
    (!bad).then_some(())
}

/// n = dim X = ν − rank ∂φ/∂x, and A of rank n.
fn check_count(
    system: &System,
    graph: &Graph,
    a: &[Vec<Edge>],
    jacobian: Option<&[Vec<Vec<Fp>>]>,
    declared: &Declared,
    report: &mut Report,
) -> Option<()> {
    let n = declared.xi.len();
    let rank_phi = jacobian.map_or(0, |lanes| rank(lanes[0].clone()));
    let dimension = declared.x.len() - rank_phi;
    let span = system
        .items
        .iter()
        .find_map(|item| match &item.kind {
            ItemKind::Velocity(list) => list.first().map(|first| {
                first
                    .name
                    .span
                    .to(list.last().map_or(first.name.span, |l| l.name.span))
            }),
            _ => None,
        })
        .unwrap_or(system.name.span);
    if n != dimension {
        let (few, help) = if n < dimension {
            (
                "too few",
                "add velocities until they are as many as the system has degrees of freedom",
            )
        } else {
            (
                "too many",
                "remove velocities, or a constraint that is not meant",
            )
        };
        report.push(
            Diagnostic::new(span, format!("{few} velocities: there are {n}, the configurations form a set of dimension {dimension} ({} coordinates less {rank_phi} independent constraints)", declared.x.len())).help(help),
        );
        return None;
    }
    let values: Vec<Vec<Fp>> = a
        .iter()
        .map(|row| row.iter().map(|&edge| graph.value(edge)[0]).collect())
        .collect();
    let rank_a = rank(values.clone());
    if rank_a < n {
        // The first column that depends on those before it.
        let dependent = (0..n)
            .find(|&i| rank(values.iter().map(|row| row[..=i].to_vec()).collect()) <= i)
            .unwrap_or(0);
        let name = graph
            .symbols()
            .iter()
            .find(|s| s.node == declared.xi[dependent].node())
            .map_or("", |s| s.name.as_str());
        report.push(
            Diagnostic::new(
                span,
                format!("the velocities are not independent: A has rank {rank_a}, not {n}"),
            )
            .help(format!(
                "`{name}` moves nothing that the velocities before it do not move"
            )),
        );
        return None;
    }
    Some(())
}
