//! Roots in F_p of a univariate polynomial f = Σ f_k x^k, by Cantor and Zassenhaus.
//!
//! gcd(f, x^p − x) = Π (x − r) over the roots r in F_p; it is split by gcd with
//! (x + a)^{(p−1)/2} − 1 for random a, which has each root with probability ½.

use crate::algebra::fp::{Fp, P, Random};

/// The distinct roots of Σ f_k x^k in F_p, ascending; none for the zero polynomial.
pub fn roots(coefficients: &[Fp], random: &mut Random) -> Vec<Fp> {
    let f = monic(coefficients.to_vec());
    if f.len() < 2 {
        return Vec::new();
    }
    let x = vec![Fp::ZERO, Fp::ONE];
    let frobenius = power(x.clone(), P, &f);
    let mut result = Vec::new();
    split(gcd(f, subtract(frobenius, &x)), random, &mut result);
    result.sort_unstable();
    result
}

/// Collects the roots of a monic product of distinct linear factors.
fn split(f: Vec<Fp>, random: &mut Random, result: &mut Vec<Fp>) {
    match f.as_slice() {
        [] | [_] => {}
        [constant, _] => result.push(-*constant),
        _ => loop {
            let shifted = vec![random.element(), Fp::ONE];
            let half = power(shifted, (P - 1) / 2, &f);
            let factor = gcd(f.clone(), subtract(half, &[Fp::ONE]));
            if factor.len() > 1 && factor.len() < f.len() {
                let (cofactor, _) = divide(f, &factor);
                split(factor, random, result);
                split(cofactor, random, result);
                return;
            }
        },
    }
}

fn trim(mut f: Vec<Fp>) -> Vec<Fp> {
    while f.last().is_some_and(|leading| leading.is_zero()) {
        f.pop();
    }
    f
}

fn monic(f: Vec<Fp>) -> Vec<Fp> {
    let mut f = trim(f);
    if let Some(inverse) = f.last().and_then(|leading| leading.inv()) {
        f.iter_mut().for_each(|c| *c = *c * inverse);
    }
    f
}

fn subtract(mut f: Vec<Fp>, g: &[Fp]) -> Vec<Fp> {
    f.resize(f.len().max(g.len()), Fp::ZERO);
    f.iter_mut().zip(g).for_each(|(a, &b)| *a = *a - b);
    trim(f)
}

/// Quotient and remainder by a monic g.
fn divide(mut f: Vec<Fp>, g: &[Fp]) -> (Vec<Fp>, Vec<Fp>) {
    if f.len() < g.len() {
        return (Vec::new(), f);
    }
    let degree = g.len() - 1;
    for top in (degree..f.len()).rev() {
        let factor = f[top];
        for (k, &c) in g[..degree].iter().enumerate() {
            f[top - degree + k] = f[top - degree + k] - factor * c;
        }
    }
    let quotient = f.split_off(degree);
    (quotient, trim(f))
}

fn multiply(f: &[Fp], g: &[Fp], modulus: &[Fp]) -> Vec<Fp> {
    let mut product = vec![Fp::ZERO; f.len() + g.len()];
    for (i, &a) in f.iter().enumerate() {
        for (j, &b) in g.iter().enumerate() {
            product[i + j] = product[i + j] + a * b;
        }
    }
    divide(trim(product), modulus).1
}

/// base^exponent modulo a monic polynomial.
fn power(base: Vec<Fp>, mut exponent: u64, modulus: &[Fp]) -> Vec<Fp> {
    let mut square = divide(base, modulus).1;
    let mut result = divide(vec![Fp::ONE], modulus).1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = multiply(&result, &square, modulus);
        }
        square = multiply(&square, &square, modulus);
        exponent >>= 1;
    }
    result
}

fn gcd(f: Vec<Fp>, g: Vec<Fp>) -> Vec<Fp> {
    let (mut f, mut g) = (monic(f), monic(g));
    while !g.is_empty() {
        let rest = divide(f, &g).1;
        f = g;
        g = monic(rest);
    }
    f
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn all_roots_are_found(list in prop::collection::btree_set(-50i64..50, 0..12), seed: u64) {
            // (x² + 1) Π (x − r), the first root twice; x² + 1 has no root.
            let mut random = Random::new(seed);
            let mut f = vec![Fp::ONE, Fp::ZERO, random.element()];
            f[0] = f[2];
            let big = vec![Fp::ZERO; 40].into_iter().chain([Fp::ONE]).collect::<Vec<_>>();
            for &r in list.iter().chain(list.first()) {
                f = multiply(&f, &[Fp::from_i64(-r), Fp::ONE], &big);
            }
            let mut expected: Vec<Fp> = list.iter().map(|&r| Fp::from_i64(r)).collect();
            expected.sort_unstable();
            prop_assert_eq!(roots(&f, &mut random), expected);
        }
    }

    #[test]
    fn constants_have_no_roots() {
        let mut random = Random::new(1);
        assert!(roots(&[], &mut random).is_empty());
        assert!(roots(&[Fp::ZERO, Fp::ZERO], &mut random).is_empty());
        assert!(roots(&[Fp::ONE], &mut random).is_empty());
    }
}
