//! Laws of polynomials, of their ideals and of points of ideals, one module for each file.

mod elimination;
mod factor;
mod field;
mod jacobian;
mod monomial;
mod normal_form;
mod oracle;
mod order;
mod polynomial;
mod solve;
mod univariate;

use hamel_algebra::poly::monomial::Monomial;
use hamel_algebra::poly::order::Order;
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::residue_pair::ResiduePair;
use proptest::prelude::*;
use std::ops::Range;

/// Returns polynomials with a number of terms, each given by powers of variables and a coefficient.
fn polynomials(
    powers: impl Strategy<Value = Vec<(u32, u32)>>,
    coefficients: Range<i64>,
    terms: Range<usize>,
) -> impl Strategy<Value = Poly<ResiduePair>> {
    prop::collection::vec((powers, coefficients), terms).prop_map(|terms| {
        let terms = terms
            .into_iter()
            .map(|(powers, c)| (Monomial::from_powers(powers), ResiduePair::from_i64(c)));
        Poly::from_terms(Order::Grevlex, terms.collect())
    })
}
