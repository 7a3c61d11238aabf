//! The prime field F_p, p = 2^61 − 1 (a Mersenne prime, p ≡ 3 mod 4).
//!
//! Values of expressions at points of the constraint variety live here: equality is exact, and
//! two different rational functions of degree D agree at a random point with probability ≤ D/p.

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use std::ops::{Add, Mul, Neg, Sub};

/// The modulus 2^61 − 1.
pub const P: u64 = (1 << 61) - 1;

/// An element of F_p, always reduced.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, PartialOrd, Ord, Default)]
pub struct Fp(u64);

impl Fp {
    /// 0.
    pub const ZERO: Fp = Fp(0);
    /// 1.
    pub const ONE: Fp = Fp(1);

    /// The class of a non-negative integer.
    pub fn new(value: u64) -> Self {
        Fp(value % P)
    }

    /// The class of an integer.
    pub fn from_i64(value: i64) -> Self {
        let magnitude = Fp::new(value.unsigned_abs());
        if value < 0 { -magnitude } else { magnitude }
    }

    /// The class of an integer of any size.
    pub fn from_integer(value: &BigInt) -> Self {
        // `mod_floor` by a positive modulus is in 0..p, so it fits.
        Fp(value.mod_floor(&BigInt::from(P)).to_u64().unwrap_or(0))
    }

    /// The class of a rational; `None` where p divides the denominator.
    pub fn from_rational(value: &BigRational) -> Option<Self> {
        Some(Fp::from_integer(value.numer()) * Fp::from_integer(value.denom()).inv()?)
    }

    /// The representative in 0..p.
    pub fn value(self) -> u64 {
        self.0
    }

    /// Whether this is 0.
    pub fn is_zero(self) -> bool {
        self.0 == 0
    }

    /// self^exponent by squaring.
    pub fn pow(self, mut exponent: u64) -> Self {
        let mut base = self;
        let mut result = Fp::ONE;
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
        // Extended Euclid on (p, a); the cofactors stay within ±p.
        let (mut r0, mut r1) = (P as i64, self.0 as i64);
        let (mut t0, mut t1) = (0i64, 1i64);
        while r1 != 0 {
            let q = r0 / r1;
            (r0, r1) = (r1, r0 - q * r1);
            (t0, t1) = (t1, t0 - q * t1);
        }
        Some(Fp(t0.rem_euclid(P as i64) as u64))
    }

    /// A square root a^((p+1)/4); `None` where self is no square.
    pub fn sqrt(self) -> Option<Self> {
        let root = self.pow(P.div_ceil(4));
        (root * root == self).then_some(root)
    }

    /// The rational n/d with |n|, d < 2^bits (bits ≤ 29) that this is the class of, if there is one.
    pub fn to_small_rational(self, bits: u32) -> Option<(i64, i64)> {
        let bound = 1i64 << bits.min(29);
        let (mut r0, mut r1) = (P as i64, self.0 as i64);
        let (mut t0, mut t1) = (0i64, 1i64);
        while r1 >= bound {
            let q = r0 / r1;
            (r0, r1) = (r1, r0 - q * r1);
            (t0, t1) = (t1, t0 - q * t1);
        }
        if t1 == 0 || t1.abs() >= bound {
            return None;
        }
        let (n, d) = if t1 < 0 { (-r1, -t1) } else { (r1, t1) };
        (n.gcd(&d) == 1).then_some((n, d))
    }
}

impl Add for Fp {
    type Output = Fp;
    fn add(self, other: Fp) -> Fp {
        let sum = self.0 + other.0;
        Fp(if sum >= P { sum - P } else { sum })
    }
}

impl Neg for Fp {
    type Output = Fp;
    fn neg(self) -> Fp {
        Fp(if self.0 == 0 { 0 } else { P - self.0 })
    }
}

impl Sub for Fp {
    type Output = Fp;
    fn sub(self, other: Fp) -> Fp {
        self + -other
    }
}

impl Mul for Fp {
    type Output = Fp;
    fn mul(self, other: Fp) -> Fp {
        let product = self.0 as u128 * other.0 as u128;
        let folded = (product as u64 & P) + (product >> 61) as u64;
        Fp(if folded >= P { folded - P } else { folded })
    }
}

/// A deterministic stream of field elements (splitmix64): same seed, same build.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The stream of a seed.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The next field element, never 0.
    pub fn element(&mut self) -> Fp {
        loop {
            let value = Fp::new(self.bits() >> 3);
            if !value.is_zero() {
                return value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn field_laws_hold() {
        let mut random = Random::new(1);
        for _ in 0..200 {
            let (a, b, c) = (random.element(), random.element(), random.element());
            assert_eq!(a * (b + c), a * b + a * c);
            assert_eq!((a - b) + b, a);
            assert_eq!(a.inv().map(|inverse| inverse * a), Some(Fp::ONE));
            assert_eq!(a.pow(P - 1), Fp::ONE);
            let root = (a * a).sqrt();
            assert!(root == Some(a) || root == Some(-a));
        }
        assert_eq!(Fp::ZERO.inv(), None);
        // −1 is no square, because p ≡ 3 mod 4.
        assert_eq!((-Fp::ONE).sqrt(), None);
    }

    #[test]
    fn small_rationals_are_recognised() {
        for (n, d) in [(0, 1), (1, 2), (-981, 100), (7, 3), (-123456789, 100000000)] {
            let value = Fp::from_i64(n) * Fp::from_i64(d).inv().unwrap_or(Fp::ZERO);
            assert_eq!(value.to_small_rational(29), Some((n, d)));
        }
        assert_eq!(Random::new(5).element().to_small_rational(29), None);
    }
}
