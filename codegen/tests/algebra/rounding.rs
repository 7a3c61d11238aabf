//! Rounding analysis: cancellation is detected, and errors are within their bounds.

use hamel_algebra::graph::{Function, Graph};
use hamel_algebra::rounding::{evaluate_rounded, evaluate_with_bounds};
use num_bigint::BigInt;
use num_rational::BigRational;

/// (1 + d) − 1 with d = 1e-9 / 7, which loses half of its digits.
#[test]
fn cancellation_is_seen() {
    let mut graph = Graph::new(1);
    let pi = graph.symbol("pi", 0, hamel_algebra::residue_pair::ResiduePair::PI);
    let x = graph.symbol(
        "x",
        2,
        hamel_algebra::residue_pair::Random::new(3).element(),
    );
    let small = graph.rational(&BigRational::new(
        BigInt::from(1),
        BigInt::from(7_000_000_000_i64),
    ));
    let product = graph.mul(small, x);
    let angle = graph.add(pi, product);
    let sine = graph.apply(Function::Sin, angle);
    let only = evaluate_rounded(&graph, &[sine], &[0.0, 1.0])[0];
    let wanted = (1e-9_f64 / 7.0).sin();
    // sin(π + d) = −sin d is recognised; in either form, the exact value is right.
    assert!((only.exact.to_f64().abs() - wanted).abs() < 1e-24);
    let bound = evaluate_with_bounds(&graph, &[angle], &[0.0, 1.0])[0];
    assert!(bound.error > 1e-16 && bound.error < 2e-15);
    assert!(
        (evaluate_rounded(&graph, &[angle], &[0.0, 1.0])[0].rounded - bound.value).abs()
            <= bound.error
    );
}
