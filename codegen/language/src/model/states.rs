//! Real states at which programs are measured: the start and a few random states with φ = 0, or, with closed loops,
//! the start with several velocities.

use super::Model;
use crate::algebra::residue_pair::Random;

/// Number of random states.
const RANDOM: usize = 2;
/// Distance from the start within which coordinates under constraints are searched for, so that they are on its
/// branch.
const NEAR: f64 = 0.3;

/// Returns the values of all symbols, in `f64`, at the start and at a few other states, with parameters at their
/// defaults.
pub fn states(model: &Model) -> Vec<Vec<f64>> {
    let mut random = Random::new(0x57a7e);
    let mut all = vec![numbers(model, model.start_x.clone(), &mut random)];
    let equations =
        (!model.points.constraints.is_empty()).then(|| model.points.equations(&model.phi));
    // Where a loop is open, the rows of an overconstrained mechanism contradict one another.
    let zero = model.graph.zero();
    let looped = model
        .constraints
        .iter()
        .any(|constraint| constraint.residual != zero);
    for _ in 0..RANDOM {
        if looped {
            all.push(numbers(model, model.start_x.clone(), &mut random));
            continue;
        }
        let Some(equations) = &equations else {
            let blocks = model.blocks.iter();
            let x = blocks.flat_map(|&block| block.point(|| number(&mut random)));
            let x = x.collect();
            all.push(numbers(model, x, &mut random));
            continue;
        };
        let guess = model.start_x.iter().map(|x| x + NEAR * number(&mut random));
        let guess = guess.collect();
        let mut state = numbers(model, guess, &mut random);
        if let Some(x) = equations.solve_near(&state) {
            let first = model.points.first;
            state[first..first + x.len()].copy_from_slice(&x);
            all.push(state);
        }
    }
    all
}

/// Returns values of all symbols, with random velocities, inputs, accelerations and momenta.
fn numbers(model: &Model, x: Vec<f64>, random: &mut Random) -> Vec<f64> {
    let mut list = |count: usize| -> Vec<f64> { (0..count).map(|_| number(random)).collect() };
    let (n, m) = (model.n(), model.u.len());
    let (xi, u, xi_dot, momenta) = (list(n), list(m), list(n), list(n));
    let mut numbers = model.numbers(&model.defaults, &x, &xi, &u, &xi_dot);
    numbers.extend(momenta);
    numbers
}

/// Returns a random number between −1 and 1.
fn number(random: &mut Random) -> f64 {
    (random.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}
