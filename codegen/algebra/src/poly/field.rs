//! Fields (F, +, ·), the coefficients of polynomials.
//!
//! Q is used where a computation is a proof, F_p where speed matters, and the pair of the two prime fields
//! where expressions are read.

use crate::prime::Residue;
use crate::residue_pair::ResiduePair;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, ToPrimitive, Zero};
use std::fmt::Debug;

/// A field with exact equality.
pub trait Field: Clone + PartialEq + Debug {
    /// 0.
    fn zero() -> Self;
    /// 1.
    fn one() -> Self;
    /// The image of an integer.
    fn integer(value: i64) -> Self;
    /// The image of a rational; `None` where its denominator is 0 in the field.
    fn from_rational(value: &BigRational) -> Option<Self>;
    /// a + b.
    fn add(&self, other: &Self) -> Self;
    /// a − b.
    fn sub(&self, other: &Self) -> Self;
    /// a b.
    fn mul(&self, other: &Self) -> Self;
    /// −a.
    fn neg(&self) -> Self;
    /// 1 / a; `None` for 0.
    fn inv(&self) -> Option<Self>;
    /// Whether a = 0.
    fn is_zero(&self) -> bool;
    /// Whether a = 1.
    fn is_one(&self) -> bool {
        *self == Self::one()
    }
    /// Size in machine words, for limits on work.
    fn words(&self) -> usize {
        1
    }
}

/// Returns numerator and denominator if both fit into a machine word, as those of most coefficients do. Big
/// integers would allocate memory in every step of a sum or product.
fn words(value: &BigRational) -> Option<(i64, i64)> {
    Some((value.numer().to_i64()?, value.denom().to_i64()?))
}

/// a/b + c/d in machine words; `None` if a number does not fit.
fn small_sum(one: &BigRational, other: &BigRational) -> Option<BigRational> {
    let ((a, b), (c, d)) = (words(one)?, words(other)?);
    let (numer, denom) = match b == d {
        true => (a.checked_add(c)?, b),
        false => {
            let numer = a.checked_mul(d)?.checked_add(c.checked_mul(b)?)?;
            (numer, b.checked_mul(d)?)
        }
    };
    let common = match denom {
        1 => 1,
        _ => numer.checked_abs()?.gcd(&denom),
    };
    let reduced = (numer / common, denom / common);
    Some(BigRational::new_raw(reduced.0.into(), reduced.1.into()))
}

/// (a/b) (c/d) in machine words; `None` if a number does not fit.
fn small_product(one: &BigRational, other: &BigRational) -> Option<BigRational> {
    let ((a, b), (c, d)) = (words(one)?, words(other)?);
    let common = |numer: i64, denom: i64| match denom {
        1 => Some(1),
        _ => Some(numer.checked_abs()?.gcd(&denom)),
    };
    let (left, right) = (common(a, d)?, common(c, b)?);
    let numer = (a / left).checked_mul(c / right)?;
    let denom = (b / right).checked_mul(d / left)?;
    Some(BigRational::new_raw(numer.into(), denom.into()))
}

impl Field for BigRational {
    fn zero() -> Self {
        Zero::zero()
    }
    fn one() -> Self {
        One::one()
    }
    fn integer(value: i64) -> Self {
        BigRational::from_integer(value.into())
    }
    fn from_rational(value: &BigRational) -> Option<Self> {
        Some(value.clone())
    }
    fn add(&self, other: &Self) -> Self {
        small_sum(self, other).unwrap_or_else(|| self + other)
    }
    fn sub(&self, other: &Self) -> Self {
        self - other
    }
    fn mul(&self, other: &Self) -> Self {
        small_product(self, other).unwrap_or_else(|| self * other)
    }
    fn neg(&self) -> Self {
        -self.clone()
    }
    fn inv(&self) -> Option<Self> {
        (!Zero::is_zero(self)).then(|| self.recip())
    }
    fn is_zero(&self) -> bool {
        Zero::is_zero(self)
    }
    fn words(&self) -> usize {
        ((self.numer().bits() + self.denom().bits()) / 64) as usize + 1
    }
}

/// Implements the operations that numbers modulo primes have under the same names.
macro_rules! modular {
    () => {
        fn zero() -> Self {
            Self::ZERO
        }
        fn one() -> Self {
            Self::ONE
        }
        fn integer(value: i64) -> Self {
            Self::from_i64(value)
        }
        fn from_rational(value: &BigRational) -> Option<Self> {
            Self::from_rational(value)
        }
        fn add(&self, other: &Self) -> Self {
            *self + *other
        }
        fn sub(&self, other: &Self) -> Self {
            *self - *other
        }
        fn mul(&self, other: &Self) -> Self {
            *self * *other
        }
        fn neg(&self) -> Self {
            -*self
        }
        fn inv(&self) -> Option<Self> {
            Self::inv(*self)
        }
        fn is_zero(&self) -> bool {
            Self::is_zero(*self)
        }
    };
}

impl<const K: usize> Field for Residue<K> {
    modular!();
}

/// Not quite a field: an element that is 0 in only one part has no inverse, which happens only by chance.
impl Field for ResiduePair {
    modular!();
}
