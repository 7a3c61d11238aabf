//! Generators of the ideals of the coordinate kinds.
//!
//! | kind | equations |
//! |---|---|
//! | circle S¹ | c² + s² = 1 |
//! | unit quaternion S³ | q₀² + q₁² + q₂² + q₃² = 1 |
//! | rotation SO(3) | RᵀR = I, RRᵀ = I, R = cof R |
//!
//! The equations of SO(3) are redundant on purpose: from all 21 quadrics the reduced basis (20
//! quadrics in grevlex) follows after 75 pairs; from RᵀR = I and det R = 1 after 2390.

use super::field::Field;
use super::monomial::Var;
use super::polynomial::Poly;

/// c² + s² − 1.
pub fn circle<F: Field>(c: Var, s: Var) -> Vec<Poly<F>> {
    vec![unit_norm(&[c, s])]
}

/// |q|² − 1.
pub fn quaternion<F: Field>(q: [Var; 4]) -> Vec<Poly<F>> {
    vec![unit_norm(&q)]
}

/// The 21 quadrics of SO(3), with R in row-major order.
pub fn rotation<F: Field>(r: [Var; 9]) -> Vec<Poly<F>> {
    let entry = |i: usize, j: usize| Poly::<F>::var(r[3 * (i % 3) + j % 3]);
    let mut result = Vec::with_capacity(21);
    for i in 0..3 {
        for j in i..3 {
            let delta = Poly::constant(F::integer(i64::from(i == j)));
            let sum =
                |of: &dyn Fn(usize) -> Poly<F>| (0..3).fold(delta.neg(), |sum, k| sum.add(&of(k)));
            result.push(sum(&|k| entry(k, i).mul(&entry(k, j))));
            result.push(sum(&|k| entry(i, k).mul(&entry(j, k))));
        }
    }
    for i in 0..3 {
        for j in 0..3 {
            // Cyclic indices carry the sign of the cofactor.
            let cofactor = entry(i + 1, j + 1)
                .mul(&entry(i + 2, j + 2))
                .sub(&entry(i + 1, j + 2).mul(&entry(i + 2, j + 1)));
            result.push(cofactor.sub(&entry(i, j)));
        }
    }
    result
}

fn unit_norm<F: Field>(variables: &[Var]) -> Poly<F> {
    let minus_one = Poly::constant(F::integer(-1));
    let squares = variables.iter().map(|&v| Poly::var(v).pow(2));
    squares.fold(minus_one, |sum, square| sum.add(&square))
}
