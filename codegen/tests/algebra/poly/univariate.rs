//! All roots of univariate polynomials are found, in the prime field and in its extension.

use hamel_algebra::poly::univariate::roots;
use hamel_algebra::prime::Residue;
use hamel_algebra::residue_pair::Random;
use proptest::prelude::*;

type ResiduePair = Residue<1>;

/// Returns the coefficients Σ f_i g_{k−i} of a product.
fn multiply(f: &[ResiduePair], g: &[ResiduePair]) -> Vec<ResiduePair> {
    let mut product = vec![ResiduePair::ZERO; f.len() + g.len() - 1];
    for (i, &a) in f.iter().enumerate() {
        for (j, &b) in g.iter().enumerate() {
            product[i + j] = product[i + j] + a * b;
        }
    }
    product
}

proptest! {
    #[test]
    fn all_roots_are_found(list in prop::collection::btree_set(-50i64..50, 0..12), seed: u64) {
        // (x² + 1) Π (x − r), with a double first root; x² + 1 has no root.
        let mut random = Random::new(seed);
        let mut f = vec![ResiduePair::ONE, ResiduePair::ZERO, random.residue()];
        f[0] = f[2];
        for &r in list.iter().chain(list.first()) {
            f = multiply(&f, &[ResiduePair::from_i64(-r), ResiduePair::ONE]);
        }
        let mut expected: Vec<ResiduePair> = list.iter().map(|&r| ResiduePair::from_i64(r)).collect();
        expected.sort_unstable();
        prop_assert_eq!(roots(&f, &mut random), expected);
    }
}

/// x² − z for z outside of F_p, and (x − a)(x − b)(x − c) for such a, b, c
#[test]
fn roots_beyond_the_prime_field_are_found() {
    let mut random = Random::new(3);
    let mut number = || random.residue() + ResiduePair::I * random.residue();
    let (a, b, c) = (number(), number(), number());
    let f = [
        -(a * b * c),
        a * b + b * c + c * a,
        -(a + b + c),
        ResiduePair::ONE,
    ];
    let mut expected = vec![a, b, c];
    expected.sort_unstable();
    assert_eq!(roots(&f, &mut Random::new(4)), expected);
    let mut squares = 0;
    for _ in 0..40 {
        let z = number();
        let found = roots(
            &[-z, ResiduePair::ZERO, ResiduePair::ONE],
            &mut Random::new(5),
        );
        assert!(found.iter().all(|&root| root * root == z));
        assert_eq!(found.len(), if z.sqrt().is_some() { 2 } else { 0 });
        squares += found.len() / 2;
    }
    assert!(squares > 8 && squares < 32);
}

#[test]
fn constants_have_no_roots() {
    let mut random = Random::new(1);
    assert!(roots::<1>(&[], &mut random).is_empty());
    assert!(roots(&[ResiduePair::ZERO, ResiduePair::ZERO], &mut random).is_empty());
    assert!(roots(&[ResiduePair::ONE], &mut random).is_empty());
}
