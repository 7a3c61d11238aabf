//! The proof of base parameters: at fresh points, which have other run-time parameters than those at which the relations
//! were found, Y_b β is Y π for random π, and for the values of the description the force of (30b), from accelerations of
//! mass points in numbers modulo p.

use super::numbers::Numbers;
use super::points::{Unequal, at_fresh_points};
use super::verdict::{failure, nowhere};
use crate::algebra::fp::{Fp, Random};
use crate::algebra::graph::Edge;
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::algebra::tape::Tape;
use crate::derive::regressor::{Kind, Regressor};
use crate::diagnostics::Diagnostic;
use crate::model::Model;
use crate::program::{FunctionId, Program};

/// Proves the base parameters of a model.
///
/// # Errors
/// A fault of the generator: what differs.
pub fn prove(model: &Model, regressor: &Regressor) -> Result<(), String> {
    let failed = |what: &str| format!("internal check failed: {what}");
    let numbers = Numbers::new(model).ok_or_else(|| failed("its forces have no numbers"))?;
    let factors = regressor.base.iter().flat_map(|base| &base.terms);
    let mut edges: Vec<Edge> = factors.map(|&(_, factor)| factor).collect();
    edges.extend(regressor.standard.iter().map(|one| one.value));
    edges.extend(regressor.columns.iter().flatten());
    edges.extend(regressor.base.iter().flat_map(|base| &base.column));
    edges.extend(&regressor.other_potentials);
    let tape = Tape::new(&regressor.model.graph, &edges)
        .ok_or_else(|| failed("its columns have no numbers"))?;
    let compared = at_fresh_points(
        |seed| model.points.lane(seed),
        |lane, seed| at(&numbers, &tape, regressor, lane, seed),
    );
    match compared {
        Ok(()) => Ok(()),
        Err(Unequal::Differs(what)) => Err(failed(&what)),
        Err(Unequal::Nowhere) => Err(failed("there are too few points to compare its forces at")),
    }
}

/// Proves the base parameters, and that what is emitted are they and their columns.
///
/// # Errors
/// A fault of the generator, never emitted.
pub fn validate(model: &Model, regressor: &Regressor, program: &Program) -> Result<(), Diagnostic> {
    prove(model, regressor).map_err(|what| failure(model, &what))?;
    let columns: Vec<&Vec<Edge>> = regressor.base.iter().map(|base| &base.column).collect();
    let n = regressor.model.n();
    let rows = (0..n).flat_map(|row| columns.iter().map(move |column| column[row]));
    let rows: Vec<Edge> = rows.collect();
    let values: Vec<Edge> = regressor.standard.iter().map(|one| one.value).collect();
    let terms = regressor.base.iter().flat_map(|base| &base.terms);
    let factors: Vec<Edge> = terms.map(|&(_, factor)| factor).collect();
    let compared = at_fresh_points(
        |seed| model.points.lane(0x4e_9e55 + seed),
        |lane, _| {
            let of = |edges: &[Edge]| evaluate_at(&regressor.model.graph, edges, &mut lane.clone());
            let emitted = |id: FunctionId| match program.function(id) {
                None => Some(None),
                Some(f) => evaluate_at(&program.graph, &f.outputs, &mut lane.clone()).map(Some),
            };
            let (values, factors) = (of(&values)?, of(&factors)?);
            let mut factors = factors.iter();
            let beta = regressor.base.iter().map(|base| {
                let terms = base.terms.iter().zip(&mut factors);
                terms.fold(Fp::ZERO, |beta, (&(k, _), &factor)| {
                    beta + factor * values[k]
                })
            });
            let beta: Vec<Fp> = beta.collect();
            let same = emitted(FunctionId::Regressor)?.is_none_or(|found| Some(found) == of(&rows))
                && emitted(FunctionId::BaseParameters)?.is_none_or(|found| found == beta);
            Some(if same { Ok(()) } else { Err(()) })
        },
    );
    compared.map_err(|unequal| match unequal {
        Unequal::Differs(()) => failure(model, "the emitted regressor is Y, the base parameters β"),
        Unequal::Nowhere => nowhere(model),
    })
}

/// Compares at a point; `None` where something has no value.
fn at(
    numbers: &Numbers,
    tape: &Tape,
    regressor: &Regressor,
    lane: &Lane,
    seed: u64,
) -> Option<Result<(), String>> {
    let left = match numbers.at(lane)? {
        Ok(values) => values.left,
        Err(what) => return Some(Err(what)),
    };
    let values = tape.values(lane)?;
    let terms: usize = regressor.base.iter().map(|base| base.terms.len()).sum();
    let (factors, values) = values.split_at_checked(terms)?;
    let (given, values) = values.split_at_checked(regressor.standard.len())?;
    let n = regressor.model.n();
    let (columns, values) = values.split_at_checked(given.len() * n)?;
    let (kept, rest) = values.split_at_checked(regressor.base.len() * n)?;
    let column = |k: usize| &columns[k * n..(k + 1) * n];
    let whole = |pi: &[Fp]| -> Vec<Fp> {
        let mut sum = vec![Fp::ZERO; n];
        (0..pi.len()).for_each(|k| increase(&mut sum, column(k), pi[k]));
        sum
    };
    let based = |pi: &[Fp]| -> Vec<Fp> {
        let mut sum = vec![Fp::ZERO; n];
        let mut factors = factors.iter();
        for (place, base) in regressor.base.iter().enumerate() {
            let terms = base.terms.iter().zip(&mut factors);
            let beta = terms.fold(Fp::ZERO, |beta, (&(k, _), &factor)| beta + factor * pi[k]);
            increase(&mut sum, &kept[place * n..(place + 1) * n], beta);
        }
        sum
    };
    let random = &mut Random::new(seed ^ 0x5bd1);
    let anything: Vec<Fp> = given.iter().map(|_| random.element()).collect();
    if whole(&anything) != based(&anything) {
        return Some(Err("base parameters do not stand for all parameters".into()));
    }
    // Dampers are no part of (30b), and what else has a potential no part of the regressor.
    let mut force = based(given);
    for (k, one) in regressor.standard.iter().enumerate() {
        if one.kind == Kind::Damping {
            increase(&mut force, column(k), -given[k]);
        }
    }
    increase(&mut force, rest, Fp::ONE);
    Some(match force == left[1] {
        true => Ok(()),
        false => Err("the regressor is not that of inverse dynamics, (30b)".into()),
    })
}

/// Adds k times a vector.
fn increase(sum: &mut [Fp], by: &[Fp], k: Fp) {
    for (sum, &by) in sum.iter_mut().zip(by) {
        *sum = *sum + by * k;
    }
}
