//! Numbers modulo two primes at once, compared with their values in both fields.

use hamel_algebra::prime::Residue;
use hamel_algebra::residue_pair::{Random, ResiduePair};

#[test]
fn small_rationals_are_recognised_where_both_fields_agree() {
    for (n, d) in [(0, 1), (1, 2), (-981, 100), (7, 3), (-123456789, 100000000)] {
        let value =
            ResiduePair::from_i64(n) * ResiduePair::from_i64(d).inv().unwrap_or(ResiduePair::ZERO);
        assert_eq!(value.to_small_rational(29), Some((n, d)));
    }
    assert_eq!(Random::new(5).element().to_small_rational(29), None);
    // In a single field, many elements look like a rational.
    let mut random = Random::new(6);
    let (mut one, mut both) = (0, 0);
    for _ in 0..2000 {
        let value = random.element();
        one += usize::from(value.0.to_small_rational(29).is_some());
        both += usize::from(value.to_small_rational(29).is_some());
    }
    assert!(one > 50 && both == 0);
    let mixed = ResiduePair(Residue::new(2), Residue::new(3));
    assert_eq!(mixed.to_small_rational(29), None);
}

#[test]
fn what_is_zero_in_one_field_has_no_inverse() {
    let half = ResiduePair(Residue::ZERO, Residue::ONE);
    let values = [
        ResiduePair::new(7),
        half,
        -ResiduePair::PI,
        ResiduePair::ZERO,
        ResiduePair::new(9),
    ];
    let inverses = ResiduePair::inverses(values.into_iter());
    assert_eq!(inverses, values.map(ResiduePair::inv));
    assert!(!half.is_zero() && half.inv().is_none());
    assert_eq!(half.is_negative(), Residue::<1>::ONE.is_negative());
}
