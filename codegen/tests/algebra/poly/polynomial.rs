//! Laws of polynomial arithmetic.

use super::polynomials;
use hamel_algebra::poly::monomial::Var;
use hamel_algebra::poly::order::Order;
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use proptest::prelude::*;

fn polynomial() -> impl Strategy<Value = Poly<ResiduePair>> {
    let powers = prop::collection::vec((0u32..4, 0u32..3), 0..3);
    polynomials(powers, -5..6, 0..6)
}

proptest! {
    #[test]
    fn evaluation_is_a_homomorphism(f in polynomial(), g in polynomial(), seed: u64) {
        let mut random = Random::new(seed);
        let x: Vec<ResiduePair> = (0..4).map(|_| random.element()).collect();
        let at = |v: Var| x[v as usize];
        prop_assert_eq!(f.add(&g).eval(&at), f.eval(&at) + g.eval(&at));
        prop_assert_eq!(f.sub(&g).eval(&at), f.eval(&at) - g.eval(&at));
        prop_assert_eq!(f.mul(&g).eval(&at), f.eval(&at) * g.eval(&at));
        prop_assert_eq!(f.pow(3).eval(&at), f.eval(&at) * f.eval(&at) * f.eval(&at));
        let shifted = |v: Var| if v == 1 { g.eval(&at) } else { at(v) };
        prop_assert_eq!(f.substitute(1, &g).eval(&at), f.eval(&shifted));
        let half = f.specialize(&|v| (v < 2).then(|| at(v)));
        prop_assert_eq!(half.eval(&at), f.eval(&at));
        prop_assert_eq!(f.with_order(Order::Lex), f.clone());
        // Leibniz: ∂(f g) = f ∂g + ∂f g.
        let rule = f.mul(&g.derivative(2)).add(&f.derivative(2).mul(&g));
        prop_assert_eq!(f.mul(&g).derivative(2), rule);
    }
}

#[test]
fn expansion_is_bounded() {
    let sum = (0..10).fold(Poly::<ResiduePair>::zero(), |sum, v| sum.add(&Poly::var(v)));
    assert_eq!(sum.pow_limited(2, 55).map(|f| f.terms().len()), Some(55));
    assert!(sum.pow_limited(2, 54).is_none());
    assert!(sum.pow_limited(30, 500).is_none());
    assert!(sum.pow(2).substitute_limited(0, &sum.pow(2), 100).is_none());
}
