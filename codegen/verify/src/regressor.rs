//! Proof of base parameters.
//!
//! At fresh points, with values of the run-time parameters other than those at which the linear relations were found,
//! Y_b β has to equal Y π for random π. It also has to equal the force of (30b), from accelerations of mass points in
//! numbers modulo p, for the bodies of the description together with a body of random inertia on every link, so that no
//! column is multiplied by 0.

use super::numbers::FormEvaluator;
use super::points::{Disagreement, compare_at_fresh_points};
use super::verdict::{failure, nowhere};
use super::violation::{RegressorFault, Violation};
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Edge;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use hamel_algebra::tape::Tape;
use hamel_dynamics::regressor::{INERTIA_ENTRIES, ParameterKind, Regressor};
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::{Body, Model};
use hamel_program::{FunctionId, Program};

/// Checks at random points, modulo p, that the base parameters reproduce the force of (30b). That they are independent
/// is not checked.
///
/// # Errors
/// A fault of the generator.
pub fn check_base_parameters(model: &Model, regressor: &Regressor) -> Result<(), RegressorFault> {
    let (heavier, added) =
        with_random_bodies(model, regressor).ok_or(RegressorFault::UnknownLink)?;
    let numbers = FormEvaluator::new(&heavier).ok_or(RegressorFault::NoForces)?;
    let factors = regressor.base.iter().flat_map(|base| &base.terms);
    let mut edges: Vec<Edge> = factors.map(|&(_, factor)| factor).collect();
    edges.extend(regressor.standard.iter().map(|one| one.value));
    edges.extend(regressor.columns.iter().flatten());
    edges.extend(regressor.base.iter().flat_map(|base| &base.column));
    edges.extend(&regressor.other_potentials);
    let tape = Tape::new(&regressor.model.graph, &edges).ok_or(RegressorFault::NoColumns)?;
    let compared = compare_at_fresh_points(
        |seed| model.points.lane(seed),
        |point, seed| at(&numbers, (&tape, &added), regressor, point, seed),
    );
    compared.map_err(|disagreement| match disagreement {
        Disagreement::Differs(violation) => RegressorFault::Violation(violation),
        Disagreement::Nowhere => RegressorFault::TooFewPoints,
    })
}

/// Checks at fresh points that the base parameters determine the forces of (30b), and that the emitted functions return
/// them and their columns.
///
/// # Errors
/// A fault of the generator; the program is not emitted.
pub fn validate(model: &Model, regressor: &Regressor, program: &Program) -> Result<(), Diagnostic> {
    check_base_parameters(model, regressor).map_err(|fault| failure(model, &fault.to_string()))?;
    let columns: Vec<&Vec<Edge>> = regressor.base.iter().map(|base| &base.column).collect();
    let n = regressor.model.n();
    let rows = (0..n).flat_map(|row| columns.iter().map(move |column| column[row]));
    let rows: Vec<Edge> = rows.collect();
    let values: Vec<Edge> = regressor.standard.iter().map(|one| one.value).collect();
    let terms = regressor.base.iter().flat_map(|base| &base.terms);
    let factors: Vec<Edge> = terms.map(|&(_, factor)| factor).collect();
    let compared = compare_at_fresh_points(
        |seed| model.points.lane(0x4e_9e55 + seed),
        |point, _| {
            let of =
                |edges: &[Edge]| evaluate_at(&regressor.model.graph, edges, &mut point.clone());
            let emitted = |id: FunctionId| match program.function(id) {
                None => Some(None),
                Some(f) => evaluate_at(&program.graph, &f.outputs, &mut point.clone()).map(Some),
            };
            let (values, factors) = (of(&values)?, of(&factors)?);
            let mut factors = factors.iter();
            let beta = regressor.base.iter().map(|base| {
                let terms = base.terms.iter().zip(&mut factors);
                terms.fold(ResiduePair::ZERO, |beta, (&(k, _), &factor)| {
                    beta + factor * values[k]
                })
            });
            let beta: Vec<ResiduePair> = beta.collect();
            let same = emitted(FunctionId::Regressor)?.is_none_or(|found| Some(found) == of(&rows))
                && emitted(FunctionId::BaseParameters)?.is_none_or(|found| found == beta);
            Some(if same { Ok(()) } else { Err(()) })
        },
    );
    compared.map_err(|unequal| match unequal {
        Disagreement::Differs(()) => {
            failure(model, "the emitted regressor is Y, the base parameters β")
        }
        Disagreement::Nowhere => nowhere(model),
    })
}

/// Returns the model with one more body on each link that has parameters, and the amounts by which this increases each
/// of the standard parameters. In a description most of them are zero, so that their columns would not be tested.
fn with_random_bodies(model: &Model, regressor: &Regressor) -> Option<(Model, Vec<ResiduePair>)> {
    let mut model = model.clone();
    let mut random = Random::new(0xb0d1e5);
    let mut number = || (random.bits() % 50) as i64 + 1;
    let mut added = vec![ResiduePair::ZERO; regressor.standard.len()];
    for link in &regressor.links {
        let frame = model.frames.iter().position(|frame| frame.name == *link)?;
        let mass = number();
        let com: [i64; 3] = std::array::from_fn(|_| number());
        let mut about_com = [[0; 3]; 3];
        for (i, j) in INERTIA_ENTRIES {
            about_com[i][j] = number();
            about_com[j][i] = about_com[i][j];
        }
        let square: i64 = com.iter().map(|entry| entry * entry).sum();
        let about_origin: [[i64; 3]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let square = if i == j { square } else { 0 };
                about_com[i][j] + mass * (square - com[i] * com[j])
            })
        });
        for (value, one) in added.iter_mut().zip(&regressor.standard) {
            if let ParameterKind::Inertia(place) = one.kind
                && one.of == *link
            {
                let number = match place {
                    0..6 => about_origin[INERTIA_ENTRIES[place].0][INERTIA_ENTRIES[place].1],
                    6..9 => mass * com[place - 6],
                    _ => mass,
                };
                *value = ResiduePair::from_i64(number);
            }
        }
        let graph = &mut model.graph;
        let body = Body {
            frame,
            mass: graph.ratio(mass, 1),
            com: com.map(|entry| graph.ratio(entry, 1)),
            inertia_com: about_com.map(|row| row.map(|entry| graph.ratio(entry, 1))),
            inertia_origin: about_origin.map(|row| row.map(|entry| graph.ratio(entry, 1))),
        };
        model.bodies.push(body);
    }
    Some((model, added))
}

/// Compares at a point; `None` if something has no value there.
fn at(
    numbers: &FormEvaluator,
    (tape, added): (&Tape, &[ResiduePair]),
    regressor: &Regressor,
    point: &FieldPoint,
    seed: u64,
) -> Option<Result<(), Violation>> {
    let left = match numbers.at(point)? {
        Ok(values) => values.left,
        Err(violation) => return Some(Err(violation)),
    };
    let values = tape.values(point)?;
    let terms: usize = regressor.base.iter().map(|base| base.terms.len()).sum();
    let (factors, values) = values.split_at_checked(terms)?;
    let (given, values) = values.split_at_checked(regressor.standard.len())?;
    let n = regressor.model.n();
    let (columns, values) = values.split_at_checked(given.len() * n)?;
    let (kept, rest) = values.split_at_checked(regressor.base.len() * n)?;
    let column = |k: usize| &columns[k * n..(k + 1) * n];
    let whole = |pi: &[ResiduePair]| -> Vec<ResiduePair> {
        let mut sum = vec![ResiduePair::ZERO; n];
        (0..pi.len()).for_each(|k| increase(&mut sum, column(k), pi[k]));
        sum
    };
    let based = |pi: &[ResiduePair]| -> Vec<ResiduePair> {
        let mut sum = vec![ResiduePair::ZERO; n];
        let mut factors = factors.iter();
        for (place, base) in regressor.base.iter().enumerate() {
            let terms = base.terms.iter().zip(&mut factors);
            let beta = terms.fold(ResiduePair::ZERO, |beta, (&(k, _), &factor)| {
                beta + factor * pi[k]
            });
            increase(&mut sum, &kept[place * n..(place + 1) * n], beta);
        }
        sum
    };
    let random = &mut Random::new(seed ^ 0x5bd1);
    let anything: Vec<ResiduePair> = given.iter().map(|_| random.element()).collect();
    if whole(&anything) != based(&anything) {
        return Some(Err(Violation::Identity(
            "base parameters do not determine all parameters",
        )));
    }
    // (30b) contains no dampers, and the regressor contains no other potentials.
    let all: Vec<ResiduePair> = given
        .iter()
        .zip(added)
        .map(|(&own, &more)| own + more)
        .collect();
    let mut force = based(&all);
    for (k, one) in regressor.standard.iter().enumerate() {
        if one.kind == ParameterKind::Damping {
            increase(&mut force, column(k), -given[k]);
        }
    }
    increase(&mut force, rest, ResiduePair::ONE);
    Some(match force == left[1] {
        true => Ok(()),
        false => Err(Violation::Identity(
            "the regressor is not that of inverse dynamics, (30b)",
        )),
    })
}

/// Adds k times a vector.
fn increase(sum: &mut [ResiduePair], by: &[ResiduePair], k: ResiduePair) {
    for (sum, &by) in sum.iter_mut().zip(by) {
        *sum = *sum + by * k;
    }
}
