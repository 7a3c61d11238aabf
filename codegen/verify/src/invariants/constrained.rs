//! Claims about systems with constraints on their velocities: d/dt I at exact points modulo p where B ξ = 0, with ξ̇
//! from the program, which has already been validated.

use crate::confidence::Confidence;
use crate::kernel::satisfying_constraints;
use crate::points::{COMPARED_POINTS, Disagreement, compare_at_fresh_points};
use crate::verdict::{Identity, Verdict};
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Edge;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::tangent::tangent_at;
use hamel_dynamics::calculus::Calculus;
use hamel_dynamics::{energy, inertia, quantity};
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::Model;
use hamel_language::model::invariants::Invariant;
use hamel_program::Program;

/// Returns an error for every quantity that an `invariant` statement claims to be constant and that is not, where the
/// constraints hold, at points modulo p.
pub fn reject_false_constrained_invariants(
    model: &Model,
    program: &Program,
) -> Result<(), Vec<Diagnostic>> {
    let loops = model
        .constraints
        .iter()
        .any(|c| c.residual != model.graph.zero());
    let mut errors = Vec::new();
    for claim in &model.invariants {
        let message = match find_refutation(model, program, claim) {
            None => continue,
            Some(Disagreement::Nowhere) => format!(
                "the claim `{}` cannot be checked: the motion has no value where the claim is made",
                claim.name
            ),
            Some(Disagreement::Differs(entry)) => format!(
                "entry {} of `{}` is not constant along the motion: d/dt is not zero where the constraints hold",
                entry + 1,
                claim.name
            ),
        };
        errors.push(Diagnostic::new(claim.span, message).help(if model.clock.is_some() || !model.accelerated.is_empty() {
            "quantities that depend on time, or on which drives do work, are not constant: T + V changes by −∂L/∂t and by their power"
        } else if loops {
            "claim only what is constant for every position of the tree: the loops are not closed where claims are checked"
        } else {
            "claim only what is constant, or give the inputs and parameters for which it is: `when F = 0`"
        }));
    }
    if errors.is_empty() {
        Ok(())
    } else {
        Err(errors)
    }
}

/// Checks at points modulo p that every quantity that an `invariant` statement claims to be constant is so where the
/// constraints hold, and returns one verdict for each.
pub fn check_constrained_invariants(model: &Model, program: &Program) -> Vec<Identity> {
    let verdict = |claim: &Invariant| match find_refutation(model, program, claim) {
        None => Verdict::Checked(confidence(model, program)),
        Some(_) => Verdict::Failed("d/dt is not zero where the constraints hold".into()),
    };
    model
        .invariants
        .iter()
        .map(|claim| Identity {
            label: "invariant",
            equation: format!("d/dt {} = 0 where B ξ = 0", claim.name),
            verdict: verdict(claim),
        })
        .collect()
}

/// Bounds the chance of error: an integral made of T, V and momenta is differentiated along ξ̇.
fn confidence(model: &Model, program: &Program) -> Confidence {
    let mut own = model.clone();
    let mut calculus = Calculus::new(&own);
    let energies = energies(&mut own, &mut calculus);
    let energies = [energies.0, energies.1];
    let mut roots = inertia::mass_matrix(&mut own, &mut calculus).concat();
    roots.extend(own.rate.iter().chain(&energies).copied());
    let accel = program.xi_dot().unwrap_or_default();
    let expressions = [(&own.graph, &roots[..]), (&program.graph, accel)];
    let terms = 4 * (model.n() + 1);
    Confidence::new(model, &expressions, terms, COMPARED_POINTS, 9)
}

/// Returns T and V.
fn energies(model: &mut Model, calculus: &mut Calculus) -> (Edge, Edge) {
    let kinetic = if model.is_affine() {
        energy::kinetic_of_bodies(model, calculus)
    } else {
        let mass = inertia::mass_matrix(model, calculus);
        energy::kinetic(model, &mass)
    };
    let kinetic = energy::kinetic_in_energy(model, kinetic);
    (kinetic, energy::potential(model))
}

/// Returns how the claim fails, with the index of the entry that changes; `None` if it does not fail.
fn find_refutation(
    model: &Model,
    program: &Program,
    claim: &Invariant,
) -> Option<Disagreement<usize>> {
    let mut own = model.clone();
    let mut calculus = Calculus::new(&own);
    let energies = energies(&mut own, &mut calculus);
    let value = quantity::quantity_value(&mut own, &mut calculus, energies, &claim.quantity);
    let entries = value.entries();
    let compared = compare_at_fresh_points(
        |number| {
            let moved = |point| satisfying_constraints(&own, point);
            own.points
                .lane_moved(0x1a7f + number, &own.graph, &claim.set, &moved)
        },
        |point, _| {
            let slopes = slopes(&own, program, &entries, point)?;
            let changes = slopes.iter().position(|slope| !slope.is_zero());
            Some(changes.map_or(Ok(()), Err))
        },
    );
    compared.err()
}

/// Returns d/dt of the entries at a point with B ξ = 0.
fn slopes(
    model: &Model,
    program: &Program,
    entries: &[Edge],
    point: &FieldPoint,
) -> Option<Vec<ResiduePair>> {
    let graph = &model.graph;
    let xi_dot = evaluate_at(&program.graph, program.xi_dot()?, &mut point.clone())?;
    let rate = evaluate_at(graph, &model.rate, &mut point.clone())?;
    let direction = super::direction(model, &rate, &xi_dot);
    let duals = tangent_at(graph, entries, &mut point.clone(), &direction)?;
    Some(duals.into_iter().map(|dual| dual.1).collect())
}
