//! Interval arithmetic: real numbers between certified bounds, for the numbers of a description.
//!
//! A number that depends on no symbol is not protected by a random point when it is compared with another
//! one: modulo a prime, √2 is one of two roots. Such numbers are therefore compared as real numbers, lo
//! 2^exponent ≤ value ≤ hi 2^exponent, with about 320 bits. Every operation rounds outwards.

mod inverse;

use num_bigint::{BigInt, Sign};
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::cmp::Ordering;

/// Number of bits that are kept.
const MANTISSA_BITS: u64 = 320;
/// Number of fractional bits within elementary functions.
const FRACTION_BITS: u64 = MANTISSA_BITS + 64;
/// Binary exponent beyond which arguments of elementary functions are rejected.
const MAX_ARGUMENT_EXPONENT: i64 = 64;

/// Bounds of a real number: lo 2^exponent ≤ value ≤ hi 2^exponent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interval {
    lo: BigInt,
    hi: BigInt,
    exponent: i64,
}

fn power_of_two(exponent: u64) -> BigInt {
    BigInt::one() << exponent
}

/// ⌈a / 2^bits⌉.
fn shift_up(a: &BigInt, bits: u64) -> BigInt {
    // Shifting to the right rounds towards −∞.
    -((-a) >> bits)
}

impl Interval {
    /// Creates the interval from lo 2^exponent to hi 2^exponent, where lo ≤ hi, rounded outwards to the
    /// bits that are kept.
    pub fn new(lo: BigInt, hi: BigInt, exponent: i64) -> Self {
        let bits = lo.bits().max(hi.bits());
        if bits <= MANTISSA_BITS {
            return Interval { lo, hi, exponent };
        }
        let excess = bits - MANTISSA_BITS;
        Interval {
            lo: lo >> excess,
            hi: shift_up(&hi, excess),
            exponent: exponent + excess as i64,
        }
    }

    /// Returns bounds of a rational.
    pub fn rational(value: &BigRational) -> Self {
        let (n, d) = (value.numer(), value.denom());
        if d.is_one() {
            return Interval::new(n.clone(), n.clone(), 0);
        }
        let shift = MANTISSA_BITS + d.bits();
        let scaled = n << shift;
        let lo = scaled.div_floor(d);
        let hi = -((-scaled).div_floor(d));
        Interval::new(lo, hi, -(shift as i64))
    }

    /// Returns bounds of π by Machin's formula, 16 arctan 1/5 − 4 arctan 1/239.
    pub fn pi() -> Self {
        let unit = power_of_two(FRACTION_BITS);
        let arctan = |n: u32| {
            let square = BigInt::from(n * n);
            let (mut power, mut sum, mut k) = (&unit / n, BigInt::zero(), 0u32);
            while !power.is_zero() {
                let term = &power / (2 * k + 1);
                sum = if k.is_even() { sum + term } else { sum - term };
                power /= &square;
                k += 1;
            }
            sum
        };
        let value: BigInt = BigInt::from(16) * arctan(5) - BigInt::from(4) * arctan(239);
        // Each of about 300 terms is truncated twice.
        let error = BigInt::from(1 << 16);
        Interval::new(&value - &error, value + error, -(FRACTION_BITS as i64))
    }

    /// Returns −a if `negative`, else a.
    pub fn signed(&self, negative: bool) -> Self {
        if !negative {
            return self.clone();
        }
        Interval {
            lo: -&self.hi,
            hi: -&self.lo,
            exponent: self.exponent,
        }
    }

    /// a + b.
    pub fn plus(&self, b: &Interval) -> Self {
        let (low, high) = if self.exponent <= b.exponent {
            (self, b)
        } else {
            (b, self)
        };
        let shift = (high.exponent - low.exponent) as u64;
        // An operand far below the last bit of the other is rounded first, which limits the shift.
        let most = 4 * MANTISSA_BITS;
        if shift > most {
            let excess = shift - most;
            let rounded = Interval {
                lo: &low.lo >> excess,
                hi: shift_up(&low.hi, excess),
                exponent: low.exponent + excess as i64,
            };
            return rounded.plus(high);
        }
        Interval::new(
            &low.lo + (&high.lo << shift),
            &low.hi + (&high.hi << shift),
            low.exponent,
        )
    }

    /// a · b.
    pub fn times(&self, b: &Interval) -> Self {
        let products = [
            &self.lo * &b.lo,
            &self.lo * &b.hi,
            &self.hi * &b.lo,
            &self.hi * &b.hi,
        ];
        let lo = products.iter().min().cloned().unwrap_or_default();
        let hi = products.into_iter().max().unwrap_or_default();
        Interval::new(lo, hi, self.exponent + b.exponent)
    }

    /// 1/a; `None` where a may be 0.
    pub fn inverse(&self) -> Option<Self> {
        if self.contains_zero() {
            return None;
        }
        let shift = MANTISSA_BITS + self.lo.bits().max(self.hi.bits());
        let unit = power_of_two(shift);
        let lo = unit.div_floor(&self.hi);
        let hi = -((-unit).div_floor(&self.lo));
        Some(Interval::new(lo, hi, -(shift as i64) - self.exponent))
    }

    pub(super) fn sin(&self) -> Option<Self> {
        Some(self.angle()?.1)
    }

    pub(super) fn cos(&self) -> Option<Self> {
        Some(self.angle()?.0)
    }

    pub(super) fn sqrt(&self) -> Option<Self> {
        if self.hi.is_negative() {
            return None;
        }
        // Scale to an even exponent and enough bits.
        let mut shift = (2 * MANTISSA_BITS).saturating_sub(self.hi.bits());
        if (self.exponent - shift as i64).is_odd() {
            shift += 1;
        }
        let lo = (&self.lo << shift).max(BigInt::zero()).sqrt();
        let hi = (&self.hi << shift).sqrt() + 1;
        Some(Interval::new(lo, hi, (self.exponent - shift as i64) / 2))
    }

    /// Returns the midpoint in multiples of 2^−FRACTION_BITS, and a bound on the distance of the bounds from it;
    /// `None` if the number is too large.
    fn middle(&self) -> Option<(BigInt, BigInt)> {
        let size = self.exponent + self.lo.bits().max(self.hi.bits()) as i64;
        if size > MAX_ARGUMENT_EXPONENT {
            return None;
        }
        let shift = self.exponent + FRACTION_BITS as i64;
        let (lo, hi) = if shift >= 0 {
            (&self.lo << shift as u64, &self.hi << shift as u64)
        } else {
            (&self.lo >> -shift as u64, shift_up(&self.hi, -shift as u64))
        };
        let middle = (&lo + &hi) >> 1u32;
        let radius = (hi - lo) / 2 + 1;
        Some((middle, radius))
    }

    /// Sums a series whose terms follow by `next(term, k)`, in multiples of 2^−FRACTION_BITS.
    fn series(first: BigInt, next: impl Fn(&BigInt, u32) -> BigInt) -> BigInt {
        let (mut term, mut sum) = (first, BigInt::zero());
        let mut k = 0;
        while !term.is_zero() && term != BigInt::from(-1) {
            sum += &term;
            term = next(&term, k);
            k += 1;
        }
        sum
    }

    /// Cosine and sine. Neither changes by more than the argument does.
    fn angle(&self) -> Option<(Self, Self)> {
        let (mut x, mut radius) = self.middle()?;
        let turn = Interval::pi();
        let (turn, error) = turn
            .times(&Interval::rational(&BigRational::from_integer(2.into())))
            .middle()?;
        let turns = x.div_floor(&turn);
        x -= &turns * &turn;
        radius += (turns.abs() + 1) * error;
        let square = (&x * &x) >> FRACTION_BITS;
        let next = |offset: u32| {
            let square = &square;
            move |term: &BigInt, k: u32| {
                let divisor = (2 * k + 1 + offset) * (2 * k + 2 + offset);
                -((term * square) >> FRACTION_BITS) / divisor
            }
        };
        let cos = Self::series(power_of_two(FRACTION_BITS), next(0));
        let sin = Self::series(x, next(1));
        // Each of about 100 terms is truncated twice, from sizes of up to 2⁶.
        radius += power_of_two(24);
        let around = |middle: BigInt| {
            Interval::new(&middle - &radius, middle + &radius, -(FRACTION_BITS as i64))
        };
        Some((around(cos), around(sin)))
    }

    /// exp(x) = exp(x / 2^k)^(2^k).
    pub(super) fn exp(&self) -> Option<Self> {
        const EXP_HALVINGS: u32 = 12;
        let (x, radius) = self.middle()?;
        if (x.abs() + &radius).bits() > FRACTION_BITS + 10 {
            return None;
        }
        let small = &x >> EXP_HALVINGS;
        let value = Self::series(power_of_two(FRACTION_BITS), |term, k| {
            ((term * &small) >> FRACTION_BITS) / (k + 1)
        });
        // |x / 2^k| < 1/4 between the bounds, where the slope of exp is below e^(1/4) < 3/2.
        let radius = ((&radius + (&radius >> 1u32)) >> EXP_HALVINGS) + power_of_two(16);
        let mut result = Interval::new(&value - &radius, value + radius, -(FRACTION_BITS as i64));
        for _ in 0..EXP_HALVINGS {
            result = result.times(&result);
        }
        Some(result)
    }

    pub(super) fn sinh(&self) -> Option<Self> {
        Some(self.powers()?.0)
    }

    pub(super) fn cosh(&self) -> Option<Self> {
        Some(self.powers()?.1)
    }

    pub(super) fn tanh(&self) -> Option<Self> {
        let (sinh, cosh) = self.powers()?;
        Some(sinh.times(&cosh.inverse()?))
    }

    /// sinh x and cosh x, (eˣ ∓ e⁻ˣ)/2.
    fn powers(&self) -> Option<(Self, Self)> {
        let power = self.exp()?;
        let inverse = power.inverse()?;
        let half = Interval::new(BigInt::one(), BigInt::one(), -1);
        let (sum, difference) = (power.plus(&inverse), power.plus(&inverse.signed(true)));
        Some((difference.times(&half), sum.times(&half)))
    }

    /// Compares the number with 0; `None` if the result is not certain.
    pub fn side(&self) -> Option<Ordering> {
        match (self.lo.sign(), self.hi.sign()) {
            (Sign::Plus, _) => Some(Ordering::Greater),
            (_, Sign::Minus) => Some(Ordering::Less),
            (Sign::NoSign, Sign::NoSign) => Some(Ordering::Equal),
            _ => None,
        }
    }

    pub(super) fn abs(&self) -> Option<Self> {
        Some(self.signed(self.side()? == Ordering::Less))
    }

    pub(super) fn sign(&self) -> Option<Self> {
        let sign = BigInt::from(self.side()? as i8);
        Some(Interval::new(sign.clone(), sign, 0))
    }

    fn contains_zero(&self) -> bool {
        self.lo.sign() != Sign::Plus && self.hi.sign() != Sign::Minus
    }

    /// Whether the two are certainly different numbers.
    pub fn differs(&self, b: &Interval) -> bool {
        !self.plus(&b.signed(true)).contains_zero()
    }

    /// Returns the bounds lo 2^exponent and hi 2^exponent.
    pub fn bounds(&self) -> [BigRational; 2] {
        [&self.lo, &self.hi].map(|bound| self.scaled_up(bound.clone()))
    }

    /// Returns a number between the bounds.
    pub fn to_f64(&self) -> f64 {
        let middle = self.scaled_up((&self.lo + &self.hi) >> 1u32);
        middle.to_f64().unwrap_or(f64::NAN)
    }

    /// a 2^exponent.
    fn scaled_up(&self, a: BigInt) -> BigRational {
        let scale = if self.exponent >= 0 {
            BigRational::from_integer(power_of_two(self.exponent as u64))
        } else {
            BigRational::new(BigInt::one(), power_of_two(-self.exponent as u64))
        };
        BigRational::from_integer(a) * scale
    }
}
