//! Energy and momenta in world axes.
//!
//! P = Σ m ċ and L_p = Σ (c − p) × m ċ + R Θ ω over the bodies, with their centres of mass c and
//! inertia Θ about these, and over the particles.

use super::calculus::Calculus;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, add3, apply3, cross, scale3, sub3, zero3};
use hamel_language::model::Model;
use hamel_language::model::invariants::Quantity;
use hamel_language::model::value::Value;

/// Returns the quantity that an invariant names, such as a momentum of some bodies, as expressions; `energies` are T
/// and V.
///
/// `energies` are the part of T in the energy, and V.
pub fn quantity_value(
    model: &mut Model,
    calculus: &mut Calculus,
    energies: (Edge, Edge),
    quantity: &Quantity,
) -> Value {
    match quantity {
        Quantity::Energy => Value::Scalar(model.graph.add(energies.0, energies.1)),
        Quantity::LinearMomentum { of, along } => {
            let mut total = zero3(&model.graph);
            for motion in mass_motions(model, calculus, *of) {
                total = add3(&mut model.graph, total, motion.momentum);
            }
            component(model, total, along.as_ref())
        }
        Quantity::AngularMomentum { of, about, along } => {
            let mut total = zero3(&model.graph);
            for motion in mass_motions(model, calculus, *of) {
                let graph = &mut model.graph;
                let arm = sub3(graph, motion.centre, *about);
                let lever = cross(graph, arm, motion.momentum);
                let moment = add3(graph, lever, motion.spin);
                total = add3(graph, total, moment);
            }
            component(model, total, along.as_ref())
        }
        Quantity::Value(value) => value.clone(),
    }
}

/// Returns the quantity that an invariant names from the total linear momentum, and the angular momentum about the
/// origin of the world; `None` for quantities that these do not determine.
pub fn quantity_of_total(
    graph: &mut Graph,
    (linear, angular): (Vec3, Vec3),
    quantity: &Quantity,
) -> Option<Vec<Edge>> {
    let (total, along) = match quantity {
        Quantity::LinearMomentum { of: None, along } => (linear, along),
        Quantity::AngularMomentum {
            of: None,
            about,
            along,
        } => {
            let lever = cross(graph, *about, linear);
            (sub3(graph, angular, lever), along)
        }
        _ => return None,
    };
    Some(match along {
        Some(along) => vec![graph.dot(along, &total)],
        None => total.to_vec(),
    })
}

/// Mass, centre of mass, linear momentum, and angular momentum about the centre of mass of one body or particle, in world
/// axes.
pub struct MovingMass {
    /// Mass (kg).
    pub mass: Edge,
    /// Centre of mass (m).
    pub centre: Vec3,
    /// Linear momentum m ċ.
    pub momentum: Vec3,
    /// Angular momentum R Θ ω about the centre of mass.
    pub spin: Vec3,
}

/// Returns mass, centre and momenta of each body on a frame, or of all bodies and particles for `None`.
pub fn mass_motions(
    model: &mut Model,
    calculus: &mut Calculus,
    of: Option<usize>,
) -> Vec<MovingMass> {
    let graph = &mut model.graph;
    let mut all = Vec::new();
    for body in &model.bodies {
        if of.is_some_and(|frame| frame != body.frame) {
            continue;
        }
        let frame = &model.frames[body.frame];
        let arm = apply3(graph, &frame.rotation, body.com);
        let centre = add3(graph, frame.position, arm);
        let velocity = calculus.rate3(graph, centre);
        let omega = calculus.spin(graph, &frame.rotation);
        let spin = apply3(graph, &body.inertia_com, omega);
        all.push(MovingMass {
            mass: body.mass,
            centre,
            momentum: scale3(graph, body.mass, velocity),
            spin: apply3(graph, &frame.rotation, spin),
        });
    }
    if of.is_none() {
        for particle in &model.particles {
            let velocity = calculus.rate3(graph, particle.position);
            all.push(MovingMass {
                mass: particle.mass,
                centre: particle.position,
                momentum: scale3(graph, particle.mass, velocity),
                spin: zero3(graph),
            });
        }
    }
    all
}

fn component(model: &mut Model, total: Vec3, along: Option<&Vec3>) -> Value {
    match along {
        Some(along) => Value::Scalar(model.graph.dot(along, &total)),
        None => Value::Vector(total.to_vec()),
    }
}
