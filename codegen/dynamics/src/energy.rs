//! Kinetic energy T = ½ M_ij ξⁱ ξʲ, potential energy V, and momentum p = ∂T/∂ξ.

use super::calculus::Calculus;
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::Edge;
use hamel_algebra::linear::{add3, apply3};
use hamel_language::model::Model;

/// Returns the potential energy V(x) as an expression: potentials given by the user, and −m ⟨g, p⟩ of bodies and
/// particles, KR18 (48).
pub fn potential(model: &mut Model) -> Edge {
    let graph = &mut model.graph;
    let mut potential = model.potential;
    let mut points = Vec::new();
    for body in &model.bodies {
        let frame = &model.frames[body.frame];
        let arm = apply3(graph, &frame.rotation, body.com);
        points.push((body.mass, add3(graph, frame.position, arm)));
    }
    points.extend(
        model
            .particles
            .iter()
            .map(|particle| (particle.mass, particle.position)),
    );
    for (mass, point) in points {
        let weight = model.gravity.map(|g| graph.mul(mass, g));
        let work = graph.dot(&weight, &point);
        potential = graph.sub(potential, work);
    }
    potential
}

/// Returns the kinetic energy T = ½ ξᵀ M ξ as an expression.
pub fn kinetic(model: &mut Model, mass: &[Vec<Edge>]) -> Edge {
    let graph = &mut model.graph;
    let momentum: Vec<Edge> = mass.iter().map(|row| graph.dot(row, &model.xi)).collect();
    let twice = graph.dot(&momentum, &model.xi);
    let half = graph.ratio(1, 2);
    graph.mul(half, twice)
}

/// Returns T from the velocities of points and bodies, ½ Σ m |ċ|² + ½ Σ ω · Θ ω, plus the energy
/// given as `kinetic`.
///
/// This is T₂ + T₁ + T₀ if ẋ has terms without ξ.
pub fn kinetic_of_bodies(model: &mut Model, calculus: &mut Calculus) -> Edge {
    let graph = &mut model.graph;
    let mut twice = Vec::new();
    for body in &model.bodies {
        let frame = &model.frames[body.frame];
        let arm = apply3(graph, &frame.rotation, body.com);
        let centre = add3(graph, frame.position, arm);
        let velocity = calculus.rate3(graph, centre);
        let square = graph.dot(&velocity, &velocity);
        twice.push(graph.mul(body.mass, square));
        let omega = calculus.spin(graph, &frame.rotation);
        let spin = apply3(graph, &body.inertia_com, omega);
        twice.push(graph.dot(&omega, &spin));
    }
    for particle in &model.particles {
        let velocity = calculus.rate3(graph, particle.position);
        let square = graph.dot(&velocity, &velocity);
        twice.push(graph.mul(particle.mass, square));
    }
    let half = graph.ratio(1, 2);
    let sum = graph.sum(&twice);
    let moved = graph.mul(half, sum);
    graph.add(moved, model.kinetic)
}

/// Returns the part of T in the energy ẋ · ∂L/∂ẋ − L.
///
/// Of the energy given as `kinetic` this is T₂ − T₀, as its terms that are linear in the velocities
/// do no work, and those without velocities act as a potential. Of moving points and bodies it is
/// their kinetic energy in space.
pub fn kinetic_in_energy(model: &mut Model, kinetic: Edge) -> Edge {
    model.graph.sub(kinetic, model.gyroscopic)
}

/// Returns T₁ + 2 T₀, by degrees in ẋ, of the energy given as `kinetic`.
///
/// This is ṫ times the derivative of T by the rate ṫ of time at fixed rates of all other
/// coordinates, Σ Yⁱₜ ∂T/∂ξⁱ, where Y is given by rows.
pub fn gyroscopic_energy(model: &mut Model, y: &[Vec<Edge>]) -> Edge {
    let Some(clock) = model.clock else {
        return model.graph.zero();
    };
    let momentum = momentum(model, model.kinetic);
    let graph = &mut model.graph;
    let column: Vec<Edge> = y.iter().map(|row| row[clock.x]).collect();
    let sum = graph.dot(&column, &momentum);
    graph.mul(model.xi[clock.xi], sum)
}

/// Returns the generalised momenta p = ∂T/∂ξ of a kinetic energy as expressions.
pub fn momentum(model: &mut Model, kinetic: Edge) -> Vec<Edge> {
    let graph = &mut model.graph;
    let one = graph.one();
    let by = model
        .xi
        .iter()
        .map(|xi| Derivation::new([(xi.node(), one)]));
    by.map(|mut by| by.of(graph, kinetic)).collect()
}
