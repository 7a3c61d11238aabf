//! Roots of a univariate polynomial f = Σ f_k x^k in the field of its coefficients, F_p or F_p(i), by
//! Cantor and Zassenhaus.
//!
//! gcd(f, x^q − x) = Π (x − r) over the roots r in the field of q elements; it is split by gcd with
//! (x + a)^{(q−1)/2} − 1 for random a, which has each root with probability ½.

use crate::algebra::fp::{Fp, P, Random};

/// The distinct roots of Σ f_k x^k, ascending; none for the zero polynomial.
pub fn roots(coefficients: &[Fp], random: &mut Random) -> Vec<Fp> {
    let f = monic(coefficients.to_vec());
    if f.len() < 2 {
        return Vec::new();
    }
    let x = vec![Fp::ZERO, Fp::ONE];
    let whole = f.iter().any(|coefficient| !coefficient.is_prime());
    let mut frobenius = power(x.clone(), P, &f);
    if whole {
        frobenius = power(frobenius, P, &f);
    }
    let mut result = Vec::new();
    let product = gcd(f, subtract(frobenius, &x));
    split(product, whole, random, &mut result);
    result.sort_unstable();
    result
}

/// Collects the roots of a monic product of distinct linear factors.
fn split(f: Vec<Fp>, whole: bool, random: &mut Random, result: &mut Vec<Fp>) {
    match f.as_slice() {
        [] | [_] => {}
        [constant, _] => result.push(-*constant),
        _ => loop {
            let mut shift = random.element();
            if whole {
                shift = shift + Fp::I * random.element();
            }
            let mut half = power(vec![shift, Fp::ONE], (P - 1) / 2, &f);
            if whole {
                half = power(half, P + 1, &f);
            }
            let factor = gcd(f.clone(), subtract(half, &[Fp::ONE]));
            if factor.len() > 1 && factor.len() < f.len() {
                let (cofactor, _) = divide(f, &factor);
                split(factor, whole, random, result);
                split(cofactor, whole, random, result);
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

    /// x² − z for z outside of F_p, and (x − a)(x − b)(x − c) for such a, b, c.
    #[test]
    fn roots_beyond_the_prime_field_are_found() {
        let mut random = Random::new(3);
        let mut number = || random.element() + Fp::I * random.element();
        let (a, b, c) = (number(), number(), number());
        let f = [-(a * b * c), a * b + b * c + c * a, -(a + b + c), Fp::ONE];
        let mut expected = vec![a, b, c];
        expected.sort_unstable();
        assert_eq!(roots(&f, &mut Random::new(4)), expected);
        let mut squares = 0;
        for _ in 0..40 {
            let z = number();
            let found = roots(&[-z, Fp::ZERO, Fp::ONE], &mut Random::new(5));
            assert!(found.iter().all(|&root| root * root == z));
            assert_eq!(found.len(), if z.sqrt().is_some() { 2 } else { 0 });
            squares += found.len() / 2;
        }
        assert!(squares > 8 && squares < 32);
    }

    #[test]
    fn constants_have_no_roots() {
        let mut random = Random::new(1);
        assert!(roots(&[], &mut random).is_empty());
        assert!(roots(&[Fp::ZERO, Fp::ZERO], &mut random).is_empty());
        assert!(roots(&[Fp::ONE], &mut random).is_empty());
    }
}
