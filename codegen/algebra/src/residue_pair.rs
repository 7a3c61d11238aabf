//! Numbers modulo two primes at once: the ring F_p(i) × F_q(i).
//!
//! Values of expressions at points of the constraint variety are elements of this ring, with one point in
//! each field. Two different rational functions of degree D agree at such a pair of points with probability
//! ≤ D²/(p q), about D² 10⁻³⁷. A value counts as rational only if both fields yield the same rational.
//! Operations act on both parts; a result that does not exist in one of the fields does not exist.

use super::prime::Residue;
use num_bigint::BigInt;
use num_rational::BigRational;
use std::ops::{Add, Mul, Neg, Sub};

/// A pair of elements of F_p(i) and F_q(i).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, PartialOrd, Ord, Default)]
pub struct ResiduePair(pub Residue<0>, pub Residue<1>);

impl ResiduePair {
    /// Zero of the ring: 0 in both fields.
    pub const ZERO: ResiduePair = ResiduePair(Residue::ZERO, Residue::ZERO);
    /// 1.
    pub const ONE: ResiduePair = ResiduePair(Residue::ONE, Residue::ONE);
    /// Value that stands for π, the same at every point. The sines and cosines of its twelfths are known.
    pub const PI: ResiduePair = ResiduePair(
        Residue::new(0x0a3f_51c7_9e26_d80b),
        Residue::new(0x1c5d_09b2_64fa_8e37),
    );

    /// Returns the residue class of a non-negative integer.
    pub fn new(value: u64) -> Self {
        ResiduePair(Residue::new(value), Residue::new(value))
    }

    /// Returns the residue class of an integer.
    pub fn from_i64(value: i64) -> Self {
        ResiduePair(Residue::from_i64(value), Residue::from_i64(value))
    }

    /// Returns the residue class of an integer of any size.
    pub fn from_integer(value: &BigInt) -> Self {
        ResiduePair(Residue::from_integer(value), Residue::from_integer(value))
    }

    /// Returns the residue class of a rational; `None` if a prime divides the denominator.
    pub fn from_rational(value: &BigRational) -> Option<Self> {
        Some(ResiduePair(
            Residue::from_rational(value)?,
            Residue::from_rational(value)?,
        ))
    }

    /// Returns 64 bits that depend on all parts, for seeding random streams.
    pub fn bits(self) -> u64 {
        self.0.bits() ^ self.1.bits().rotate_left(32)
    }

    /// Whether the canonical representative of ±self is −self.
    pub fn is_negative(self) -> bool {
        if self.0.is_zero() {
            self.1.is_negative()
        } else {
            self.0.is_negative()
        }
    }

    /// Whether this is 0 in both fields.
    pub fn is_zero(self) -> bool {
        self.0.is_zero() && self.1.is_zero()
    }

    /// The inverse; `None` where a part is 0.
    pub fn inv(self) -> Option<Self> {
        Some(ResiduePair(self.0.inv()?, self.1.inv()?))
    }

    /// Inverts many values at the cost of one inversion, and of three products for each value (Montgomery's
    /// trick).
    pub fn inverses(values: impl Iterator<Item = ResiduePair>) -> Vec<Option<Self>> {
        let has_inverse = |value: ResiduePair| !value.0.is_zero() && !value.1.is_zero();
        let mut product = ResiduePair::ONE;
        // Each value with the product of the invertible ones before it.
        let before: Vec<(ResiduePair, ResiduePair)> = values
            .map(|value| {
                let before = product;
                product = if has_inverse(value) {
                    product * value
                } else {
                    product
                };
                (value, before)
            })
            .collect();
        let mut rest = product.inv().unwrap_or(ResiduePair::ONE);
        let mut inverses = vec![None; before.len()];
        for (inverse, (value, before)) in inverses.iter_mut().zip(before).rev() {
            if has_inverse(value) {
                *inverse = Some(rest * before);
                rest = rest * value;
            }
        }
        inverses
    }

    /// Square root, of either sign in each field; `None` if a part has none.
    pub fn sqrt(self) -> Option<Self> {
        Some(ResiduePair(self.0.sqrt()?, self.1.sqrt()?))
    }

    /// Returns (a, −b) for (a, b): of the four square roots of a square, one that is not ± this one.
    pub fn flipped(self) -> Self {
        ResiduePair(self.0, -self.1)
    }

    /// Returns the rational n/d with |n|, d < 2^bits (bits ≤ 29) whose residue class this is, if there is
    /// one. A value that has no reason to be rational passes with probability below 4^bits/(p q).
    pub fn to_small_rational(self, bits: u32) -> Option<(i64, i64)> {
        let found = self.0.to_small_rational(bits)?;
        (self.1.to_small_rational(bits)? == found).then_some(found)
    }
}

impl Add for ResiduePair {
    type Output = ResiduePair;
    fn add(self, other: ResiduePair) -> ResiduePair {
        ResiduePair(self.0 + other.0, self.1 + other.1)
    }
}

impl Neg for ResiduePair {
    type Output = ResiduePair;
    fn neg(self) -> ResiduePair {
        ResiduePair(-self.0, -self.1)
    }
}

impl Sub for ResiduePair {
    type Output = ResiduePair;
    fn sub(self, other: ResiduePair) -> ResiduePair {
        ResiduePair(self.0 - other.0, self.1 - other.1)
    }
}

impl Mul for ResiduePair {
    type Output = ResiduePair;
    fn mul(self, other: ResiduePair) -> ResiduePair {
        ResiduePair(self.0 * other.0, self.1 * other.1)
    }
}

/// Deterministic stream of random field elements (splitmix64): the same seed gives the same build.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// Creates the stream of a seed.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// Returns the next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns the next element of a prime field, never 0.
    pub fn residue<const K: usize>(&mut self) -> Residue<K> {
        loop {
            let bits = self.bits() >> 2;
            if bits != 0 && bits < Residue::<K>::P {
                return Residue::new(bits);
            }
        }
    }

    /// Returns the next pair of elements of the prime fields, neither of them 0.
    pub fn element(&mut self) -> ResiduePair {
        ResiduePair(self.residue(), self.residue())
    }
}
