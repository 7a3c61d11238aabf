//! Bases and normal forms, compared with an independent implementation and checked by their laws.

use super::polynomials;
use groebner as independent;
use hamel_algebra::poly::buchberger::{LimitExceeded, Limits, groebner};
use hamel_algebra::poly::field::Field;
use hamel_algebra::poly::ideals::{circle, quaternion, rotation};
use hamel_algebra::poly::monomial::Var;
use hamel_algebra::poly::normal_form::Basis;
use hamel_algebra::poly::order::Order;
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::residue_pair::{Random, ResiduePair};
use independent::PolynomialExt;
use num_rational::BigRational as Q;
use proptest::prelude::*;

const R: [Var; 9] = [0, 1, 2, 3, 4, 5, 6, 7, 8];

fn basis<F: Field>(generators: &[Poly<F>], order: Order) -> Basis<F> {
    groebner(generators, order, Limits::default()).expect("within the limits")
}

fn x<F: Field>(v: Var) -> Poly<F> {
    Poly::var(v)
}

fn n<F: Field>(value: i64) -> Poly<F> {
    Poly::constant(F::integer(value))
}

/// Returns the sum of the parts minus a constant.
fn equation<F: Field>(parts: &[Poly<F>], value: i64) -> Poly<F> {
    parts.iter().fold(n(-value), |sum, part| sum.add(part))
}

/// Returns a four-bar with absolute angles (c, s), three rods of lengths 2, 5, 4 and base 6.
fn four_bar<F: Field>() -> Vec<Poly<F>> {
    let loops = |k: u32, length| {
        let sum = [n(2).mul(&x(k)), n(5).mul(&x(2 + k)), n(-4).mul(&x(4 + k))];
        equation(&sum, length)
    };
    let circles = [circle(0, 1), circle(2, 3), circle(4, 5)].concat();
    [circles, vec![loops(0, 6), loops(1, 0)]].concat()
}

fn determinant<F: Field>() -> Poly<F> {
    let product = |i: u32, j: u32, k: u32| x::<F>(i % 3).mul(&x(3 + j % 3)).mul(&x(6 + k % 3));
    (0..3).fold(Poly::zero(), |sum, i| {
        let minor = product(i, i + 1, i + 2).sub(&product(i, i + 2, i + 1));
        sum.add(&minor)
    })
}

type Theirs = independent::Polynomial<Q>;

fn text(f: &Poly<Q>) -> String {
    let terms = f.terms().iter().map(|(monomial, c)| {
        let powers = monomial.powers().iter();
        powers.fold(format!("({c})"), |text, (v, e)| format!("{text}*x{v}^{e}"))
    });
    let terms: Vec<String> = terms.collect();
    match terms.len() {
        0 => "0".to_string(),
        _ => terms.join(" + "),
    }
}

fn translate(list: &[Poly<Q>], variables: u32, order: Order) -> Vec<Theirs> {
    let order = match order {
        Order::Grevlex => independent::MonomialOrder::GRevLex,
        Order::Lex => independent::MonomialOrder::Lex,
        Order::Block(split) => {
            let (big, small) = (split.min(variables), variables.saturating_sub(split));
            independent::MonomialOrder::elimination(big as usize, small as usize)
        }
    };
    let names: Vec<String> = (0..variables).map(|v| format!("x{v}")).collect();
    let ring = independent::PolynomialRing::<Q>::new(names, order).expect("ring");
    let parsed = list
        .iter()
        .map(|f| ring.parse(&text(f)).expect("polynomial"));
    parsed.collect()
}

fn assert_same_basis(generators: &[Poly<Q>], variables: u32, order: Order) -> Basis<Q> {
    let ours = basis(generators, order);
    let list: Vec<Poly<Q>> = ours.polynomials().cloned().collect();
    let translated = translate(generators, variables, order);
    let mut theirs = independent::groebner_basis_f4(translated, true).expect("basis");
    let mut ours_there = translate(&list, variables, order);
    theirs.sort_by_key(|f| format!("{:?}", f.terms));
    ours_there.sort_by_key(|f| format!("{:?}", f.terms));
    assert_eq!(ours_there, theirs);
    ours
}

#[test]
fn rotations_have_twenty_quadrics() {
    let so3 = basis::<Q>(&rotation(R), Order::Grevlex);
    assert_eq!(so3.polynomials().len(), 20);
    assert!(so3.polynomials().all(|f| f.degree() == 2));
}

#[test]
fn bases_agree_with_the_independent_implementation() {
    for order in [Order::Grevlex, Order::Lex, Order::Block(3)] {
        assert_same_basis(&circle(0, 1), 2, order);
        assert_same_basis(&quaternion([0, 1, 2, 3]), 4, order);
        assert_same_basis(&rotation(R), 9, order);
        let elbow = four_bar().into_iter().map(|f| f.substitute(5, &n(0)));
        assert_same_basis(&elbow.collect::<Vec<_>>(), 6, order);
    }
    let loop_basis = assert_same_basis(&four_bar(), 6, Order::Grevlex);
    assert_eq!(loop_basis.polynomials().len(), 9);
    assert_same_basis(&four_bar(), 6, Order::Block(2));
}

#[test]
fn determinant_alone_gives_the_same_rotations() {
    let so3 = basis::<Q>(&rotation(R), Order::Grevlex);
    let mut minimal: Vec<Poly<Q>> = Vec::new();
    for i in 0..3 {
        for j in i..3 {
            let dot = (0..3).map(|k| x(3 * k + i).mul(&x(3 * k + j)));
            let parts: Vec<Poly<Q>> = dot.collect();
            minimal.push(equation(&parts, i64::from(i == j)));
        }
    }
    minimal.push(determinant().sub(&n(1)));
    let again = basis(&minimal, Order::Grevlex);
    assert!(again.polynomials().eq(so3.polynomials()));
}

/// γ^k_ij of SO(3) in x-free form: Y_k·(d_i A_j − d_j A_i) with d_i = (R ê_i) : ∂/∂R is constant.
#[test]
fn structure_coefficients_of_rotations_are_constant() {
    let so3 = basis::<Q>(&rotation(R), Order::Grevlex);
    // Column i of A: Ṙ = R ê_i.
    let hat = |i: usize| -> [[i64; 3]; 3] {
        let mut matrix = [[0; 3]; 3];
        matrix[(i + 2) % 3][(i + 1) % 3] = 1;
        matrix[(i + 1) % 3][(i + 2) % 3] = -1;
        matrix
    };
    let column = |i: usize| -> Vec<Poly<Q>> {
        let entry = |row: usize, column: usize| {
            (0..3).fold(Poly::zero(), |sum, k| {
                sum.add(&x(R[3 * row + k]).scale(&Q::integer(hat(i)[k][column])))
            })
        };
        (0..9).map(|a| entry(a / 3, a % 3)).collect()
    };
    let along = |i: usize, f: &Poly<Q>| {
        let directions = column(i);
        (0..9).fold(Poly::zero(), |sum, a| {
            sum.add(&f.derivative(R[a]).mul(&directions[a]))
        })
    };
    for (i, j, k) in (0..27).map(|n| (n / 9, n / 3 % 3, n % 3)) {
        for equation in rotation::<Q>(R) {
            assert!(so3.contains(&along(i, &equation)));
        }
        // Y_k = ½ (R ê_k) : ·, a left inverse of A.
        let (ai, aj, yk) = (column(i), column(j), column(k));
        let gamma = (0..9).fold(Poly::zero(), |sum, a| {
            let bracket = along(i, &aj[a]).sub(&along(j, &ai[a]));
            sum.add(&yk[a].mul(&bracket))
        });
        let sign = match (j + 3 - i) % 3 {
            1 if k == (i + 2) % 3 => 2,
            2 if k == (i + 1) % 3 => -2,
            _ => 0,
        };
        assert_eq!(so3.normal_form(&gamma), n(sign));
        // A cubic factor that is 1 on the variety has no effect.
        assert_eq!(so3.normal_form(&gamma.mul(&determinant())), n(sign));
    }
}

#[test]
fn limits_stop_the_search() {
    let limits = Limits {
        pairs: 3,
        ..Limits::default()
    };
    let result = groebner::<Q>(&rotation(R), Order::Grevlex, limits);
    assert_eq!(result.map(|_| ()), Err(LimitExceeded));
    let limits = Limits {
        work: 50,
        ..Limits::default()
    };
    let result = groebner::<Q>(&four_bar(), Order::Lex, limits);
    assert_eq!(result.map(|_| ()), Err(LimitExceeded));
}

/// Returns a random point of SO(3), from a quaternion of any length.
fn rotation_point(random: &mut Random) -> Vec<ResiduePair> {
    loop {
        let q: Vec<ResiduePair> = (0..4).map(|_| random.element()).collect();
        let norm = q.iter().fold(ResiduePair::ZERO, |sum, &a| sum + a * a);
        let Some(inverse) = norm.inv() else { continue };
        let two = ResiduePair::from_i64(2);
        let entry = |i: usize, j: usize| {
            let v = |k: usize| q[k % 3 + 1];
            let mixed = match (j + 3 - i) % 3 {
                0 => q[0] * q[0] - (norm - q[0] * q[0]),
                1 => -two * q[0] * v(i + 2),
                _ => two * q[0] * v(i + 1),
            };
            (mixed + two * v(i) * v(j)) * inverse
        };
        return (0..9).map(|a| entry(a / 3, a % 3)).collect();
    }
}

fn polynomial() -> impl Strategy<Value = Poly<ResiduePair>> {
    let powers = prop::collection::vec((0u32..9, 1u32..3), 0..4);
    polynomials(powers, -9..10, 1..6)
}

proptest! {
    #[test]
    fn normal_forms_are_projections_modulo_the_ideal(
        f in polynomial(), g in polynomial(), which in 0usize..21, seed: u64,
    ) {
        for order in [Order::Grevlex, Order::Lex, Order::Block(4)] {
            let so3 = basis(&rotation::<ResiduePair>(R), order);
            let normal = so3.normal_form(&f);
            prop_assert_eq!(&so3.normal_form(&normal), &normal);
            prop_assert!(so3.contains(&g.mul(&rotation(R)[which])));
            let shifted = f.add(&g.mul(&rotation(R)[which]));
            prop_assert_eq!(&so3.normal_form(&shifted), &normal);
            let point = rotation_point(&mut Random::new(seed));
            let at = |v: Var| point[v as usize];
            prop_assert_eq!(f.eval(&at), normal.eval(&at));
        }
    }

    #[test]
    fn normal_forms_agree_with_the_independent_implementation(f in polynomial()) {
        let small = |c: &ResiduePair| c.to_small_rational(8).map(|(n, _)| Q::integer(n));
        let f = f.map(small).expect("small integers");
        let so3 = basis::<Q>(&rotation(R), Order::Grevlex);
        let list: Vec<Poly<Q>> = so3.polynomials().cloned().collect();
        let theirs = translate(&list, 9, Order::Grevlex);
        let input = translate(&[f.clone(), so3.normal_form(&f)], 9, Order::Grevlex);
        prop_assert_eq!(&input[0].normal_form(&theirs), &input[1]);
    }
}
