//! Turns polynomials into expressions as a person would write them.
//!
//! m s₁ + m s₂ becomes m (s₁ + s₂), ½ a − ½ b becomes ½ (a − b); terms are sorted by their symbols in
//! order of declaration, and a sum begins with a positive term.

use super::expression::Term;
use hamel_algebra::poly::monomial::{Monomial, Var};
use hamel_algebra::poly::polynomial::Poly;
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// How the variables of a polynomial are written.
pub struct Letters<'a> {
    /// The expression of a variable.
    pub atom: &'a dyn Fn(Var) -> Term,
    /// Whether a variable is constant at run time.
    pub is_free: &'a dyn Fn(Var) -> bool,
}

/// Returns the terms in reading order: those in symbols that are declared first come first.
pub fn sorted(polynomial: &Poly<BigRational>) -> Vec<(Monomial, BigRational)> {
    let mut terms = polynomial.terms().to_vec();
    terms.sort_by(|(a, _), (b, _)| reading_order(a, b));
    terms
}

/// Compares the powers of the first variable in which two monomials differ; higher powers come first.
fn reading_order(a: &Monomial, b: &Monomial) -> Ordering {
    let (mut left, mut right) = (a.powers().iter(), b.powers().iter());
    loop {
        match (left.next(), right.next()) {
            (None, None) => return Ordering::Equal,
            (Some(_), None) => return Ordering::Less,
            (None, Some(_)) => return Ordering::Greater,
            (Some((v, p)), Some((w, q))) => {
                let order = v.cmp(w).then(q.cmp(p));
                if order != Ordering::Equal {
                    return order;
                }
            }
        }
    }
}

/// Whether −f reads better than f as the value of a row: the form with fewer positive terms is better,
/// if it has at least one, as in KR18 (45); in case of a tie the first term should be positive.
pub fn reads_better_negated(polynomial: &Poly<BigRational>) -> bool {
    let terms = sorted(polynomial);
    let positive = terms.iter().filter(|(_, c)| c.is_positive()).count();
    let negative = terms.len() - positive;
    match (positive, negative) {
        (0, _) => true,
        (_, 0) => false,
        _ if positive == negative => terms.first().is_some_and(|(_, c)| c.is_negative()),
        _ => negative < positive,
    }
}

/// Returns the expression of a polynomial, with common factors in front.
pub fn polish(polynomial: &Poly<BigRational>, letters: &Letters) -> Term {
    match split(polynomial, letters) {
        Some((constant, varying)) => {
            let (varying, constant) = (plain(&varying, letters), plain(&constant, letters));
            let number = Term::number(varying.coefficient.clone());
            let varying = Term {
                coefficient: BigRational::one(),
                ..varying
            };
            number.times(&constant).times(&varying)
        }
        None => plain(polynomial, letters),
    }
}

/// Factors a polynomial into one in run-time constants and one in the other variables, neither a
/// single term: (m₁ + m₂)(x − y). `None` if that is not possible.
fn split(
    polynomial: &Poly<BigRational>,
    letters: &Letters,
) -> Option<(Poly<BigRational>, Poly<BigRational>)> {
    let mut parts: BTreeMap<Monomial, Vec<(Monomial, BigRational)>> = BTreeMap::new();
    for (monomial, c) in sorted(polynomial) {
        let (constant, varying) = halves(&monomial, letters);
        parts.entry(varying).or_default().push((constant, c));
    }
    let mut base = parts.values().next()?.clone();
    // The first term becomes positive; signs go to the varying factor.
    if base.first().is_some_and(|(_, c)| c.is_negative()) {
        base = base.into_iter().map(|(m, c)| (m, -c)).collect();
    }
    if parts.len() < 2 || base.len() < 2 {
        return None;
    }
    let mut varying = Vec::new();
    for (monomial, part) in parts {
        let ratio = &part[0].1 / &base[0].1;
        let scaled = base.iter().map(|(m, c)| (m, c * &ratio));
        if !part.iter().map(|(m, c)| (m, c.clone())).eq(scaled) {
            return None;
        }
        varying.push((monomial, ratio));
    }
    let order = polynomial.order();
    Some((
        Poly::from_terms(order, base),
        Poly::from_terms(order, varying),
    ))
}

/// Splits a monomial into the factors that are constant at run time, and the others.
fn halves(monomial: &Monomial, letters: &Letters) -> (Monomial, Monomial) {
    let powers = monomial.powers().iter().copied();
    let (constant, varying): (Vec<_>, Vec<_>) = powers.partition(|&(v, _)| (letters.is_free)(v));
    (
        Monomial::from_powers(constant),
        Monomial::from_powers(varying),
    )
}

/// Writes the terms sorted by their varying factors first, with a common monomial and a common number in front.
fn plain(polynomial: &Poly<BigRational>, letters: &Letters) -> Term {
    let mut terms = polynomial.terms().to_vec();
    terms.sort_by(|(a, _), (b, _)| {
        let ((p, x), (q, y)) = (halves(a, letters), halves(b, letters));
        reading_order(&x, &y).then_with(|| reading_order(&p, &q))
    });
    let atom = letters.atom;
    if terms.len() < 2 {
        let written = terms.iter().map(|(monomial, c)| product(monomial, c, atom));
        return Term::sum(written.collect());
    }
    let mut number = common_number(&terms);
    if terms.iter().all(|(_, c)| c.is_negative()) {
        number = -number;
    }
    let common = common_monomial(&terms);
    let inner = terms.iter().map(|(monomial, c)| {
        let rest = monomial.div(&common).unwrap_or_default();
        product(&rest, &(c / &number), atom)
    });
    let inner = Term::sum(inner.collect());
    if number.is_one() && common.is_one() {
        return inner;
    }
    product(&common, &number, atom).times(&inner)
}

/// Returns n/d if all denominators are d, where n is the greatest common divisor of the numerators; else 1.
fn common_number(terms: &[(Monomial, BigRational)]) -> BigRational {
    let mut numbers = terms.iter().map(|(_, c)| c);
    let Some(first) = numbers.next() else {
        return BigRational::one();
    };
    let mut numerator: BigInt = first.numer().abs();
    for number in numbers {
        if number.denom() != first.denom() {
            return BigRational::one();
        }
        numerator = numerator.gcd(number.numer());
    }
    if numerator.is_zero() {
        return BigRational::one();
    }
    BigRational::new(numerator, first.denom().clone())
}

fn common_monomial(terms: &[(Monomial, BigRational)]) -> Monomial {
    let mut monomials = terms.iter().map(|(monomial, _)| monomial);
    let first = monomials.next().cloned().unwrap_or_default();
    monomials.fold(first, |common, monomial| common.gcd(monomial))
}

fn product(monomial: &Monomial, number: &BigRational, atom: &dyn Fn(Var) -> Term) -> Term {
    let mut term = Term::number(number.clone());
    for &(var, power) in monomial.powers() {
        let factor = atom(var);
        for _ in 0..power {
            term = term.times(&factor);
        }
    }
    term
}
