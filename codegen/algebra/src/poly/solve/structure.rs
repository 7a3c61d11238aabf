//! Structure of a system: its independent parts, and the variable to set next.

use super::super::monomial::Var;
use super::super::polynomial::Poly;
use crate::prime::Residue;
use std::collections::{BTreeMap, BTreeSet};

/// Splits the system into independent parts, with their variables.
pub(super) fn parts<const K: usize>(
    system: &[Poly<Residue<K>>],
    open: &BTreeSet<Var>,
) -> Vec<(Vec<Poly<Residue<K>>>, BTreeSet<Var>)> {
    let mut parts: Vec<(Vec<Poly<Residue<K>>>, BTreeSet<Var>)> = open
        .iter()
        .map(|&v| (Vec::new(), BTreeSet::from([v])))
        .collect();
    for f in system.iter().filter(|f| !f.is_zero()) {
        let variables: BTreeSet<Var> = f.variables().into_iter().collect();
        let (touched, mut apart): (Vec<_>, Vec<_>) = parts
            .into_iter()
            .partition(|part| !part.1.is_disjoint(&variables));
        let mut joined = (Vec::new(), BTreeSet::new());
        for (polynomials, own) in touched {
            joined.0.extend(polynomials);
            joined.1.extend(own);
        }
        joined.0.push(f.clone());
        apart.push(joined);
        parts = apart;
    }
    parts
}

/// Returns the coefficients of a polynomial in one variable, ascending.
pub(super) fn dense<const K: usize>(f: &Poly<Residue<K>>) -> Vec<Residue<K>> {
    let mut result = vec![Residue::ZERO; f.degree() as usize + 1];
    for (monomial, c) in f.terms() {
        result[monomial.degree() as usize] = *c;
    }
    result
}

/// Picks a variable of a Gröbner basis with a finite variety; `None` if the variety is not finite.
pub(super) fn determined<const K: usize>(
    system: &[Poly<Residue<K>>],
    open: &BTreeSet<Var>,
) -> Option<Var> {
    // The variety is finite if a power of every variable is a leading monomial.
    let powers: BTreeMap<Var, u32> = system
        .iter()
        .filter_map(|f| match f.leading()?.0.powers() {
            [power] => Some(*power),
            _ => None,
        })
        .collect();
    if powers.len() < open.len() {
        return None;
    }
    powers
        .into_iter()
        .min_by_key(|power| power.1)
        .map(|power| power.0)
}

/// Returns the open variables by preference: first those of the polynomial with the fewest variables, and
/// among these first the one of highest degree, so that the rest is easy to solve.
pub(super) fn by_preference<const K: usize>(
    system: &[Poly<Residue<K>>],
    open: &BTreeSet<Var>,
) -> Vec<Var> {
    let mut result = Vec::new();
    let mut polynomials: Vec<(Vec<Var>, &Poly<Residue<K>>)> =
        system.iter().map(|f| (f.variables(), f)).collect();
    polynomials.sort_by_key(|(variables, f)| (variables.len(), f.degree()));
    for (mut variables, f) in polynomials {
        let degree = |v: Var| f.terms().iter().map(|term| term.0.exponent(v)).max();
        variables.sort_by_key(|&v| std::cmp::Reverse(degree(v)));
        result.extend(variables);
    }
    result.extend(open);
    let mut seen = BTreeSet::new();
    result.retain(|&v| seen.insert(v));
    result
}
