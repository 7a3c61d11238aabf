//! That care rejects the cheapest program, where it should.

use hamel_codegen::algebra::double::Double;
use hamel_codegen::generate::from_text;
use hamel_codegen::program::count::count;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::program::{FunctionId, Program};

/// Springs of the fourth power about places near the start, far from the origin. The slope of their force
/// is Σ (x − c)², and expanded it is cheaper: a x² + b x + c, the difference of large terms. The constraint
/// is there because states are then measured near the start alone. Near the origin, where START is 0.1, nothing is lost.
const TEXT: &str = "system Far {
    coord x, y, z; velocity u, v; rate x = u; rate y = y * v; rate z = -z * v;
    constraint y * z = 1; kinetic (u^2 + v^2) / 2;
    potential ((x - 999)^4 + (x - 1000)^4 + (x - 1001)^4 + (x - 1002)^4) / 12;
    start x = START, y = 1, z = 1;
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

fn emitted(start: &str) -> Program {
    let generated = from_text(&TEXT.replace("START", start));
    generated
        .unwrap_or_else(|errors| panic!("{errors:?}"))
        .program
}

/// What is emitted keeps the digits that the cheapest program loses, for some operations more.
#[test]
fn the_cheapest_program_is_rejected_for_its_digits() {
    let (cheapest, careful) = (emitted("0.1"), emitted("1000.1"));
    for x in [1000.1, 1000.7, 1001.3] {
        let (lost, cost) = digits_and_cost(&cheapest, x);
        let (kept, price) = digits_and_cost(&careful, x);
        assert!(
            lost > 4.0 && kept < 1.5,
            "{x}: {lost} digits, {kept} digits"
        );
        assert!(cost < price, "{x}: {cost} operations, {price} operations");
    }
}
