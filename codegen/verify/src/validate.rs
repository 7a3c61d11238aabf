//! Proof of the emitted functions, required before every emission.
//!
//! At fresh points of X modulo p the three forms (30a), (30b), (30c) have the same left side F(x, ξ, ξ̇), and every
//! emitted function is the one that F, f, T and V imply.
//!
//! | function | has to be |
//! |---|---|
//! | `accel` | the ξ̇ with F(x, ξ, ξ̇) = f |
//! | `inverse_dynamics` | F(x, ξ, ξ̇) |
//! | `bias` | h = Γ ξ ξ, with F = M ξ̇ + h + ∂V |
//! | `potential_force` | ∂V |
//! | `generalized_force` | f by virtual work |
//! | `momentum` | ∂T/∂ξ |
//! | `dissipation` | D of the dampers' forces on points |
//! | `kick` and related functions | the motion of the system, see `splitting` |
//! | `mass_matrix` | M |
//! | `momentum_rate` | Ṁ ξ + f − h − ∂V |
//! | `velocity_from_momentum` | the ξ with M ξ = p |

use super::charts::ChartComparison;
use super::check::failed_identities;
use super::forms::ComparedQuantities;
use super::kernel::dot;
use super::numbers::{FormEvaluator, PointValues};
use super::points::{Disagreement, compare_at_fresh_points};
use super::slopes::DerivativeComparison;
use super::splitting::SplittingComparison;
use super::states;
use super::verdict::{failure, nowhere};
use super::violation::Violation;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Edge;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::tape::Tape;
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::Model;
use hamel_program::Program;
use rustc_hash::FxHashMap;

/// Largest number of velocities of a model for which a failure is explained by the identities that are broken.
const MAX_EXPLAINED_VELOCITIES: usize = 8;

/// Compares the emitted functions of a program without constraints with independent values at random points modulo p.
///
/// # Errors
/// A fault of the generator; the program is not emitted. The message also names the broken identities of the symbols,
/// to help to find the fault.
pub fn validate(model: &Model, program: &Program) -> Result<(), Diagnostic> {
    first_failure(model, program).map_err(|unequal| {
        let Disagreement::Differs(what) = unequal else {
            return nowhere(model);
        };
        let mut broken = vec![what.to_string()];
        if model.n() <= MAX_EXPLAINED_VELOCITIES
            && let Some(symbols) = ComparedQuantities::new(model)
        {
            let identities = failed_identities(model, program, symbols);
            broken.extend(identities.iter().map(|identity| identity.label.to_string()));
        }
        failure(model, &broken.join(", "))
    })
}

/// Returns the first comparison that fails, at the first point at which one does.
pub(super) fn first_failure(
    model: &Model,
    program: &Program,
) -> Result<(), Disagreement<Violation>> {
    let without = |identity| Disagreement::Differs(Violation::Identity(identity));
    let with_rates = states::with_rates(model, program);
    let numbers = FormEvaluator::new(model).ok_or_else(|| without("Y A = I"))?;
    let emitted =
        Emitted::new(model, program).ok_or_else(|| without("that numbers have values"))?;
    let slopes =
        DerivativeComparison::new(&with_rates, program).ok_or_else(|| without("Y A = I"))?;
    let splitting = SplittingComparison::new(model, program);
    let charts = ChartComparison::new(program).ok_or_else(|| without("that charts have values"))?;
    let at_point = |point: &FieldPoint| -> Option<Result<(), Violation>> {
        let values = match numbers.at(point)? {
            Ok(values) => values,
            Err(violation) => return Some(Err(violation)),
        };
        let all = [
            compare(
                [model, &with_rates],
                program,
                &values,
                &emitted.at(point)?,
                point,
            )?,
            slopes.at_point(program, point)?,
            match charts.hold(&values.rate, point)? {
                true => Ok(()),
                false => Err(Violation::Identity("K(x) times the rate of the chart = ẋ")),
            },
            splitting.as_ref().map_or(Some(Ok(())), |splitting| {
                splitting.at_point(&numbers, program, point)
            })?,
        ];
        Some(all.into_iter().collect())
    };
    compare_at_fresh_points(
        |number| model.points.lane(0x7a11 + number),
        |point, _| at_point(point),
    )
}

/// Emitted functions that are compared with the forms, evaluated together.
struct Emitted {
    /// Names of the functions with the number of their values.
    names: Vec<(String, usize)>,
    tape: Tape,
}

/// Names of the emitted functions that are compared here, in addition to the outputs of the description.
pub const COMPARED_FUNCTIONS: [&str; 14] = [
    "accel",
    "bias",
    "dissipation",
    "energy",
    "generalized_force",
    "inverse_dynamics",
    "kinetic_energy",
    "mass_matrix",
    "momentum",
    "momentum_rate",
    "potential_energy",
    "potential_force",
    "rate",
    "velocity_from_momentum",
];

impl Emitted {
    fn new(model: &Model, program: &Program) -> Option<Self> {
        let compared = |name: &str| {
            COMPARED_FUNCTIONS.contains(&name)
                || model.outputs.iter().any(|(output, _)| output == name)
        };
        let functions = || program.functions.iter().filter(|f| compared(&f.name));
        let roots: Vec<Edge> = functions().flat_map(|f| f.outputs.clone()).collect();
        Some(Emitted {
            names: functions()
                .map(|function| (function.name.clone(), function.outputs.len()))
                .collect(),
            tape: Tape::new(&program.graph, &roots)?,
        })
    }

    /// Returns the values of all functions at a point, by name.
    fn at(&self, point: &FieldPoint) -> Option<FxHashMap<&str, Vec<ResiduePair>>> {
        let values = self.tape.values(point)?;
        let mut rest = values.into_iter();
        Some(
            self.names
                .iter()
                .map(|(name, size)| (name.as_str(), rest.by_ref().take(*size).collect()))
                .collect(),
        )
    }
}

/// Compares at one point; `None` if something has no value there.
///
/// `with_rates` is the model with the emitted ξ̇ in the rates of its states.
fn compare(
    [model, with_rates]: [&Model; 2],
    program: &Program,
    values: &PointValues,
    emitted: &FxHashMap<&str, Vec<ResiduePair>>,
    point: &FieldPoint,
) -> Option<Result<(), Violation>> {
    let broken = disagreements(&values.left);
    if !broken.is_empty() {
        return Some(Err(Violation::Forms(broken)));
    }
    let product = |vector: &[ResiduePair]| -> Vec<ResiduePair> {
        let rows = values.mass.iter();
        rows.map(|row| dot(row, vector)).collect()
    };
    let sum = |lists: &[&[ResiduePair]]| -> Vec<ResiduePair> {
        (0..model.n())
            .map(|i| {
                lists
                    .iter()
                    .fold(ResiduePair::ZERO, |sum, list| sum + list[i])
            })
            .collect()
    };
    let energy = values.kinetic + values.potential;
    let resistance = sum(&[&values.bias, &values.slope]);
    let table: [(&str, &[ResiduePair], &'static str); 11] = [
        (
            "mass_matrix",
            &values.mass.concat(),
            "(20), M_ij = Σ m_p ⟨∂ᵢr_p, ∂ⱼr_p⟩ for the emitted M",
        ),
        ("bias", &values.bias, "h = Γ ξ ξ for the emitted bias force"),
        (
            "potential_force",
            &values.slope,
            "∂ᵢV for the emitted slope",
        ),
        (
            "generalized_force",
            &values.force,
            "(28), fᵢ = Σ ⟨F_p, ∂ᵢr_p⟩ for the emitted loads",
        ),
        (
            "inverse_dynamics",
            &values.left[0],
            "(30c) for the emitted inverse dynamics",
        ),
        ("momentum", &values.momentum, "p = ∂T/∂ξ"),
        ("kinetic_energy", &[values.kinetic], "T = ½ Σ m_p ‖ṙ_p‖²"),
        (
            "potential_energy",
            &[values.potential],
            "V = −Σ m_p ⟨g, r_p⟩",
        ),
        ("energy", &[energy], "T + V"),
        (
            "dissipation",
            &[values.dissipation],
            "2 D = −fᵢ ξⁱ of dampers",
        ),
        ("rate", &values.rate, "(5), ẋ = A ξ"),
    ];
    for (name, expected, what) in table {
        if emitted.get(name).is_some_and(|value| value != expected) {
            return Some(Err(Violation::Identity(what)));
        }
    }
    if let Some(rates) = emitted.get("accel") {
        let (xi_dot, state_rates) = rates.split_at(model.n());
        if sum(&[&product(xi_dot), &resistance]) != values.force {
            return Some(Err(Violation::Identity("(30c) for the emitted ξ̇")));
        }
        if state_rates != states::rates(with_rates, xi_dot, point)? {
            return Some(Err(Violation::Identity(states::SUBJECT)));
        }
    }
    // d/dt (M ξ) = Ṁ ξ + f − h − ∂V.
    if let Some(rate) = emitted.get("momentum_rate")
        && sum(&[rate, &resistance]) != sum(&[&values.mass_rate, &values.force])
    {
        return Some(Err(Violation::Identity("ṗ")));
    }
    if let Some(xi) = emitted.get("velocity_from_momentum") {
        let momenta = evaluate_at(&model.graph, &model.momenta, &mut point.clone())?;
        if product(xi) != momenta {
            return Some(Err(Violation::Identity("ξ of p")));
        }
    }
    for (name, expected) in &model.outputs {
        if program.function(name).is_some() {
            let expected = evaluate_at(&model.graph, &expected.entries(), &mut point.clone())?;
            if emitted.get(name.as_str()) != Some(&expected) {
                return Some(Err(Violation::Output(name.clone())));
            }
        }
    }
    Some(Ok(()))
}

/// Names the pairs of forms that differ.
fn disagreements([hamel, gibbs, levi_civita]: &[Vec<ResiduePair>; 3]) -> Vec<&'static str> {
    let pairs = [
        (hamel == gibbs, "(30a) = (30b)"),
        (hamel == levi_civita, "(30a) = (30c)"),
        (gibbs == levi_civita, "(30b) = (30c)"),
    ];
    let broken = pairs.iter().filter(|(agree, _)| !agree);
    broken.map(|(_, name)| *name).collect()
}
