//! −Ψ φ(x), the stabilising direction of KR18 (8): ẋ = A ξ − λ Ψ φ makes φ decay like exp(−λ t).
//!
//! Ψ is that of the description, with Y Ψ = 0. It is wanted off X, where φ is not 0: Ψ may be any
//! expression with the right values on X, φ has to be itself. Φ A = 0 on X alone, too: off it a motion
//! adds terms of ξ φ to φ̇ = −λ φ, which λ has to exceed.

use super::complement::{Complement, complement};
use super::kinematics::left_inverse;
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{multiply, transpose};
use crate::algebra::numeric::evaluate_at;
use crate::algebra::transplant::rebuild;
use crate::diagnostics::Diagnostic;
use crate::model::Model;
use crate::model::layout::Block;
use crate::program::{FunctionId, Program};

/// Points at which the emitted function is compared.
const POINTS: usize = 4;
/// Points tried.
const TRIES: u64 = 200;

/// −Ψ φ in the graph with unconstrained points: −½ (|x|² − 1) x for circle and quaternion,
/// −½ R (RᵀR − I), and for what is beyond these −Ψ φ with Ψ as it is on X.
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

/// The corrections of the coordinate kinds alone.
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

/// Proves the emitted correction at fresh points of X: its derivative there is −Ψ Φ = A Y − I, KR18
/// (6), along any direction, be it tangent or not.
pub fn validate(model: &Model, program: &Program) -> Result<(), Diagnostic> {
    let Some(function) = program.function(FunctionId::Correction) else {
        return Ok(());
    };
    let failure = || {
        Diagnostic::new(
            model.span,
            format!(
                "internal check failed: −Ψ φ of `{}` does not lead back to φ = 0",
                model.name
            ),
        )
        .help(
            "this is a fault of the generator, nothing was emitted; please report the description",
        )
    };
    let mut on_x = model.clone();
    let y = left_inverse(&mut on_x).ok_or_else(failure)?;
    let (mut free, first) = (model.points.free.clone(), model.points.first);
    let direction: Vec<i64> = (0..model.nu() as i64)
        .map(|alpha| (7 * alpha * alpha + 3) % 11 - 5)
        .collect();
    // Node by node again, in the graph where nothing was simplified modulo φ.
    let emitted = rebuild(&program.graph, &mut free, &function.outputs);
    let seeds: Vec<_> = direction
        .iter()
        .enumerate()
        .map(|(alpha, &step)| (free.symbols()[first + alpha].node, free.ratio(step, 1)))
        .collect();
    let found = Derivation::new(seeds).all(&mut free, &emitted);
    let graph = &mut on_x.graph;
    let steps: Vec<Edge> = direction.iter().map(|&step| graph.ratio(step, 1)).collect();
    let seen: Vec<Edge> = y.iter().map(|row| graph.dot(row, &steps)).collect();
    let expected: Vec<Edge> = on_x
        .a
        .iter()
        .zip(&steps)
        .map(|(row, &step)| {
            let tangent = graph.dot(row, &seen);
            graph.sub(tangent, step)
        })
        .collect();
    let mut compared = 0;
    for seed in 0..TRIES {
        let Some(lane) = model.points.lane(0xc0_44ec + seed) else {
            continue;
        };
        let left = evaluate_at(&free, &found, &mut lane.clone());
        let right = evaluate_at(graph, &expected, &mut lane.clone());
        let (Some(left), Some(right)) = (left, right) else {
            continue;
        };
        if left != right {
            return Err(failure());
        }
        compared += 1;
        if compared == POINTS {
            return Ok(());
        }
    }
    Err(failure())
}
