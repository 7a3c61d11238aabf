//! A monomial x^a = Π x_i^{a_i}, as the sparse list of its non-zero exponents.

use smallvec::SmallVec;
use std::cmp::Ordering;

/// The index of an indeterminate.
pub type Var = u32;

/// Number of powers that are stored without a heap allocation, enough for most monomials.
const INLINE_POWERS: usize = 6;

/// A product of powers of variables. Its derived `Ord` is a fixed total order for use as a map key,
/// not a monomial order; see [`super::order::Order`].
#[derive(PartialEq, Eq, Hash, PartialOrd, Ord, Debug, Default)]
pub struct Monomial(SmallVec<[(Var, u32); INLINE_POWERS]>);

/// Copies the memory in one piece, where a derived `Clone` would push the powers one by one.
impl Clone for Monomial {
    fn clone(&self) -> Self {
        Monomial(SmallVec::from_slice(&self.0))
    }
}

impl Monomial {
    /// 1.
    pub fn one() -> Self {
        Monomial(SmallVec::new())
    }

    /// x_v.
    pub fn var(variable: Var) -> Self {
        Monomial(SmallVec::from_slice(&[(variable, 1)]))
    }

    /// The product of the given powers, in any order; repeated variables multiply.
    pub fn from_powers(powers: impl IntoIterator<Item = (Var, u32)>) -> Self {
        let mut list: SmallVec<[_; INLINE_POWERS]> =
            powers.into_iter().filter(|power| power.1 > 0).collect();
        list.sort_unstable_by_key(|power| power.0);
        list.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        Monomial(list)
    }

    /// The non-zero exponents, by ascending variable.
    pub fn powers(&self) -> &[(Var, u32)] {
        &self.0
    }

    /// The exponent of one variable.
    pub fn exponent(&self, variable: Var) -> u32 {
        match self.0.binary_search_by_key(&variable, |power| power.0) {
            Ok(position) => self.0[position].1,
            Err(_) => 0,
        }
    }

    /// Whether this is 1.
    pub fn is_one(&self) -> bool {
        self.0.is_empty()
    }

    /// The total degree Σ a_i.
    pub fn degree(&self) -> u32 {
        self.0.iter().map(|power| power.1).sum()
    }

    /// x^a x^b.
    pub fn mul(&self, other: &Self) -> Self {
        self.merge(other, |a, b| a + b)
    }

    /// The least common multiple, max(a_i, b_i).
    pub fn lcm(&self, other: &Self) -> Self {
        self.merge(other, u32::max)
    }

    /// The greatest common divisor, min(a_i, b_i).
    pub fn gcd(&self, other: &Self) -> Self {
        self.merge(other, u32::min)
    }

    /// x^a / x^b; `None` if it is not a monomial.
    pub fn div(&self, other: &Self) -> Option<Self> {
        if !other.divides(self) {
            return None;
        }
        Some(self.merge(other, |a, b| a - b))
    }

    /// Whether x^a divides x^b.
    pub fn divides(&self, other: &Self) -> bool {
        let mut rest = other.0.iter();
        self.0
            .iter()
            .all(|&(v, a)| rest.any(|&(w, b)| w == v && b >= a))
    }

    /// Whether the monomials have no variable in common.
    pub fn coprime(&self, other: &Self) -> bool {
        let (mut i, mut j) = (0, 0);
        while let (Some(a), Some(b)) = (self.0.get(i), other.0.get(j)) {
            match a.0.cmp(&b.0) {
                Ordering::Less => i += 1,
                Ordering::Greater => j += 1,
                Ordering::Equal => return false,
            }
        }
        true
    }

    /// Bit mask that is a subset of the mask of every multiple: a quick necessary test of divisibility.
    pub fn mask(&self) -> u64 {
        self.0.iter().fold(0, |mask, &(variable, exponent)| {
            let bit = 2 * (variable % 32);
            mask | (if exponent > 1 { 3 } else { 1 }) << bit
        })
    }

    /// Combines exponents: f(a_i, b_i) over the variables of either monomial.
    fn merge(&self, other: &Self, f: impl Fn(u32, u32) -> u32) -> Self {
        let mut result: SmallVec<[_; INLINE_POWERS]> = SmallVec::new();
        let (mut i, mut j) = (0, 0);
        loop {
            let (variable, a, b) = match (self.0.get(i), other.0.get(j)) {
                (Some(&(v, a)), Some(&(w, b))) if v == w => (v, a, b),
                (Some(&(v, a)), Some(&(w, _))) if v < w => (v, a, 0),
                (_, Some(&(w, b))) => (w, 0, b),
                (Some(&(v, a)), None) => (v, a, 0),
                (None, None) => return Monomial(result),
            };
            i += usize::from(a > 0);
            j += usize::from(b > 0);
            let exponent = f(a, b);
            if exponent > 0 {
                result.push((variable, exponent));
            }
        }
    }
}
