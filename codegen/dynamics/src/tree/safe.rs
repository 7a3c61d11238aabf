//! Which shifts of origins and which directions of axes keep the digits of the numbers in them.

use super::draft::Draft;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::rounding::{UNIT, bounded};
use hamel_language::model::Model;

/// An origin is moved at most so many times the size of the description: rounding then costs less than
/// its square, 64 units.
const REACH: f64 = 8.0;
/// A direction is known where rounding turns it by less than so many units.
const BLUR: f64 = 256.0;

/// The size of a description, and what its symbols stand for.
#[derive(Clone, Debug)]
pub struct Safe {
    /// Default values of parameters.
    numbers: Vec<f64>,
    /// The greatest distance between an origin and the one before or a centre of mass (m); where in the
    /// world the first links stand does not count.
    size: f64,
}

impl Safe {
    /// That of the links of a model.
    pub fn of(model: &Model, links: &[Draft]) -> Self {
        let mut safe = Safe {
            numbers: model.numbers(&model.defaults, &[], &[], &[], &[]),
            size: 0.0,
        };
        let graph = &model.graph;
        for link in links {
            let mass = safe.length(graph, &[link.mass.mass]);
            let mut lengths = vec![safe.length(graph, &link.mass.first) / mass];
            if link.parent.is_some() {
                lengths.push(safe.length(graph, &link.position));
            }
            let known = lengths.into_iter().filter(|length| length.is_finite());
            safe.size = known.fold(safe.size, f64::max);
        }
        safe
    }

    /// The norm of what is constant; NaN for what varies.
    fn length(&self, graph: &Graph, entries: &[Edge]) -> f64 {
        if entries.iter().any(|entry| !graph.is_free(entry.node())) {
            return f64::NAN;
        }
        let values = bounded(graph, entries, &self.numbers).into_iter();
        values
            .map(|entry| entry.value * entry.value)
            .sum::<f64>()
            .sqrt()
    }

    /// Whether an origin may be moved by a distance.
    pub fn is_near(&self, graph: &Graph, distance: Edge) -> bool {
        self.length(graph, &[distance]) <= REACH * self.size
    }

    /// Whether rounding leaves the direction of a vector what it is.
    pub fn has_direction(&self, graph: &Graph, vector: &[Edge]) -> bool {
        let entries = bounded(graph, vector, &self.numbers);
        let norm = |pick: fn(f64, f64) -> f64| {
            let squares = entries.iter().map(|e| pick(e.value, e.error).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let (length, error) = (norm(|value, _| value), norm(|_, error| error));
        length > 0.0 && error <= BLUR * UNIT * length
    }

    /// Whether rounding leaves a cosine and a sine what they are: their root may be known by another
    /// expression, in which digits cancel.
    pub fn is_sharp(&self, graph: &Graph, turn: &[Edge]) -> bool {
        let entries = bounded(graph, turn, &self.numbers);
        entries.iter().all(|entry| entry.error <= BLUR * UNIT)
    }
}
