//! Interval arithmetic: bounds are valid and narrow, and contradict no identity.

mod inverse;

use hamel_algebra::function::Function;
use hamel_algebra::interval::Interval;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

fn number(n: i64, d: i64) -> Interval {
    Interval::rational(&BigRational::new(n.into(), d.into()))
}

fn power_of_two(exponent: u64) -> BigInt {
    BigInt::one() << exponent
}

/// Returns whether the bounds are within 2^−bits of the size.
fn is_narrow(a: &Interval, bits: u64) -> bool {
    let [lo, hi] = a.bounds();
    let width = &hi - &lo;
    let size = lo.abs().max(hi.abs());
    width * power_of_two(bits) <= size
}

#[test]
fn bounds_hold_and_are_narrow() {
    let root = |n: i64| number(n, 1).apply(Function::Sqrt).expect("positive");
    let cases: [(Interval, f64); 9] = [
        (number(1, 3), 1.0 / 3.0),
        (Interval::pi(), std::f64::consts::PI),
        (root(2), 2f64.sqrt()),
        (
            root(3).plus(&root(2).signed(true)),
            3f64.sqrt() - 2f64.sqrt(),
        ),
        (root(2).inverse().expect("not 0"), 0.5f64.sqrt()),
        (
            number(3, 4).apply(Function::Sin).expect("a value"),
            0.75f64.sin(),
        ),
        (
            number(-2000, 8).apply(Function::Cos).expect("a value"),
            (-250.0f64).cos(),
        ),
        (
            number(5, 2).apply(Function::Exp).expect("a value"),
            2.5f64.exp(),
        ),
        (
            number(-90, 8).apply(Function::Exp).expect("a value"),
            (-90.0f64 / 8.0).exp(),
        ),
    ];
    for (found, expected) in cases {
        let error = (found.to_f64() - expected).abs();
        assert!(error <= 1e-15 * expected.abs().max(0.1), "{expected}");
        assert!(is_narrow(&found, 250), "{expected}: {found:?}");
    }
    // Published digits of π.
    let digits = "31415926535897932384626433832795028841971693993751058209749445923";
    let published: BigInt = digits.parse().expect("digits");
    let pi = BigRational::new(published, BigInt::from(10).pow(digits.len() as u32 - 1));
    let rest = Interval::pi().plus(&Interval::rational(&pi).signed(true));
    assert!(rest.to_f64().abs() < 1e-63 && rest.to_f64() != 0.0);
}

#[test]
fn identities_are_not_contradicted() {
    let apply = |a: &Interval, f| a.apply(f).expect("a value");
    for k in -40..40i64 {
        let x = number(3 * k, 7);
        let (c, s) = (apply(&x, Function::Cos), apply(&x, Function::Sin));
        let one = c.times(&c).plus(&s.times(&s));
        assert!(!one.differs(&number(1, 1)) && is_narrow(&one, 250), "{k}");
        let double = apply(&x.plus(&x), Function::Cos);
        assert!(!double.differs(&c.times(&c).plus(&s.times(&s).signed(true))));
        let product = apply(&x, Function::Exp).times(&apply(&x.signed(true), Function::Exp));
        assert!(
            !product.differs(&number(1, 1)) && is_narrow(&product, 250),
            "{k}"
        );
    }
    let root = |n: i64| apply(&number(n, 1), Function::Sqrt);
    assert!(!root(2).times(&root(3)).differs(&root(6)));
    let nested = apply(
        &number(5, 1).plus(&root(6).times(&number(-2, 1))),
        Function::Sqrt,
    );
    let plain = root(3).plus(&root(2).signed(true));
    assert!(!nested.differs(&plain) && nested.differs(&plain.signed(true)));
    let sixth = apply(&Interval::pi().times(&number(1, 6)), Function::Sin);
    assert!(!sixth.differs(&number(1, 2)));
}

#[test]
fn what_differs_by_little_differs() {
    let tiny = Interval::rational(&BigRational::new(1.into(), BigInt::from(10).pow(60)));
    let root = number(2, 1).apply(Function::Sqrt).expect("positive");
    assert!(root.plus(&tiny).differs(&root) && !root.plus(&tiny).differs(&root.plus(&tiny)));
    let huge = Interval::rational(&BigRational::from_integer(BigInt::from(10).pow(600)));
    assert!(huge.differs(&huge.plus(&huge)) && huge.plus(&tiny).to_f64().is_infinite());
}

#[test]
fn what_has_no_value_is_none() {
    let zero = number(2, 1).plus(&number(-2, 1));
    assert_eq!(zero.inverse(), None);
    assert_eq!(number(-1, 1).apply(Function::Sqrt), None);
    assert_eq!(number(-1, 1).apply(Function::Log), None);
    let huge = Interval::rational(&BigRational::from_integer(BigInt::from(10).pow(40)));
    assert!(huge.apply(Function::Sin).is_none() && huge.apply(Function::Exp).is_none());
    assert_eq!(
        zero.apply(Function::Sqrt).map(|root| root.to_f64()),
        Some(0.0)
    );
}

/// Wide and narrow bounds contain eˣ at both of their ends, which is summed here in numbers of 3000 bits.
#[test]
fn exponentials_of_the_ends_are_between_the_bounds() {
    const BITS: u64 = 3000;
    // x = n / 2¹²; each of at most 6000 terms is truncated twice.
    let power = |n: i64| -> BigInt {
        let (mut term, mut sum) = (power_of_two(BITS), BigInt::zero());
        for k in 1..6000u32 {
            sum += &term;
            term = ((term * n.abs()) >> 12u32) / k;
        }
        match n < 0 {
            true => power_of_two(2 * BITS) / sum,
            false => sum,
        }
    };
    for x in [-900, -30, 0, 1, 250, 900] {
        for width in [0, 1, 64, 4096, 40 * 4096] {
            let (lo, hi) = (x * 4096, x * 4096 + width);
            let wide = Interval::new(lo.into(), hi.into(), -12);
            let found = wide.apply(Function::Exp).expect("of moderate size");
            let slack = BigRational::new(1.into(), power_of_two(400));
            let at = |n: i64| BigRational::new(power(n), power_of_two(BITS));
            let (least, most) = (at(lo), at(hi));
            let [low, high] = found.bounds();
            let one = BigRational::one();
            assert!(low <= least * (&one + &slack), "{x}, {width}");
            assert!(high >= most * (&one - &slack), "{x}, {width}");
        }
    }
}
