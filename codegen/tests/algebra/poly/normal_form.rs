//! Sums of sorted lists of terms: both algorithms give the same result.

// The field of the sums, under the name that the included file uses.
use field::Field;
use hamel_algebra::poly::{field, monomial, order};
use monomial::Monomial;
use num_rational::BigRational as Rational;
use order::Order;
use sums::{insert_terms, merge_terms};

// Included, since these sums are used only by divisions, which do not distinguish the two algorithms.
#[path = "../../../algebra/src/poly/sums.rs"]
mod sums;

/// Inserting terms of various sizes, some of which cancel, agrees with merging them.
#[test]
fn terms_in_their_places_are_terms_merged() {
    let order = Order::Grevlex;
    let term = |k: u32, value: i64| {
        let powers = [(0, k % 3), (1, k / 3 % 4), (2, k / 12)];
        (
            Monomial::from_powers(powers),
            <Rational as Field>::integer(value),
        )
    };
    let sorted = |mut list: Vec<(Monomial, Rational)>| {
        list.sort_by(|a, b| order.compare(&a.0, &b.0));
        list
    };
    let list = sorted((0..40).map(|k| term(k, i64::from(k) - 50)).collect());
    for first in 0..20 {
        let terms = (first..60).step_by(7);
        let cancelling = |k: u32| [50 - i64::from(k), 3][k as usize % 2];
        let terms = sorted(terms.map(|k| term(k, cancelling(k))).collect());
        let down = insert_terms(order, list.clone(), terms.iter().rev().cloned());
        let up = merge_terms(order, list.clone(), terms.iter().cloned(), terms.len());
        assert_eq!(down, up);
        assert!(up.len() < list.len() + terms.len());
    }
}
