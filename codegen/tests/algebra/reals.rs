//! Real values with error bounds: equal, different and undefined ones.

use crate::common::functions;
use hamel_algebra::function::Slope;
use hamel_algebra::graph::Function;
use hamel_algebra::reals::{Real, contradict};

fn exact(value: f64) -> Real {
    Real::new(value, 0.0)
}

/// Returns whether b cannot replace a.
fn differs(a: Real, b: Real) -> bool {
    contradict(&[a], &[b])
}

#[test]
fn equal_numbers_agree_and_others_differ() {
    let root = |n: f64| exact(n).apply(Function::Sqrt);
    let (two, three) = (root(2.0), root(3.0));
    // √3 − √2 = √(5 − 2√6), and its negative is different.
    let difference = three.plus(two.signed(true));
    let nested = exact(5.0)
        .plus(exact(-2.0).times(root(6.0)))
        .apply(Function::Sqrt);
    assert!(!differs(difference, nested) && differs(difference.signed(true), nested));
    assert!(!differs(two.times(three), root(6.0)));
    // A cancelled sum is 0 within its error, and differs from other small numbers.
    let zero = root(6.0).plus(two.times(three).signed(true));
    assert!(!differs(zero, exact(0.0)) && differs(zero, exact(1e-12)));
}

#[test]
fn what_has_no_value_contradicts_nothing() {
    let unknown = [
        Real::UNKNOWN,
        exact(1.0).over(Real::new(0.0, 1e-16)),
        exact(0.0).apply(Function::Log),
        Real::new(0.0, 1e-16).atan2(exact(-1.0)),
    ];
    for value in unknown {
        assert!(!differs(value, exact(3.0)) && !differs(exact(3.0), value.plus(exact(1.0))));
    }
}

/// √x √x may become x, but not the reverse, which is undefined for x < 0.
#[test]
fn what_has_no_value_stands_for_nothing_that_has_one() {
    let none = exact(-1.0).apply(Function::Sqrt);
    assert!(differs(exact(-1.0), none.times(none)) && !differs(none.times(none), exact(-1.0)));
    assert!(!differs(none, none.plus(exact(1.0))));
    let blurred = Real::new(-1e-17, 1e-16).apply(Function::Sqrt);
    assert!(!differs(exact(1e-9), blurred) && differs(exact(1.0), blurred));
    assert!(differs(exact(2.0), exact(-1.0).apply(Function::Log)));
}

#[test]
fn errors_bound_what_a_perturbation_does() {
    let (a, b, h) = (0.8, 1.7, 1e-7);
    let one = |of: &dyn Fn(Real) -> Real| {
        let (blurred, moved) = (of(Real::new(a, h)), of(exact(a + h)));
        let change = (blurred.value - moved.value).abs();
        assert!(change > 0.0 && change <= blurred.error * (1.0 + 1e-6));
    };
    let moving = |function: &Function| function.row().slope != Slope::Zero;
    for function in functions().filter(moving) {
        one(&|x| x.apply(function));
    }
    one(&|x| x.times(exact(b)));
    one(&|x| exact(b).over(x));
    one(&|x| x.over(exact(b)));
    one(&|x| x.atan2(exact(b)));
    one(&|x| x.plus(exact(b)));
}
