//! Arithmetic of monomials agrees with that of their exponents.

use hamel_algebra::poly::monomial::{Monomial, Var};

fn m(powers: &[(Var, u32)]) -> Monomial {
    Monomial::from_powers(powers.iter().copied())
}

#[test]
fn arithmetic_is_by_exponents() {
    let (a, b) = (m(&[(2, 1), (0, 2)]), m(&[(0, 1), (5, 3)]));
    assert_eq!(a.mul(&b), m(&[(0, 3), (2, 1), (5, 3)]));
    assert_eq!(a.lcm(&b), m(&[(0, 2), (2, 1), (5, 3)]));
    assert_eq!(a.gcd(&b), m(&[(0, 1)]));
    assert_eq!(a.mul(&b).div(&b), Some(a.clone()));
    assert_eq!(a.div(&b), None);
    assert!(b.divides(&a.lcm(&b)) && !b.divides(&a));
    assert!(!a.coprime(&b) && a.coprime(&m(&[(1, 4)])));
    assert_eq!((a.degree(), a.exponent(0), a.exponent(1)), (3, 2, 0));
    assert_eq!(m(&[(3, 1), (3, 1), (4, 0)]), m(&[(3, 2)]));
    assert_eq!(a.mask() & !a.mul(&b).mask(), 0);
}
