//! Points of a system with constraints on its velocities: ξ moved to where B ξ = 0.

use crate::algebra::fp::Fp;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::model::points::Moved;
use crate::model::{Model, class};

/// The velocities of a point moved to where all rows vanish, with the symbols that they are.
pub(super) fn at_rest(model: &Model, mut lane: Lane) -> Option<Moved> {
    let places = places(&model.graph, class::VELOCITY);
    let rows = model.constraints.iter().flat_map(|c| c.row.clone());
    let rows: Vec<Edge> = rows.collect();
    let xi: Vec<Fp> = places.iter().map(|&place| lane.symbol(place)).collect();
    let rows = evaluate_at(&model.graph, &rows, &mut lane)?;
    let moved = in_kernel(&rows, &xi)?;
    Some(places.into_iter().zip(moved).collect())
}

/// A vector on which all rows vanish: by elimination, dependent entries replaced.
fn in_kernel(rows: &[Fp], xi: &[Fp]) -> Option<Vec<Fp>> {
    let n = xi.len();
    let mut rows: Vec<Vec<Fp>> = rows.chunks(n).map(<[Fp]>::to_vec).collect();
    let mut xi = xi.to_vec();
    let mut pivots: Vec<(usize, usize)> = Vec::new();
    for i in 0..rows.len() {
        // What is left of a row that follows from others vanishes anyway.
        let Some(pivot) = (0..n).find(|&j| !rows[i][j].is_zero()) else {
            continue;
        };
        let inverse = rows[i][pivot].inv()?;
        let row: Vec<Fp> = rows[i].iter().map(|&entry| entry * inverse).collect();
        for (k, other) in rows.iter_mut().enumerate() {
            if k != i {
                let factor = other[pivot];
                for (entry, &by) in other.iter_mut().zip(&row) {
                    *entry = *entry - factor * by;
                }
            }
        }
        rows[i] = row;
        pivots.push((i, pivot));
    }
    for &(row, pivot) in &pivots {
        xi[pivot] = (0..n)
            .filter(|j| pivots.iter().all(|(_, pivot)| pivot != j))
            .fold(Fp::ZERO, |sum, j| sum - rows[row][j] * xi[j]);
    }
    Some(xi)
}

/// The places of the symbols of a class.
pub(super) fn places(graph: &Graph, class: u8) -> Vec<usize> {
    let symbols = graph.symbols().iter().enumerate();
    symbols
        .filter(|(_, symbol)| symbol.class == class)
        .map(|(index, _)| index)
        .collect()
}
