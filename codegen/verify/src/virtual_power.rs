//! Generalised forces by their definition, fᵢ = Σ ⟨F_p, ∂ᵢr_p⟩, KR18 (28): every load as forces on particles, and
//! motion of points from ∂ᵢr and ∂ᵢ∂ⱼr.
//!
//! The results are compared with `loads` and with the functions of the language. This route uses neither angular
//! velocities for loads nor forces as derivatives of D.

use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{
    Mat3, Vec3, add3, apply3, cross, multiply3, scale3, sub3, transpose3, zero3,
};
use hamel_dynamics::calculus::Calculus;
use hamel_language::model::elements::Along;
use hamel_language::model::motion::{Observed, Quantity};
use hamel_language::model::{Model, Wrench};
use hamel_language::syntax::ast::Axes;

/// Sum of forces on points, in world axes, as generalised forces.
struct Forces<'a> {
    graph: &'a mut Graph,
    calculus: &'a mut Calculus,
    sum: Vec<Edge>,
}

impl<'a> Forces<'a> {
    fn none(graph: &'a mut Graph, calculus: &'a mut Calculus) -> Self {
        let sum = vec![graph.zero(); calculus.n()];
        Forces {
            graph,
            calculus,
            sum,
        }
    }

    /// Adds ⟨F, ∂ᵢr⟩.
    fn at(&mut self, force: Vec3, point: Vec3) {
        for (i, column) in self
            .calculus
            .point_jacobian(self.graph, point)
            .iter()
            .enumerate()
        {
            let power = self.graph.dot(&force, column);
            self.sum[i] = self.graph.add(self.sum[i], power);
        }
    }

    /// Adds a force along a line, positive if it drives the points apart, at both points.
    fn along(&mut self, force: Vec3, from: Vec3, to: Vec3) {
        self.at(force, to);
        self.at(force.map(|entry| -entry), from);
    }

    /// Adds F ∂ᵢe for a scalar e of the configuration.
    fn on(&mut self, force: Edge, scalar: Edge) {
        for i in 0..self.sum.len() {
            let slope = self.calculus.along(self.graph, i, scalar);
            let power = self.graph.mul(force, slope);
            self.sum[i] = self.graph.add(self.sum[i], power);
        }
    }

    /// Adds generalised forces as they are given.
    fn add(&mut self, forces: &[Edge]) {
        for (sum, &force) in self.sum.iter_mut().zip(forces) {
            *sum = self.graph.add(*sum, force);
        }
    }

    /// Adds a wrench: the force at its point, and the torque as three couples, ½ τ × eₖ at the tips of the frame's axes
    /// eₖ and −½ τ × eₖ at its origin, since Σ eₖ × (τ × eₖ) = 2 τ.
    fn wrench(&mut self, wrench: &Wrench, rotation: &Mat3, position: Vec3) {
        let world = |graph: &mut Graph, a: Vec3| match wrench.axes {
            Axes::World => a,
            Axes::Body => apply3(graph, rotation, a),
        };
        let force = world(self.graph, wrench.force);
        self.at(force, position);
        // A point fixed in the frame: R moves, the components `at` are constant.
        for (axis, &at) in transpose3(rotation).into_iter().zip(&wrench.at) {
            let part = scale3(self.graph, at, force);
            self.at(part, axis);
        }
        let half = self.graph.ratio(1, 2);
        let torque = world(self.graph, wrench.torque);
        let torque = scale3(self.graph, half, torque);
        for axis in transpose3(rotation) {
            let couple = cross(self.graph, torque, axis);
            let tip = add3(self.graph, position, axis);
            self.along(couple, position, tip);
        }
    }
}

/// Derives the generalised forces fᵢ of all loads as expressions, by virtual work of forces on points: wrenches, forces
/// along lines, dampers, dissipation, generalised forces.
pub fn applied_forces(model: &Model, graph: &mut Graph, calculus: &mut Calculus) -> Vec<Edge> {
    let mut forces = Forces::none(graph, calculus);
    forces.add(&model.elements.generalized);
    for wrench in &model.elements.wrenches {
        let frame = &model.frames[wrench.frame];
        forces.wrench(wrench, &frame.rotation, frame.position);
    }
    for push in &model.elements.pushes {
        if let Along::Line {
            from,
            to,
            length: Some(length),
        } = push.along
        {
            let d = sub3(forces.graph, to, from);
            let tension = quotient(forces.graph, push.force, length);
            let force = scale3(forces.graph, tension, d);
            forces.along(force, from, to);
        }
    }
    add_resistance(model, &mut forces);
    forces.sum
}

/// Adds what dissipates energy: dampers along lines as forces −c (d·ḋ)/(d·d) d on their second points, dampers of a
/// rate e as −c e ∂e/∂ξⁱ, and −C ξ with C the second derivatives of the given dissipation.
fn add_resistance(model: &Model, forces: &mut Forces) {
    for damper in &model.elements.dampers {
        let graph = &mut *forces.graph;
        match damper.along {
            Along::Line { from, to, .. } => {
                let d = sub3(graph, to, from);
                let speed = forces.calculus.rate3(graph, d);
                let (along, square) = (graph.dot(&d, &speed), graph.dot(&d, &d));
                let speed = quotient(graph, along, square);
                let factor = graph.mul(damper.coefficient, speed);
                let force = scale3(graph, -factor, d);
                forces.along(force, from, to);
            }
            Along::Scalar(rate) => {
                let pull = -graph.mul(damper.coefficient, rate);
                let slopes = slopes(graph, &model.xi, rate);
                let pulls: Vec<Edge> = slopes.iter().map(|&s| graph.mul(pull, s)).collect();
                forces.add(&pulls);
            }
        }
    }
    let graph = &mut *forces.graph;
    let resistance: Vec<Edge> = slopes(graph, &model.xi, model.elements.dissipation)
        .into_iter()
        .map(|slope| {
            let row = slopes(graph, &model.xi, slope);
            -graph.dot(&row, &model.xi)
        })
        .collect();
    forces.add(&resistance);
}

/// Derives 2 D, the power −fᵢ ξⁱ that dampers and dissipation take, as an expression.
pub fn dissipated_power(model: &Model, graph: &mut Graph, calculus: &mut Calculus) -> Edge {
    let mut forces = Forces::none(graph, calculus);
    add_resistance(model, &mut forces);
    let sum = forces.sum;
    -graph.dot(&sum, &model.xi)
}

/// Returns the conservative forces −∂ᵢV as expressions, by virtual work: weights and springs as forces on points, and
/// the given potential.
pub fn conservative_forces(model: &Model, graph: &mut Graph, calculus: &mut Calculus) -> Vec<Edge> {
    let minus = -graph.one();
    let mut forces = Forces::none(graph, calculus);
    for body in &model.bodies {
        let frame = &model.frames[body.frame];
        let arm = apply3(forces.graph, &frame.rotation, body.com);
        let centre = add3(forces.graph, frame.position, arm);
        let weight = scale3(forces.graph, body.mass, model.gravity);
        forces.at(weight, centre);
    }
    for particle in &model.particles {
        let weight = scale3(forces.graph, particle.mass, model.gravity);
        forces.at(weight, particle.position);
    }
    for spring in &model.elements.springs {
        let graph = &mut *forces.graph;
        match spring.along {
            Along::Line { from, to, length } => {
                let d = sub3(graph, to, from);
                let mut factor = spring.stiffness;
                if let Some(length) = length {
                    // k (1 − l/ℓ)
                    let slack = quotient(graph, spring.length, length);
                    let stretch = graph.sub(graph.one(), slack);
                    factor = graph.mul(factor, stretch);
                }
                let force = scale3(graph, -factor, d);
                forces.along(force, from, to);
            }
            Along::Scalar(scalar) => {
                let stretch = graph.sub(scalar, spring.length);
                let pull = -graph.mul(spring.stiffness, stretch);
                forces.on(pull, scalar);
            }
        }
    }
    forces.on(minus, model.elements.potential);
    forces.sum
}

/// Returns, for springs and forces along lines whose length ℓ is an expression of the model, all ℓ² and then all d·d,
/// which must be equal.
pub fn squared_lengths(model: &Model, graph: &mut Graph) -> (Vec<Edge>, Vec<Edge>) {
    let elements = &model.elements;
    let springs = elements.springs.iter().map(|spring| &spring.along);
    let pushes = elements.pushes.iter().map(|push| &push.along);
    let (mut left, mut right) = (Vec::new(), Vec::new());
    for along in springs.chain(pushes) {
        if let Along::Line {
            from,
            to,
            length: Some(length),
        } = along
        {
            left.push(graph.mul(*length, *length));
            let d = sub3(graph, *to, *from);
            right.push(graph.dot(&d, &d));
        }
    }
    (left, right)
}

/// Returns the velocities and accelerations that expressions of the description use, as the model has them, and the
/// same ones derived from Jacobians.
///
/// v = (∂ᵢr + ∂ᵢR p) ξⁱ, and, by the formula of rigid bodies, a = r̈ + ω̇ × R p + ω × (ω × R p) with
/// r̈ = ∂ᵢr ξ̇ⁱ + ∂ⱼ(∂ᵢr ξⁱ) ξʲ.
pub fn observed_motions(
    model: &Model,
    graph: &mut Graph,
    calculus: &mut Calculus,
) -> (Vec<Edge>, Vec<Edge>) {
    let (mut left, mut right) = (Vec::new(), Vec::new());
    for observed in &model.observed {
        left.extend(observed.value);
        right.extend(derived(model, graph, calculus, observed));
    }
    (left, right)
}

fn derived(model: &Model, graph: &mut Graph, calculus: &mut Calculus, observed: &Observed) -> Vec3 {
    let Observed {
        rotation, position, ..
    } = observed;
    let arm = apply3(graph, rotation, observed.point);
    let back = transpose3(rotation);
    let turns: Vec<Vec3> = (0..calculus.n())
        .map(|i| {
            let change = rotation.map(|row| row.map(|entry| calculus.along(graph, i, entry)));
            let skew = multiply3(graph, &change, &back);
            [skew[2][1], skew[0][2], skew[1][0]]
        })
        .collect();
    let columns = calculus.point_jacobian(graph, *position);
    let omega = combine(graph, &turns, &model.xi);
    let velocity = combine(graph, &columns, &model.xi);
    // d/dt of a function of x and ξ that is linear in ξ.
    let mut second = |graph: &mut Graph, first: Vec3, columns: &[Vec3]| {
        let drift = calculus.point_jacobian(graph, first);
        let drift = combine(graph, &drift, &model.xi);
        let driven = combine(graph, columns, &model.xi_dot);
        add3(graph, drift, driven)
    };
    match observed.quantity {
        Quantity::Position => add3(graph, *position, arm),
        Quantity::Rate => {
            let driven = position.map(|entry| {
                let slopes = slopes(graph, &model.xi, entry);
                graph.dot(&slopes, &model.xi_dot)
            });
            add3(graph, velocity, driven)
        }
        Quantity::Velocity => {
            let lever = cross(graph, omega, arm);
            add3(graph, velocity, lever)
        }
        Quantity::AngularVelocity => omega,
        Quantity::AngularAcceleration => second(graph, omega, &turns),
        Quantity::Acceleration => {
            let origin = second(graph, velocity, &columns);
            let alpha = second(graph, omega, &turns);
            let tangential = cross(graph, alpha, arm);
            let inner = cross(graph, omega, arm);
            let centripetal = cross(graph, omega, inner);
            let lever = add3(graph, tangential, centripetal);
            add3(graph, origin, lever)
        }
    }
}

/// Returns Σ columnᵢ cᵢ.
fn combine(graph: &mut Graph, columns: &[Vec3], factors: &[Edge]) -> Vec3 {
    let mut sum = zero3(graph);
    for (column, &factor) in columns.iter().zip(factors) {
        let part = scale3(graph, factor, *column);
        sum = add3(graph, sum, part);
    }
    sum
}

/// Returns ∂f/∂ξⁱ for all i.
fn slopes(graph: &mut Graph, xi: &[Edge], f: Edge) -> Vec<Edge> {
    xi.iter()
        .map(|xi| Derivation::new([(xi.node(), graph.one())]).of(graph, f))
        .collect()
}

/// Returns a/b, where b is known not to vanish on X.
fn quotient(graph: &mut Graph, a: Edge, b: Edge) -> Edge {
    graph.div(a, b).unwrap_or(graph.zero())
}
