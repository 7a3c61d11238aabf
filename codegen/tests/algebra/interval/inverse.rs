//! Interval logarithms and angles: their values, and that they are inverse functions.

use hamel_algebra::function::Function;
use hamel_algebra::interval::Interval;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;
use std::cmp::Ordering;

fn number(n: i64, d: i64) -> Interval {
    Interval::rational(&BigRational::new(n.into(), d.into()))
}

fn logarithm(a: &Interval) -> Option<Interval> {
    a.apply(Function::Log)
}

/// Returns whether the bounds are within 2^−281.
fn is_narrow(a: &Interval) -> bool {
    let [lo, hi] = a.bounds();
    hi - lo < BigRational::new(BigInt::one(), BigInt::one() << 281)
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
        let found = logarithm(&number(n, d)).expect("positive");
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

/// Laws independent of the series: exp log a = a, log a + log b = log a b, tangents of angles, Machin's formula.
#[test]
fn they_invert_what_they_should() {
    let one = number(1, 1);
    for k in 1..40i64 {
        let a = number(k * k * k + 1, 7 * k);
        let log = logarithm(&a).expect("positive");
        let back = log.apply(Function::Exp).expect("a value");
        assert!(!back.differs(&a), "{k}");
        assert!(log.differs(&logarithm(&a.plus(&number(1, 1 << 62))).expect("positive")));
        let product = logarithm(&a.times(&number(k, 3))).expect("positive");
        assert!(!product.differs(&log.plus(&logarithm(&number(k, 3)).expect("positive"))));
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
    let sum = fifth
        .map(|a| a.times(&number(16, 1)))
        .zip(last.map(|a| a.times(&number(4, 1))));
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
    assert_eq!(logarithm(&about_zero), None);
    assert_eq!(about_zero.atan2(&number(-1, 1)), None);
    assert!(about_zero.atan2(&number(1, 1)).is_some());
    assert_eq!(logarithm(&number(-1, 1)), None);
    let huge = Interval::rational(&BigRational::from_integer(BigInt::from(10).pow(600)));
    let (log, ten) = (
        logarithm(&huge).expect("positive"),
        logarithm(&number(10, 1)),
    );
    let ten = ten.expect("positive").times(&number(600, 1));
    assert!(!log.differs(&ten) && huge.atan2(&huge).is_some());
}
