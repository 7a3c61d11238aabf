//! M and the right-hand side of M ξ̇ = Σ groups, traced with reference points and axes chosen by the generator.
//!
//! Every body contributes Jᵀ (M_b V̇_b + bias), without forming Γ: if its reference point has the acceleration a
//! and its frame the angular acceleration α at ξ̇ = 0, the force is m a and the torque is Θ α + ω × Θ ω.

use crate::calculus::{Calculus, into_frame};
use crate::commutation::gamma;
use crate::connection::bias_forces;
use crate::inertia::{add_matrix, build_symmetric, written_mass_matrix};
use crate::normal::eliminate_coordinates;
use crate::{energy, kinematics, loads};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Mat3, Vec3, add3, apply3, cross, scale3, zero3};
use hamel_algebra::transplant::{graft, rebuild};
use hamel_language::model::{Body, Model};
use hamel_language::syntax::ast::Axes;
use hamel_program::provenance::Quantity;

/// Reference point of a body whose motion is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferencePoint {
    /// Centre of mass: force and torque are not coupled.
    Com,
    /// Origin of the frame: no shift terms if the origin is at rest.
    Origin,
}

impl EquationTerms {
    /// Returns the right-hand side f − Γ ξ ξ − ∂V.
    pub fn right_hand_side(&self, graph: &mut Graph) -> Vec<Edge> {
        (0..self.inertia.len())
            .map(|i| graph.sum(&[self.inertia[i], self.conservative[i], self.applied[i]]))
            .collect()
    }

    /// Copies the expressions into another graph, keeping the way they are computed here.
    pub fn copy_into(&self, from: &Graph, into: &mut Graph) -> EquationTerms {
        self.mapped(|edges| graft(from, into, edges))
    }

    /// Rebuilds the expressions in another graph, reusing equal expressions that the graph already contains.
    pub fn rebuild_in(&self, from: &Graph, into: &mut Graph) -> EquationTerms {
        self.mapped(|edges| rebuild(from, into, edges))
    }

    fn mapped(&self, mut vector: impl FnMut(&[Edge]) -> Vec<Edge>) -> EquationTerms {
        EquationTerms {
            mass: self.mass.iter().map(|row| vector(row)).collect(),
            groups: self.groups.iter().map(|group| vector(group)).collect(),
            inertia: vector(&self.inertia),
            conservative: vector(&self.conservative),
            applied: vector(&self.applied),
            inverse_dynamics: self.inverse_dynamics.as_deref().map(&mut vector),
            momentum: self.momentum.as_deref().map(&mut vector),
            kinetic: self.kinetic.and_then(|edge| vector(&[edge]).pop()),
        }
    }
}

/// Axes and reference points in which the motion of bodies is expressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TracingVariant {
    /// Axes in which linear motion is written.
    pub axes: Axes,
    /// Reference point.
    pub reference: ReferencePoint,
    /// Index k for which Θ_kk I is subtracted in ω × Θ ω, which saves one product and one sum; allowed because (λ
    /// ω) × ω = 0.
    pub shift: Option<usize>,
}

/// Terms of the equations of motion M ξ̇ = Σ groups.
#[derive(Clone, Debug, Default)]
pub struct EquationTerms {
    /// Mass matrix M.
    pub mass: Vec<Vec<Edge>>,
    /// Right-hand sides by origin: inertia, gravity, potential, and each load.
    pub groups: Vec<Vec<Edge>>,
    /// Inertial forces −Γ ξ ξ.
    pub inertia: Vec<Edge>,
    /// Conservative forces −∂V, gravity included.
    pub conservative: Vec<Edge>,
    /// Sum fᴱ of all applied loads.
    pub applied: Vec<Edge>,
    /// Inverse dynamics M ξ̇ + Γ ξ ξ + ∂V, if it was traced as a whole.
    pub inverse_dynamics: Option<Vec<Edge>>,
    /// Momentum ∂T/∂ξ, if it was traced separately: M ξ, plus further terms if ẋ has terms without ξ.
    pub momentum: Option<Vec<Edge>>,
    /// Contribution of T to the energy, if it is not ½ ξᵀ M ξ.
    pub kinetic: Option<Edge>,
}

impl EquationTerms {
    /// Returns the part of the energy that comes from T: ½ ξ · p with p = `momentum`, unless a kinetic energy that the
    /// user wrote has terms of other degrees.
    pub fn kinetic_of(&self, graph: &mut Graph, model: &Model, momentum: &[Edge]) -> Edge {
        if let Some(kinetic) = self.kinetic {
            return kinetic;
        }
        let twice = graph.dot(momentum, &model.xi);
        let half = graph.ratio(1, 2);
        graph.mul(half, twice)
    }

    /// Returns the generalised momenta p = ∂T/∂ξ as expressions.
    pub fn momentum_of(&self, graph: &mut Graph, model: &Model) -> Vec<Edge> {
        match &self.momentum {
            Some(momentum) => momentum.clone(),
            None => {
                let rows = self.mass.iter();
                rows.map(|row| graph.dot(row, &model.xi)).collect()
            }
        }
    }

    /// Returns the inverse dynamics M ξ̇ + Γ ξ ξ + ∂V as expressions, without applied forces.
    pub fn inverse_dynamics_of(&self, graph: &mut Graph, model: &Model) -> Vec<Edge> {
        if let Some(traced) = &self.inverse_dynamics {
            return traced.clone();
        }
        (0..self.inertia.len())
            .map(|i| {
                let inertial = graph.dot(&self.mass[i], &model.xi_dot);
                let force = graph.sub(inertial, self.inertia[i]);
                graph.sub(force, self.conservative[i])
            })
            .collect()
    }
}

/// Derives M and the forces of a model from the motion of each body and particle.
pub fn trace_terms(
    model: &mut Model,
    calculus: &mut Calculus,
    variant: TracingVariant,
) -> EquationTerms {
    let n = model.n();
    let zero = model.graph.zero();
    let mut mass = vec![vec![zero; n]; n];
    let mut inertia = vec![zero; n];
    let mut gravity = vec![zero; n];
    for body in model.bodies.clone() {
        let traced = BodyTerms::new(model, calculus, &body, variant);
        traced.add(&mut model.graph, &mut mass, &mut inertia, &mut gravity);
    }
    for (index, particle) in model.particles.clone().into_iter().enumerate() {
        let graph = &mut model.graph;
        let columns = calculus.point_jacobian(graph, particle.position);
        let velocity = calculus.rate3(graph, particle.position);
        let acceleration = calculus.rate3(graph, velocity);
        let force = scale3(graph, particle.mass, acceleration);
        let weight = scale3(graph, particle.mass, model.gravity);
        graph.label(&columns.concat(), Quantity::ParticleJacobian.of(index));
        graph.label(&velocity, Quantity::ParticleVelocity.of(index));
        graph.label(&acceleration, Quantity::ParticleAcceleration.of(index));
        graph.label(&force, Quantity::ParticleForce.of(index));
        graph.label(&weight, Quantity::ParticleWeight.of(index));
        for i in 0..n {
            let (h, g) = (
                graph.dot(&columns[i], &force),
                graph.dot(&columns[i], &weight),
            );
            inertia[i] = graph.sub(inertia[i], h);
            gravity[i] = graph.add(gravity[i], g);
        }
        let part = build_symmetric(n, |i, j| {
            let product = graph.dot(&columns[i], &columns[j]);
            graph.mul(particle.mass, product)
        });
        add_matrix(graph, &mut mass, &part);
    }
    if let Some(terms) = model.kinetic_terms.clone() {
        for (sum, &h) in inertia.iter_mut().zip(&terms.bias) {
            *sum = model.graph.sub(*sum, h);
        }
        add_matrix(&mut model.graph, &mut mass, &terms.mass);
    } else if model.kinetic != zero {
        let part = written_mass_matrix(model);
        let rows = kinematics::left_inverse(model).unwrap_or_default();
        let gamma = gamma(model, calculus, &rows);
        let h = bias_forces(model, calculus, &part, &gamma);
        let graph = &mut model.graph;
        for i in 0..n {
            inertia[i] = graph.sub(inertia[i], h[i]);
        }
        add_matrix(graph, &mut mass, &part);
    }
    if n <= crate::candidates::MAX_SEARCHED_VELOCITIES {
        let mut forms = None;
        for entry in mass.iter_mut().flatten() {
            *entry = eliminate_coordinates(
                &mut model.graph,
                calculus,
                &model.points,
                &mut forms,
                *entry,
            );
        }
    }
    let kinetic = model
        .is_affine()
        .then(|| energy::kinetic_of_bodies(model, calculus));
    let momentum = kinetic.map(|kinetic| energy::momentum(model, kinetic));
    let kinetic = kinetic.map(|kinetic| energy::kinetic_in_energy(model, kinetic));
    let potential = loads::elastic_force(model, calculus);
    let loads = loads::applied_force_terms(model, calculus);
    let graph = &mut model.graph;
    let conservative = (0..n)
        .map(|i| graph.add(gravity[i], potential[i]))
        .collect();
    let applied = (0..n)
        .map(|i| loads.iter().fold(zero, |sum, load| graph.add(sum, load[i])))
        .collect();
    let mut groups = vec![inertia.clone(), gravity, potential];
    groups.extend(loads);
    groups.retain(|group| group.iter().any(|&edge| edge != zero));
    EquationTerms {
        mass,
        groups,
        inertia,
        conservative,
        applied,
        inverse_dynamics: None,
        momentum,
        kinetic,
    }
}

/// Jacobian, bias force and weight of a body, in the chosen axes and about the chosen point.
struct BodyTerms {
    linear: Vec<Vec3>,
    angular: Vec<Vec3>,
    mass: Edge,
    inertia: Mat3,
    /// First moment m s in body axes if the reference point is the origin, else 0.
    moment: Vec3,
    /// Rotation from body axes to world axes, if linear motion is written in world axes.
    rotation: Option<Mat3>,
    force: Vec3,
    torque: Vec3,
    weight: Vec3,
    weight_torque: Vec3,
}

impl BodyTerms {
    fn new(
        model: &mut Model,
        calculus: &mut Calculus,
        body: &Body,
        variant: TracingVariant,
    ) -> Self {
        let frame = model.frames[body.frame].clone();
        let graph = &mut model.graph;
        let zero = zero3(graph);
        let angular = calculus.spin_jacobian(graph, &frame.rotation);
        let omega = calculus.spin(graph, &frame.rotation);
        let alpha = calculus.rate3(graph, omega);
        let at_com = variant.reference == ReferencePoint::Com;
        let (inertia, arm) = if at_com {
            (body.inertia_com, body.com)
        } else {
            (body.inertia_origin, zero)
        };
        let moment = if at_com {
            zero
        } else {
            scale3(graph, body.mass, body.com)
        };
        // Motion of the reference point.
        let (linear, acceleration, rotation) = match variant.axes {
            Axes::Body => {
                let mut linear: Vec<Vec3> = calculus
                    .point_jacobian(graph, frame.position)
                    .into_iter()
                    .map(|v| into_frame(graph, &frame.rotation, v))
                    .collect();
                let moved = calculus.rate3(graph, frame.position);
                let mut velocity = into_frame(graph, &frame.rotation, moved);
                for (v, &w) in linear.iter_mut().zip(&angular) {
                    let lever = cross(graph, w, arm);
                    *v = add3(graph, *v, lever);
                }
                let lever = cross(graph, omega, arm);
                velocity = add3(graph, velocity, lever);
                graph.label(&velocity, Quantity::LinearVelocity.of(body.frame));
                let change = calculus.rate3(graph, velocity);
                let turn = cross(graph, omega, velocity);
                (linear, add3(graph, change, turn), None)
            }
            Axes::World => {
                let turned = apply3(graph, &frame.rotation, arm);
                let point = add3(graph, frame.position, turned);
                let linear = calculus.point_jacobian(graph, point);
                let velocity = calculus.rate3(graph, point);
                graph.label(&velocity, Quantity::LinearVelocity.of(body.frame));
                (
                    linear,
                    calculus.rate3(graph, velocity),
                    Some(frame.rotation),
                )
            }
        };
        let mut force = scale3(graph, body.mass, acceleration);
        let mut torque = gyroscopic(graph, &inertia, omega, variant.shift);
        let spun = apply3(graph, &inertia, alpha);
        torque = add3(graph, torque, spun);
        // Coupling through the first moment m s, if the reference point is not the centre of mass.
        let tangential = cross(graph, alpha, moment);
        let inner = cross(graph, omega, moment);
        let centripetal = cross(graph, omega, inner);
        let mut coupling = add3(graph, tangential, centripetal);
        let mut local = acceleration;
        if let Some(rotation) = &rotation {
            coupling = apply3(graph, rotation, coupling);
            local = into_frame(graph, rotation, acceleration);
        }
        force = add3(graph, force, coupling);
        let lever = cross(graph, moment, local);
        torque = add3(graph, torque, lever);
        // Weight.
        let mut weight = scale3(graph, body.mass, model.gravity);
        let of = |quantity: Quantity| quantity.of(body.frame);
        graph.label(&omega, of(Quantity::AngularVelocity));
        graph.label(&alpha, of(Quantity::BiasAngularAcceleration));
        graph.label(&acceleration, of(Quantity::BiasAcceleration));
        graph.label(&force, of(Quantity::InertialForce));
        graph.label(&torque, of(Quantity::InertialTorque));
        graph.label(&angular.concat(), of(Quantity::AngularJacobian));
        graph.label(&linear.concat(), of(Quantity::LinearJacobian));
        let weight_torque = if at_com {
            zero
        } else {
            // m s × Rᵀ g with its constant factors grouped: (m s g) × Rᵀ e.
            let pull = into_frame(graph, &frame.rotation, weight);
            cross(graph, body.com, pull)
        };
        if variant.axes == Axes::Body {
            weight = into_frame(graph, &frame.rotation, weight);
        }
        graph.label(&weight, of(Quantity::Weight));
        graph.label(&weight_torque, of(Quantity::Weight));
        BodyTerms {
            linear,
            angular,
            mass: body.mass,
            inertia,
            moment,
            rotation,
            force,
            torque,
            weight,
            weight_torque,
        }
    }

    fn add(
        &self,
        graph: &mut Graph,
        mass: &mut [Vec<Edge>],
        inertia: &mut [Edge],
        gravity: &mut [Edge],
    ) {
        let n = self.linear.len();
        for i in 0..n {
            let (force, torque) = (
                graph.dot(&self.linear[i], &self.force),
                graph.dot(&self.angular[i], &self.torque),
            );
            let h = graph.add(force, torque);
            inertia[i] = graph.sub(inertia[i], h);
            let (pull, twist) = (
                graph.dot(&self.linear[i], &self.weight),
                graph.dot(&self.angular[i], &self.weight_torque),
            );
            let g = graph.add(pull, twist);
            gravity[i] = graph.add(gravity[i], g);
        }
        let spun: Vec<Vec3> = self
            .angular
            .iter()
            .map(|&w| apply3(graph, &self.inertia, w))
            .collect();
        let lever: Vec<Vec3> = self
            .angular
            .iter()
            .map(|&w| {
                let lever = cross(graph, w, self.moment);
                match &self.rotation {
                    Some(rotation) => apply3(graph, rotation, lever),
                    None => lever,
                }
            })
            .collect();
        let part = build_symmetric(n, |i, j| {
            let linear = graph.dot(&self.linear[i], &self.linear[j]);
            let terms = [
                graph.mul(self.mass, linear),
                graph.dot(&self.linear[i], &lever[j]),
                graph.dot(&self.linear[j], &lever[i]),
                graph.dot(&self.angular[i], &spun[j]),
            ];
            graph.sum(&terms)
        });
        add_matrix(graph, mass, &part);
    }
}

/// Returns ω × Θ ω = ω × (Θ − λ I) ω.
fn gyroscopic(graph: &mut Graph, inertia: &Mat3, omega: Vec3, shift: Option<usize>) -> Vec3 {
    let mut inertia = *inertia;
    if let Some(k) = shift {
        let lambda = inertia[k][k];
        for (i, row) in inertia.iter_mut().enumerate() {
            row[i] = graph.sub(row[i], lambda);
        }
    }
    let momentum = apply3(graph, &inertia, omega);
    cross(graph, omega, momentum)
}
