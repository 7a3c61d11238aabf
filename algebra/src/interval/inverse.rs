//! Logarithms and angles between certain bounds: square roots bring the argument near 1 or 0, a series does
//! the rest.

use super::{Interval, power_of_two};
use num_bigint::{BigInt, Sign};
use num_rational::BigRational;
use num_traits::One;
use std::cmp::Ordering;

/// How often an argument is brought nearer.
const ROOTS: u32 = 10;
/// Terms of the series, whose argument is below 2^−ROOTS.
const TERMS: i64 = 18;
/// What they leave is below 2 to this.
const REST: i64 = -(ROOTS as i64) * (2 * TERMS + 1) + 1;

impl Interval {
    /// log a = e log 2 + log m with a = m 2^e, ½ ≤ m ≤ 1; `None` where a may not be positive.
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

    /// log m = 2^k · 2 artanh (r − 1)/(r + 1) with the 2^k-th root r of m.
    fn log_below_one(&self) -> Option<Self> {
        let root = (0..ROOTS).try_fold(self.clone(), |a, _| a.sqrt())?;
        let one = Interval::whole(1);
        let below = root.plus(&one).inverse()?;
        let argument = root.plus(&one.signed(true)).times(&below);
        Some(argument.odd_series(false)?.scaled(i64::from(ROOTS) + 1))
    }

    /// The angle of (x, y), in (−π, π]; `None` where it is not certain on which side of the cut it is.
    pub(crate) fn atan2(&self, x: &Interval) -> Option<Self> {
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

    /// arctan t = 2 arctan t / (1 + √(1 + t²)), again and again; the first time leaves at most 1.
    fn arctan(&self) -> Option<Self> {
        let one = Interval::whole(1);
        let small = (0..=ROOTS).try_fold(self.clone(), |t, _| {
            let root = one.plus(&t.times(&t)).sqrt()?;
            Some(t.times(&one.plus(&root).inverse()?))
        })?;
        Some(small.odd_series(true)?.scaled(i64::from(ROOTS) + 1))
    }

    /// t ± t³/3 + t⁵/5 ± …, for |t| below 2^−ROOTS.
    fn odd_series(&self, alternating: bool) -> Option<Self> {
        let size = self.exponent + self.lo.bits().max(self.hi.bits()) as i64;
        if size > -i64::from(ROOTS) {
            return None;
        }
        let square = self.times(self).signed(alternating);
        let rest = power_of_two(0);
        // Later terms are smaller by 2^(2 ROOTS) each.
        let mut sum = Interval {
            lo: -&rest,
            hi: rest,
            exponent: REST,
        };
        let mut power = self.clone();
        for k in 0..TERMS {
            let odd = Interval::whole(2 * k + 1).inverse()?;
            sum = sum.plus(&power.times(&odd));
            power = power.times(&square);
        }
        Some(sum)
    }

    fn whole(value: i64) -> Self {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::function::Function;

    fn number(n: i64, d: i64) -> Interval {
        Interval::rational(&BigRational::new(n.into(), d.into()))
    }

    /// That the bounds are narrower than 2^−280.
    fn is_narrow(a: &Interval) -> bool {
        let width = &a.hi - &a.lo;
        width.bits() as i64 + a.exponent < -280
    }

    #[test]
    fn they_have_the_values_of_floating_arithmetic() {
        for (n, d) in [
            (1, 3),
            (2, 1),
            (7, 5),
            (1_000_000_007, 3),
            (1, 1_000_000_007),
            (999, 1000),
        ] {
            let found = number(n, d).log().expect("positive");
            let expected = (n as f64 / d as f64).ln();
            assert!(
                (found.to_f64() - expected).abs() <= 1e-15 * expected.abs().max(1e-3),
                "{n}/{d}"
            );
            assert!(is_narrow(&found), "{n}/{d}");
        }
        for y in -5..=5i64 {
            for x in -5..=5i64 {
                let found = number(y, 3).atan2(&number(x, 7));
                if (x, y) == (0, 0) {
                    assert_eq!(found, None);
                    continue;
                }
                let found = found.expect("a direction");
                let expected = (y as f64 / 3.0).atan2(x as f64 / 7.0);
                assert!((found.to_f64() - expected).abs() < 1e-15, "{y} {x}");
                assert!(is_narrow(&found), "{y} {x}");
            }
        }
    }

    /// Laws that do not know the series: exp log a = a, log a + log b = log a b, tangents of angles,
    /// Machin's formula.
    #[test]
    fn they_invert_what_they_should() {
        let one = number(1, 1);
        for k in 1..40i64 {
            let a = number(k * k * k + 1, 7 * k);
            let log = a.log().expect("positive");
            let back = log.apply(Function::Exp).expect("a value");
            assert!(!back.differs(&a), "{k}");
            assert!(log.differs(&a.plus(&number(1, 1 << 62)).log().expect("positive")));
            let product = a.times(&number(k, 3)).log().expect("positive");
            assert!(!product.differs(&log.plus(&number(k, 3).log().expect("positive"))));
            let (y, x) = (number(k - 20, 3), number(2 * k - 41, 5));
            let angle = y.atan2(&x).expect("a direction");
            let (c, s) = (angle.apply(Function::Cos), angle.apply(Function::Sin));
            let (c, s) = (c.expect("a value"), s.expect("a value"));
            assert!(
                !s.times(&x).differs(&c.times(&y)) && is_narrow(&angle),
                "{k}"
            );
            let along = c.times(&x).plus(&s.times(&y));
            assert_eq!(along.side(), Some(Ordering::Greater), "{k}");
        }
        let (fifth, last) = (number(1, 5).atan2(&one), number(1, 239).atan2(&one));
        let sum = fifth.map(|a| a.scaled(4)).zip(last.map(|a| a.scaled(2)));
        let (fifth, last) = sum.expect("angles");
        assert!(!fifth.plus(&last.signed(true)).differs(&Interval::pi()));
    }

    #[test]
    fn what_is_not_certain_is_none() {
        let about_zero = number(2, 1).apply(Function::Sqrt).map(|root| {
            let square = root.times(&root);
            square.plus(&number(-2, 1))
        });
        let about_zero = about_zero.expect("a number");
        assert_eq!(about_zero.log(), None);
        assert_eq!(about_zero.atan2(&number(-1, 1)), None);
        assert!(about_zero.atan2(&number(1, 1)).is_some());
        assert_eq!(number(-1, 1).log(), None);
        let huge = Interval::rational(&BigRational::from_integer(BigInt::from(10).pow(600)));
        let (log, ten) = (huge.log().expect("positive"), number(10, 1).log());
        let ten = ten.expect("positive").times(&number(600, 1));
        assert!(!log.differs(&ten) && huge.atan2(&huge).is_some());
    }
}
