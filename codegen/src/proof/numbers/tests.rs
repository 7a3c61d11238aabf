//! The numbers are those of the symbolic derivations, and a term that is wrong anywhere is noticed.

use super::Numbers;
use crate::algebra::graph::Edge;
use crate::algebra::numeric::evaluate_at;
use crate::generate::{Generated, from_text};
use crate::proof::forms::Symbols;
use crate::proof::validate::{COMPARED, compared};

/// Everything that has a route of its own: bodies with their centres beside the origin, a particle, a
/// kinetic energy that was written, noncommuting velocities, loads and dampers of all kinds.
const MODEL: &str = "system Whole {
    param m = 1.3, g = 9.81, J = 0.02, k = 3, c = 0.4;
    param s: vec3 = [0.1, -0.2, 0.3];
    param Theta: sym3 = [[2.1, 0.1, -0.2], [0.1, 1.7, 0.15], [-0.2, 0.15, 1.2]];
    coord r: R3, R: SO3, q, a: S1;
    velocity v: vec3, w: vec3, u, b;
    rate r = R * v;
    rate R = R * hat(w);
    rate q = u;
    rate a = b - u;
    frame hull = pose(R, r);
    frame arm on hull = pose(rotx(q), [0.2, 0, 0.1]);
    frame hand on arm = pose(rotz(a), [0, 0.3, 0]);
    body on hull { mass m; com s; inertia Theta about origin; }
    body on arm { mass 0.7; com s; inertia Theta about com; }
    body on hand { mass 0.2; com [0, 0.1, 0]; inertia Theta about com; }
    particle mass 0.3 at r + R * [1, q, q^2];
    kinetic J / 2 * (u + q * b)^2;
    potential k / 2 * q^2;
    gravity [0, 0, -g];
    input F: vec3, tau: vec3;
    wrench (F, tau) on hull in body;
    wrench (tau, F) on arm in world;
    dissipation c / 2 * u^2;

}";

fn generated(text: &str) -> Generated {
    from_text(text).unwrap_or_else(|errors| panic!("{errors:?}"))
}

#[test]
fn the_numbers_are_those_of_the_symbolic_derivations() {
    let model = generated(MODEL).model;
    let symbols = Symbols::new(&model).expect("Y");
    let graph = &symbols.geometry.model.graph;
    let numbers = Numbers::new(&model).expect("Y");
    for seed in 1..4 {
        let lane = model.points.lane(seed).expect("a point");
        let values = numbers.at(&lane).expect("values").expect("Y A = I");
        let at = |edges: &[Edge]| evaluate_at(graph, edges, &mut lane.clone()).expect("values");
        assert_eq!(values.left[0], values.left[1], "(30a) = (30b)");
        assert_eq!(values.left[0], values.left[2], "(30a) = (30c)");
        assert_eq!(values.left[0], at(&symbols.hamel));
        assert_eq!(values.left[1], at(&symbols.gibbs));
        assert_eq!(values.mass.concat(), at(&symbols.geometry.mass.concat()));
        assert_eq!(values.force, at(&symbols.virtual_work));
        assert_eq!(vec![values.kinetic], at(&[symbols.kinetic]));
        assert_eq!(vec![values.potential], at(&[symbols.geometry.potential]));
    }
}

#[test]
fn a_wrong_term_of_any_function_is_refused() {
    let Generated { model, program, .. } = generated(MODEL);
    assert!(compared(&model, &program).is_ok());
    let mut refused = 0;
    for index in 0..program.functions.len() {
        if !COMPARED.contains(&program.functions[index].name.as_str()) {
            continue;
        }
        let last = program.functions[index].outputs.len() - 1;
        for place in [0, last / 2, last] {
            let mut broken = program.clone();
            let one = broken.graph.one();
            let entry = broken.functions[index].outputs[place];
            broken.functions[index].outputs[place] = broken.graph.add(entry, one);
            let name = &program.functions[index].name;
            assert!(compared(&model, &broken).is_err(), "{name} {place}");
            refused += 1;
        }
    }
    assert!(refused > 30);
}
