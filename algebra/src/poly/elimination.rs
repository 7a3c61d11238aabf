//! The minimal polynomial of a variable modulo an ideal: the generator μ of I ∩ `F[x_v]`.
//!
//! μ is the first linear dependence among NF(1), NF(x_v), NF(x_v²), …; there is one exactly
//! where x_v takes finitely many values on the variety.

use super::field::Field;
use super::monomial::Var;
use super::normal_form::Basis;
use super::polynomial::Poly;

/// The coefficients μ_0 … μ_n of the monic minimal polynomial of x_v modulo the ideal of a Gröbner
/// basis; `None` where there is none up to the given degree.
pub fn minimal_polynomial<F: Field>(
    basis: &Basis<F>,
    variable: Var,
    most: usize,
) -> Option<Vec<F>> {
    let x = Poly::var(variable);
    let mut power = basis.normal_form(&Poly::one());
    // Monic combinations of normal forms with their coefficients, leading monomials descending.
    let mut rows: Vec<(Poly<F>, Vec<F>)> = Vec::new();
    for degree in 0..=most {
        let mut rest = power.clone();
        let mut combination = vec![F::zero(); degree];
        combination.push(F::one());
        for (row, coefficients) in &rows {
            let Some((pivot, _)) = row.leading() else {
                continue;
            };
            let found = rest.terms().iter().find(|term| term.0 == *pivot);
            if let Some(factor) = found.map(|term| term.1.clone()) {
                rest = rest.sub(&row.scale(&factor));
                for (c, d) in combination.iter_mut().zip(coefficients) {
                    *c = c.sub(&factor.mul(d));
                }
            }
        }
        let Some(inverse) = rest.leading().and_then(|term| term.1.inv()) else {
            return Some(combination);
        };
        combination.iter_mut().for_each(|c| *c = c.mul(&inverse));
        let position = rows.partition_point(|(row, _)| match (row.leading(), rest.leading()) {
            (Some(a), Some(b)) => basis.order().compare(&a.0, &b.0).is_gt(),
            _ => true,
        });
        rows.insert(position, (rest.scale(&inverse), combination));
        power = basis.normal_form(&power.mul(&x));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::super::buchberger::{Limits, groebner};
    use super::super::order::Order;
    use super::*;
    use crate::fp::Fp;

    fn n(value: i64) -> Poly<Fp> {
        Poly::constant(Fp::from_i64(value))
    }

    #[test]
    fn algebraic_and_free_variables_are_told_apart() {
        // z² = x y, x y = 2, so z² = 2; x and y stay free.
        let (x, y, z) = (Poly::var(0), Poly::var(1), Poly::var(2));
        let generators = [z.mul(&z).sub(&x.mul(&y)), x.mul(&y).sub(&n(2))];
        let Ok(basis) = groebner(&generators, Order::Grevlex, Limits::default()) else {
            panic!("limits");
        };
        let minimal = minimal_polynomial(&basis, 2, 10);
        assert_eq!(minimal, Some(vec![Fp::from_i64(-2), Fp::ZERO, Fp::ONE]));
        assert_eq!(minimal_polynomial(&basis, 0, 10), None);
        // (z − 1)(z − 2)(z − 3) and w = z² have the values 1, 4, 9.
        let cubic = (1..4).fold(n(1), |product, k| product.mul(&z.sub(&n(k))));
        let generators = [cubic, Poly::var(3).sub(&z.mul(&z))];
        let Ok(basis) = groebner(&generators, Order::Grevlex, Limits::default()) else {
            panic!("limits");
        };
        let expected = [-36, 49, -14, 1].map(Fp::from_i64);
        assert_eq!(minimal_polynomial(&basis, 3, 10), Some(expected.to_vec()));
    }
}
