//! The stabilising direction −Ψ φ(x) of KR18 (8): ẋ = A ξ − λ Ψ φ makes φ decay like exp(−λ t).
//!
//! Ψ is that of the description, with Y Ψ = 0. The direction is needed off X, where φ is not 0: Ψ
//! may be any expression with the right values on X, but φ has to be exact. Φ A = 0 also holds on X
//! only: off X, a motion adds terms in ξ φ to φ̇ = −λ φ, which λ has to exceed.

use super::complement::{Complement, complement};
use super::kinematics::left_inverse;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{multiply, transpose};
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;
use hamel_language::model::layout::Block;

/// Returns −Ψ φ, the change of x that returns it to X to first order, as expressions in the graph with unconstrained
/// points.
///
/// It is −½ (|x|² − 1) x for circle and quaternion, −½ R (RᵀR − I) for rotations, and −Ψ φ with the
/// Ψ valid on X for everything else.
pub fn correction(model: &Model, free: &mut Graph) -> Option<Vec<Edge>> {
    let mut on_x = model.clone();
    let y = left_inverse(&mut on_x)?;
    let complement = complement(&mut on_x, &y)?;
    let first = model.points.first;
    let x: Vec<Edge> = (first..first + model.nu())
        .map(|index| Edge::of(free.symbols()[index].node))
        .collect();
    let mut correction = closed_forms(free, &model.blocks, &x);
    let Complement {
        rows,
        psi,
        beyond,
        kinds,
        ..
    } = complement;
    for (alpha, entry) in correction.iter_mut().enumerate() {
        let row: Vec<Edge> = beyond[alpha]
            .iter()
            .chain(&psi[alpha][kinds..])
            .copied()
            .collect();
        let row = rebuild(&on_x.graph, free, &row);
        for (&number, factor) in rows.iter().zip(row) {
            let product = free.mul(factor, model.phi[number].0);
            *entry = free.sub(*entry, product);
        }
    }
    Some(correction)
}

/// Returns the corrections of the coordinate kinds alone.
fn closed_forms(free: &mut Graph, blocks: &[Block], x: &[Edge]) -> Vec<Edge> {
    let half = free.ratio(1, 2);
    let mut correction = vec![free.zero(); x.len()];
    let mut place = 0;
    for &block in blocks {
        let entries = &x[place..place + block.len()];
        match block {
            Block::Flat(_) => {}
            Block::Circle | Block::Quaternion => {
                let square = free.dot(entries, entries);
                let defect = free.sub(free.one(), square);
                let factor = free.mul(half, defect);
                for (k, &entry) in entries.iter().enumerate() {
                    correction[place + k] = free.mul(factor, entry);
                }
            }
            Block::Rotation => {
                let rows: Vec<Vec<Edge>> = entries.chunks(3).map(<[Edge]>::to_vec).collect();
                let columns = transpose(&rows);
                let mut gram = multiply(free, &columns, &rows);
                for (i, row) in gram.iter_mut().enumerate() {
                    for (j, entry) in row.iter_mut().enumerate() {
                        let target = if i == j { free.one() } else { free.zero() };
                        let defect = free.sub(target, *entry);
                        *entry = free.mul(half, defect);
                    }
                }
                let product = multiply(free, &rows, &gram);
                for (k, entry) in product.concat().into_iter().enumerate() {
                    correction[place + k] = entry;
                }
            }
        }
        place += block.len();
    }
    correction
}
