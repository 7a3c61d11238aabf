//! Rates w of the coordinates: w = B(x) ξ and ξ = N(x) w.
//!
//! Block by block, w is ẋ for plain coordinates, θ̇ for circles, and the body angular velocity for
//! quaternions and rotations.

use super::variation::Variation;
use crate::kinematics::{chart_rates, left_inverse};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{multiply, transpose};
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;
use hamel_language::model::charts::all_tangents;
use hamel_language::model::layout::{Block, blocks};

/// Block of x, with its position in x and among the rates, and the name of its coordinate.
#[derive(Clone, Debug)]
pub struct CoordinateBlock {
    /// Kind of the block.
    pub block: Block,
    /// Name as the language writes it: `R`, `X.p`.
    pub name: String,
    /// Index of its first entry in x.
    pub first: usize,
    /// Index of its first rate.
    pub rate: usize,
}

impl CoordinateBlock {
    /// Returns the indices of its rates.
    pub fn rates(&self) -> std::ops::Range<usize> {
        self.rate..self.rate + self.block.dimension()
    }

    /// Returns its entries of x.
    pub fn entries<'a>(&self, x: &'a [Edge]) -> &'a [Edge] {
        x.get(self.first..self.first + self.block.len())
            .unwrap_or_default()
    }

    /// Returns whether the block is the attitude of a rotor: a quaternion or a rotation matrix.
    pub fn is_rotor(&self) -> bool {
        matches!(self.block, Block::Quaternion | Block::Rotation)
    }
}

/// Returns the blocks of x in order.
pub fn coordinate_blocks(model: &Model) -> Vec<CoordinateBlock> {
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
            parts.push(CoordinateBlock {
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

/// Matrices B and N between velocities and rates.
pub struct RateMaps {
    /// w = B ξ.
    pub of_velocities: Vec<Vec<Edge>>,
    /// ξ = N w.
    pub to_velocities: Vec<Vec<Edge>>,
}

/// Computes the matrices B and N between velocities and rates of the coordinates, in `graph`, another graph with the
/// model's symbols.
///
/// The model must have as many velocities as its blocks have rates.
pub fn rate_maps(model: &Model, graph: &mut Graph) -> Option<RateMaps> {
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

/// Returns whether det B is constant, that is, whether d ln det B = tr (N dB) vanishes along all
/// rates.
pub fn is_volume_preserving(model: &Model, graph: &mut Graph, rates: &RateMaps) -> bool {
    let zero = graph.zero();
    let tangents = all_tangents(graph, &model.blocks, &model.x, |_| true);
    // Entries that depend on coordinates; in large matrices they are few.
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

/// Returns the names of those blocks of x with which at least one of the expressions changes.
pub fn changing_parts(
    variation: &Variation,
    graph: &Graph,
    parts: &[CoordinateBlock],
    x: &[Edge],
    edges: &[Edge],
) -> Vec<String> {
    let dependence = variation.dependence_of(graph, edges);
    let changing = parts.iter().filter(|part| match &dependence {
        Some(dependence) => dependence.changes(part.entries(x)).contains(&true),
        None => true,
    });
    changing.map(|part| part.name.clone()).collect()
}
