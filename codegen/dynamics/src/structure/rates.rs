//! The rates w of the coordinates: w = B(x) ξ per block, ẋ of plain coordinates, θ̇ of circles, the body
//! angular velocity of quaternions and rotations; ξ = N(x) w.

use super::variation::Variation;
use crate::kinematics::{chart_rates, left_inverse};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{multiply, transpose};
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;
use hamel_language::model::charts::all_tangents;
use hamel_language::model::layout::{Block, blocks};

/// A block of x with its place in x and among the rates, and the name of its coordinate.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its kind.
    pub block: Block,
    /// As the language writes it: `R`, `X.p`.
    pub name: String,
    /// Place of its first entry in x.
    pub first: usize,
    /// Place of its first rate.
    pub rate: usize,
}

impl Part {
    /// Places of its rates.
    pub fn rates(&self) -> std::ops::Range<usize> {
        self.rate..self.rate + self.block.dimension()
    }

    /// Its entries.
    pub fn entries<'a>(&self, x: &'a [Edge]) -> &'a [Edge] {
        x.get(self.first..self.first + self.block.len())
            .unwrap_or_default()
    }

    /// Whether it is a rotor's attitude.
    pub fn turns(&self) -> bool {
        matches!(self.block, Block::Quaternion | Block::Rotation)
    }
}

/// The blocks of x in their order.
pub fn parts(model: &Model) -> Vec<Part> {
    let mut parts = Vec::new();
    let (mut first, mut rate) = (0, 0);
    for coordinate in &model.coordinates {
        let kinds = blocks(coordinate.kind);
        for (index, &block) in kinds.iter().enumerate() {
            let suffix = match (kinds.len(), index) {
                (1, _) => "",
                (_, 0) => ".p",
                _ => ".R",
            };
            parts.push(Part {
                block,
                name: format!("{}{suffix}", coordinate.name),
                first,
                rate,
            });
            first += block.len();
            rate += block.dimension();
        }
    }
    parts
}

/// B and N.
pub struct RateMaps {
    /// w = B ξ.
    pub of_velocities: Vec<Vec<Edge>>,
    /// ξ = N w.
    pub to_velocities: Vec<Vec<Edge>>,
}

/// B and N of a model with as many velocities as its blocks have rates, in another graph with its
/// symbols.
pub fn rates(model: &Model, graph: &mut Graph) -> Option<RateMaps> {
    let mut own = model.clone();
    let y = left_inverse(&mut own)?;
    let columns = transpose(&own.a);
    let b: Vec<Vec<Edge>> = columns
        .iter()
        .map(|column| chart_rates(&mut own.graph, &own.blocks, &own.x, column))
        .collect();
    let tangents = all_tangents(&mut own.graph, &own.blocks, &own.x, |_| true);
    let n = multiply(&mut own.graph, &y, &transpose(&tangents));
    let mut carry = |rows: &[Vec<Edge>]| -> Vec<Vec<Edge>> {
        rows.iter()
            .map(|row| rebuild(&own.graph, graph, row))
            .collect()
    };
    Some(RateMaps {
        of_velocities: transpose(&carry(&b)),
        to_velocities: carry(&n),
    })
}

/// Whether det B is the same everywhere: d ln det B = tr (N dB) vanishes along all rates.
pub fn measure_alike(model: &Model, graph: &mut Graph, rates: &RateMaps) -> bool {
    let zero = graph.zero();
    let tangents = all_tangents(graph, &model.blocks, &model.x, |_| true);
    // Entries that depend on coordinates: of large frames they are few.
    let mut varying = Vec::new();
    for (i, row) in rates.of_velocities.iter().enumerate() {
        for (j, &entry) in row.iter().enumerate() {
            let factor = rates.to_velocities[j][i];
            if factor != zero && !graph.is_free(entry.node()) {
                varying.push((entry, factor));
            }
        }
    }
    tangents.into_iter().all(|column| {
        let seeds = model.x.iter().map(|x| x.node()).zip(column);
        let mut along = hamel_algebra::derivation::Derivation::new(seeds);
        let mut trace = zero;
        for &(entry, factor) in &varying {
            let slope = along.of(graph, entry);
            let product = graph.mul(slope, factor);
            trace = graph.add(trace, product);
        }
        trace == zero
    })
}

/// The names of the parts with which some of the expressions change.
pub fn dependence(
    variation: &Variation,
    graph: &Graph,
    parts: &[Part],
    x: &[Edge],
    edges: &[Edge],
) -> Vec<String> {
    let dependence = variation.of(graph, edges);
    let changing = parts.iter().filter(|part| match &dependence {
        Some(dependence) => dependence.changes(part.entries(x)).contains(&true),
        None => true,
    });
    changing.map(|part| part.name.clone()).collect()
}
