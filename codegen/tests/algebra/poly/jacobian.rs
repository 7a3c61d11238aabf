//! Free variables of a system: constraints reduce their number.

use hamel_algebra::poly::jacobian::free_variables;
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::prime::Residue;
use hamel_algebra::residue_pair::Random;

type ResiduePair = Residue<0>;

#[test]
fn constraints_take_freedom() {
    let (x, y, z): (Poly<ResiduePair>, _, _) = (Poly::var(0), Poly::var(1), Poly::var(2));
    let mut random = Random::new(1);
    let mut free = |system: &[Poly<ResiduePair>]| free_variables(system, &[2, 0, 1], &mut random);
    assert_eq!(free(&[]), [2, 0, 1]);
    assert_eq!(free(&[x.mul(&x).add(&y)]), [2, 0, 1]);
    assert_eq!(free(&[x.mul(&x).add(&y), x.sub(&y)]), [2]);
    assert_eq!(free(&[z.pow(2), x.sub(&y)]), [0, 1]);
    assert_eq!(free(&[x.add(&z), x.sub(&y), y.mul(&z)]), Vec::<u32>::new());
}
