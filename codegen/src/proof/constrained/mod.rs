//! The proof for systems with constraints: at points of X, with ξ = C ξₐ, the emitted ξ̇ₐ and
//! multipliers satisfy M ξ̇ + h + ∂V = f + Bᵀ λ in every row of the full frame, and d/dt (B ξ) is what
//! the constraints ask for; M, h, V and f come from T and γ of the full frame.

pub mod frame;
mod point;

use super::confidence::Confidence;
use super::kernel::{dot, rows_at_rest, virtual_velocity};
use super::points::{POINTS, Unequal, at_fresh_points};
use super::verdict::{Identity, Verdict, failure, nowhere};
use super::{centroidal, derivatives, frames, outputs, states};
use crate::algebra::fp::Fp;
use crate::algebra::graph::Edge;
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::derive::accel::saddle;
use crate::derive::reduction::Reduction;
use crate::diagnostics::Diagnostic;
use crate::model::Model;
use crate::model::points::{Points, imposed};
use crate::program::{FunctionId, Program};
use frame::{Full, given};
use point::At;

/// What is compared, with the label and equation that `check` prints.
const IDENTITIES: [(&str, &str); 14] = [
    ("C", "B C = 0 for the rows that were solved"),
    (
        "(30c)",
        "M ξ̇ + Γ ξ ξ + ∂V = f + Bᵀ λ for the emitted ξ̇ and λ",
    ),
    (
        "B",
        "d/dt (B ξ) = −2 λ B ξ − λ² φ for the emitted ξ̇, and rates that are given",
    ),
    ("M", "the emitted mass matrix is Cᵀ M C"),
    ("(30a)", "the emitted bias is Cᵀ (Γ ξ ξ + M Ċ ξ)"),
    ("(28)", "the emitted forces are Cᵀ f and Cᵀ ∂V"),
    (
        "power",
        "d/dt (T + V) = fᵢ ξⁱ for the emitted ξ̇ where B ξ + b = 0",
    ),
    (
        "[A B]",
        "the emitted [A B] are the slopes of ẋ and ξ̇ along δx = A h",
    ),
    (
        "slopes",
        "the emitted slopes are those of inverse dynamics, and of ξ̇ by parameters",
    ),
    ("states", "ż as described, with the emitted ξ̇"),
    (
        "outputs",
        "the emitted outputs are those of the description",
    ),
    (
        "frames",
        "the emitted twists are Ṙ Rᵀ and ṗ, with their slopes by ξ and along ẋ",
    ),
    (
        "momentum",
        "the emitted centre of mass is Σ m c / Σ m, the momentum about it A_G ξ",
    ),
    (
        "(30)",
        "M, Γ ξ ξ, ∂V and f of the full frame are those of the three forms in numbers",
    ),
];

/// The place of the power among them: it is compared at points of its own.
const POWER: usize = 6;

/// That of the full frame, where no constraint acts.
const FRAME: usize = 13;

/// Validates the functions of a program with constraints; an error is a fault of the generator.
pub fn validate(model: &Model, reduction: &Reduction, program: &Program) -> Result<(), Diagnostic> {
    let Some(full) = Full::new(model, reduction) else {
        return Err(failure(model, "Y A = I"));
    };
    let Some(failed) = compare(&full, model, reduction, program) else {
        return Err(nowhere(model));
    };
    let mut rows = IDENTITIES.iter().zip(&failed);
    let failing = rows.find(|((label, _), failed)| {
        failed.is_some() && is_there(label, &full, reduction, program)
    });
    match failing {
        Some(((_, equation), _)) => Err(failure(model, equation)),
        None => Ok(()),
    }
}

/// What fails at fresh points; `None` where there are none.
///
/// Where constraints make velocities multiples of one another, their norm is √c |ξ|, and c may be no square of F_p.
fn compare(
    full: &Full,
    model: &Model,
    reduction: &Reduction,
    program: &Program,
) -> Option<[Option<String>; IDENTITIES.len()]> {
    let wider = || compare_at(&model.points.extended()?, full, reduction, program);
    compare_at(&model.points, full, reduction, program).or_else(wider)
}

fn compare_at(
    points: &Points,
    full: &Full,
    reduction: &Reduction,
    program: &Program,
) -> Option<[Option<String>; IDENTITIES.len()]> {
    let mut failed: [Option<String>; IDENTITIES.len()] = Default::default();
    // Prescribed coordinates are where they are prescribed to be, so that roots of them have values.
    let given = given(&full.reference.model);
    let compared = at_fresh_points(
        |number| {
            // Roots of what constraints give need values, too.
            let graph = &full.reference.model.graph;
            let solved = |lane| imposed(lane, graph, &full.solved);
            points.lane_moved(0xb0d5 + number, graph, &given, &solved)
        },
        |lane, _| {
            let results = at_point(full, reduction, program, lane)?;
            for (failed, result) in failed.iter_mut().zip(results) {
                *failed = failed.take().or(result.err());
            }
            Some(Ok::<(), ()>(()))
        },
    );
    // Powers balance where B ξ + b = 0 in the rows that have forces: where a loop is open, the others ask for something else.
    let n = full.reference.model.n();
    let solved = reduction.solved.iter().map(|&(row, _)| row);
    let rows = solved.chain(reduction.kept.iter().copied());
    let rows: Vec<Edge> = rows
        .flat_map(|row| full.rows[row * n..][..n].to_vec())
        .collect();
    let still = at_fresh_points(
        |number| {
            let model = &full.reference.model;
            let moved = |lane| rows_at_rest(model, &rows, lane);
            points.lane_moved(0x50_0e4 + number, &model.graph, &given, &moved)
        },
        |lane, _| {
            let balanced = At::new(full, reduction, program, lane)?.power()?;
            Some(if balanced { Ok(()) } else { Err(()) })
        },
    );
    if let Err(Unequal::Differs(())) = still {
        failed[POWER] = Some("the power differs".into());
    }
    if full.frame == Some(false) {
        failed[FRAME] = Some("the full frame differs".into());
    }
    (compared.is_ok() && still != Err(Unequal::Nowhere)).then_some(failed)
}

/// Nothing is said of what is not there.
fn is_there(label: &str, full: &Full, reduction: &Reduction, program: &Program) -> bool {
    match label {
        "(30)" => full.frame.is_some(),
        "power" => full.power_is_known(program),
        "C" => !reduction.solved.is_empty(),
        "B" => !reduction.kept.is_empty() || !reduction.model.accelerated.is_empty(),
        "slopes" => [
            FunctionId::InverseDynamicsSlopes,
            FunctionId::ParameterSlopes,
        ]
        .iter()
        .any(|&id| program.function(id).is_some()),
        "states" => !reduction.model.states.is_empty(),
        "outputs" => {
            let mut outputs = reduction.model.outputs.iter();
            outputs.any(|(name, _)| program.function(name).is_some())
        }
        "frames" => !reduction.model.asked.jacobians.is_empty(),
        "momentum" => {
            let mut all = FunctionId::CENTROIDAL.iter();
            all.any(|id| program.function(id).is_some())
        }
        "[A B]" => program.function(FunctionId::Linearize).is_some(),
        _ => true,
    }
}

/// What agreement at all points says: all that is evaluated, in sums and solutions of n + rows terms.
fn confidence(full: &Full, model: &Model, program: &Program) -> Confidence {
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
    Confidence::new(model, &expressions, terms, POINTS, terms * terms)
}

/// The identities with their verdicts.
pub fn identities(model: &Model, reduction: &Reduction, program: &Program) -> Vec<Identity> {
    let full = Full::new(model, reduction);
    let failed = full
        .as_ref()
        .and_then(|full| compare(full, model, reduction, program));
    let confidence = full.as_ref().map(|full| confidence(full, model, program));
    let verdict = |index: usize| match (&failed, confidence) {
        (Some(failed), Some(confidence)) => match &failed[index] {
            Some(message) => Verdict::Failed(message.clone()),
            None => Verdict::Checked(confidence),
        },
        _ => Verdict::Failed("no point was found to compare at".into()),
    };
    IDENTITIES
        .iter()
        .enumerate()
        .filter(|(_, (label, _))| {
            let known = full.as_ref();
            known.is_none_or(|full| is_there(label, full, reduction, program))
        })
        .map(|(index, &(label, equation))| Identity {
            label,
            equation: equation.into(),
            verdict: verdict(index),
        })
        .collect()
}

type Comparison = Result<(), String>;

/// All comparisons at one point but that of the power; `None` where something has no value there.
fn at_point(
    full: &Full,
    reduction: &Reduction,
    program: &Program,
    lane: &Lane,
) -> Option<[Comparison; IDENTITIES.len()]> {
    let (n, na) = (full.reference.model.n(), reduction.active.len());
    let graph = &full.reference.model.graph;
    let at = At::new(full, reduction, program, lane)?;
    let c = &at.c;
    let column = |j: usize| -> Vec<Fp> { (0..n).map(|i| c[i * na + j]).collect() };
    let project = |v: &[Fp]| -> Vec<Fp> { (0..na).map(|j| dot(&column(j), v)).collect() };
    let rows = evaluate_at(graph, &full.rows, &mut lane.clone())?;
    let vanish = reduction.solved.iter().all(|&(row, _)| {
        let row = &rows[row * n..][..n];
        (0..na).all(|j| dot(row, &column(j)).is_zero()) && dot(row, &at.shift).is_zero()
    });
    let time = full.reference.model.clock.map(|clock| clock.xi);
    let inner = &at.inner;
    let values = at.values()?;
    let [mass, bias, slope, force] = [&values.mass, &values.bias, &values.slope, &values.force];
    let emitted = |name: &str| -> Option<Option<Vec<Fp>>> {
        match program.function(name) {
            None => Some(None),
            Some(f) => evaluate_at(&program.graph, &f.outputs, &mut inner.clone()).map(Some),
        }
    };
    // ξ̇, and behind it the rates of states.
    let mut xi_dot = emitted("accel")?;
    let state_rates = xi_dot.as_mut().map(|rates| rates.split_off(na));
    let same_states = match (&xi_dot, state_rates) {
        (Some(xi_dot), Some(found)) => states::rates(&full.reduced, xi_dot, inner)? == found,
        _ => true,
    };
    let balanced = match (xi_dot.clone(), emitted("constraint_force")?) {
        (Some(xi_dot), Some(lambda)) => {
            let needed = values.needed(&values.lift(c, &xi_dot));
            // The row of ξ⁰ is no equation of motion.
            (0..n).filter(|&i| Some(i) != time).all(|i| {
                let bonds = lambda.iter().zip(rows.chunks(n));
                let bond = bonds.fold(Fp::ZERO, |sum, (&lambda, row)| sum + row[i] * lambda);
                // Beyond the rows of constraints stand the forces of drives whose rates are given.
                let drives = full.reference.model.accelerated.iter();
                let drives = drives.zip(lambda.get(rows.len() / n..).unwrap_or(&[]));
                let drive = drives.filter(|((velocity, _), _)| *velocity == i);
                let drive = drive.fold(Fp::ZERO, |sum, (_, &force)| sum + force);
                needed[i] == force[i] + bond + drive
            })
        }
        _ => true,
    };
    let kept: Vec<Edge> = full
        .reduced
        .constraints
        .iter()
        .flat_map(|constraint| constraint.row.iter().copied())
        .collect();
    let inner_graph = &full.reduced.graph;
    let kept = evaluate_at(inner_graph, &kept, &mut inner.clone())?;
    let right = evaluate_at(inner_graph, &full.right, &mut inner.clone())?;
    let reduced_mass: Vec<Fp> = (0..na)
        .flat_map(|i| {
            let moved: Vec<Fp> = (0..n)
                .map(|k| dot(&mass[k * n..][..n], &column(i)))
                .collect();
            project(&moved)
        })
        .collect();
    let projected: Vec<Fp> = (0..n)
        .map(|k| bias[k] + dot(&mass[k * n..][..n], &values.drift))
        .collect();
    // Whatever the multipliers are, they do no work where B v = 0, nor do drives where what they give stands still: there
    // the equations of motion hold by themselves.
    let balanced = balanced
        && match xi_dot.clone() {
            None => true,
            Some(xi_dot) => {
                let needed = values.needed(&values.lift(c, &xi_dot));
                let left = needed
                    .iter()
                    .zip(force)
                    .map(|(&needed, &force)| needed - force);
                let virtual_velocity = virtual_velocity(&full.reduced, &kept, &values.xi)?;
                dot(&virtual_velocity, &project(&left.collect::<Vec<_>>())).is_zero()
            }
        };
    let accelerated = &full.reduced.accelerated;
    let given: Vec<Edge> = accelerated.iter().map(|(_, rate)| *rate).collect();
    let given = evaluate_at(inner_graph, &given, &mut inner.clone())?;
    let places = accelerated.iter().map(|(place, _)| *place);
    let given: Vec<(usize, Fp)> = places.zip(given).collect();
    let held = match xi_dot {
        None => true,
        Some(xi_dot) if full.reduced.overconstrained => {
            let rest: Vec<Fp> = (0..n).map(|k| force[k] - slope[k] - projected[k]).collect();
            let parts = [&reduced_mass[..], &project(&rest), &kept, &right];
            saddle::solve_at(&full.reduced, parts, &given, inner)? == xi_dot
        }
        Some(xi_dot) => {
            let mut driven = given.iter().map(|&(place, rate)| xi_dot[place] == rate);
            let mut held = right.iter().zip(kept.chunks(na.max(1)));
            driven.all(|holds| holds) && held.all(|(&right, row)| dot(row, &xi_dot) == right)
        }
    };
    let equal = |name: &str, expected: Vec<Fp>| -> Option<bool> {
        Some(emitted(name)?.is_none_or(|found| found == expected))
    };
    let same_mass = equal("mass_matrix", reduced_mass.clone())?;
    let same_bias = equal("bias", project(&projected))?;
    let same_loads = equal("generalized_force", project(force))?
        && equal("potential_force", project(slope))?
        && equal("kinetic_energy", vec![values.kinetic])?
        && equal("potential_energy", vec![values.potential])?
        && equal("energy", vec![values.kinetic + values.potential])?
        && equal("dissipation", vec![values.dissipation])?;
    let same_rate = equal("rate", at.rate()?)?;
    let rates = evaluate_at(inner_graph, &full.reduced.xi_dot, &mut inner.clone())?;
    let needed = values.needed(&values.lift(c, &rates));
    let same_whole = equal("inverse_dynamics", project(&needed))?;
    let momentum: Vec<Fp> = (0..n)
        .map(|i| dot(&mass[i * n..][..n], &values.xi))
        .collect();
    let same_mass = same_mass && equal("momentum", project(&momentum))?;
    let same_linear = at.linear()?;
    let same_slopes = derivatives::hold(&full.reference.model, program, [&at.point, inner])?;
    let same_outputs = outputs::values_hold(&full.reduced, program, inner)?;
    let same_momentum = centroidal::holds(&full.reduced, program, inner)?;
    let same_frames = frames::hold(&full.reduced, program, inner)?;
    let result = |holds: bool, what: &str| if holds { Ok(()) } else { Err(what.to_string()) };
    Some([
        result(vanish && same_rate, "a row does not vanish, or ẋ differs"),
        result(balanced && same_whole, "the forces do not balance"),
        result(held, "the constraint is left"),
        result(same_mass, "M or p differs"),
        result(same_bias, "the bias differs"),
        result(same_loads, "a force or energy differs"),
        Ok(()),
        result(same_linear, "a slope differs"),
        result(same_slopes, derivatives::WHAT),
        result(same_states, "ż differs"),
        result(same_outputs, "an output differs"),
        result(same_frames, frames::WHAT),
        result(same_momentum, centroidal::WHAT),
        Ok(()),
    ])
}
