//! The numbers are those of the symbolic derivations.

use super::Numbers;
use crate::algebra::graph::Edge;
use crate::algebra::numeric::evaluate_at;
use crate::proof::forms::Symbols;
use crate::syntax::parse_text;

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

#[test]
fn the_numbers_are_those_of_the_symbolic_derivations() {
    let system = parse_text(MODEL).expect("a description");
    let model = crate::lower::build(&system).expect("a model");
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
