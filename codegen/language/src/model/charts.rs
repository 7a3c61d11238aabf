//! Tangent vectors of each kind of coordinate, ẋ = K(x) η, and the Jacobian ∂φ/∂x.
//!
//! K has closed forms with C K = I for the canonical quasi-velocities η = C ẋ of `layout`, so that the constraints φ
//! of the coordinates themselves are eliminated without a division.

use super::layout::Block;
use super::points::Points;
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::transplant::rebuild;

/// Returns the columns of K for one block: unit vectors for flat coordinates, (−s, c) for a circle, ½ q ⊗ (0, eₖ) for
/// a quaternion and R êₖ for a rotation matrix.
pub fn tangents(graph: &mut Graph, block: Block, x: &[Edge]) -> Vec<Vec<Edge>> {
    let zero = graph.zero();
    match block {
        Block::Flat(n) => (0..n)
            .map(|k| {
                (0..n)
                    .map(|i| if i == k { graph.one() } else { zero })
                    .collect()
            })
            .collect(),
        Block::Circle => vec![vec![-x[1], x[0]]],
        Block::Quaternion => {
            let half = graph.ratio(1, 2);
            // q ⊗ (0, eₖ) = (−vₖ, w eₖ + v × eₖ).
            (0..3)
                .map(|k| {
                    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                    let mut column = vec![-x[1 + k]; 4];
                    column[1 + k] = x[0];
                    column[1 + i] = x[1 + j];
                    column[1 + j] = -x[1 + i];
                    column
                        .into_iter()
                        .map(|entry| graph.mul(half, entry))
                        .collect()
                })
                .collect()
        }
        // Column i of R êₖ is R (eₖ × eᵢ).
        Block::Rotation => (0..3)
            .map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                let mut column = vec![zero; 9];
                for row in 0..3 {
                    column[3 * row + i] = x[3 * row + j];
                    column[3 * row + j] = -x[3 * row + i];
                }
                column
            })
            .collect(),
    }
}

/// Returns the columns of K for all blocks, each with ν entries; `keep` selects blocks by the index of their first
/// entry in x.
pub fn all_tangents(
    graph: &mut Graph,
    blocks: &[Block],
    x: &[Edge],
    keep: impl Fn(usize) -> bool,
) -> Vec<Vec<Edge>> {
    let mut columns = Vec::new();
    let mut place = 0;
    for &block in blocks {
        let range = place..place + block.len();
        place += block.len();
        if !keep(range.start) {
            continue;
        }
        for part in tangents(graph, block, &x[range.clone()]) {
            let mut column = vec![graph.zero(); x.len()];
            column[range.clone()].copy_from_slice(&part);
            columns.push(column);
        }
    }
    columns
}

/// Returns ∂φ/∂x, with one row for each row of φ. The derivatives are taken in the graph with free coordinates and
/// then rebuilt in `graph`, whose points lie on X.
pub fn jacobian(
    points: &Points,
    phi: &[(Edge, String)],
    nu: usize,
    graph: &mut Graph,
) -> Vec<Vec<Edge>> {
    let mut free = points.free.clone();
    let mut columns: Vec<Derivation> = (points.first..points.first + nu)
        .map(|index| Derivation::new([(free.symbols()[index].node, free.one())]))
        .collect();
    let rows: Vec<Vec<Edge>> = phi
        .iter()
        .map(|(row, _)| columns.iter_mut().map(|c| c.of(&mut free, *row)).collect())
        .collect();
    rows.iter().map(|row| rebuild(&free, graph, row)).collect()
}
