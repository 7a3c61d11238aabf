//! Derives and evaluates descriptions of `models/`, with tolerances for comparisons.

use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::render::render;
use std::path::Path;

/// Rounding of a few hundred operations.
pub const TOLERANCE: f64 = 1e-11;

#[track_caller]
pub fn assert_near(what: &str, found: f64, expected: f64, bound: f64) {
    let apart = (found - expected).abs() / expected.abs().max(1.0);
    assert!(apart <= bound, "{what}: {found}, expected {expected}");
}

pub fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.eom"));
    std::fs::read_to_string(path).expect("the model is in the repository")
}

pub fn generated(text: &str) -> Generated {
    from_text(text)
        .unwrap_or_else(|errors| panic!("{}", render(&errors, "description", text, false)))
}

pub fn value(of: &Generated, name: &str, [x, xi, u]: [&[f64]; 3]) -> Vec<f64> {
    let function = of.program.function(name).expect("it is generated");
    let compiled = Interpreter::new(&of.program, function, &of.program.defaults);
    compiled
        .call(x, xi, u, &vec![0.0; xi.len()])
        .expect("no pivot vanishes")
}

/// Returns states of a few numbers, the same on every machine.
pub fn states<const N: usize>() -> impl Iterator<Item = [f64; N]> {
    (1..8).map(|k| std::array::from_fn(|i| (1.7 * (k * (i + 2)) as f64).sin() * 1.3))
}
