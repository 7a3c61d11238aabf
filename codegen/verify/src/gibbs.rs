//! The equations of Gibbs and Appell, KR18 (30b): ∂S/∂ξ̇ⁱ + ∂ᵢV = fᵢ (N or N m, n entries).
//!
//! S = ½ Σ m ‖r̈‖² over particles (kg m²/s⁴); for a rigid body, up to terms without ξ̇,
//! S = ½ m ‖a_c‖² + ½ α·Θα + α·(ω × Θω) with Θ about the centre of mass. Positions and rotations are differentiated
//! twice; M, Γ and γ do not occur. The weight enters by its virtual work.
//!
//! A kinetic energy that the user wrote as `kinetic` belongs to no particles. Its S is ½ M_ij ξ̇ⁱ ξ̇ʲ + ξ̇ⁱ Γᵢⱼₖ ξʲ ξᵏ,
//! so that for this term (30b) is not independent of the other forms.

use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::Edge;
use hamel_algebra::linear::{Vec3, add3, apply3, cross};
use hamel_dynamics::calculus::Calculus;
use hamel_dynamics::{connection, inertia};
use hamel_language::model::Model;

/// How much of T belongs to bodies and particles, so that S is known from accelerations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// All of it.
    Whole,
    /// A part; the rest was written as `kinetic`.
    Part,
    /// Nothing: T was written as `kinetic`.
    None,
}

/// Returns how much of the kinetic energy belongs to bodies and particles, for which (30b) follows from accelerations,
/// without M and Γ.
pub fn coverage(model: &Model) -> Coverage {
    let traced = !model.bodies.is_empty() || !model.particles.is_empty();
    match (model.kinetic == model.graph.zero(), traced) {
        (true, _) => Coverage::Whole,
        (false, true) => Coverage::Part,
        (false, false) => Coverage::None,
    }
}

/// Returns the energy of accelerations S(x, ξ, ξ̇) = Σ ½ m ‖a‖² + … of bodies and particles as an expression. `motion`
/// is d/dt along ẋ = A ξ with ξ̇ as symbols.
pub fn acceleration_energy(model: &mut Model, motion: &mut Calculus) -> Edge {
    let half = model.graph.ratio(1, 2);
    let mut terms = Vec::new();
    for body in model.bodies.clone() {
        let frame = model.frames[body.frame].clone();
        let graph = &mut model.graph;
        let arm = apply3(graph, &frame.rotation, body.com);
        let centre = add3(graph, frame.position, arm);
        let velocity = motion.rate3(graph, centre);
        let acceleration = motion.rate3(graph, velocity);
        let square = graph.dot(&acceleration, &acceleration);
        let linear = graph.mul(body.mass, square);
        terms.push(graph.mul(half, linear));
        // In body axes dω/dt and α have the same components.
        let omega = motion.spin(graph, &frame.rotation);
        let alpha = motion.rate3(graph, omega);
        let spun = apply3(graph, &body.inertia_com, alpha);
        let angular = graph.dot(&alpha, &spun);
        terms.push(graph.mul(half, angular));
        let momentum = apply3(graph, &body.inertia_com, omega);
        let gyroscopic = cross(graph, omega, momentum);
        terms.push(graph.dot(&alpha, &gyroscopic));
    }
    for particle in model.particles.clone() {
        let graph = &mut model.graph;
        let velocity = motion.rate3(graph, particle.position);
        let acceleration = motion.rate3(graph, velocity);
        let square = graph.dot(&acceleration, &acceleration);
        let weighted = graph.mul(particle.mass, square);
        terms.push(graph.mul(half, weighted));
    }
    model.graph.sum(&terms)
}

/// Returns the left side of the Gibbs-Appell equations (30b), ∂S/∂ξ̇ + ∂V, as expressions in (x, ξ, ξ̇). `gamma` is
/// used for a kinetic energy that the user wrote.
pub fn gibbs_appell(
    model: &mut Model,
    motion: &mut Calculus,
    gamma: &[Vec<Vec<Edge>>],
) -> Vec<Edge> {
    let energy = acceleration_energy(model, motion);
    let weights = weights(model);
    let xi_dot = model.xi_dot.clone();
    let graph = &mut model.graph;
    let one = graph.one();
    let mut forces: Vec<Edge> = xi_dot
        .iter()
        .enumerate()
        .map(|(i, symbol)| {
            let inertial = Derivation::new([(symbol.node(), one)]).of(graph, energy);
            let slope = motion.along(graph, i, model.potential);
            let mut force = graph.add(inertial, slope);
            for (weight, centre) in &weights {
                let moved = centre.map(|entry| motion.along(graph, i, entry));
                let work = graph.dot(weight, &moved);
                force = graph.sub(force, work);
            }
            force
        })
        .collect();
    if coverage(model) != Coverage::Whole {
        let mass = inertia::written_mass_matrix(model);
        let mut resting = Calculus::new(model);
        let bias = connection::bias_forces(model, &mut resting, &mass, gamma);
        let graph = &mut model.graph;
        for (i, force) in forces.iter_mut().enumerate() {
            let inertial = graph.dot(&mass[i], &xi_dot);
            let sum = graph.add(inertial, bias[i]);
            *force = graph.add(*force, sum);
        }
    }
    forces
}

/// Returns m g and the point at which it acts, for every body and particle, in world axes.
fn weights(model: &mut Model) -> Vec<(Vec3, Vec3)> {
    let graph = &mut model.graph;
    let mut weights = Vec::new();
    if model.gravity.iter().all(|&entry| entry == graph.zero()) {
        return weights;
    }
    for body in &model.bodies {
        let frame = &model.frames[body.frame];
        let arm = apply3(graph, &frame.rotation, body.com);
        let centre = add3(graph, frame.position, arm);
        weights.push((model.gravity.map(|g| graph.mul(body.mass, g)), centre));
    }
    for particle in &model.particles {
        let weight = model.gravity.map(|g| graph.mul(particle.mass, g));
        weights.push((weight, particle.position));
    }
    weights
}
