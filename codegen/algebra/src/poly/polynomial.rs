//! A polynomial Σ_a c_a x^a over a field.

use super::field::Field;
use super::monomial::{Monomial, Var};
use super::order::Order;
use std::cmp::Ordering;

/// A polynomial: its non-zero terms, descending in its order. Arithmetic keeps the order of the
/// left operand; equality ignores the order.
#[derive(Clone, Debug)]
pub struct Poly<F> {
    order: Order,
    terms: Vec<(Monomial, F)>,
}

impl<F: Field> PartialEq for Poly<F> {
    fn eq(&self, other: &Self) -> bool {
        if self.order == other.order {
            return self.terms == other.terms;
        }
        self.terms == other.with_order(self.order).terms
    }
}

impl<F: Field> Poly<F> {
    /// 0.
    pub fn zero() -> Self {
        Self::from_terms(Order::default(), Vec::new())
    }

    /// 1.
    pub fn one() -> Self {
        Self::constant(F::one())
    }

    /// The constant polynomial c.
    pub fn constant(value: F) -> Self {
        Self::from_terms(Order::default(), vec![(Monomial::one(), value)])
    }

    /// The polynomial x_v.
    pub fn var(variable: Var) -> Self {
        Self::from_terms(Order::default(), vec![(Monomial::var(variable), F::one())])
    }

    /// The sum of the given terms, in any order; equal monomials add up.
    pub fn from_terms(order: Order, mut terms: Vec<(Monomial, F)>) -> Self {
        collect(order, &mut terms);
        Poly { order, terms }
    }

    /// Creates a polynomial from terms that are already descending and non-zero.
    pub(super) fn from_sorted(order: Order, terms: Vec<(Monomial, F)>) -> Self {
        Poly { order, terms }
    }

    /// The same polynomial, sorted in another order.
    pub fn with_order(&self, order: Order) -> Self {
        let mut result = self.clone();
        if order != result.order {
            result.order = order;
            result.terms.sort_by(|a, b| order.compare(&b.0, &a.0));
        }
        result
    }

    /// The order of the terms.
    pub fn order(&self) -> Order {
        self.order
    }

    /// The non-zero terms, descending.
    pub fn terms(&self) -> &[(Monomial, F)] {
        &self.terms
    }

    /// The leading term; `None` for 0.
    pub fn leading(&self) -> Option<&(Monomial, F)> {
        self.terms.first()
    }

    /// Whether this is 0.
    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    /// Returns the value, if the polynomial is constant.
    pub fn as_constant(&self) -> Option<F> {
        match self.terms.as_slice() {
            [] => Some(F::zero()),
            [(monomial, value)] if monomial.is_one() => Some(value.clone()),
            _ => None,
        }
    }

    /// Total degree; 0 for the zero polynomial.
    pub fn degree(&self) -> u32 {
        let degrees = self.terms.iter().map(|term| term.0.degree());
        degrees.max().unwrap_or(0)
    }

    /// The variables that occur, ascending.
    pub fn variables(&self) -> Vec<Var> {
        let powers = self.terms.iter().flat_map(|term| term.0.powers());
        let mut list: Vec<Var> = powers.map(|power| power.0).collect();
        list.sort_unstable();
        list.dedup();
        list
    }

    /// f + g.
    pub fn add(&self, other: &Self) -> Self {
        if self.order != other.order {
            return self.add(&other.with_order(self.order));
        }
        Self::from_sorted(self.order, unite(self.order, &self.terms, &other.terms))
    }

    /// −f.
    pub fn neg(&self) -> Self {
        let terms = self.terms.iter().map(|(m, c)| (m.clone(), c.neg()));
        Self::from_sorted(self.order, terms.collect())
    }

    /// f − g.
    pub fn sub(&self, other: &Self) -> Self {
        self.add(&other.neg())
    }

    /// c f.
    pub fn scale(&self, factor: &F) -> Self {
        if factor.is_zero() {
            return Self::from_sorted(self.order, Vec::new());
        }
        let terms = self.terms.iter().map(|(m, c)| (m.clone(), c.mul(factor)));
        Self::from_sorted(self.order, terms.collect())
    }

    /// f divided by its leading coefficient; 0 stays 0.
    pub fn monic(&self) -> Self {
        match self.leading().and_then(|term| term.1.inv()) {
            Some(inverse) if !inverse.is_one() => self.scale(&inverse),
            _ => self.clone(),
        }
    }

    /// f g.
    pub fn mul(&self, other: &Self) -> Self {
        let products = self.products(other, usize::MAX);
        products.unwrap_or_else(|| Self::from_sorted(self.order, Vec::new()))
    }

    /// f g, unless the result or a partial sum has more than `most` terms.
    pub fn mul_limited(&self, other: &Self, most: usize) -> Option<Self> {
        self.products(other, most)
    }

    /// f^n.
    pub fn pow(&self, exponent: u32) -> Self {
        let result = self.pow_limited(exponent, usize::MAX);
        result.unwrap_or_else(|| Self::from_sorted(self.order, Vec::new()))
    }

    /// f^n, unless an intermediate power has more than `most` terms.
    pub fn pow_limited(&self, exponent: u32, most: usize) -> Option<Self> {
        let mut result = Self::one().with_order(self.order);
        for _ in 0..exponent {
            result = result.mul_limited(self, most)?;
        }
        Some(result)
    }

    /// Maps the coefficients; `None` if one of them has no image.
    pub fn map<G: Field>(&self, f: impl Fn(&F) -> Option<G>) -> Option<Poly<G>> {
        let terms = self.terms.iter().map(|(m, c)| Some((m.clone(), f(c)?)));
        Some(Poly::from_terms(self.order, terms.collect::<Option<_>>()?))
    }

    fn products(&self, other: &Self, most: usize) -> Option<Self> {
        let mut terms = Vec::new();
        for (a, c) in &self.terms {
            terms.extend(other.terms.iter().map(|(b, d)| (a.mul(b), c.mul(d))));
            if terms.len() / 2 > most {
                collect(self.order, &mut terms);
                if terms.len() > most {
                    return None;
                }
            }
        }
        collect(self.order, &mut terms);
        (terms.len() <= most).then_some(Self::from_sorted(self.order, terms))
    }
}

/// Returns the sum of two descending lists.
fn unite<F: Field>(
    order: Order,
    one: &[(Monomial, F)],
    other: &[(Monomial, F)],
) -> Vec<(Monomial, F)> {
    let mut terms = Vec::with_capacity(one.len() + other.len());
    let (mut one, mut other) = (one.iter().peekable(), other.iter().peekable());
    while let (Some((a, c)), Some((b, d))) = (one.peek(), other.peek()) {
        match order.compare(a, b) {
            Ordering::Greater => terms.extend(one.next().cloned()),
            Ordering::Less => terms.extend(other.next().cloned()),
            Ordering::Equal => {
                let sum = c.add(d);
                if !sum.is_zero() {
                    terms.push((a.clone(), sum));
                }
                one.next();
                other.next();
            }
        }
    }
    terms.extend(one.chain(other).cloned());
    terms
}

/// Sorts terms in descending order, adds up equal monomials, and drops zeros.
fn collect<F: Field>(order: Order, terms: &mut Vec<(Monomial, F)>) {
    terms.sort_by(|a, b| order.compare(&b.0, &a.0));
    terms.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 = kept.1.add(&next.1);
        }
        same
    });
    terms.retain(|term| !term.1.is_zero());
}
