//! Limits on moving origins and choosing axes, within which the resulting numbers keep their
//! digits.

use super::draft::LinkDraft;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::rounding::{UNIT_ROUNDOFF, evaluate_with_bounds};
use hamel_language::model::Model;

/// Largest shift of an origin in multiples of the size of the description.
///
/// Rounding then costs less than the square of this, 64 units of roundoff.
const MAX_SHIFT_RATIO: f64 = 8.0;
/// Largest accepted rounding error of a direction, in units of roundoff.
const MAX_DIRECTION_ERROR: f64 = 256.0;

/// Limits within which origins may be moved and axes chosen without losing digits to rounding.
#[derive(Clone, Debug)]
pub struct RoundingLimits {
    /// Default values of parameters.
    numbers: Vec<f64>,
    /// Largest distance between an origin and that of the parent link or a centre of mass (m).
    ///
    /// The positions of the first links in the world do not count.
    size: f64,
}

impl RoundingLimits {
    /// Determines the largest distance between an origin and that of its parent link or a centre of mass, at the default
    /// parameters; origins may be moved by a multiple of it.
    pub fn of(model: &Model, links: &[LinkDraft]) -> Self {
        let mut limits = RoundingLimits {
            numbers: model.numbers(&model.defaults, &[], &[], &[], &[]),
            size: 0.0,
        };
        let graph = &model.graph;
        for link in links {
            let mass = limits.length(graph, &[link.mass.mass]);
            let mut lengths = vec![limits.length(graph, &link.mass.first) / mass];
            if link.parent.is_some() {
                lengths.push(limits.length(graph, &link.position));
            }
            let known = lengths.into_iter().filter(|length| length.is_finite());
            limits.size = known.fold(limits.size, f64::max);
        }
        limits
    }

    /// Returns the norm of constant entries; NaN if one of them varies.
    fn length(&self, graph: &Graph, entries: &[Edge]) -> f64 {
        if entries.iter().any(|entry| !graph.is_free(entry.node())) {
            return f64::NAN;
        }
        let values = evaluate_with_bounds(graph, entries, &self.numbers).into_iter();
        values
            .map(|entry| entry.value * entry.value)
            .sum::<f64>()
            .sqrt()
    }

    /// Returns whether an origin may be moved by a distance.
    pub fn allows_shift(&self, graph: &Graph, distance: Edge) -> bool {
        self.length(graph, &[distance]) <= MAX_SHIFT_RATIO * self.size
    }

    /// Returns whether the direction of a vector is accurate in spite of rounding.
    pub fn has_direction(&self, graph: &Graph, vector: &[Edge]) -> bool {
        let entries = evaluate_with_bounds(graph, vector, &self.numbers);
        let norm = |pick: fn(f64, f64) -> f64| {
            let squares = entries.iter().map(|e| pick(e.value, e.error).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let (length, error) = (norm(|value, _| value), norm(|_, error| error));
        length > 0.0 && error <= MAX_DIRECTION_ERROR * UNIT_ROUNDOFF * length
    }

    /// Returns whether a cosine and a sine are accurate in spite of rounding.
    ///
    /// Their square root may be known by another expression, in which digits cancel.
    pub fn is_accurate(&self, graph: &Graph, turn: &[Edge]) -> bool {
        let entries = evaluate_with_bounds(graph, turn, &self.numbers);
        entries
            .iter()
            .all(|entry| entry.error <= MAX_DIRECTION_ERROR * UNIT_ROUNDOFF)
    }
}
