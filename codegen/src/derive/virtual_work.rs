//! Generalised forces by virtual work, KR18 (28): fᵢ = Σ ⟨F, ∂ᵢr⟩ + ⟨τ, ωᵢ⟩ (N or N m, n entries).
//!
//! All in world axes, with ωᵢ from ω̂ᵢ = (∂ᵢR) Rᵀ, while `loads` works in body axes with Rᵀ ∂ᵢR.

use super::calculus::Calculus;
use crate::algebra::graph::Edge;
use crate::algebra::linear::{Vec3, add3, apply3};
use crate::model::{Model, Wrench};
use crate::syntax::ast::Axes;

/// fᵢ of all loads: wrenches and generalised forces.
pub fn virtual_work(model: &mut Model, calculus: &mut Calculus) -> Vec<Edge> {
    let mut forces = model.generalized.clone();
    for wrench in model.wrenches.clone() {
        for (i, force) in forces.iter_mut().enumerate() {
            let work = work(model, calculus, &wrench, i);
            *force = model.graph.add(*force, work);
        }
    }
    forces
}

/// F·(∂ᵢp + (∂ᵢR) at) + τ·ωᵢ: the point of attack moves with the frame.
fn work(model: &mut Model, calculus: &mut Calculus, wrench: &Wrench, i: usize) -> Edge {
    let frame = &model.frames[wrench.frame];
    let graph = &mut model.graph;
    let (force, torque) = match wrench.axes {
        Axes::World => (wrench.force, wrench.torque),
        Axes::Body => (
            apply3(graph, &frame.rotation, wrench.force),
            apply3(graph, &frame.rotation, wrench.torque),
        ),
    };
    let moved = frame.position.map(|entry| calculus.along(graph, i, entry));
    let change = frame
        .rotation
        .map(|row| row.map(|entry| calculus.along(graph, i, entry)));
    let swung = apply3(graph, &change, wrench.at);
    let displacement = add3(graph, moved, swung);
    // ω₁ = row 3 of ∂ᵢR · row 2 of R, and cyclic.
    let turn: Vec3 = std::array::from_fn(|axis| {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        graph.dot(&change[k], &frame.rotation[j])
    });
    let (push, twist) = (graph.dot(&force, &displacement), graph.dot(&torque, &turn));
    graph.add(push, twist)
}
