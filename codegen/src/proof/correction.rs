//! The proof of the stabilising term −Ψ φ, KR18 (8).

use super::points::at_fresh_points;
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::Edge;
use crate::algebra::numeric::evaluate_at;
use crate::algebra::transplant::rebuild;
use crate::derive::kinematics::left_inverse;
use crate::diagnostics::Diagnostic;
use crate::model::Model;
use crate::program::{FunctionId, Program};

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
    at_fresh_points(
        |number| model.points.lane(0xc0_44ec + number),
        |lane, _| {
            let left = evaluate_at(&free, &found, &mut lane.clone())?;
            let right = evaluate_at(graph, &expected, &mut lane.clone())?;
            Some(if left == right { Ok(()) } else { Err(()) })
        },
    )
    .map_err(|_| failure())
}
