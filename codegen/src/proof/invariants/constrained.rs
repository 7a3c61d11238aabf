//! Claims about systems with constraints on their velocities: d/dt I at exact points modulo p where
//! B ξ = 0, with ξ̇ by the program, which has been validated.

use crate::algebra::fp::Fp;
use crate::algebra::graph::Edge;
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::algebra::tangent::tangent_at;
use crate::derive::calculus::Calculus;
use crate::derive::{energy, inertia, quantity};
use crate::diagnostics::Diagnostic;
use crate::model::invariants::Invariant;
use crate::model::{Model, class};
use crate::program::{FunctionId, Program};
use crate::proof::confidence::Confidence;
use crate::proof::kernel::{in_kernel, places};
use crate::proof::verdict::{Identity, Verdict};

/// Fresh points for every claim.
const POINTS: u64 = 4;
/// Points tried where something has no value.
const TRIES: u64 = 400;

/// Refuses false claims; `model` is that of the active velocities.
pub fn refute(model: &Model, program: &Program) -> Result<(), Vec<Diagnostic>> {
    let loops = model
        .constraints
        .iter()
        .any(|c| c.residual != model.graph.zero());
    let mut errors = Vec::new();
    for claim in &model.invariants {
        let Some(entry) = refuted(model, program, claim) else {
            continue;
        };
        let entry = entry.map_or(String::new(), |entry| format!("entry {} of ", entry + 1));
        let message = format!(
            "{entry}`{}` is not constant along the motion: d/dt is not zero where the constraints hold",
            claim.name
        );
        errors.push(Diagnostic::new(claim.span, message).help(if loops {
            "claim what is constant for every position of the tree: the loops are not closed where claims are checked"
        } else {
            "claim what is constant, or say for which inputs and parameters it is: `when F = 0`"
        }));
    }
    if errors.is_empty() {
        Ok(())
    } else {
        Err(errors)
    }
}

/// The claims with their verdicts.
pub fn identities(model: &Model, program: &Program) -> Vec<Identity> {
    let verdict = |claim: &Invariant| match refuted(model, program, claim) {
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

/// What agreement at all points says: an integral of T, V and momenta is differentiated along ξ̇.
fn confidence(model: &Model, program: &Program) -> Confidence {
    let mut own = model.clone();
    let mut calculus = Calculus::new(&own);
    let mass = inertia::mass_matrix(&mut own, &mut calculus);
    let energies = [
        energy::kinetic(&mut own, &mass),
        energy::potential(&mut own),
    ];
    let mut roots = mass.concat();
    roots.extend(own.rate.iter().chain(&energies).copied());
    let accel = program
        .function(FunctionId::Accel)
        .map_or(&[][..], |accel| &accel.outputs);
    let expressions = [(&own.graph, &roots[..]), (&program.graph, accel)];
    let terms = 4 * (model.n() + 1);
    Confidence::new(model, &expressions, terms, POINTS, 9)
}

/// The entry that changes, `Some(None)` where there is no point to check it at.
fn refuted(model: &Model, program: &Program, claim: &Invariant) -> Option<Option<usize>> {
    let mut own = model.clone();
    let mut calculus = Calculus::new(&own);
    let mass = inertia::mass_matrix(&mut own, &mut calculus);
    let energies = (
        energy::kinetic(&mut own, &mass),
        energy::potential(&mut own),
    );
    let value = quantity::value(&mut own, &mut calculus, energies, &claim.quantity);
    let entries = value.entries();
    let mut found = 0;
    for seed in 1..TRIES {
        if found == POINTS {
            break;
        }
        let lane = own.points.lane_where(0x1a7f + seed, &own.graph, &claim.set);
        let slopes = lane.and_then(|lane| slopes(&own, program, &entries, lane, seed));
        let Some(slopes) = slopes else { continue };
        if let Some(entry) = slopes.iter().position(|slope| !slope.is_zero()) {
            return Some(Some(entry));
        }
        found += 1;
    }
    (found == 0).then_some(None)
}

/// d/dt of the entries at a point, moved to where B ξ = 0.
fn slopes(
    model: &Model,
    program: &Program,
    entries: &[Edge],
    mut lane: Lane,
    seed: u64,
) -> Option<Vec<Fp>> {
    let graph = &model.graph;
    let velocities = places(graph, class::VELOCITY);
    let rows: Vec<Edge> = model
        .constraints
        .iter()
        .flat_map(|c| c.row.clone())
        .collect();
    let rows = evaluate_at(graph, &rows, &mut lane.clone())?;
    let xi: Vec<Fp> = velocities.iter().map(|&place| lane.symbol(place)).collect();
    for (&place, value) in velocities.iter().zip(in_kernel(&rows, &xi, seed)?) {
        lane.set_symbol(place, value);
    }
    let accel = program.function(FunctionId::Accel)?;
    let xi_dot = evaluate_at(&program.graph, &accel.outputs, &mut lane.clone())?;
    let rate = evaluate_at(graph, &model.rate, &mut lane.clone())?;
    let direction = super::direction(model, &rate, &xi_dot);
    let duals = tangent_at(graph, entries, &mut lane.clone(), &direction)?;
    Some(duals.into_iter().map(|dual| dual.1).collect())
}
