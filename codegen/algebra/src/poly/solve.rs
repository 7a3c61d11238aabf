//! Search for a random point of a variety over F_p: x with g(x) = 0 for all generators g.
//!
//! The search is depth-first. A variable with finitely many values is set to a root in F_p of its minimal
//! polynomial; otherwise a free variable is set at random. Independent parts are solved separately. If a
//! polynomial has no root in F_p (a quadratic has none every second time), the last random choices are
//! revised, within a budget. Which variables are free is first decided by the rank of the Jacobian, which
//! is quick, and right for equations in general position. If that fails, it is decided by Gröbner bases: a
//! random value of a free variable leaves a consistent system.

mod structure;

use super::buchberger::{Limits, groebner_within};
use super::elimination::minimal_polynomial;
use super::jacobian::free_variables;
use super::monomial::Var;
use super::normal_form::Basis;
use super::order::Order;
use super::polynomial::Poly;
use super::univariate::roots;
use crate::prime::Residue;
use crate::residue_pair::Random;
use std::collections::{BTreeMap, BTreeSet};
use structure::{by_preference, dense, determined, parts};

/// Numbers of random values tried: for the first variable, and for a later one before an earlier choice is
/// revised.
const RANDOM_VALUES: (usize, usize) = (60, 6);
/// Largest number of systems examined for each variable before the search gives up.
const MAX_SYSTEMS_PER_VARIABLE: usize = 60;
/// The largest degree of a minimal polynomial.
const MAX_MINIMAL_DEGREE: usize = 64;
/// The largest amount of work in one system, in a quick and in a thorough search.
const MAX_SYSTEM_WORK: (u64, u64) = (60_000, 1_500_000);
/// The largest amount of work in all systems of a search.
const MAX_TOTAL_WORK: u64 = 8_000_000;

/// Returns a random F_p point of the variety of the generators, by ascending variable; `None` if no point
/// was found: the system is inconsistent, has no point over F_p, or is too big.
pub fn point<const K: usize>(
    generators: &[Poly<Residue<K>>],
    variables: &[Var],
    random: &mut Random,
) -> Option<Vec<(Var, Residue<K>)>> {
    let open: BTreeSet<Var> = variables.iter().copied().collect();
    let known = |f: &Poly<Residue<K>>| f.variables().iter().all(|v| open.contains(v));
    if !generators.iter().all(known) {
        return None;
    }
    let search = |quick: bool, random: &mut Random| {
        let mut search = Search {
            random,
            quick,
            systems: MAX_SYSTEMS_PER_VARIABLE * (open.len() + 1),
            work: MAX_TOTAL_WORK,
            choices: 0,
        };
        search.solve(generators, &open)
    };
    let values = match search(true, random) {
        Err(Failure::Inconsistent) => return None,
        Err(Failure::Unlucky) => search(false, random).ok()?,
        Ok(values) => values,
    };
    let at = |v: Var| values.get(&v).copied().unwrap_or(Residue::ZERO);
    let vanishes = |f: &Poly<Residue<K>>| f.eval(&at).is_zero();
    let complete = open.iter().all(|v| values.contains_key(v));
    (complete && generators.iter().all(vanishes)).then(|| values.into_iter().collect())
}

type Values<const K: usize> = BTreeMap<Var, Residue<K>>;

enum Failure {
    /// There is no point, not even over the algebraic closure.
    Inconsistent,
    /// There may be points, but these choices did not lead to one.
    Unlucky,
}

struct Search<'a> {
    random: &'a mut Random,
    /// Whether the rank of the Jacobian decides which variables are free.
    quick: bool,
    systems: usize,
    work: u64,
    /// Number of variables that are now set at random.
    choices: usize,
}

impl Search<'_> {
    /// Finds values of the open variables at which the system vanishes.
    fn solve<const K: usize>(
        &mut self,
        system: &[Poly<Residue<K>>],
        open: &BTreeSet<Var>,
    ) -> Result<Values<K>, Failure> {
        let mut values = Values::<K>::new();
        for (part, variables) in parts(system, open) {
            values.extend(self.solve_part(&part, &variables)?);
        }
        Ok(values)
    }

    /// Solves a connected system.
    fn solve_part<const K: usize>(
        &mut self,
        system: &[Poly<Residue<K>>],
        open: &BTreeSet<Var>,
    ) -> Result<Values<K>, Failure> {
        self.systems = self.systems.checked_sub(1).ok_or(Failure::Unlucky)?;
        if system.is_empty() {
            return Ok(open.iter().map(|&v| (v, self.random.residue())).collect());
        }
        if open.is_empty() {
            return Err(Failure::Inconsistent);
        }
        let single = |f: &&Poly<Residue<K>>| f.variables().len() == 1;
        if let Some(f) = system.iter().filter(single).min_by_key(|f| f.degree())
            && let Some(variable) = f.variables().first()
        {
            return self.choose_root(system, &dense(f), open, *variable);
        }
        let variables = by_preference(system, open);
        if self.quick
            && let Some(&free) = free_variables(system, &variables, self.random).first()
        {
            return self.choose_free(system, None, open, free);
        }
        let work = if self.quick {
            MAX_SYSTEM_WORK.0
        } else {
            MAX_SYSTEM_WORK.1
        };
        let limits = Limits {
            pairs: 2_000,
            terms: 2_000,
            work: self.work.min(work),
        };
        let mut rest = limits;
        let basis = groebner_within(system, Order::Grevlex, &mut rest);
        self.work -= limits.work - rest.work;
        let Some(basis) = basis else {
            // Too big to decide: smaller systems may be easier.
            let Some(&variable) = variables.first() else {
                return Err(Failure::Unlucky);
            };
            return self.choose_free(system, None, open, variable);
        };
        if basis.is_unit() {
            return Err(Failure::Inconsistent);
        }
        let system: Vec<Poly<Residue<K>>> = basis.polynomials().cloned().collect();
        let mut values = Values::<K>::new();
        for (part, variables) in parts(&system, open) {
            values.extend(self.branch(&part, &basis, &variables)?);
        }
        Ok(values)
    }

    /// Solves a connected part of a Gröbner basis by setting one variable.
    fn branch<const K: usize>(
        &mut self,
        system: &[Poly<Residue<K>>],
        basis: &Basis<Residue<K>>,
        open: &BTreeSet<Var>,
    ) -> Result<Values<K>, Failure> {
        let variable = match determined(system, open) {
            Some(variable) => {
                let minimal = minimal_polynomial(basis, variable, MAX_MINIMAL_DEGREE);
                return self.choose_root(system, &minimal.ok_or(Failure::Unlucky)?, open, variable);
            }
            None => by_preference(system, open).first().copied(),
        };
        self.choose_free(system, Some(basis), open, variable.ok_or(Failure::Unlucky)?)
    }

    /// Sets a variable at random. If the basis is known and this leads to a contradiction, the variable has
    /// only finitely many values.
    fn choose_free<const K: usize>(
        &mut self,
        system: &[Poly<Residue<K>>],
        basis: Option<&Basis<Residue<K>>>,
        open: &BTreeSet<Var>,
        variable: Var,
    ) -> Result<Values<K>, Failure> {
        let tries = if self.choices == 0 {
            RANDOM_VALUES.0
        } else {
            RANDOM_VALUES.1
        };
        for _ in 0..tries {
            let value = self.random.residue();
            self.choices += 1;
            let result = self.fix(system, open, variable, value);
            self.choices -= 1;
            match (result, basis) {
                (Ok(values), _) => return Ok(values),
                (Err(Failure::Inconsistent), Some(basis)) => {
                    let minimal = minimal_polynomial(basis, variable, MAX_MINIMAL_DEGREE);
                    return self.choose_root(
                        system,
                        &minimal.ok_or(Failure::Unlucky)?,
                        open,
                        variable,
                    );
                }
                (Err(_), _) => {}
            }
        }
        Err(Failure::Unlucky)
    }

    /// Sets a variable to a root of a polynomial that has all possible values of the variable as roots.
    fn choose_root<const K: usize>(
        &mut self,
        system: &[Poly<Residue<K>>],
        polynomial: &[Residue<K>],
        open: &BTreeSet<Var>,
        variable: Var,
    ) -> Result<Values<K>, Failure> {
        let mut candidates = roots(polynomial, self.random);
        while !candidates.is_empty() {
            let index = self.random.bits() % candidates.len() as u64;
            let root = candidates.swap_remove(index as usize);
            if let Ok(values) = self.fix(system, open, variable, root) {
                return Ok(values);
            }
        }
        Err(Failure::Unlucky)
    }

    /// Sets one variable, and solves the rest.
    fn fix<const K: usize>(
        &mut self,
        system: &[Poly<Residue<K>>],
        open: &BTreeSet<Var>,
        variable: Var,
        value: Residue<K>,
    ) -> Result<Values<K>, Failure> {
        let set = |f: &Poly<Residue<K>>| f.specialize(&|v| (v == variable).then_some(value));
        let rest: Vec<Poly<Residue<K>>> = system.iter().map(set).collect();
        let others: BTreeSet<Var> = open.iter().copied().filter(|&v| v != variable).collect();
        let mut values = self.solve(&rest, &others)?;
        values.insert(variable, value);
        Ok(values)
    }
}
