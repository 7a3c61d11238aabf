//! Buchberger's algorithm: every S-polynomial S(f, g) = (l/lm f) f − (l/lm g) g,
//! l = lcm(lm f, lm g), of a Gröbner basis reduces to 0.
//!
//! Pairs that need no test are dropped by the coprime and the chain criterion in the form of
//! Gebauer and Möller (Becker, Weispfenning: Gröbner Bases, 1993, algorithm UPDATE); the next
//! pair is the one with the smallest lcm (normal selection).

use super::field::Field;
use super::monomial::Monomial;
use super::normal_form::{Basis, Divisor, reduce};
use super::order::Order;
use super::polynomial::Poly;

/// Bounds within which a basis must be found.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Limits {
    /// The largest number of pairs reduced.
    pub pairs: usize,
    /// The largest number of terms of a polynomial on the way.
    pub terms: usize,
    /// The largest number of coefficient words written.
    pub work: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            pairs: 20_000,
            terms: 4_000,
            work: 5_000_000,
        }
    }
}

/// Error that a basis was not found within the limits.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct LimitExceeded;

impl std::fmt::Display for LimitExceeded {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("the Gröbner basis was not found within the limits")
    }
}

impl std::error::Error for LimitExceeded {}

/// Computes the reduced Gröbner basis of the ideal of the generators.
pub fn groebner<F: Field>(
    generators: &[Poly<F>],
    order: Order,
    mut limits: Limits,
) -> Result<Basis<F>, LimitExceeded> {
    groebner_within(generators, order, &mut limits).ok_or(LimitExceeded)
}

/// Computes the reduced Gröbner basis, and subtracts the work done from the limits.
pub(super) fn groebner_within<F: Field>(
    generators: &[Poly<F>],
    order: Order,
    limits: &mut Limits,
) -> Option<Basis<F>> {
    let generators = generators.iter().map(|f| f.with_order(order));
    let mut generators: Vec<Poly<F>> = generators.filter(|f| !f.is_zero()).collect();
    generators.sort_by(|f, g| match (f.leading(), g.leading()) {
        (Some(a), Some(b)) => order.compare(&a.0, &b.0),
        _ => std::cmp::Ordering::Equal,
    });
    let state = State {
        order,
        limits,
        elements: Vec::new(),
        alive: Vec::new(),
        pairs: Vec::new(),
    };
    state.run(generators)
}

struct Pair {
    lcm: Monomial,
    first: usize,
    second: usize,
}

struct State<'a, F> {
    order: Order,
    limits: &'a mut Limits,
    elements: Vec<Divisor<F>>,
    /// Elements whose leading monomial is not divisible by that of another element.
    alive: Vec<usize>,
    pairs: Vec<Pair>,
}

impl<F: Field> State<'_, F> {
    fn run(mut self, generators: Vec<Poly<F>>) -> Option<Basis<F>> {
        for f in &generators {
            self.insert(f)?;
        }
        for _ in 0..self.limits.pairs {
            let Some(pair) = self.next_pair() else {
                return self.reduce_basis();
            };
            let s = self.s_polynomial(&pair)?;
            self.insert(&s)?;
            if self.elements.last().is_some_and(|last| last.lead.is_one()) {
                self.pairs.clear();
            }
        }
        None
    }

    fn next_pair(&mut self) -> Option<Pair> {
        let pairs = self.pairs.iter().enumerate();
        let key = |pair: &Pair| (pair.second, pair.first);
        let best = pairs.min_by(|(_, a), (_, b)| {
            let by_lcm = self.order.compare(&a.lcm, &b.lcm);
            by_lcm.then(key(a).cmp(&key(b)))
        })?;
        let index = best.0;
        Some(self.pairs.swap_remove(index))
    }

    /// Returns the remainder of f after division by these elements, within the limits.
    fn remainder(&mut self, f: &Poly<F>, by: &[usize]) -> Option<Poly<F>> {
        let divisors: Vec<&Divisor<F>> = by.iter().map(|&i| &self.elements[i]).collect();
        reduce(f, &divisors, self.limits.terms, &mut self.limits.work)
    }

    fn s_polynomial(&self, pair: &Pair) -> Option<Poly<F>> {
        let part = |index: usize| {
            let element = &self.elements[index];
            let cofactor = pair.lcm.div(&element.lead)?;
            let tail = element.poly.terms().get(1..).unwrap_or(&[]).iter();
            let terms = tail.map(|(monomial, c)| (monomial.mul(&cofactor), c.clone()));
            Some(Poly::from_sorted(self.order, terms.collect()))
        };
        Some(part(pair.first)?.sub(&part(pair.second)?))
    }

    /// Reduces f and, unless it vanishes, adds it and updates pairs and elements.
    fn insert(&mut self, f: &Poly<F>) -> Option<()> {
        let alive = self.alive.clone();
        let Some(new) = Divisor::new(&self.remainder(f, &alive)?) else {
            return Some(());
        };
        let index = self.elements.len();
        let elements = &self.elements;
        // Chain criterion on old pairs: S(f, g) is covered by (f, new) and (g, new).
        self.pairs.retain(|pair| {
            !new.lead.divides(&pair.lcm)
                || elements[pair.first].lead.lcm(&new.lead) == pair.lcm
                || elements[pair.second].lead.lcm(&new.lead) == pair.lcm
        });
        // Chain criterion among the new pairs; coprime ones may cover others, and go last.
        let mut open: Vec<Pair> = alive
            .iter()
            .map(|&first| Pair {
                lcm: elements[first].lead.lcm(&new.lead),
                first,
                second: index,
            })
            .collect();
        let mut kept: Vec<Pair> = Vec::new();
        while let Some(pair) = open.pop() {
            let coprime = elements[pair.first].lead.coprime(&new.lead);
            let mut others = open.iter().chain(&kept);
            if coprime || !others.any(|other| other.lcm.divides(&pair.lcm)) {
                kept.push(pair);
            }
        }
        kept.retain(|pair| !elements[pair.first].lead.coprime(&new.lead));
        self.pairs.extend(kept);
        self.alive
            .retain(|&other| !new.lead.divides(&elements[other].lead));
        self.alive.push(index);
        self.elements.push(new);
        Some(())
    }

    /// Returns the basis of the alive elements, each reduced by the others.
    fn reduce_basis(mut self) -> Option<Basis<F>> {
        let mut result = Vec::with_capacity(self.alive.len());
        for position in 0..self.alive.len() {
            let mut others = self.alive.clone();
            let index = others.swap_remove(position);
            let f = self.elements[index].poly.clone();
            result.extend(Divisor::new(&self.remainder(&f, &others)?));
        }
        Some(Basis::new(self.order, result))
    }
}
