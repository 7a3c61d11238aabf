//! Values of functions at a point: like terms are combined, and twelfths of a turn are exact.

use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Function;
use hamel_algebra::residue_pair::ResiduePair;
use num_rational::BigRational;

/// Values that are 0 at a point are 0 in arguments of functions, and like terms of written-out arguments are combined.
#[test]
fn forms_are_collected() {
    let mut point = FieldPoint::new();
    let [a, b, zero] = [ResiduePair::new(7), ResiduePair::new(5), ResiduePair::ZERO];
    let rational = |n: i64, d: i64| BigRational::new(n.into(), d.into());
    // b = −2/3 a, so that a/3 − b/3 = 5/9 a.
    point.set_linear_form(b, vec![(a, rational(-2, 3))]);
    for function in [Function::Sin, Function::Exp, Function::Tanh] {
        let mut at = |form: &[(ResiduePair, i64, i64)]| {
            let form = form.iter().map(|&(atom, n, d)| (atom, rational(n, d)));
            point.function(function, ResiduePair::ZERO, &form.collect())
        };
        assert_eq!(at(&[(a, 1, 3), (b, -1, 3)]), at(&[(a, 5, 9)]));
        assert_eq!(at(&[(a, 1, 3), (-a, 1, 3)]), at(&[]));
        assert_eq!(at(&[(a, 1, 3), (zero, 1, 1)]), at(&[(a, 1, 3)]));
    }
}

/// Sines and cosines of twelfths of π are the expected roots, in both fields.
#[test]
fn twelfths_of_a_turn_are_exact() {
    let mut point = FieldPoint::new();
    let mut at = |function, n: i64| {
        let form = vec![(ResiduePair::PI, BigRational::new(n.into(), 12.into()))];
        point.function(function, ResiduePair::ZERO, &form)
    };
    let half = ResiduePair::new(2).inv().expect("odd");
    assert_eq!(at(Function::Sin, 2), half);
    assert_eq!(at(Function::Cos, 8), -half);
    for n in -30..30 {
        let (sin, cos) = (at(Function::Sin, n), at(Function::Cos, n));
        assert_eq!(sin * sin + cos * cos, ResiduePair::ONE);
        assert_eq!(at(Function::Sin, -n), -sin);
        assert_eq!(at(Function::Sin, n + 12), -sin);
        assert_eq!(at(Function::Cos, 6 - n), sin);
    }
}
