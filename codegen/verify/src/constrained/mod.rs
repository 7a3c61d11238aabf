//! Proof for systems with constraints.
//!
//! At points of X with ξ = C ξₐ, the emitted ξ̇ₐ and multipliers have to satisfy M ξ̇ + h + ∂V = f + Bᵀ λ in every row
//! of the full frame, and d/dt (B ξ) has to be what the constraints demand; M, h, V and f are those of the full frame.

mod comparison;
pub mod frame;
mod point;

use super::charts::ChartComparison;
use super::confidence::Confidence;
use super::kernel::satisfying_rows;
use super::points::{COMPARED_POINTS, Disagreement, compare_at_fresh_points};
use super::verdict::{Identity, Verdict, failure, nowhere};
use comparison::PointComparison;
use frame::{FullFrameQuantities, prescribed_values};
use hamel_algebra::graph::Edge;
use hamel_dynamics::reduction::Reduction;
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::Model;
use hamel_language::model::points::{Points, imposed};
use hamel_program::{FunctionId, Program};
use point::ConstrainedPoint;

/// Claims about the emitted functions that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Claim {
    Complement,
    Rate,
    Balance,
    Constraint,
    Mass,
    Bias,
    Loads,
    Power,
    Projection,
    Linearisation,
    Slopes,
    States,
    Outputs,
    Invariants,
    Frames,
    Momentum,
    FullFrame,
}

impl Claim {
    /// All claims, in the order in which they are shown.
    const ALL: [Claim; 17] = [
        Claim::Complement,
        Claim::Rate,
        Claim::Balance,
        Claim::Constraint,
        Claim::Mass,
        Claim::Bias,
        Claim::Loads,
        Claim::Power,
        Claim::Projection,
        Claim::Linearisation,
        Claim::Slopes,
        Claim::States,
        Claim::Outputs,
        Claim::Invariants,
        Claim::Frames,
        Claim::Momentum,
        Claim::FullFrame,
    ];

    /// Returns the label and the equation that `check` prints.
    fn label(self) -> (&'static str, &'static str) {
        match self {
            Claim::Complement => ("C", "B C = 0 for the rows that were solved"),
            Claim::Rate => (
                "(5)",
                "the emitted ẋ is A C ξₐ, and K(x) times the rate of the chart",
            ),
            Claim::Balance => (
                "(30c)",
                "M ξ̇ + Γ ξ ξ + ∂V = f + Bᵀ λ for the emitted ξ̇ and λ",
            ),
            Claim::Constraint => (
                "B",
                "d/dt (B ξ) = −2 λ B ξ − λ² φ for the emitted ξ̇, and rates that are given",
            ),
            Claim::Mass => ("M", "the emitted mass matrix is Cᵀ M C"),
            Claim::Bias => ("(30a)", "the emitted bias is Cᵀ (Γ ξ ξ + M Ċ ξ)"),
            Claim::Loads => ("(28)", "the emitted forces are Cᵀ f and Cᵀ ∂V"),
            Claim::Power => (
                "power",
                "d/dt (T + V) = fᵢ ξⁱ for the emitted ξ̇ where B ξ + b = 0",
            ),
            Claim::Projection => (
                "back",
                "the emitted φ is that of the loops; B δ = −φ and B δ = −B ξ for steps back along M⁻¹ Bᵀ",
            ),
            Claim::Linearisation => (
                "[A B]",
                "the emitted [A B] are the slopes of ẋ and ξ̇ along δx = A h",
            ),
            Claim::Slopes => (
                "slopes",
                "the emitted slopes are those of inverse dynamics, and of ξ̇ by parameters",
            ),
            Claim::States => ("states", "ż as described, with the emitted ξ̇"),
            Claim::Outputs => (
                "outputs",
                "the emitted outputs are those of the description",
            ),
            Claim::Invariants => (
                "claims",
                "the emitted invariants are those of the full frame",
            ),
            Claim::Frames => (
                "frames",
                "the emitted twists are Ṙ Rᵀ and ṗ, with their slopes by ξ and along ẋ",
            ),
            Claim::Momentum => (
                "momentum",
                "the emitted centre of mass is Σ m c / Σ m, the momentum about it A_G ξ",
            ),
            Claim::FullFrame => (
                "(30)",
                "M, Γ ξ ξ, ∂V and f of the full frame are those of the three forms in numbers",
            ),
        }
    }

    /// Returns whether the program has the functions that the claim is about; other claims are not shown.
    fn is_applicable(
        self,
        full: &FullFrameQuantities,
        reduction: &Reduction,
        program: &Program,
    ) -> bool {
        let has_entries = |id: &FunctionId| {
            let function = program.function(*id);
            function.is_some_and(|function| !function.outputs.is_empty())
        };
        let any = |ids: &[FunctionId]| ids.iter().any(has_entries);
        match self {
            Claim::FullFrame => full.frame.is_some(),
            Claim::Power => full.power_is_known(program),
            Claim::Complement => !reduction.solved.is_empty(),
            Claim::Rate => any(&[FunctionId::Rate]),
            Claim::Balance => any(&[
                FunctionId::Accel,
                FunctionId::ConstraintForce,
                FunctionId::InverseDynamics,
            ]),
            Claim::Constraint => {
                any(&[FunctionId::Accel])
                    && !(reduction.kept.is_empty() && reduction.model.accelerated.is_empty())
            }
            Claim::Mass => any(&[FunctionId::MassMatrix, FunctionId::Momentum]),
            Claim::Bias => any(&[FunctionId::Bias]),
            Claim::Loads => any(&[
                FunctionId::GeneralizedForce,
                FunctionId::PotentialForce,
                FunctionId::KineticEnergy,
                FunctionId::PotentialEnergy,
                FunctionId::Energy,
                FunctionId::Dissipation,
            ]),
            Claim::Projection => any(&[FunctionId::ProjectVelocity]),
            Claim::Linearisation => any(&[FunctionId::Linearize]),
            Claim::Slopes => any(&[
                FunctionId::InverseDynamicsSlopes,
                FunctionId::ParameterSlopes,
            ]),
            Claim::States => !reduction.model.states.is_empty(),
            Claim::Outputs => {
                let mut outputs = reduction.model.outputs.iter();
                outputs.any(|(name, _)| program.function(name).is_some())
            }
            Claim::Invariants => {
                let mut claims = full.claims.iter();
                claims.any(|(name, _)| program.function(name).is_some())
            }
            Claim::Frames => !reduction.model.asked.jacobians.is_empty(),
            Claim::Momentum => any(&FunctionId::CENTROIDAL),
        }
    }
}

/// Compares the emitted functions of a system with constraints with the equations of its full frame, at random points
/// modulo p.
///
/// # Errors
/// A fault of the generator, with the first claim that fails.
pub fn validate(model: &Model, reduction: &Reduction, program: &Program) -> Result<(), Diagnostic> {
    let Some(full) = FullFrameQuantities::new(model, reduction, program) else {
        return Err(failure(model, "Y A = I"));
    };
    let Some(failed) = compare(&full, model, reduction, program) else {
        return Err(nowhere(model));
    };
    match failed.first() {
        Some(claim) => Err(failure(model, claim.label().1)),
        None => Ok(()),
    }
}

/// Returns the claims that fail at fresh points; `None` if there are no such points.
///
/// If constraints make velocities multiples of one another, their norm is √c |ξ|, and c may have no root in F_p: then
/// points are tried that allow roots in F_p(i).
fn compare(
    full: &FullFrameQuantities,
    model: &Model,
    reduction: &Reduction,
    program: &Program,
) -> Option<Vec<Claim>> {
    let wider = || compare_at(&model.points.extended()?, full, reduction, program);
    compare_at(&model.points, full, reduction, program).or_else(wider)
}

fn compare_at(
    points: &Points,
    full: &FullFrameQuantities,
    reduction: &Reduction,
    program: &Program,
) -> Option<Vec<Claim>> {
    let mut failed: Vec<Claim> = Vec::new();
    let charts = ChartComparison::new(program)?;
    // Prescribed coordinates take their prescribed values, so that roots of them have values.
    let given = prescribed_values(&full.reference.model);
    let compared = compare_at_fresh_points(
        |number| {
            // Roots of velocities that constraints determine need values, too.
            let graph = &full.reference.model.graph;
            let solved = |point| imposed(point, graph, &full.solved);
            points.lane_moved(0xb0d5 + number, graph, &given, &solved)
        },
        |point, _| {
            let comparison = PointComparison::new(full, reduction, (program, &charts), point)?;
            for claim in Claim::ALL {
                if !comparison.holds(claim)? {
                    failed.push(claim);
                }
            }
            Some(Ok::<(), ()>(()))
        },
    );
    // Power balances where B ξ + b = 0 in the rows that have multipliers; where a loop is open, the other rows demand
    // other velocities.
    let n = full.reference.model.n();
    let solved = reduction.solved.iter().map(|&(row, _)| row);
    let rows = solved.chain(reduction.kept.iter().copied());
    let rows: Vec<Edge> = rows
        .flat_map(|row| full.rows[row * n..][..n].to_vec())
        .collect();
    let still = compare_at_fresh_points(
        |number| {
            let model = &full.reference.model;
            let moved = |point| satisfying_rows(model, &rows, point);
            points.lane_moved(0x50_0e4 + number, &model.graph, &given, &moved)
        },
        |point, _| {
            let balanced = ConstrainedPoint::new(full, reduction, program, point)?.power()?;
            Some(if balanced { Ok(()) } else { Err(()) })
        },
    );
    if let Err(Disagreement::Differs(())) = still {
        failed.push(Claim::Power);
    }
    (compared.is_ok() && still != Err(Disagreement::Nowhere)).then_some(failed)
}

/// Bounds the chance of error: everything is evaluated, in sums and linear solves of n + rows terms.
fn confidence(full: &FullFrameQuantities, model: &Model, program: &Program) -> Confidence {
    let reference = &full.reference;
    let mut roots = reference.mass.concat();
    let lists = [
        &reference.force,
        &reference.bias,
        &reference.slope,
        &reference.model.rate,
        &full.complement,
        &full.rows,
        &full.drift,
    ];
    lists.iter().for_each(|list| roots.extend(list.iter()));
    roots.push(full.change);
    let emitted: Vec<Edge> = program
        .functions
        .iter()
        .flat_map(|function| function.outputs.clone())
        .collect();
    let expressions = [
        (&reference.model.graph, &roots[..]),
        (&full.reduced.graph, &full.right[..]),
        (&program.graph, &emitted[..]),
    ];
    let terms = 4 * (model.n() + full.rows.len() + 1);
    Confidence::new(model, &expressions, terms, COMPARED_POINTS, terms * terms)
}

/// Compares the emitted functions of a system with constraints with the equations of its full frame, M ξ̇ + Γ ξ ξ + ∂V
/// = f + Bᵀ λ and others, at random points modulo p, and returns one verdict for each claim.
pub fn check_constrained(model: &Model, reduction: &Reduction, program: &Program) -> Vec<Identity> {
    let full = FullFrameQuantities::new(model, reduction, program);
    let failed = full
        .as_ref()
        .and_then(|full| compare(full, model, reduction, program));
    let confidence = full.as_ref().map(|full| confidence(full, model, program));
    let verdict = |claim: Claim| match (&failed, confidence) {
        (Some(failed), Some(_)) if failed.contains(&claim) => {
            Verdict::Failed("both sides differ at a point".into())
        }
        (Some(_), Some(confidence)) => Verdict::Checked(confidence),
        _ => Verdict::Failed("no point was found to compare at".into()),
    };
    let is_applicable = |claim: &Claim| {
        let known = full.as_ref();
        known.is_none_or(|full| claim.is_applicable(full, reduction, program))
    };
    (Claim::ALL.into_iter().filter(is_applicable))
        .map(|claim| {
            let (label, equation) = claim.label();
            Identity {
                label,
                equation: equation.into(),
                verdict: verdict(claim),
            }
        })
        .collect()
}
