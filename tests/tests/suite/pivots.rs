//! The attribution of guards to velocities: the pivot of a velocity is between its inertia with all others fixed, Mᵢᵢ,
//! and its inertia with all others free, 1/(M⁻¹)ᵢᵢ, for any order of the factorisation of M; for every model of the
//! tests.

use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::program::{Cause, Program};
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::path::Path;

/// Relative rounding of M and of its inverse.
const TOLERANCE: f64 = 1e-9;

/// Returns the guards of velocities, with their values at the start.
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
    let all = crate::models::models(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/models")));
    let (of, all) = (all.len(), crate::thinning::thin_out(all));
    let compared = all.par_iter().filter_map(|path| {
        let asked = "accel, mass_matrix, linearize, velocity_from_momentum";
        // M is not available for all systems with constraints.
        let generated = crate::models::asked_for(path, asked).ok()?;
        let program = &generated.program;
        let mass = mass(&generated);
        let inverse = mass.clone().try_inverse()?;
        let pivots = pivots(program, &program.defaults);
        for &(place, pivot) in &pivots {
            let (least, most) = (1.0 / inverse[(place, place)], mass[(place, place)]);
            assert!(
                (1.0 - TOLERANCE) * least <= pivot && pivot <= (1.0 + TOLERANCE) * most,
                "{}: `{}`: {least} <= {pivot} <= {most}",
                path.display(),
                program.velocity(place)
            );
        }
        Some(pivots.len())
    });
    let compared: Vec<usize> = compared.collect();
    let (models, compared) = (compared.len(), compared.iter().sum::<usize>());
    assert!(
        models > 40 * all.len() / of && compared > 100 * all.len() / of,
        "{models}, {compared}"
    );
}
