//! Minimal polynomials distinguish algebraic and free variables.

use hamel_algebra::poly::buchberger::{Limits, groebner};
use hamel_algebra::poly::elimination::minimal_polynomial;
use hamel_algebra::poly::order::Order;
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::residue_pair::ResiduePair;

fn n(value: i64) -> Poly<ResiduePair> {
    Poly::constant(ResiduePair::from_i64(value))
}

#[test]
fn algebraic_and_free_variables_are_told_apart() {
    // z² = x y and x y = 2, so z² = 2; x and y are free.
    let (x, y, z) = (Poly::var(0), Poly::var(1), Poly::var(2));
    let generators = [z.mul(&z).sub(&x.mul(&y)), x.mul(&y).sub(&n(2))];
    let Ok(basis) = groebner(&generators, Order::Grevlex, Limits::default()) else {
        panic!("limits");
    };
    let minimal = minimal_polynomial(&basis, 2, 10);
    assert_eq!(
        minimal,
        Some(vec![
            ResiduePair::from_i64(-2),
            ResiduePair::ZERO,
            ResiduePair::ONE
        ])
    );
    assert_eq!(minimal_polynomial(&basis, 0, 10), None);
    // (z − 1)(z − 2)(z − 3) and w = z² have the values 1, 4, 9.
    let cubic = (1..4).fold(n(1), |product, k| product.mul(&z.sub(&n(k))));
    let generators = [cubic, Poly::var(3).sub(&z.mul(&z))];
    let Ok(basis) = groebner(&generators, Order::Grevlex, Limits::default()) else {
        panic!("limits");
    };
    let expected = [-36, 49, -14, 1].map(ResiduePair::from_i64);
    assert_eq!(minimal_polynomial(&basis, 3, 10), Some(expected.to_vec()));
}
