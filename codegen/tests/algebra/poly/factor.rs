//! Operation counts of typical equations, and the values of random ones.

use hamel_algebra::poly::factor::{Coefficient, Operand, Step, Term, Value, factor};
use hamel_algebra::poly::monomial::{Monomial, Var};
use hamel_algebra::residue_pair::{Random, ResiduePair};
use proptest::prelude::*;

/// Returns terms ±id x_v x_w …; a negative id means a negated coefficient.
fn terms(list: &[(i64, &[Var])]) -> Vec<Term> {
    let term = |&(id, variables): &(i64, &[Var])| Term {
        coefficient: Coefficient {
            id: id.unsigned_abs() as u32,
            negative: id < 0,
        },
        monomial: Monomial::from_powers(variables.iter().map(|&v| (v, 1))),
    };
    list.iter().map(term).collect()
}

/// Checks the program at a random point, and returns its number of operations.
fn checked(polynomials: &[Vec<Term>], seed: u64) -> usize {
    let program = factor(polynomials);
    let mixed = Random::new(seed).bits();
    let value = |key: u64| Random::new(mixed ^ key).element();
    let coefficient = |id: u32| value(2 * u64::from(id));
    let variable = |v: Var| value(2 * u64::from(v) + 1);
    let direct = polynomials.iter().map(|terms| {
        terms.iter().fold(ResiduePair::ZERO, |sum, term| {
            let constant = match term.coefficient.id {
                0 => ResiduePair::ONE,
                id => coefficient(id),
            };
            let powers = term.monomial.powers().iter();
            let product = powers.fold(constant, |p, &(v, e)| {
                (0..e).fold(p, |p, _| p * variable(v))
            });
            if term.coefficient.negative {
                sum - product
            } else {
                sum + product
            }
        })
    });
    let direct: Vec<ResiduePair> = direct.collect();
    assert_eq!(program.evaluate(&coefficient, &variable), direct);
    let earlier = |index: usize, o: Operand| !matches!(o.value, Value::Step(k) if k >= index);
    for (index, step) in program.steps.iter().enumerate() {
        let (Step::Mul(a, b) | Step::Add(a, b)) = *step;
        assert!(earlier(index, a) && earlier(index, b) && !a.negative);
    }
    program.operations()
}

#[test]
fn rigid_bodies() {
    let euler = [
        terms(&[(1, &[1, 2])]),
        terms(&[(2, &[2, 0])]),
        terms(&[(3, &[0, 1])]),
    ];
    assert!(checked(&euler, 1) <= 6);
    let heavy = [
        terms(&[(1, &[1, 2]), (4, &[4])]),
        terms(&[(2, &[2, 0]), (5, &[3])]),
        terms(&[(3, &[0, 1])]),
    ];
    assert!(checked(&heavy, 1) <= 10);
    // (Θ ω) × ω with Θ₁₂, Θ₁₃, Θ₂₃ = 1, 2, 3 and the differences of the diagonal 4, 5, 6.
    let gyroscopic = [
        terms(&[
            (1, &[0, 2]),
            (4, &[1, 2]),
            (3, &[2, 2]),
            (-3, &[1, 1]),
            (-2, &[0, 1]),
        ]),
        terms(&[
            (2, &[0, 0]),
            (-2, &[2, 2]),
            (3, &[0, 1]),
            (5, &[0, 2]),
            (-1, &[1, 2]),
        ]),
        terms(&[
            (6, &[0, 1]),
            (1, &[1, 1]),
            (-1, &[0, 0]),
            (2, &[1, 2]),
            (-3, &[0, 2]),
        ]),
    ];
    assert!(checked(&gyroscopic, 1) <= 24);
}

#[test]
fn quadratic_forms() {
    let squares: [&[Var]; 6] = [&[0, 0], &[1, 1], &[2, 2], &[0, 1], &[1, 2], &[2, 0]];
    let row = |k: i64| {
        let entries = squares.iter().zip(6 * k + 1..);
        terms(&entries.map(|(&m, id)| (id, m)).collect::<Vec<_>>())
    };
    assert!(checked(&[row(0), row(1), row(2)], 1) <= 39);
}

#[test]
fn double_pendulum() {
    // s₁, c₁, s₂, c₂, ω₁, ω₂ = 0 … 5; b, g₁, g₂ = 1, 2, 3.
    let rows = [
        terms(&[(1, &[0, 3, 5, 5]), (-1, &[1, 2, 5, 5]), (2, &[0])]),
        terms(&[(-1, &[0, 3, 4, 4]), (1, &[1, 2, 4, 4]), (3, &[2])]),
    ];
    assert!(checked(&rows, 1) <= 12);
}

#[test]
fn degenerate_polynomials() {
    assert_eq!(checked(&[], 1), 0);
    let rows = [
        terms(&[]),
        terms(&[(0, &[])]),
        terms(&[(7, &[]), (-7, &[])]),
        terms(&[(0, &[3]), (0, &[3])]),
        terms(&[(-2, &[])]),
        terms(&[(0, &[5, 5, 5, 5, 5, 5, 5, 5])]),
        terms(&[(0, &[1]), (-0, &[2])]),
        terms(&[(0, &[1]), (0, &[2])]),
    ];
    assert_eq!(checked(&rows, 1), 5);
    // (a + b)(c + d) and its negative.
    let product = [(0i64, [0, 2]), (0, [0, 3]), (0, [1, 2]), (0, [1, 3])];
    let both = [false, true].map(|negative| {
        let mut row = terms(&product.each_ref().map(|(id, m)| (*id, m.as_slice())));
        row.iter_mut()
            .for_each(|term| term.coefficient.negative = negative);
        row
    });
    assert_eq!(checked(&both, 1), 3);
}

/// Returns rows of pseudo-random terms.
fn random_rows(rows: usize, terms: usize, variables: u64, ids: u64) -> Vec<Vec<Term>> {
    let mut random = Random::new(7);
    let mut below = |n: u64| random.bits() % n;
    let mut term = || Term {
        coefficient: Coefficient {
            id: below(ids) as u32,
            negative: below(2) == 0,
        },
        monomial: Monomial::from_powers((0..4).map(|_| (below(variables) as Var, below(3) as u32))),
    };
    let mut row = || (0..terms).map(|_| term()).collect();
    (0..rows).map(|_| row()).collect()
}

#[test]
fn large_systems_are_factored() {
    for (rows, length) in [(6, 50), (1, 300), (30, 10), (6, 500), (1, 10_000)] {
        checked(&random_rows(rows, length, 10, 30), 1);
    }
}

proptest! {
    #[test]
    fn programs_have_the_values_of_their_polynomials(
        rows in prop::collection::vec(
            prop::collection::vec(
                (0u32..4, any::<bool>(), prop::collection::vec((0u32..5, 1u32..4), 0..4)),
                0..9,
            ),
            0..5,
        ),
        seed: u64,
    ) {
        let term = |(id, negative, powers): (u32, bool, Vec<(Var, u32)>)| Term {
            coefficient: Coefficient { id, negative },
            monomial: Monomial::from_powers(powers),
        };
        let rows: Vec<Vec<Term>> = rows
            .into_iter()
            .map(|row| row.into_iter().map(term).collect())
            .collect();
        checked(&rows, seed);
    }
}
