//! The prime field F_p, p = 2^61 − 1 (a Mersenne prime, p ≡ 3 mod 4), and its square roots.
//!
//! Values of expressions at points of the constraint variety live here: equality is exact, and
//! two different rational functions of degree D agree at a random point with probability ≤ D/p.
//! As −1 is no square, every element of F_p has its roots in F_p(i), i² = −1: so an element is
//! a + b i, where b is 0 unless a root made it otherwise.

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use std::ops::{Add, Mul, Neg, Sub};

/// The modulus 2^61 − 1.
pub const P: u64 = (1 << 61) - 1;

/// An element a + b i of F_p(i), always reduced.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, PartialOrd, Ord, Default)]
pub struct Fp(u64, u64);

impl Fp {
    /// 0.
    pub const ZERO: Fp = Fp(0, 0);
    /// 1.
    pub const ONE: Fp = Fp(1, 0);
    /// i.
    pub const I: Fp = Fp(0, 1);
    /// What stands for π, the same at every point: the sines and cosines of its twelfths are known.
    pub const PI: Fp = Fp(0x0a3f_51c7_9e26_d80b, 0);

    /// The class of a non-negative integer.
    pub fn new(value: u64) -> Self {
        Fp(value % P, 0)
    }

    /// The class of an integer.
    pub fn from_i64(value: i64) -> Self {
        let magnitude = Fp::new(value.unsigned_abs());
        if value < 0 { -magnitude } else { magnitude }
    }

    /// The class of an integer of any size.
    pub fn from_integer(value: &BigInt) -> Self {
        // `mod_floor` by a positive modulus is in 0..p, so it fits.
        Fp(value.mod_floor(&BigInt::from(P)).to_u64().unwrap_or(0), 0)
    }

    /// The class of a rational; `None` where p divides the denominator.
    pub fn from_rational(value: &BigRational) -> Option<Self> {
        Some(Fp::from_integer(value.numer()) * Fp::from_integer(value.denom()).inv()?)
    }

    /// The representative in 0..p of a.
    pub fn value(self) -> u64 {
        self.0
    }

    /// 64 bits that depend on a and b, for random streams.
    pub fn bits(self) -> u64 {
        self.0 ^ self.1.wrapping_mul(0x9e37_79b9_7f4a_7c15)
    }

    /// Whether it is an element of F_p.
    pub fn is_prime(self) -> bool {
        self.1 == 0
    }

    /// Which of ±self stands for both: whether it is the other one.
    pub fn is_negative(self) -> bool {
        let leading = if self.0 == 0 { self.1 } else { self.0 };
        leading > P / 2
    }

    /// Whether this is 0.
    pub fn is_zero(self) -> bool {
        self.0 == 0 && self.1 == 0
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
        if self.1 != 0 {
            let conjugate = Fp(self.0, negated(self.1));
            return Some(conjugate * (self * conjugate).inv()?);
        }
        // Extended Euclid on (p, a); the cofactors stay within ±p.
        let (mut r0, mut r1) = (P as i64, self.0 as i64);
        let (mut t0, mut t1) = (0i64, 1i64);
        while r1 != 0 {
            let q = r0 / r1;
            (r0, r1) = (r1, r0 - q * r1);
            (t0, t1) = (t1, t0 - q * t1);
        }
        Some(Fp(t0.rem_euclid(P as i64) as u64, 0))
    }

    /// A square root: of a in F_p it is ±a^((p+1)/4) or i times that of −a; of the rest of F_p(i)
    /// half the elements have one (Adj and Rodríguez-Henríquez, algorithm 9), `None` for the others.
    pub fn sqrt(self) -> Option<Self> {
        if self.1 == 0 {
            let root = self.pow(P.div_ceil(4));
            return Some(if root * root == self {
                root
            } else {
                Fp::I * (-self).pow(P.div_ceil(4))
            });
        }
        let power = self.pow((P - 3) / 4);
        let root = power * self;
        let alpha = power * root;
        let root = if alpha == -Fp::ONE {
            Fp::I * root
        } else {
            (Fp::ONE + alpha).pow((P - 1) / 2) * root
        };
        (root * root == self).then_some(root)
    }

    /// The rational n/d with |n|, d < 2^bits (bits ≤ 29) that this is the class of, if there is one.
    pub fn to_small_rational(self, bits: u32) -> Option<(i64, i64)> {
        if self.1 != 0 {
            return None;
        }
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

fn plus(a: u64, b: u64) -> u64 {
    let sum = a + b;
    if sum >= P { sum - P } else { sum }
}

fn negated(a: u64) -> u64 {
    if a == 0 { 0 } else { P - a }
}

fn times(a: u64, b: u64) -> u64 {
    let product = a as u128 * b as u128;
    plus(product as u64 & P, (product >> 61) as u64)
}

impl Add for Fp {
    type Output = Fp;
    fn add(self, other: Fp) -> Fp {
        Fp(plus(self.0, other.0), plus(self.1, other.1))
    }
}

impl Neg for Fp {
    type Output = Fp;
    fn neg(self) -> Fp {
        Fp(negated(self.0), negated(self.1))
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
        let (Fp(a, b), Fp(c, d)) = (self, other);
        if b | d == 0 {
            return Fp(times(a, c), 0);
        }
        Fp(
            plus(times(a, c), negated(times(b, d))),
            plus(times(a, d), times(b, c)),
        )
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
    }

    #[test]
    fn roots_of_all_elements_of_the_prime_field_exist() {
        let mut random = Random::new(2);
        let mut roots = 0;
        for _ in 0..100 {
            let a = random.element();
            let root = a.sqrt().expect("it has one in F_p(i)");
            assert_eq!(root * root, a);
            let b = root + random.element();
            assert_eq!(b.inv().map(|inverse| inverse * b), Some(Fp::ONE));
            let square = (b * b).sqrt();
            assert!(square == Some(b) || square == Some(-b));
            roots += usize::from(b.sqrt().is_some_and(|root| root * root == b));
        }
        assert!(roots > 40 && roots < 100);
        // −1 is no square, because p ≡ 3 mod 4.
        assert!(matches!((-Fp::ONE).sqrt(), Some(root) if root == Fp::I || root == -Fp::I));
        assert!(Fp::I.is_negative() != (-Fp::I).is_negative());
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
