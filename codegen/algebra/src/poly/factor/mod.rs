//! Factorization of several polynomials at once into a cheap straight-line program.
//!
//! The total number of products and sums is made small by factoring and by sharing subexpressions:
//! f = m c₁ + m c₂ + … becomes m K + … with K = c₁ + c₂, wherever K occurs, and products of two factors that
//! occur several times are computed once. Coefficients are factors like any other. Divisors are extracted
//! greedily. As the result depends on their order, several orders are tried; then parts of the best program
//! are expanded and extracted again. The search is deterministic, and limited to a fixed amount of work.

mod divisor;
mod greedy;
mod network;
mod program;
mod split;
mod system;

pub use program::{Operand, Program, Step, Value};

use super::monomial::Monomial;
use divisor::{Strategy, mix};
use greedy::extract_divisors;

use std::collections::{BTreeMap, BTreeSet};
use system::{Literal, Product, System, cancelled};

/// ± a run-time constant. Different ids are unrelated; id 0 is the number 1.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Coefficient {
    /// Identifier of the constant.
    pub id: u32,
    /// Whether it is negated.
    pub negative: bool,
}

/// A constant times a monomial in run-time variables.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Term {
    /// The constant.
    pub coefficient: Coefficient,
    /// The monomial.
    pub monomial: Monomial,
}

/// Budget of all attempts together, in pairs of products examined (about 50 ms); one attempt is always
/// made.
const PAIR_BUDGET: u64 = 300_000;
/// Attempts without an improvement before the search ends: a fixed number, and a number for each term.
const IDLE_ATTEMPTS: (usize, usize) = (30, 4);
/// Largest number of products that one product may become when sums in it are expanded.
const MAX_EXPANDED_PRODUCTS: usize = 64;

/// Returns a cheap program whose outputs are the given polynomials.
pub fn factor(polynomials: &[Vec<Term>]) -> Program {
    let system = split::split(system(polynomials));
    let strategy = |kernel, cube, noise, seed| Strategy {
        kernel,
        cube,
        noise,
        seed,
    };
    let fixed = [(16, 10), (16, 16), (10, 16), (16, 4)];
    let mut best = system.clone();
    let mut least = best.operations();
    let terms: usize = polynomials.iter().map(Vec::len).sum();
    let patience = IDLE_ATTEMPTS.0 + IDLE_ATTEMPTS.1 * terms;
    let (mut work, mut failures) = (0, 0);
    for attempt in 0.. {
        let dice = |index: u64, sides: u64| mix(mix(attempt) ^ index) % sides;
        let (start, chosen) = match fixed.get(attempt as usize) {
            Some(&(kernel, cube)) if attempt == 0 || work < PAIR_BUDGET / 3 => {
                (system.clone(), strategy(kernel, cube, 0, 0))
            }
            _ => {
                let (kernel, cube) = [(16, 16), (16, 10), (16, 14), (12, 16)][dice(0, 4) as usize];
                let noise = [8, 20, 40][dice(1, 3) as usize];
                let wanted = [3, 6, 12, 24][dice(2, 4) as usize];
                let inner = best.outputs..best.sums.len();
                let share = 100 * wanted / inner.len().max(1) as u64;
                let inner = inner.filter(|&k| dice(k as u64 + 3, 100) < share);
                let start = best.expanded(&inner.collect(), MAX_EXPANDED_PRODUCTS);
                (start, strategy(kernel, cube, noise, mix(attempt)))
            }
        };
        let (result, spent) = extract_divisors(&start, chosen, 4 * PAIR_BUDGET);
        work += spent + 50 + 4 * start.sums.len() as u64;
        let operations = result.operations();
        failures = if operations < least { 0 } else { failures + 1 };
        if operations <= least {
            least = operations;
            best = result;
        }
        if failures > patience || work > PAIR_BUDGET {
            break;
        }
    }
    best.program()
}

/// Writes the polynomials as sums of products of literals.
fn system(polynomials: &[Vec<Term>]) -> System {
    let values = |term: &Term| {
        let id = term.coefficient.id;
        let constant = (id != 0).then_some((Value::Coefficient(id), 1));
        let powers = term.monomial.powers().iter();
        let variables = powers.map(|&(variable, exponent)| (Value::Var(variable), exponent));
        constant.into_iter().chain(variables).collect::<Vec<_>>()
    };
    let terms = polynomials.iter().flatten();
    let inputs: BTreeSet<Value> = terms.flat_map(values).map(|entry| entry.0).collect();
    let inputs: Vec<Value> = inputs.into_iter().collect();
    let numbered = inputs.iter().enumerate();
    let literals: BTreeMap<Value, Literal> = numbered
        .map(|(index, &value)| (value, index as Literal))
        .collect();
    let product = |term: &Term| {
        let factors = values(term).into_iter();
        let factors = factors.flat_map(|(value, exponent)| {
            let literal = literals.get(&value).copied();
            (0..exponent).filter_map(move |_| literal)
        });
        Product {
            negative: term.coefficient.negative,
            literals: factors.collect(),
        }
    };
    let sums = polynomials.iter();
    let sums = sums.map(|terms| cancelled(terms.iter().map(product)));
    System {
        outputs: polynomials.len(),
        sums: sums.collect(),
        inputs,
    }
}
