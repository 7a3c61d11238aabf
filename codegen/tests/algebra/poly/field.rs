//! Laws of the coefficient fields, and rational numbers compared with big integers.

use hamel_algebra::poly::field::Field;
use hamel_algebra::prime::Residue;
use hamel_algebra::residue_pair::ResiduePair;
use num_rational::BigRational;

fn laws<F: Field>() {
    let (a, b) = (F::integer(-6), F::integer(4));
    assert_eq!(a.add(&b), F::integer(-2));
    assert_eq!(a.sub(&b), F::integer(-10));
    assert_eq!(a.mul(&b), F::integer(-24));
    assert_eq!(a.neg(), F::integer(6));
    assert_eq!(a.inv().map(|inverse| inverse.mul(&a)), Some(F::one()));
    assert_eq!(F::zero().inv(), None);
    let ratio = BigRational::new((-6).into(), 4.into());
    assert_eq!(F::from_rational(&ratio).map(|r| r.mul(&b)), Some(a));
    assert!(F::zero().is_zero() && F::one().is_one() && !b.is_zero());
}

/// Compares with the operators of `num_rational`, exactly and in lowest terms.
#[test]
fn rationals_of_any_size_are_those_of_big_integers() {
    let ends = [0, 1, -1, 6, -35, 1 << 31, i64::MAX, i64::MIN, i64::MIN + 1];
    let mut numbers = Vec::new();
    for numer in ends {
        for denom in ends.iter().filter(|&&denom| denom != 0) {
            numbers.push(BigRational::new(numer.into(), (*denom).into()));
        }
    }
    numbers.extend([1, -15].map(|n| BigRational::new(n.into(), (1i128 << 70).into())));
    for a in &numbers {
        for b in &numbers {
            for (ours, theirs) in [(Field::add(a, b), a + b), (Field::mul(a, b), a * b)] {
                let parts = |value: &BigRational| (value.numer().clone(), value.denom().clone());
                assert_eq!(parts(&ours), parts(&theirs), "{a} {b}");
            }
        }
    }
}

#[test]
fn all_fields_obey_the_laws() {
    laws::<BigRational>();
    laws::<Residue<0>>();
    laws::<Residue<1>>();
    laws::<ResiduePair>();
}
