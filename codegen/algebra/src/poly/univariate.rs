//! Roots of a univariate polynomial f = Σ f_k x^k in the field of its coefficients, F_p or F_p(i), by the
//! algorithm of Cantor and Zassenhaus.
//!
//! gcd(f, x^q − x) = Π (x − r) over the roots r in the field of q elements; it is split by gcd with
//! (x + a)^{(q−1)/2} − 1 for random a, which has each root with probability ½.

use crate::prime::Residue;
use crate::residue_pair::Random;

/// Returns the distinct roots of Σ f_k x^k, ascending; none for the zero polynomial.
pub fn roots<const K: usize>(coefficients: &[Residue<K>], random: &mut Random) -> Vec<Residue<K>> {
    let f = monic(coefficients.to_vec());
    if f.len() < 2 {
        return Vec::new();
    }
    let x = vec![Residue::ZERO, Residue::ONE];
    let whole = f.iter().any(|coefficient| !coefficient.is_in_prime_field());
    let mut frobenius = power(x.clone(), Residue::<K>::P, &f);
    if whole {
        frobenius = power(frobenius, Residue::<K>::P, &f);
    }
    let mut result = Vec::new();
    let product = gcd(f, subtract(frobenius, &x));
    split(product, whole, random, &mut result);
    result.sort_unstable();
    result
}

/// Collects the roots of a monic product of distinct linear factors.
fn split<const K: usize>(
    f: Vec<Residue<K>>,
    whole: bool,
    random: &mut Random,
    result: &mut Vec<Residue<K>>,
) {
    match f.as_slice() {
        [] | [_] => {}
        [constant, _] => result.push(-*constant),
        _ => loop {
            let mut shift = random.residue();
            if whole {
                shift = shift + Residue::I * random.residue();
            }
            let mut half = power(vec![shift, Residue::ONE], (Residue::<K>::P - 1) / 2, &f);
            if whole {
                half = power(half, Residue::<K>::P + 1, &f);
            }
            let factor = gcd(f.clone(), subtract(half, &[Residue::ONE]));
            if factor.len() > 1 && factor.len() < f.len() {
                let (cofactor, _) = divide(f, &factor);
                split(factor, whole, random, result);
                split(cofactor, whole, random, result);
                return;
            }
        },
    }
}

fn trim<const K: usize>(mut f: Vec<Residue<K>>) -> Vec<Residue<K>> {
    while f.last().is_some_and(|leading| leading.is_zero()) {
        f.pop();
    }
    f
}

fn monic<const K: usize>(f: Vec<Residue<K>>) -> Vec<Residue<K>> {
    let mut f = trim(f);
    if let Some(inverse) = f.last().and_then(|leading| leading.inv()) {
        f.iter_mut().for_each(|c| *c = *c * inverse);
    }
    f
}

fn subtract<const K: usize>(mut f: Vec<Residue<K>>, g: &[Residue<K>]) -> Vec<Residue<K>> {
    f.resize(f.len().max(g.len()), Residue::ZERO);
    f.iter_mut().zip(g).for_each(|(a, &b)| *a = *a - b);
    trim(f)
}

/// Returns quotient and remainder of a division by a monic g.
fn divide<const K: usize>(
    mut f: Vec<Residue<K>>,
    g: &[Residue<K>],
) -> (Vec<Residue<K>>, Vec<Residue<K>>) {
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

fn multiply<const K: usize>(
    f: &[Residue<K>],
    g: &[Residue<K>],
    modulus: &[Residue<K>],
) -> Vec<Residue<K>> {
    let mut product = vec![Residue::ZERO; f.len() + g.len()];
    for (i, &a) in f.iter().enumerate() {
        for (j, &b) in g.iter().enumerate() {
            product[i + j] = product[i + j] + a * b;
        }
    }
    divide(trim(product), modulus).1
}

/// base^exponent modulo a monic polynomial.
fn power<const K: usize>(
    base: Vec<Residue<K>>,
    mut exponent: u64,
    modulus: &[Residue<K>],
) -> Vec<Residue<K>> {
    let mut square = divide(base, modulus).1;
    let mut result = divide(vec![Residue::ONE], modulus).1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = multiply(&result, &square, modulus);
        }
        square = multiply(&square, &square, modulus);
        exponent >>= 1;
    }
    result
}

fn gcd<const K: usize>(f: Vec<Residue<K>>, g: Vec<Residue<K>>) -> Vec<Residue<K>> {
    let (mut f, mut g) = (monic(f), monic(g));
    while !g.is_empty() {
        let rest = divide(f, &g).1;
        f = g;
        g = monic(rest);
    }
    f
}
