//! The field F_p(i), a prime field extended by i with i² = −1, for the two primes of the project.
//!
//! The primes are the largest p ≡ 3 mod 4 below π 2⁶⁰ and e 2⁶⁰ modulo which all primes below 40 are
//! squares. They have 62 bits and otherwise no structure, so that no power of 2, no root of a small integer
//! and no root of unity is near a small rational there (the tests check this). As −1 is not a square, every
//! element of F_p has its square roots in F_p(i). An element is therefore a + b i, where b is 0 unless a
//! root made it otherwise. Roots of small numbers are in F_p, so that sums with them are elements of F_p
//! and have roots, too. Elements are stored in Montgomery form, as a R with R = 2⁶⁴ (P. Montgomery,
//! *Modular multiplication without trial division*, 1985).

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};
use std::ops::{Add, Mul, Neg, Sub};

/// The primes p and q.
pub const PRIMES: [u64; 2] = [3_622_009_729_038_446_591, 3_133_965_575_612_089_391];

/// An element a + b i of F_p(i) for the K-th of the primes, always reduced.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Residue<const K: usize>(u64, u64);

impl<const K: usize> Residue<K> {
    /// The modulus p.
    pub const P: u64 = PRIMES[K];
    /// −1/p mod 2⁶⁴, by Newton's iteration.
    const NEGATIVE_INVERSE: u64 = {
        let mut inverse = Self::P;
        let mut digits = 3;
        while digits < 64 {
            inverse = inverse.wrapping_mul(2u64.wrapping_sub(Self::P.wrapping_mul(inverse)));
            digits *= 2;
        }
        inverse.wrapping_neg()
    };
    /// R mod p.
    const R: u64 = ((1u128 << 64) % Self::P as u128) as u64;
    /// R² mod p.
    const R2: u64 = (Self::R as u128 * Self::R as u128 % Self::P as u128) as u64;
    /// R³ mod p.
    const R3: u64 = (Self::R2 as u128 * Self::R as u128 % Self::P as u128) as u64;

    /// 0.
    pub const ZERO: Self = Residue(0, 0);
    /// 1.
    pub const ONE: Self = Residue(Self::R, 0);
    /// The imaginary unit i of F_p(i), i² = −1; not an element of F_p, since p ≡ 3 mod 4.
    pub const I: Self = Residue(0, Self::R);

    /// Returns the residue class of a non-negative integer.
    pub const fn new(value: u64) -> Self {
        Residue(Self::times(value % Self::P, Self::R2), 0)
    }

    /// Returns the residue class of an integer.
    pub fn from_i64(value: i64) -> Self {
        let magnitude = Self::new(value.unsigned_abs());
        if value < 0 { -magnitude } else { magnitude }
    }

    /// Returns the residue class of an integer of any size.
    pub fn from_integer(value: &BigInt) -> Self {
        if let Some(small) = value.to_i64() {
            return Self::from_i64(small);
        }
        // `mod_floor` by a positive modulus is in 0..p, so it fits.
        Self::new(
            value
                .mod_floor(&BigInt::from(Self::P))
                .to_u64()
                .unwrap_or(0),
        )
    }

    /// Returns the residue class of a rational; `None` if p divides the denominator.
    pub fn from_rational(value: &BigRational) -> Option<Self> {
        let numerator = Self::from_integer(value.numer());
        if value.is_integer() {
            return Some(numerator);
        }
        Some(numerator * Self::from_integer(value.denom()).inv()?)
    }

    /// Parts of a + b i as they are stored: a R and b R modulo p.
    pub fn parts(self) -> [u64; 2] {
        [self.0, self.1]
    }

    /// Creates the element with these stored parts.
    pub(crate) fn of_parts([a, b]: [u64; 2]) -> Self {
        Self(a, b)
    }

    /// Returns 64 bits that depend on a and b, for seeding random streams.
    pub fn bits(self) -> u64 {
        self.0 ^ self.1.wrapping_mul(0x9e37_79b9_7f4a_7c15)
    }

    /// Whether it is an element of F_p.
    pub fn is_in_prime_field(self) -> bool {
        self.1 == 0
    }

    /// Whether the canonical representative of ±self is −self.
    pub fn is_negative(self) -> bool {
        let leading = if self.0 == 0 { self.1 } else { self.0 };
        leading > Self::P / 2
    }

    /// Whether this is 0.
    pub fn is_zero(self) -> bool {
        self.0 | self.1 == 0
    }

    /// self^exponent by squaring.
    pub fn pow(self, mut exponent: u64) -> Self {
        let mut base = self;
        let mut result = Self::ONE;
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = result * base;
            }
            base = base * base;
            exponent >>= 1;
        }
        result
    }

    /// The inverse; `None` for 0.
    pub fn inv(self) -> Option<Self> {
        if self.is_zero() {
            return None;
        }
        if self.1 != 0 {
            let conjugate = Residue(self.0, Self::negated(self.1));
            return Some(conjugate * (self * conjugate).inv()?);
        }
        // Extended Euclid on (p, a R); the cofactors stay within ±p.
        let (mut r0, mut r1) = (Self::P as i64, self.0 as i64);
        let (mut t0, mut t1) = (0i64, 1i64);
        while r1 != 0 {
            let q = r0 / r1;
            (r0, r1) = (r1, r0 - q * r1);
            (t0, t1) = (t1, t0 - q * t1);
        }
        // The inverse of a R times R³ is R²/a, which Montgomery multiplication divides by R.
        let inverse = t0.rem_euclid(Self::P as i64) as u64;
        Some(Residue(Self::times(inverse, Self::R3), 0))
    }

    /// Square root. For a in F_p it is ±a^((p+1)/4), or i times that of −a. Of the other elements of
    /// F_p(i), half have a root (Adj and Rodríguez-Henríquez, algorithm 9); `None` for the others.
    pub fn sqrt(self) -> Option<Self> {
        if self.1 == 0 {
            let root = self.pow(Self::P.div_ceil(4));
            return Some(if root * root == self {
                root
            } else {
                Self::I * (-self).pow(Self::P.div_ceil(4))
            });
        }
        let power = self.pow((Self::P - 3) / 4);
        let root = power * self;
        let alpha = power * root;
        let root = if alpha == -Self::ONE {
            Self::I * root
        } else {
            (Self::ONE + alpha).pow((Self::P - 1) / 2) * root
        };
        (root * root == self).then_some(root)
    }

    /// The square root of a in F_p that is itself a square of F_p; `None` if a is not a square of F_p. It
    /// is a^((p+1)/4), because p ≡ 3 mod 4.
    pub fn principal_root(self) -> Option<Self> {
        let root = self
            .is_in_prime_field()
            .then(|| self.pow(Self::P.div_ceil(4)))?;
        (root * root == self).then_some(root)
    }

    /// Returns the rational n/d with |n|, d < 2^bits (bits ≤ 29) whose residue class this is, if there is
    /// one.
    pub fn to_small_rational(self, bits: u32) -> Option<(i64, i64)> {
        if self.1 != 0 {
            return None;
        }
        let bound = 1i64 << bits.min(29);
        // Convert from Montgomery form.
        let (mut r0, mut r1) = (Self::P as i64, Self::times(self.0, 1) as i64);
        let (mut t0, mut t1) = (0i64, 1i64);
        while r1 >= bound && t1.abs() < bound {
            let q = r0 / r1;
            (r0, r1) = (r1, r0 - q * r1);
            (t0, t1) = (t1, t0 - q * t1);
        }
        if r1 >= bound || t1 == 0 || t1.abs() >= bound {
            return None;
        }
        let (n, d) = if t1 < 0 { (-r1, -t1) } else { (r1, t1) };
        (n.gcd(&d) == 1).then_some((n, d))
    }

    fn plus(a: u64, b: u64) -> u64 {
        let sum = a + b;
        if sum >= Self::P { sum - Self::P } else { sum }
    }

    fn negated(a: u64) -> u64 {
        if a == 0 { 0 } else { Self::P - a }
    }

    /// Montgomery product a b / R mod p.
    const fn times(a: u64, b: u64) -> u64 {
        let product = a as u128 * b as u128;
        let factor = (product as u64).wrapping_mul(Self::NEGATIVE_INVERSE);
        let sum = ((product + factor as u128 * Self::P as u128) >> 64) as u64;
        if sum >= Self::P { sum - Self::P } else { sum }
    }
}

impl<const K: usize> std::fmt::Debug for Residue<K> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let plain = |a: u64| Self::times(a, 1);
        write!(f, "{} + {} i mod {}", plain(self.0), plain(self.1), Self::P)
    }
}

impl<const K: usize> Add for Residue<K> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Residue(Self::plus(self.0, other.0), Self::plus(self.1, other.1))
    }
}

impl<const K: usize> Neg for Residue<K> {
    type Output = Self;
    fn neg(self) -> Self {
        Residue(Self::negated(self.0), Self::negated(self.1))
    }
}

impl<const K: usize> Sub for Residue<K> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const K: usize> Mul for Residue<K> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (Residue(a, b), Residue(c, d)) = (self, other);
        if b | d == 0 {
            return Residue(Self::times(a, c), 0);
        }
        Residue(
            Self::plus(Self::times(a, c), Self::negated(Self::times(b, d))),
            Self::plus(Self::times(a, d), Self::times(b, c)),
        )
    }
}

/// Whether one of the primes divides the numerator or the denominator of a nonzero number, so that the
/// number has no faithful image.
pub fn has_bad_prime(value: &BigRational) -> bool {
    let divides =
        |n: &BigInt, p: u64| n.abs() >= BigInt::from(p) && n.is_multiple_of(&BigInt::from(p));
    let small = |n: &BigInt| n.bits() < 61;
    if small(value.numer()) && small(value.denom()) {
        return false;
    }
    PRIMES
        .iter()
        .any(|&p| divides(value.numer(), p) || divides(value.denom(), p))
}
