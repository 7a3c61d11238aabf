//! The prime fields: their laws, their roots, and primes without special structure.

use hamel_algebra::prime::{PRIMES, Residue, has_bad_prime};
use hamel_algebra::residue_pair::Random;
use num_bigint::BigInt;
use num_rational::BigRational;

fn laws<const K: usize>() {
    let mut random = Random::new(1);
    let one = Residue::<K>::ONE;
    for _ in 0..200 {
        let [a, b, c] = std::array::from_fn(|_| random.residue::<K>());
        assert_eq!(a * (b + c), a * b + a * c);
        assert_eq!((a - b) + b, a);
        assert_eq!(a.inv().map(|inverse| inverse * a), Some(one));
        assert_eq!(a.pow(Residue::<K>::P - 1), one);
        let root = (a * a).sqrt();
        assert!(root == Some(a) || root == Some(-a));
    }
    assert_eq!(Residue::<K>::ZERO.inv(), None);
    assert_eq!(Residue::<K>::new(3) * Residue::new(5), Residue::new(15));
    assert_eq!(Residue::<K>::from_i64(-7) + Residue::new(7), Residue::ZERO);
}

#[test]
fn field_laws_hold() {
    laws::<0>();
    laws::<1>();
}

fn roots<const K: usize>() {
    let mut random = Random::new(2);
    let mut roots = 0;
    for _ in 0..100 {
        let a = random.residue::<K>();
        let root = a.sqrt().expect("it has one in F_p(i)");
        assert_eq!(root * root, a);
        let b = root + random.residue();
        assert_eq!(b.inv().map(|inverse| inverse * b), Some(Residue::ONE));
        let square = (b * b).sqrt();
        assert!(square == Some(b) || square == Some(-b));
        roots += usize::from(b.sqrt().is_some_and(|root| root * root == b));
    }
    assert!(roots > 40 && roots < 100);
    // −1 is not a square, because p ≡ 3 mod 4.
    let i = Residue::<K>::I;
    assert!(matches!((-Residue::<K>::ONE).sqrt(), Some(root) if root == i || root == -i));
    assert!(i.is_negative() != (-i).is_negative());
}

#[test]
fn roots_of_all_elements_of_the_prime_field_exist() {
    roots::<0>();
    roots::<1>();
}

/// Small powers of 2, roots of small integers, and generators of the roots of unity of low order are not close to a
/// small rational, unlike for p = 2⁶¹ − 1, where √2 = ±2³¹.
fn unstructured<const K: usize>() {
    const BITS: u32 = 22;
    let small = |a: Residue<K>| a.to_small_rational(BITS);
    let two = Residue::<K>::new(2);
    for exponent in BITS..1024 {
        assert_eq!(small(two.pow(u64::from(exponent))), None, "2^{exponent}");
    }
    for base in [3u64, 5, 7, 10] {
        let first = (f64::from(BITS) * 2f64.ln() / (base as f64).ln()).ceil() as u64;
        for exponent in first..256 {
            let power = Residue::<K>::new(base).pow(exponent);
            assert_eq!(small(power), None, "{base}^{exponent}");
        }
    }
    let is_square = |n: u64| n.isqrt() * n.isqrt() == n;
    for n in (2..2000).filter(|&n| !is_square(n)) {
        let root = Residue::<K>::new(n).sqrt().expect("in F_p(i)");
        // Either in F_p, or i times an element of it.
        let real = if root.is_in_prime_field() {
            root
        } else {
            -(Residue::I * root)
        };
        assert_eq!(small(real), None, "root of {n}");
        // Multiplied by small factors, and roots of roots.
        for factor in 1..50 {
            assert_eq!(
                small(real * Residue::new(factor)),
                None,
                "{factor} root {n}"
            );
        }
        if let Some(fourth) = real.principal_root() {
            assert_eq!(small(fourth), None, "fourth root of {n}");
        }
    }
    // Elements of low order in the group of F_p(i): ζ + 1/ζ = 2 cos(2π/order).
    let order = u128::from(Residue::<K>::P) * u128::from(Residue::<K>::P) - 1;
    let mut random = Random::new(9);
    for n in (3..200u128).filter(|n| order % n == 0) {
        let any = random.residue::<K>() + Residue::I * random.residue();
        let mut zeta = Residue::<K>::ONE;
        let (mut exponent, mut base) = (order / n, any);
        while exponent > 0 {
            if exponent & 1 == 1 {
                zeta = zeta * base;
            }
            base = base * base;
            exponent >>= 1;
        }
        let cosine = zeta + zeta.inv().expect("not 0");
        if let Some((numerator, denominator)) = small(cosine) {
            assert!(
                numerator.abs() < 3 && denominator == 1,
                "{n}: {numerator}/{denominator}"
            );
        }
    }
}

#[test]
fn the_primes_have_no_structure() {
    unstructured::<0>();
    unstructured::<1>();
    assert!(PRIMES[0] != PRIMES[1]);
    for p in PRIMES {
        assert!(p >= 1 << 61 && p % 4 == 3);
        let is_square =
            |n: u64| BigInt::from(n).modpow(&((p - 1) / 2).into(), &p.into()) == 1.into();
        assert!(
            [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37]
                .into_iter()
                .all(is_square)
        );
        // The Miller-Rabin test with the first primes as bases is exact below 2^64.
        let n = BigInt::from(p);
        let odd = BigInt::from((p - 1) / 2);
        for base in [2u32, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37] {
            let power = BigInt::from(base).modpow(&odd, &n);
            assert!(
                power == BigInt::from(1) || power == &n - 1,
                "{p} is no prime"
            );
        }
    }
}

#[test]
fn multiples_of_the_primes_are_noticed() {
    let whole = |n: u64| BigRational::from_integer(BigInt::from(n));
    assert!(has_bad_prime(&whole(PRIMES[0])) && has_bad_prime(&whole(PRIMES[1]).recip()));
    assert!(!has_bad_prime(&whole((1 << 61) - 1)) && !has_bad_prime(&whole(0)));
    let product = whole(PRIMES[0]) * whole(PRIMES[1]);
    assert!(has_bad_prime(&(product * whole(12))));
}
