//! Digits that the functions of a program lose to rounding, found by evaluating each in `f64` and in twice that
//! precision at the same states.
//!
//! A function loses log₁₀(max ‖f − f*‖ / u max ‖f*‖) digits, where f is its result in `f64`, f* its result in twice the
//! precision, both maxima are over the states, norms are largest entries, and u = 2^-53. So a result that happens to be
//! 0 at one state is measured relative to its size at the others.

use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::rounding::{RoundedValue, UNIT_ROUNDOFF, evaluate_rounded};

/// Results that are measured together: the entries of a function, and the pivots that have to be positive for it to
/// have a value.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    /// Entries of the result.
    pub outputs: &'a [Edge],
    /// Pivots that have to be positive.
    pub guards: &'a [Edge],
}

/// Returns the decimal digits that each function loses to rounding.
///
/// Each state lists the values of all symbols. The entry of a function is `None` if it has no value at any of the
/// states, or is 0 at all of them.
pub fn digits_lost(graph: &Graph, functions: &[Measured], states: &[Vec<f64>]) -> Vec<Option<f64>> {
    let mut sizes = vec![(0.0_f64, 0.0_f64); functions.len()];
    let roots: Vec<Edge> = functions
        .iter()
        .flat_map(|function| function.outputs.iter().chain(function.guards).copied())
        .collect();
    for state in states {
        let values = evaluate_rounded(graph, &roots, state);
        let mut rest = values.as_slice();
        for (function, (error, size)) in functions.iter().zip(&mut sizes) {
            let (outputs, after) = rest.split_at(function.outputs.len());
            let (guards, after) = after.split_at(function.guards.len());
            rest = after;
            if let Some((apart, largest)) = compared(outputs, guards) {
                *error = error.max(apart);
                *size = size.max(largest);
            }
        }
    }
    let digits = |(error, size): (f64, f64)| {
        (size > 0.0).then(|| (error / (UNIT_ROUNDOFF * size)).max(1.0).log10())
    };
    sizes.into_iter().map(digits).collect()
}

/// Returns the largest error and the largest entry of a function at one state; `None` if it has no value there.
///
/// The error is infinite if an entry has a value, but not in `f64`.
fn compared(outputs: &[RoundedValue], guards: &[RoundedValue]) -> Option<(f64, f64)> {
    let exists = |value: &RoundedValue| value.exact.to_f64().is_finite();
    let positive = |pivot: &RoundedValue| pivot.exact.to_f64() > 0.0;
    if !outputs.iter().all(exists) || !guards.iter().all(positive) {
        return None;
    }
    let (mut error, mut size) = (0.0_f64, 0.0_f64);
    for entry in outputs {
        let apart = entry.rounding_error();
        error = error.max(if apart.is_nan() { f64::INFINITY } else { apart });
        size = size.max(entry.exact.to_f64().abs());
    }
    Some((error, size))
}
