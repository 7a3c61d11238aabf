//! Square roots modulo p: the root of a product is the product of the roots.

use hamel_algebra::prime::Residue;
use hamel_algebra::residue_pair::Random;
use hamel_algebra::roots::of_rational;
use num_bigint::BigInt;
use num_rational::BigRational;

#[test]
fn roots_of_products_are_products_of_roots() {
    let number = |n: i64, d: i64| BigRational::new(BigInt::from(n), BigInt::from(d));
    let numbers: Vec<BigRational> = (1..40)
        .flat_map(|n| [1, 2, 7, 30, 1009 * 1013].map(|d| number(n, d)))
        .chain([number(4099 * 4111, 3), number(4099, 1), number(i64::MAX, 7)])
        .collect();
    for a in &numbers {
        let root = of_rational::<1>(a).expect("positive");
        assert_eq!(Some(root * root), Residue::from_rational(a), "{a}");
        for b in numbers.iter().take(80) {
            let product = of_rational::<1>(&(a * b)).expect("positive");
            assert_eq!(
                product,
                root * of_rational(b).expect("positive"),
                "{a}, {b}"
            );
        }
    }
    // Squares of numbers have that number as root; a negative number has no root.
    assert_eq!(
        of_rational::<0>(&number(9, 16)),
        Residue::from_rational(&number(3, 4))
    );
    assert_eq!(of_rational::<0>(&number(-1, 4)), None);
    assert_eq!(of_rational::<0>(&number(0, 1)), None);
}

#[test]
fn principal_roots_are_closed_under_products() {
    let mut random = Random::new(5);
    let mut found = 0;
    for _ in 0..200 {
        let (a, b) = (random.residue::<0>(), random.residue());
        if let (Some(x), Some(y)) = (a.principal_root(), b.principal_root()) {
            assert_eq!(x * x, a);
            assert_eq!((a * b).principal_root(), Some(x * y));
            found += 1;
        }
    }
    assert!(found > 20);
}
