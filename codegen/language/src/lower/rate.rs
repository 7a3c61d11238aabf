//! Rates of coordinates, ẋ = A ξ; the coordinates and parts that statements name; and how a rate is written.

use super::declare::{Declared, coordinate_value, size};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::numeric::evaluate;
use crate::model::Coordinate;
use crate::model::completion::Completion;
use crate::model::value::Value;
use crate::shapes::{rate_help, velocity_for};
use crate::syntax::ast::{CoordKind, Expr, Target};
use std::ops::Range;

/// Kinematics of a description: expressions of ẋ and of A in ẋ = A ξ.
pub struct Kinematics {
    pub rate: Vec<Edge>,
    pub a: Vec<Vec<Edge>>,
    pub completion: Completion,
}

/// Rate of one entry of x, and index of the statement that gives it.
#[derive(Clone, Copy)]
pub struct Rate {
    pub edge: Edge,
    pub item: usize,
}

/// Values of the parameters and of x at the start, which satisfy φ = 0.
#[derive(Clone, Copy)]
pub struct At<'a> {
    pub defaults: &'a [f64],
    pub x: &'a [f64],
}

impl At<'_> {
    /// Evaluates expressions of parameters and coordinates.
    pub fn evaluate(&self, graph: &Graph, edges: &[Edge]) -> Vec<f64> {
        let mut numbers = vec![std::f64::consts::PI];
        numbers.extend(self.defaults.iter().chain(self.x));
        numbers.resize(graph.symbols().len(), f64::NAN);
        evaluate(graph, edges, &numbers)
    }
}

/// Returns the range of entries of x that a target names, and its value.
pub fn part(target: &Target, declared: &Declared) -> Option<(Range<usize>, Value)> {
    let name = &target.name;
    let mut coordinates = declared.coordinates.iter();
    let coordinate = coordinates.find(|c| c.name == name.name)?;
    let entries = &declared.x[coordinate.offset..coordinate.offset + size(coordinate.kind)];
    let at = |from: usize, len: usize| coordinate.offset + from..coordinate.offset + from + len;
    let field = target.field.as_ref().map(|field| field.name.as_str());
    let (range, value) = match (field, coordinate.kind) {
        (None, kind) => (at(0, entries.len()), coordinate_value(kind, entries)),
        (Some("p"), CoordKind::SE3) => (at(0, 3), Value::Vector(entries[..3].to_vec())),
        (Some("R"), CoordKind::SE3) => (at(3, 9), coordinate_value(CoordKind::SO3, &entries[3..])),
        (Some("c"), CoordKind::S1) => (at(0, 1), Value::Scalar(entries[0])),
        (Some("s"), CoordKind::S1) => (at(1, 1), Value::Scalar(entries[1])),
        _ => return None,
    };
    Some(entry(target, range, value))
}

/// Returns the part of a vector in a range that a target names: all of it, or one entry.
pub fn entry(target: &Target, range: Range<usize>, value: Value) -> (Range<usize>, Value) {
    match &value {
        Value::Vector(entries) => match target.place(entries.len()) {
            Some(place) => {
                let first = range.start + place;
                (first..first + 1, Value::Scalar(entries[place]))
            }
            None => (range, value),
        },
        _ => (range, value),
    }
}

/// Returns how the rate of a coordinate is written, with the velocity that probably moves it.
pub fn advised(coordinate: &Coordinate, rate: Option<&Expr>, declared: &Declared) -> String {
    let velocities = declared.velocities.iter();
    let velocities = velocities.map(|group| (group.name.as_str(), group.shape));
    let velocity = velocity_for(coordinate.kind, rate, velocities);
    rate_help(&coordinate.name, coordinate.kind, velocity)
}
