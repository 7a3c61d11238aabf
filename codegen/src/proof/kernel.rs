//! Points of a system with constraints on its velocities: ξ moved to where B ξ + b = 0.

use crate::algebra::fp::{Fp, Random};
use crate::algebra::graph::Graph;

/// A vector ξ near `random` with B ξ + b = 0: by elimination, dependent entries replaced. B by rows.
pub(super) fn in_kernel(rows: &[Fp], shift: &[Fp], random: &[Fp], seed: u64) -> Option<Vec<Fp>> {
    let n = random.len();
    let mut rows: Vec<Vec<Fp>> = rows
        .chunks(n)
        .zip(shift)
        .map(|(row, &shift)| [row, &[shift]].concat())
        .collect();
    let mut stream = Random::new(seed);
    let mut xi: Vec<Fp> = random.iter().map(|&v| v + stream.element()).collect();
    let mut pivots: Vec<usize> = Vec::new();
    for i in 0..rows.len() {
        let pivot = (0..n).find(|&j| !rows[i][j].is_zero())?;
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
        pivots.push(pivot);
    }
    for (row, &pivot) in rows.iter().zip(&pivots) {
        xi[pivot] = (0..n)
            .filter(|j| !pivots.contains(j))
            .fold(-row[n], |sum, j| sum - row[j] * xi[j]);
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
