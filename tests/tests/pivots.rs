//! What a guard is said to belong to: the pivot of a velocity lies between what inertia it has with all others held,
//! Mᵢᵢ, and with all others free to follow, 1/(M⁻¹)ᵢᵢ, in whatever order M was factored; on every model of the tests.

#[path = "../../codegen/tests/common/models.rs"]
mod models;

use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::program::{Cause, Program};
use nalgebra::DMatrix;
use std::path::Path;

/// Roundings of M and of its inverse.
const CLOSE: f64 = 1e-9;

/// Guards of velocities, with their values at the start.
fn pivots(program: &Program, params: &[f64]) -> Vec<(usize, f64)> {
    let functions = program.functions.iter();
    let guards = functions.flat_map(|function| &function.guards);
    let guards: Vec<Edge> = guards.chain(&program.constant_guards).copied().collect();
    let mut symbols = vec![std::f64::consts::PI];
    symbols.extend_from_slice(params);
    let (xi, z) = program.start_xi.split_at(program.n);
    symbols.extend(&program.start_x);
    symbols.extend(xi);
    symbols.extend(std::iter::repeat_n(0.0, program.m));
    symbols.extend(z);
    symbols.resize(program.graph.symbols().len(), 0.0);
    let values = evaluate(&program.graph, &guards, &symbols);
    let found = guards.iter().zip(values);
    found
        .filter_map(|(&guard, value)| match program.cause(guard) {
            Cause::Velocity(place) => Some((place, value)),
            _ => None,
        })
        .collect()
}

fn mass(generated: &Generated) -> DMatrix<f64> {
    let program = &generated.program;
    let function = program.function("mass_matrix").expect("M");
    let compiled = Interpreter::new(program, function, &program.defaults);
    let value = compiled.call(&program.start_x, &[], &[], &[]);
    DMatrix::from_row_slice(program.n, program.n, &value.expect("no pivots"))
}

#[test]
fn pivots_lie_between_the_inertias_of_their_velocities() {
    let (mut models, mut compared) = (0, 0);
    for path in models::models(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/models"))) {
        let asked = "accel, mass_matrix, linearize, velocity_from_momentum";
        let Ok(generated) = models::asked_for(&path, asked) else {
            // M of systems with constraints is not asked for everywhere.
            continue;
        };
        let program = &generated.program;
        let mass = mass(&generated);
        let Some(inverse) = mass.clone().try_inverse() else {
            continue;
        };
        models += 1;
        for (place, pivot) in pivots(program, &program.defaults) {
            let (least, most) = (1.0 / inverse[(place, place)], mass[(place, place)]);
            compared += 1;
            assert!(
                (1.0 - CLOSE) * least <= pivot && pivot <= (1.0 + CLOSE) * most,
                "{}: `{}`: {least} <= {pivot} <= {most}",
                path.display(),
                program.velocity(place)
            );
        }
    }
    assert!(models > 40 && compared > 100, "{models}, {compared}");
}
