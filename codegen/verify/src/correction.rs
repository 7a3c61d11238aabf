//! Proof of φ, and of the stabilising term −Ψ φ, KR18 (8).

use super::kernel::multiply;
use super::points::{Disagreement, compare_at_fresh_points};
use super::verdict::{failure, nowhere};
use hamel_algebra::graph::Edge;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_algebra::tangent::{Dual, tangent_at};
use hamel_algebra::transplant::rebuild;
use hamel_dynamics::kinematics::left_inverse;
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::Model;
use hamel_program::{FunctionId, Program};

/// Checks at random points modulo p that the emitted φ of coordinates is that of the model and that the emitted
/// correction −Ψ φ has the derivative A Y − I on X.
///
/// φ is compared off X, at random x. The correction is compared at fresh points of X: there it is 0, and its derivative
/// is −Ψ Φ = A Y − I, KR18 (6), along any direction, tangent or not; random directions are taken.
pub fn validate(model: &Model, program: &Program) -> Result<(), Diagnostic> {
    constraint(model, program)?;
    let Some(function) = program.function(FunctionId::Correction) else {
        return Ok(());
    };
    let what = "d(−Ψ φ) = A Y − I on X";
    let failure = || failure(model, what);
    let mut on_x = model.clone();
    let y = left_inverse(&mut on_x).ok_or_else(failure)?;
    let (mut free, first) = (model.points.free.clone(), model.points.first);
    // Copied node by node into the graph in which nothing is simplified modulo φ.
    let emitted = rebuild(&program.graph, &mut free, &function.outputs);
    let (n, nu) = (model.n(), model.nu());
    let mut roots = on_x.a.concat();
    roots.extend(y.iter().flatten());
    compare_at_fresh_points(
        |number| model.points.lane(0xc0_44ec + number),
        |point, number| {
            let values = evaluate_at(&on_x.graph, &roots, &mut point.clone())?;
            let (a, y) = values.split_at(nu * n);
            let mut random = Random::new(0x9e5 + number);
            let step: Vec<ResiduePair> = (0..nu).map(|_| random.element()).collect();
            let mut direction = vec![ResiduePair::ZERO; free.symbols().len()];
            direction[first..first + nu].copy_from_slice(&step);
            let seen = multiply(n, y, &step);
            let tangent = multiply(nu, a, &seen);
            let slopes = tangent.iter().zip(&step).map(|(&tangent, &h)| tangent - h);
            // The correction is 0 on X.
            let expected: Vec<Dual> = slopes.map(|slope| (ResiduePair::ZERO, slope)).collect();
            let found = tangent_at(&free, &emitted, &mut point.clone(), &direction)?;
            Some(if found == expected { Ok(()) } else { Err(()) })
        },
    )
    .map_err(|unequal| match unequal {
        Disagreement::Differs(()) => failure(),
        Disagreement::Nowhere => nowhere(model),
    })
}

/// Compares φ of coordinates, whose rows precede those of loops.
fn constraint(model: &Model, program: &Program) -> Result<(), Diagnostic> {
    let Some(function) = program.function(FunctionId::Constraint) else {
        return Ok(());
    };
    let (mut free, first) = (model.points.free.clone(), model.points.first);
    let phi: Vec<Edge> = model.phi.iter().map(|(edge, _)| *edge).collect();
    let Some(outputs) = function.outputs.get(..phi.len()) else {
        return Err(failure(model, "φ as described"));
    };
    let emitted = rebuild(&program.graph, &mut free, outputs);
    compare_at_fresh_points(
        |number| {
            let mut point = model.points.lane(0xf1_0ff + number)?;
            let mut random = Random::new(0x0f_f2e + number);
            for place in first..first + model.nu() {
                point.set_symbol(place, random.element());
            }
            Some(point)
        },
        |point, _| {
            let at = |edges: &[Edge]| evaluate_at(&free, edges, &mut point.clone());
            let same = at(&emitted)? == at(&phi)?;
            Some(if same { Ok(()) } else { Err(()) })
        },
    )
    .map_err(|unequal| match unequal {
        Disagreement::Differs(()) => failure(model, "φ as described"),
        Disagreement::Nowhere => nowhere(model),
    })
}
