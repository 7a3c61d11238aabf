//! The proof of the stabilising term −Ψ φ, KR18 (8).

use super::frames::applied;
use super::points::at_fresh_points;
use crate::algebra::fp::{Fp, Random};
use crate::algebra::numeric::evaluate_at;
use crate::algebra::tangent::{Dual, tangent_at};
use crate::algebra::transplant::rebuild;
use crate::derive::kinematics::left_inverse;
use crate::diagnostics::Diagnostic;
use crate::model::Model;
use crate::program::{FunctionId, Program};

/// Proves the emitted correction at fresh points of X: it is 0 there, and its derivative is −Ψ Φ = A Y − I, KR18
/// (6), along any direction, be it tangent or not; random ones are taken.
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
    // Node by node again, in the graph where nothing was simplified modulo φ.
    let emitted = rebuild(&program.graph, &mut free, &function.outputs);
    let (n, nu) = (model.n(), model.nu());
    let mut roots = on_x.a.concat();
    roots.extend(y.iter().flatten());
    at_fresh_points(
        |number| model.points.lane(0xc0_44ec + number),
        |lane, number| {
            let values = evaluate_at(&on_x.graph, &roots, &mut lane.clone())?;
            let (a, y) = values.split_at(nu * n);
            let mut random = Random::new(0x9e5 + number);
            let step: Vec<Fp> = (0..nu).map(|_| random.element()).collect();
            let mut direction = vec![Fp::ZERO; free.symbols().len()];
            direction[first..first + nu].copy_from_slice(&step);
            let seen = applied(n, y, &step);
            let tangent = applied(nu, a, &seen);
            let slopes = tangent.iter().zip(&step).map(|(&tangent, &h)| tangent - h);
            // It is 0 on X.
            let expected: Vec<Dual> = slopes.map(|slope| (Fp::ZERO, slope)).collect();
            let found = tangent_at(&free, &emitted, &mut lane.clone(), &direction)?;
            Some(if found == expected { Ok(()) } else { Err(()) })
        },
    )
    .map_err(|_| failure())
}
