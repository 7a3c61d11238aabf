//! Division with remainder: f = Σ q_i g_i + r, no term of r divisible by a leading monomial.
//!
//! For a Gröbner basis r = NF(f) is unique, and NF(f) = 0 decides membership in the ideal.

use super::field::Field;
use super::monomial::Monomial;
use super::order::Order;
use super::polynomial::Poly;
use super::sums::{insert_terms, merge_terms};

/// A monic divisor with the mask of its leading monomial.
#[derive(Clone, Debug)]
pub(super) struct Divisor<F> {
    pub(super) lead: Monomial,
    pub(super) mask: u64,
    pub(super) poly: Poly<F>,
}

impl<F: Field> Divisor<F> {
    /// Creates the divisor of a non-zero polynomial; `None` for 0.
    pub(super) fn new(poly: &Poly<F>) -> Option<Self> {
        let poly = poly.monic();
        let lead = poly.leading()?.0.clone();
        let mask = lead.mask();
        Some(Divisor { lead, mask, poly })
    }
}

/// A list of monic polynomials in one order, as [`super::buchberger::groebner`] returns it:
/// a reduced Gröbner basis, ascending by leading monomial.
#[derive(Clone, Debug)]
pub struct Basis<F> {
    order: Order,
    divisors: Vec<Divisor<F>>,
}

impl<F: Field> Basis<F> {
    pub(super) fn new(order: Order, mut divisors: Vec<Divisor<F>>) -> Self {
        divisors.sort_by(|a, b| order.compare(&a.lead, &b.lead));
        Basis { order, divisors }
    }

    /// The order the basis belongs to.
    pub fn order(&self) -> Order {
        self.order
    }

    /// The polynomials, ascending by leading monomial.
    pub fn polynomials(&self) -> impl ExactSizeIterator<Item = &Poly<F>> {
        self.divisors.iter().map(|divisor| &divisor.poly)
    }

    /// Whether the ideal is the whole ring, so that the variety is empty.
    pub fn is_unit(&self) -> bool {
        self.divisors.iter().any(|divisor| divisor.lead.is_one())
    }

    /// The normal form NF(f), in the order of the basis.
    pub fn normal_form(&self, f: &Poly<F>) -> Poly<F> {
        let f = f.with_order(self.order);
        let divisors: Vec<&Divisor<F>> = self.divisors.iter().collect();
        let mut unlimited = u64::MAX;
        // Without limits, there is always a result.
        reduce(&f, &divisors, usize::MAX, &mut unlimited).unwrap_or(f)
    }

    /// Whether f is in normal form: no leading monomial of the basis divides one of its terms.
    pub fn is_reduced(&self, f: &Poly<F>) -> bool {
        f.terms().iter().all(|(monomial, _)| {
            let mask = !monomial.mask();
            self.divisors
                .iter()
                .all(|divisor| divisor.mask & mask != 0 || monomial.div(&divisor.lead).is_none())
        })
    }

    /// Whether f lies in the ideal.
    pub fn contains(&self, f: &Poly<F>) -> bool {
        self.normal_form(f).is_zero()
    }
}

/// The remainder of f (sorted in the divisors' order). `None` when a polynomial grows beyond
/// `most` terms, or when the work (in words of coefficients written) exceeds the budget.
pub(super) fn reduce<F: Field>(
    f: &Poly<F>,
    divisors: &[&Divisor<F>],
    most: usize,
    budget: &mut u64,
) -> Option<Poly<F>> {
    let order = f.order();
    // Ascending, so that the leading term is popped from the end.
    let mut rest: Vec<(Monomial, F)> = f.terms().iter().rev().cloned().collect();
    let mut remainder = Vec::new();
    while let Some((monomial, coefficient)) = rest.pop() {
        let mask = !monomial.mask();
        let fitting = divisors
            .iter()
            .filter(|divisor| divisor.mask & mask == 0)
            .find_map(|divisor| Some((divisor, monomial.div(&divisor.lead)?)));
        match fitting {
            Some((divisor, cofactor)) => {
                let tail = divisor.poly.terms().get(1..).unwrap_or(&[]);
                rest = subtract(order, rest, &cofactor, &coefficient, tail, budget)?;
                if rest.len() > most {
                    return None;
                }
            }
            None => remainder.push((monomial, coefficient)),
        }
    }
    Some(Poly::from_sorted(order, remainder))
}

/// Number of terms of a tail up to which each term is inserted by binary search; longer tails are merged.
const MAX_BINARY_INSERTIONS: usize = 8;

/// rest − c m tail, for an ascending `rest` and a descending `tail`.
fn subtract<F: Field>(
    order: Order,
    rest: Vec<(Monomial, F)>,
    m: &Monomial,
    c: &F,
    tail: &[(Monomial, F)],
    budget: &mut u64,
) -> Option<Vec<(Monomial, F)>> {
    let mut work = rest.len() as u64 / 8 + 1;
    let products = tail.iter().map(|(monomial, coefficient)| {
        let value = coefficient.mul(c).neg();
        work += value.words() as u64;
        (monomial.mul(m), value)
    });
    let result = match tail.len() <= MAX_BINARY_INSERTIONS {
        true => insert_terms(order, rest, products),
        false => merge_terms(order, rest, products.rev(), tail.len()),
    };
    *budget = budget.checked_sub(work)?;
    Some(result)
}
