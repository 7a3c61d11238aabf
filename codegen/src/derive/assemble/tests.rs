//! That care rejects the cheapest candidate, where it should.

use super::*;
use crate::algebra::double::Double;
use crate::derive::reduction::reduce;
use crate::lower::build;
use crate::program::count::count;
use crate::program::interpret::Interpreter;
use crate::syntax;
use proc_macro2::TokenStream;

/// Springs of the fourth power about places near the start, far from the origin. The slope of their force
/// is Σ (x − c)², and expanded it is cheaper: a x² + b x + c, the difference of large terms. The constraint
/// is there because states are then measured near the start alone.
const TEXT: &str = "system Far {
    coord x, y, z; velocity u, v; rate x = u; rate y = y * v; rate z = -z * v;
    constraint y * z = 1; kinetic (u^2 + v^2) / 2;
    potential ((x - 999)^4 + (x - 1000)^4 + (x - 1001)^4 + (x - 1002)^4) / 12;
    start x = 1000.1, y = 1, z = 1;
    generate accel, linearize;
}";

/// The digits that ∂(du/dt)/∂x loses at a place, and the operations of the linearisation.
fn digits_and_cost(program: &Program, x: f64) -> (f64, usize) {
    let function = program.function(FunctionId::Linearize).expect("asked for");
    let compiled = Interpreter::new(program, function, &[]);
    let found = compiled.call(&[x, 1.0, 1.0], &[0.0; 2], &[], &[]);
    // Two displacements, two changes of velocities: row 3, column 1.
    let found = found.expect("a value")[2 * 4];
    let exact = [999.0, 1000.0, 1001.0, 1002.0].map(|place| {
        let apart = Double::new(x) - Double::new(place);
        apart * apart
    });
    let exact = -exact
        .into_iter()
        .fold(Double::ZERO, |sum, square| sum + square);
    let error = (Double::new(found) - exact).abs().to_f64() / exact.abs().to_f64();
    let cost = count(&program.graph, &function.outputs).weight();
    ((error / f64::EPSILON).max(1.0).log10(), cost)
}

/// What is emitted keeps the digits that the cheapest program loses, for some operations more.
#[test]
fn the_cheapest_candidate_is_rejected_for_its_digits() {
    let tokens: TokenStream = TEXT.parse().expect("tokens");
    let (_, system) = syntax::parse_tokens(tokens);
    let model = build(&system.expect("a system")).expect("a model");
    let reduction = reduce(&model).expect("rows that are solved");
    let reduction = reduction.as_ref();
    let (cheapest, _) =
        put_together(&model, reduction, None, true, &Care::default()).expect("a program");
    let emitted = assemble(&model, reduction, None, true).expect("a program");
    for x in [1000.1, 1000.7, 1001.3] {
        let (lost, cost) = digits_and_cost(&cheapest, x);
        let (kept, price) = digits_and_cost(&emitted, x);
        assert!(
            lost > 4.0 && kept < 1.5,
            "{x}: {lost} digits, {kept} digits"
        );
        assert!(cost < price, "{x}: {cost} operations, {price} operations");
    }
}
