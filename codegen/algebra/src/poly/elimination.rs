//! The minimal polynomial of a variable modulo an ideal: the generator μ of I ∩ `F[x_v]`.
//!
//! μ is the first linear dependence among NF(1), NF(x_v), NF(x_v²), …; it exists exactly if x_v takes
//! finitely many values on the variety.

use super::field::Field;
use super::monomial::Var;
use super::normal_form::Basis;
use super::polynomial::Poly;

/// Returns the coefficients μ_0 … μ_n of the monic minimal polynomial of x_v modulo the ideal of a Gröbner
/// basis; `None` if there is none of degree up to `most`.
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
