//! The rates of coordinates: ẋ = A ξ, the coordinates and parts that statements name, and how a rate is written.

use super::declare::{Declared, coordinate_value, size};
use super::expression::Evaluator;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::numeric::evaluate;
use crate::diagnostics::Diagnostic;
use crate::model::Coordinate;
use crate::model::completion::Completion;
use crate::model::value::Value;
use crate::syntax::ast::{CoordKind, Expr, ExprKind, Ident, ShapeKind, Target};

/// ẋ and A.
pub struct Kinematics {
    pub rate: Vec<Edge>,
    pub a: Vec<Vec<Edge>>,
    pub completion: Completion,
}

/// The rate of one entry of x, and the statement that gives it.
#[derive(Clone, Copy)]
pub struct Rate {
    pub edge: Edge,
    pub item: usize,
}

/// Numbers of parameters and of x at the start, which satisfy φ = 0.
#[derive(Clone, Copy)]
pub struct At<'a> {
    pub defaults: &'a [f64],
    pub x: &'a [f64],
}

impl At<'_> {
    /// Numbers of expressions of parameters and coordinates.
    pub fn evaluate(&self, graph: &Graph, edges: &[Edge]) -> Vec<f64> {
        let mut numbers = vec![std::f64::consts::PI];
        numbers.extend(self.defaults.iter().chain(self.x));
        numbers.resize(graph.symbols().len(), f64::NAN);
        evaluate(graph, edges, &numbers)
    }
}

/// A target as it stands in the text.
pub fn written(target: &Target) -> String {
    match &target.field {
        Some(field) => format!("{}.{}", target.name.name, field.name),
        None => target.name.name.clone(),
    }
}

/// The entries of x that a target names, and its value.
pub fn part(
    target: &Target,
    evaluator: &mut Evaluator,
    declared: &Declared,
) -> Option<(std::ops::Range<usize>, Value)> {
    let name = &target.name;
    let mut coordinates = declared.coordinates.iter();
    let coordinate = coordinates.find(|c| c.name == name.name)?;
    let entries = &declared.x[coordinate.offset..coordinate.offset + size(coordinate.kind)];
    let at = |from: usize, len: usize| coordinate.offset + from..coordinate.offset + from + len;
    let field = target.field.as_ref().map(|field| field.name.as_str());
    Some(match (field, coordinate.kind) {
        (None, kind) => (at(0, entries.len()), coordinate_value(kind, entries)),
        (Some("p"), CoordKind::SE3) => (at(0, 3), Value::Vector(entries[..3].to_vec())),
        (Some("R"), CoordKind::SE3) => (at(3, 9), coordinate_value(CoordKind::SO3, &entries[3..])),
        (Some("c"), CoordKind::S1) => (at(0, 1), Value::Scalar(entries[0])),
        (Some("s"), CoordKind::S1) => (at(1, 1), Value::Scalar(entries[1])),
        (Some(_), kind) => return evaluator.error(no_part(name, target.field.as_ref()?, kind)),
    })
}

fn no_part(name: &Ident, field: &Ident, kind: CoordKind) -> Diagnostic {
    let message = format!("`{}` has no part `.{}`", name.name, field.name);
    let error = Diagnostic::new(field.span, message);
    match kind {
        CoordKind::SE3 => error.help("its parts are `.p` and `.R`"),
        CoordKind::S1 => error.help("its parts are `.c` and `.s`"),
        _ => error.help(format!(
            "write `{}` alone: it is given as a whole",
            name.name
        )),
    }
}

/// How the rate of a coordinate is written, with the name of a velocity.
pub fn rate_help(coordinate: &Coordinate, velocity: &str) -> String {
    let name = &coordinate.name;
    match coordinate.kind {
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

/// The velocity that probably moves a coordinate: one that its rate mentions, else the first
/// or (for a rotation) last one of fitting shape, else a name for it.
pub fn velocity_for(coordinate: &Coordinate, rate: Option<&Expr>, declared: &Declared) -> String {
    let (shape, otherwise) = match coordinate.kind {
        CoordKind::Real => (ShapeKind::Scalar, "u"),
        CoordKind::S1 => (ShapeKind::Scalar, "w"),
        CoordKind::Euclidean(n) => (ShapeKind::Vector(n), "v"),
        CoordKind::S3 | CoordKind::SO3 | CoordKind::SE3 => (ShapeKind::Vector(3), "w"),
    };
    let fits = || {
        declared
            .velocities
            .iter()
            .filter(|group| group.shape == shape)
    };
    let mut mentioned = Vec::new();
    if let Some(rate) = rate {
        names_in(rate, &mut mentioned);
    }
    let found = fits().find(|group| mentioned.contains(&group.name.as_str()));
    let likely = match coordinate.kind {
        CoordKind::Real | CoordKind::Euclidean(_) => fits().next(),
        _ => fits().next_back(),
    };
    found
        .or(likely)
        .map_or(otherwise.into(), |group| group.name.clone())
}

fn names_in<'a>(expr: &'a Expr, names: &mut Vec<&'a str>) {
    if let ExprKind::Name(name) = &expr.kind {
        names.push(name);
    }
    let parts = expr.parts().into_iter();
    parts.for_each(|part| names_in(part, names));
}
