//! Logarithms and angles of intervals: repeated square roots bring the argument near 1 or 0, then a series
//! is summed.

use super::{Interval, power_of_two};
use num_bigint::{BigInt, Sign};
use num_rational::BigRational;
use num_traits::One;
use std::cmp::Ordering;

/// Number of square roots that are taken of an argument.
const SQUARE_ROOTS: u32 = 10;
/// Number of terms of the series, whose argument is below 2^−SQUARE_ROOTS.
const SERIES_TERMS: i64 = 18;
/// Binary exponent of a bound on the truncated rest of the series.
const TRUNCATION_EXPONENT: i64 = -(SQUARE_ROOTS as i64) * (2 * SERIES_TERMS + 1) + 1;

impl Interval {
    /// log a = e log 2 + log m with a = m 2^e, ½ ≤ m ≤ 1; `None` if a may be 0 or negative.
    pub(crate) fn log(&self) -> Option<Self> {
        if self.lo.sign() != Sign::Plus {
            return None;
        }
        let bits = self.hi.bits() as i64;
        let mantissa = Interval {
            exponent: -bits,
            ..self.clone()
        };
        let two = Interval::power(-1).log_below_one()?.signed(true);
        let whole = Interval::whole(self.exponent + bits);
        Some(mantissa.log_below_one()?.plus(&whole.times(&two)))
    }

    /// log m = 2^k · 2 artanh((r − 1)/(r + 1)), where r is the 2^k-th root of m.
    fn log_below_one(&self) -> Option<Self> {
        let root = (0..SQUARE_ROOTS).try_fold(self.clone(), |a, _| a.sqrt())?;
        let one = Interval::whole(1);
        let below = root.plus(&one).inverse()?;
        let argument = root.plus(&one.signed(true)).times(&below);
        Some(
            argument
                .odd_series(false)?
                .scaled(i64::from(SQUARE_ROOTS) + 1),
        )
    }

    /// Angle of (x, y) in (−π, π], where `self` is y; `None` if it is not certain on which side of the
    /// branch cut it is.
    pub fn atan2(&self, x: &Interval) -> Option<Self> {
        let half = Interval::pi().scaled(-1);
        match (self.side(), x.side()) {
            (_, Some(Ordering::Greater)) => self.times(&x.inverse()?).arctan(),
            (Some(Ordering::Greater), _) => {
                let rest = x.times(&self.inverse()?).arctan()?;
                Some(half.plus(&rest.signed(true)))
            }
            (Some(Ordering::Less), _) => {
                let rest = x.times(&self.inverse()?).arctan()?;
                Some(half.plus(&rest).signed(true))
            }
            (Some(Ordering::Equal), Some(Ordering::Less)) => Some(Interval::pi()),
            _ => None,
        }
    }

    /// arctan t = 2 arctan(t / (1 + √(1 + t²))), applied repeatedly; after the first time the argument is
    /// at most 1.
    fn arctan(&self) -> Option<Self> {
        let one = Interval::whole(1);
        let small = (0..=SQUARE_ROOTS).try_fold(self.clone(), |t, _| {
            let root = one.plus(&t.times(&t)).sqrt()?;
            Some(t.times(&one.plus(&root).inverse()?))
        })?;
        Some(small.odd_series(true)?.scaled(i64::from(SQUARE_ROOTS) + 1))
    }

    /// t ± t³/3 + t⁵/5 ± …, for |t| below 2^−SQUARE_ROOTS.
    fn odd_series(&self, alternating: bool) -> Option<Self> {
        let size = self.exponent + self.lo.bits().max(self.hi.bits()) as i64;
        if size > -i64::from(SQUARE_ROOTS) {
            return None;
        }
        let square = self.times(self).signed(alternating);
        let rest = power_of_two(0);
        // Later terms are smaller by a factor of 2^(2 SQUARE_ROOTS) each.
        let mut sum = Interval {
            lo: -&rest,
            hi: rest,
            exponent: TRUNCATION_EXPONENT,
        };
        let mut power = self.clone();
        for k in 0..SERIES_TERMS {
            let odd = Interval::whole(2 * k + 1).inverse()?;
            sum = sum.plus(&power.times(&odd));
            power = power.times(&square);
        }
        Some(sum)
    }

    pub(crate) fn whole(value: i64) -> Self {
        Interval::rational(&BigRational::from_integer(value.into()))
    }

    fn power(exponent: i64) -> Self {
        Interval::new(BigInt::one(), BigInt::one(), exponent)
    }

    /// a 2^exponent.
    fn scaled(self, exponent: i64) -> Self {
        Interval {
            exponent: self.exponent + exponent,
            ..self
        }
    }
}
