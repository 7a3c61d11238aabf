//! Treats time as a coordinate with a known velocity: the frame of KR18 extended by ∂₀ with ξ⁰ = 1.
//!
//! `time t;` expands to a coordinate `t` with a velocity `t_dot` and `rate t = t_dot`. Terms without a velocity, as
//! in `rate x = u + 3 * t`, are multiplied by ξ⁰: in x' = (t, x), ξ' = (ξ⁰, ξ) everything is linear or quadratic as
//! it is without time, and γ, M and Γ of the extended frame follow from KR18 (12), (20) and (23). ξ⁰ = 1 is
//! substituted when the system is reduced to its free velocities.

use super::affine::Affine;
use super::declare::Declared;
use super::quadratic::is_quadratic;
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::transplant::substitute;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::{Clock, class};
use crate::syntax::ast::{
    CoordKind, Declaration, Expr, ExprKind, Ident, Item, ItemKind, Shape, ShapeKind, System, Target,
};
use num_bigint::BigInt;
use num_rational::BigRational;

/// Returns the name of the velocity of time.
fn velocity_of(time: &Ident) -> Ident {
    Ident {
        name: format!("{}_dot", time.name),
        span: time.span,
    }
}

/// Returns the name of the time, if it is declared.
pub fn name(system: &System) -> Option<&Ident> {
    system.items.iter().find_map(|item| match &item.kind {
        ItemKind::Time(name) => Some(name),
        _ => None,
    })
}

/// Returns the system with the time expanded to a coordinate.
pub fn expand(system: &System, report: &mut Report) -> System {
    let mut items = Vec::new();
    let mut first: Option<&Ident> = None;
    for item in &system.items {
        items.push(item.clone());
        let ItemKind::Time(name) = &item.kind else {
            continue;
        };
        if let Some(first) = first {
            let error = Diagnostic::new(name.span, "the time is declared twice");
            report.push(
                error
                    .help("remove one of the two")
                    .note(first.span, "first declared here"),
            );
            continue;
        }
        first = Some(name);
        items.extend(written(name).map(|kind| Item {
            kind,
            span: item.span,
        }));
    }
    System {
        items,
        ..system.clone()
    }
}

/// Returns `coord t; velocity t_dot; rate t = t_dot; start t_dot = 1;`
fn written(time: &Ident) -> [ItemKind; 4] {
    let (velocity, span) = (velocity_of(time), time.span);
    let target = |name: &Ident| Target {
        name: name.clone(),
        field: None,
        entry: Vec::new(),
    };
    let expr = |kind: ExprKind| Expr { kind, span };
    let kind = ShapeKind::Scalar;
    [
        ItemKind::Coord(vec![(time.clone(), CoordKind::Real, None)]),
        ItemKind::Velocity(vec![Declaration {
            name: velocity.clone(),
            shape: Shape { kind, span },
            unit: None,
            value: None,
        }]),
        ItemKind::Rate {
            target: target(time),
            value: expr(ExprKind::Name(velocity.name.clone())),
        },
        ItemKind::Start {
            target: target(&velocity),
            value: expr(ExprKind::Number(
                BigRational::from_integer(BigInt::from(1)).into(),
            )),
        },
    ]
}

/// Returns the index of the time in x and that of ξ⁰ in ξ.
pub fn clock(system: &System, declared: &Declared) -> Option<Clock> {
    let time = name(system)?;
    let velocity = velocity_of(time).name;
    let coordinate = declared.coordinates.iter().find(|c| c.name == time.name)?;
    let group = declared.velocities.iter().find(|g| g.name == velocity)?;
    Some(Clock {
        x: coordinate.offset,
        xi: group.offset,
    })
}

/// Returns the term without a velocity of a function that is affine in ξ, with the index of ξ⁰, by which it is to be
/// multiplied. Returns `None` if there is no time, or if the term depends on more than coordinates and parameters.
pub fn with_time(graph: &Graph, declared: &Declared, affine: &Affine) -> Option<(usize, Edge)> {
    let clock = declared.clock?;
    let (_, found) = affine.classes(graph);
    (found & !(class::PARAM | class::CONFIGURATION) == 0).then_some((clock.xi, affine.rest))
}

/// Makes a function that is affine in ξ linear, by multiplying the term without a velocity by ξ⁰. Returns the
/// function itself if there is no time or if it has another form.
pub fn linear(graph: &mut Graph, declared: &Declared, rate: Edge) -> Edge {
    if declared.clock.is_none() {
        return rate;
    }
    let affine = Affine::of(graph, rate, &declared.xi);
    match with_time(graph, declared, &affine) {
        Some((xi, rest)) => {
            let moved = graph.mul(rest, declared.xi[xi]);
            graph.add(affine.linear, moved)
        }
        None => rate,
    }
}

/// Makes a function of degree two in ξ, such as T₂ + T₁ + T₀, quadratic: T₂ + T₁ ξ⁰ + T₀ (ξ⁰)². Returns the function
/// itself if there is no time or if it has another form.
pub fn homogeneous(graph: &mut Graph, declared: &Declared, energy: Edge) -> Edge {
    let Some(clock) = declared.clock else {
        return energy;
    };
    if is_quadratic(graph.clone(), energy, &declared.xi) {
        return energy;
    }
    let before = graph.clone();
    let tau = declared.xi[clock.xi];
    let others: Vec<Edge> = declared.xi.iter().copied().filter(|&v| v != tau).collect();
    let place = |graph: &Graph, edge: Edge| {
        let node = edge.node();
        graph.symbols().iter().position(|s| s.node == node)
    };
    let set = |graph: &Graph, edges: &[Edge], value: Edge| -> Vec<(usize, Edge)> {
        let places = edges.iter().filter_map(|&edge| place(graph, edge));
        places.map(|symbol| (symbol, value)).collect()
    };
    let now = set(graph, &[tau], graph.one());
    let still = set(graph, &others, graph.zero());
    let plain = substitute(graph, &[energy], &now)[0];
    let slopes: Vec<Edge> = others
        .iter()
        .map(|xi| Derivation::new([(xi.node(), graph.one())]).of(graph, plain))
        .collect();
    let mut sum = substitute(graph, &[plain], &still)[0];
    sum = graph.mul(sum, tau);
    for (&xi, &slope) in others.iter().zip(&slopes) {
        let linear = substitute(graph, &[slope], &still)[0];
        let term = graph.mul(linear, xi);
        sum = graph.add(sum, term);
    }
    sum = graph.mul(sum, tau);
    let half = graph.ratio(1, 2);
    let mut twice = graph.zero();
    for (&xi, &slope) in others.iter().zip(&slopes) {
        let seeds = others.iter().map(|other| (other.node(), *other));
        let quadratic = Derivation::new(seeds).of(graph, slope);
        let term = graph.mul(quadratic, xi);
        twice = graph.add(twice, term);
    }
    let quadratic = graph.mul(half, twice);
    let whole = graph.add(sum, quadratic);
    let back = substitute(graph, &[whole], &now)[0];
    if back == plain && is_quadratic(graph.clone(), whole, &declared.xi) {
        return whole;
    }
    *graph = before;
    energy
}
