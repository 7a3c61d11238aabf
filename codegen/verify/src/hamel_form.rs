//! The equations of Lagrange and Hamel, KR18 (30a), from T, V and γ:
//! d/dt ∂L/∂ξⁱ + γᵢⱼᵏ ξʲ ∂L/∂ξᵏ − ∂ᵢL = fᵢ with L = T − V (N or N m, n entries).
//!
//! T is not taken from M, but from the velocities of bodies and particles.

use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::Edge;
use hamel_algebra::linear::{add3, apply3, cross};
use hamel_dynamics::calculus::{Calculus, into_frame};
use hamel_language::model::Model;

/// Returns the kinetic energy T(x, ξ) = Σ ½ m ‖v_c‖² + ½ ω·Θω + Σ ½ m ‖ṙ‖², plus the kinetic energy that the user wrote
/// (J), as an expression.
///
/// v_c and ω are in body axes, Θ is about the centre of mass. `motion` is d/dt along ẋ = A ξ.
pub fn kinetic_energy(model: &mut Model, motion: &mut Calculus) -> Edge {
    let mut twice = Vec::new();
    for body in model.bodies.clone() {
        let frame = model.frames[body.frame].clone();
        let graph = &mut model.graph;
        let omega = motion.spin(graph, &frame.rotation);
        let moved = motion.rate3(graph, frame.position);
        let origin = into_frame(graph, &frame.rotation, moved);
        let lever = cross(graph, omega, body.com);
        let velocity = add3(graph, origin, lever);
        let square = graph.dot(&velocity, &velocity);
        let spun = apply3(graph, &body.inertia_com, omega);
        twice.push(graph.mul(body.mass, square));
        twice.push(graph.dot(&omega, &spun));
    }
    for particle in model.particles.clone() {
        let graph = &mut model.graph;
        let velocity = motion.rate3(graph, particle.position);
        let square = graph.dot(&velocity, &velocity);
        twice.push(graph.mul(particle.mass, square));
    }
    let graph = &mut model.graph;
    let sum = graph.sum(&twice);
    let half = graph.ratio(1, 2);
    let energy = graph.mul(half, sum);
    graph.add(energy, model.kinetic)
}

/// Returns the derivatives ∂f/∂ξⁱ of an expression by the velocity coordinates, for all i.
pub fn velocity_gradient(model: &mut Model, f: Edge) -> Vec<Edge> {
    let graph = &mut model.graph;
    let one = graph.one();
    model
        .xi
        .iter()
        .map(|xi| Derivation::new([(xi.node(), one)]).of(graph, f))
        .collect()
}

/// Returns the left side of Hamel's equations (30a), d/dt ∂T/∂ξⁱ + γᵢⱼᵏ ξʲ ∂T/∂ξᵏ − ∂ᵢ(T − V), as expressions in (x, ξ,
/// ξ̇). `motion` is d/dt along ẋ = A ξ with ξ̇ as symbols.
pub fn hamel_form(
    model: &mut Model,
    motion: &mut Calculus,
    gamma: &[Vec<Vec<Edge>>],
    kinetic: Edge,
    potential: Edge,
) -> Vec<Edge> {
    // V does not depend on ξ: ∂L/∂ξ = ∂T/∂ξ.
    let momentum = velocity_gradient(model, kinetic);
    let xi = model.xi.clone();
    let graph = &mut model.graph;
    let lagrangian = graph.sub(kinetic, potential);
    (0..xi.len())
        .map(|i| {
            let mut force = motion.rate(graph, momentum[i]);
            for (j, &speed) in xi.iter().enumerate() {
                let row = graph.dot(&gamma[i][j], &momentum);
                let product = graph.mul(row, speed);
                force = graph.add(force, product);
            }
            let slope = motion.along(graph, i, lagrangian);
            graph.sub(force, slope)
        })
        .collect()
}
