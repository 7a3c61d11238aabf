//! The cheapest program is rejected where it loses too many digits.

use hamel_codegen::algebra::double::Double;
use hamel_codegen::generate::from_text;
use hamel_codegen::program::count::count;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::program::{FunctionId, Program};

/// Potentials (x − a)² (x − b)² with zeros near the start, far from the origin. The slope of their force is a sum of
/// squares and products of such differences; expanded, it is cheaper: a x² + b x + c, the difference of large terms.
/// With the constraint, states are only measured near the start. Near the origin, where START is 0.1, nothing is lost.
const FAR_POTENTIALS: &str = "system Far {
    coord x, y, z; velocity u, v; rate x = u; rate y = y * v; rate z = -z * v;
    constraint y * z = 1; kinetic (u^2 + v^2) / 2;
    potential ((x - 9999)^2 * (x - 10000)^2 + (x - 10001)^2 * (x - 10002)^2) / 2;
    start x = START, y = 1, z = 1;
    generate accel, linearize;
}";

/// Returns the digits that ∂(du/dt)/∂x loses at a position, and the operations of the linearisation.
fn digits_and_cost(program: &Program, x: f64) -> (f64, usize) {
    let function = program.function(FunctionId::Linearize).expect("asked for");
    let compiled = Interpreter::new(program, function, &[]);
    let found = compiled.call(&[x, 1.0, 1.0], &[0.0; 2], &[], &[]);
    // Two displacements and two changes of velocities: row 3, column 1.
    let found = found.expect("a value")[2 * 4];
    let exact = [[9999.0, 10000.0], [10001.0, 10002.0]].map(|places| {
        let [a, b] = places.map(|place| Double::new(x) - Double::new(place));
        a * a + b * b + Double::new(4.0) * a * b
    });
    let exact = -exact
        .into_iter()
        .fold(Double::ZERO, |sum, square| sum + square);
    let error = (Double::new(found) - exact).abs().to_f64() / exact.abs().to_f64();
    let cost = count(&program.graph, &function.outputs).weight();
    ((error / f64::EPSILON).max(1.0).log10(), cost)
}

fn emitted(start: &str) -> Program {
    let generated = from_text(&FAR_POTENTIALS.replace("START", start));
    generated
        .unwrap_or_else(|errors| panic!("{errors:?}"))
        .program
}

/// The emitted program keeps the digits that the cheapest one loses, at the cost of some operations.
#[test]
fn the_cheapest_program_is_rejected_for_its_digits() {
    let (cheapest, careful) = (emitted("0.1"), emitted("10000.1"));
    for x in [10000.1, 10000.7, 10001.3] {
        let (lost, cost) = digits_and_cost(&cheapest, x);
        let (kept, price) = digits_and_cost(&careful, x);
        assert!(
            lost > 4.0 && kept < 1.5,
            "{x}: {lost} digits, {kept} digits"
        );
        assert!(cost < price, "{x}: {cost} operations, {price} operations");
    }
}

/// A hardening spring, −4 s (q − 1)³, in an arm whose second joint is held by a stiff spring.
const HARDENING: &str = "system Springs {
    param m = 0.5, l = 0.3, g = 0, s = 1e6;
    coord q, p; velocity w, v; rate q = w, p = v;
    particle mass m at [l * sin(q), 0, -l * cos(q)];
    particle mass m at [l * sin(q) + l * sin(q + p), 0, -l * cos(q) - l * cos(q + p)];
    gravity [0, 0, -g];
    damper coefficient 0.1 on w;
    potential s * p^2 / 2 + s * (q - 1)^4;
    generate accel, linearize;
}";

/// At half the deflection its force is an eighth, to the last digits: in expanded form, the terms would cancel.
#[test]
fn powers_of_differences_keep_their_digits() {
    let generated = from_text(HARDENING).unwrap_or_else(|errors| panic!("{errors:?}"));
    let program = generated.program;
    let function = program.function(FunctionId::Accel).expect("asked for");
    let compiled = Interpreter::new(&program, function, &[0.5, 0.3, 0.0, 1e6]);
    let pushed = |apart: f64| {
        let found = compiled.call(&[1.0 + apart, 0.0], &[0.0; 2], &[], &[]);
        found.expect("a value")[0]
    };
    for exponent in 5..40 {
        let apart = 0.5_f64.powi(exponent);
        for apart in [apart, -apart] {
            let parts = pushed(apart) / pushed(apart / 2.0);
            assert!((parts - 8.0).abs() < 1e-14, "{apart:e}: {parts}");
        }
    }
}
