//! Generalised forces: fᵢ = Σ ⟨F_p, ∂ᵢr_p⟩ of applied loads, KR18 (28), and −∂ᵢV of potentials.

use super::calculus::{Calculus, into_frame};
use hamel_algebra::graph::Edge;
use hamel_algebra::linear::{add3, cross};
use hamel_language::model::{Model, Wrench};
use hamel_language::syntax::ast::Axes;

/// Returns the n entries F·(vᵢ + ωᵢ × at) + τ·ωᵢ of the generalised force of one wrench, in the axes in which it is
/// given.
pub fn wrench_force(model: &mut Model, calculus: &mut Calculus, wrench: &Wrench) -> Vec<Edge> {
    let frame = model.frames[wrench.frame].clone();
    let graph = &mut model.graph;
    let spins = calculus.spin_jacobian(graph, &frame.rotation);
    let velocities = calculus.point_jacobian(graph, frame.position);
    let zero = graph.zero();
    let pure_torque = wrench.force.iter().all(|&edge| edge == zero);
    match wrench.axes {
        Axes::Body => {
            let lever = cross(graph, wrench.at, wrench.force);
            let torque = add3(graph, wrench.torque, lever);
            velocities
                .into_iter()
                .zip(spins)
                .map(|(v, w)| {
                    let v = if pure_torque {
                        [zero; 3]
                    } else {
                        into_frame(graph, &frame.rotation, v)
                    };
                    let (force, turn) = (graph.dot(&v, &wrench.force), graph.dot(&w, &torque));
                    graph.add(force, turn)
                })
                .collect()
        }
        Axes::World => {
            // The torque about the frame's origin is transformed to the frame's axes, as ωᵢ is.
            let force = into_frame(graph, &frame.rotation, wrench.force);
            let lever = cross(graph, wrench.at, force);
            let turned = into_frame(graph, &frame.rotation, wrench.torque);
            let torque = add3(graph, turned, lever);
            velocities
                .into_iter()
                .zip(spins)
                .map(|(v, w)| {
                    let (force, turn) = (graph.dot(&v, &wrench.force), graph.dot(&w, &torque));
                    graph.add(force, turn)
                })
                .collect()
        }
    }
}

/// Returns the force −∂ᵢV of a potential, without gravity on bodies, which is computed separately.
pub fn potential_force(model: &mut Model, calculus: &mut Calculus, potential: Edge) -> Vec<Edge> {
    (0..model.n())
        .map(|i| -calculus.along(&mut model.graph, i, potential))
        .collect()
}

/// Returns the same −∂ᵢV as [`potential_force`], but with springs along lines acting by their wrenches.
pub fn elastic_force(model: &mut Model, calculus: &mut Calculus) -> Vec<Edge> {
    let mut sum = potential_force(model, calculus, model.elements.scalar_potential);
    for spring in model.elements.springs.clone() {
        for load in &spring.wrenches {
            let force = wrench_force(model, calculus, load);
            for (sum, force) in sum.iter_mut().zip(force) {
                *sum = model.graph.add(*sum, force);
            }
        }
    }
    sum
}

/// Returns the terms of the applied force fᴱ: one vector for every wrench, then the sum of all generalised forces,
/// dissipation included, unless that is zero.
pub fn applied_force_terms(model: &mut Model, calculus: &mut Calculus) -> Vec<Vec<Edge>> {
    let mut loads: Vec<Vec<Edge>> = Vec::new();
    for load in model.wrenches.clone() {
        loads.push(wrench_force(model, calculus, &load));
    }
    if model
        .generalized
        .iter()
        .any(|&edge| edge != model.graph.zero())
    {
        loads.push(model.generalized.clone());
    }
    loads
}

/// Returns the sum of the applied forces fᴱ, n entries, without those of potentials, as a reference for validation.
pub fn applied_force(model: &mut Model, calculus: &mut Calculus) -> Vec<Edge> {
    let all = applied_force_terms(model, calculus);
    (0..model.n())
        .map(|i| {
            let column: Vec<Edge> = all.iter().map(|load| load[i]).collect();
            model.graph.sum(&column)
        })
        .collect()
}
