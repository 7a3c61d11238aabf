//! Kinetic energy T = ½ M_ij ξⁱ ξʲ, potential energy V, and power.

use crate::algebra::graph::Edge;
use crate::algebra::linear::{add3, apply3};
use crate::model::Model;

/// V(x): potentials that the user wrote, and −m ⟨g, p⟩ of bodies and particles, KR18 (48).
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

/// T = ½ ξᵀ M ξ.
pub fn kinetic(model: &mut Model, mass: &[Vec<Edge>]) -> Edge {
    let graph = &mut model.graph;
    let momentum: Vec<Edge> = mass.iter().map(|row| graph.dot(row, &model.xi)).collect();
    let twice = graph.dot(&momentum, &model.xi);
    let half = graph.ratio(1, 2);
    graph.mul(half, twice)
}
