//! Motions of frames and of their points: the functions `position`, `velocity`, `acceleration`,
//! `angular_velocity` and `angular_acceleration`.
//!
//! | call | value | unit |
//! |---|---|---|
//! | `position(f, p)` | r + R p | m |
//! | `velocity(f, p)` | ṙ + Ṙ p | m/s |
//! | `acceleration(f, p)` | r̈ + R̈ p | m/s² |
//! | `angular_velocity(f)` | ω with ω̂ = Ṙ Rᵀ | rad/s |
//! | `angular_acceleration(f)` | ω̇ | rad/s² |
//!
//! The point p is fixed in f and given in its axes; without it, p is the origin. Components are in world axes. With a
//! frame g as last argument, (r, R) is the pose of f in g: the motion as g sees it, in the axes of g. Time
//! derivatives of x are taken along ẋ = A ξ, and those of ξ along ξ̇, so that accelerations are functions of ξ̇.

use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Mat3, Vec3, add3, apply3, cross, multiply3, transpose3};
use crate::model::motion::Observed;
use crate::model::motion::Quantity;
use std::cell::RefCell;

/// The operator d/dt, given by ẋ and ξ̇.
#[derive(Clone, Debug)]
pub struct TimeDerivative {
    seeds: Vec<(u32, Edge)>,
    /// Motions that were asked for so far.
    pub seen: RefCell<Vec<Observed>>,
}

impl TimeDerivative {
    /// Creates the derivative along ẋ = `rate` and the symbols ξ̇.
    pub fn new(x: &[Edge], rate: &[Edge], xi: &[Edge], xi_dot: &[Edge]) -> Self {
        let pairs = x.iter().zip(rate).chain(xi.iter().zip(xi_dot));
        TimeDerivative {
            seeds: pairs.map(|(symbol, &rate)| (symbol.node(), rate)).collect(),
            seen: RefCell::new(Vec::new()),
        }
    }

    /// Returns d/dt of expressions.
    pub fn along(&self, graph: &mut Graph, edges: &[Edge]) -> Vec<Edge> {
        Derivation::new(self.seeds.iter().copied()).all(graph, edges)
    }

    /// Returns d/dt of several expressions.
    pub fn rates<const N: usize>(&self, graph: &mut Graph, edges: [Edge; N]) -> [Edge; N] {
        let mut along = Derivation::new(self.seeds.iter().copied());
        edges.map(|edge| along.of(graph, edge))
    }

    pub(super) fn velocity(
        &self,
        graph: &mut Graph,
        rotation: &Mat3,
        position: Vec3,
        point: Vec3,
    ) -> Vec3 {
        let origin = self.rates(graph, position);
        let turned = self.turning(graph, rotation);
        let moved = apply3(graph, &turned, point);
        add3(graph, origin, moved)
    }

    pub(super) fn acceleration(
        &self,
        graph: &mut Graph,
        rotation: &Mat3,
        position: Vec3,
        point: Vec3,
    ) -> Vec3 {
        let origin = self.rates(graph, position);
        let origin = self.rates(graph, origin);
        let turned = self.turning(graph, rotation);
        let turned = self.turning(graph, &turned);
        let moved = apply3(graph, &turned, point);
        add3(graph, origin, moved)
    }

    /// Registers the same motion in frame axes with the graph, v = Rᵀṙ + ω × p and v̇ + ω × v, so that
    /// `f.R.T * velocity(f, p)` becomes this instead of a world vector that is rotated back.
    pub(super) fn note_in_frame(
        &self,
        graph: &mut Graph,
        rotation: &Mat3,
        position: Vec3,
        point: Vec3,
        quantity: Quantity,
    ) {
        let back = transpose3(rotation);
        let turned = self.turning(graph, rotation);
        let skew = multiply3(graph, &back, &turned);
        let omega = [skew[2][1], skew[0][2], skew[1][0]];
        let moved = self.rates(graph, position);
        let origin = apply3(graph, &back, moved);
        let lever = cross(graph, omega, point);
        let velocity = add3(graph, origin, lever);
        if matches!(
            quantity,
            Quantity::Acceleration | Quantity::AngularAcceleration
        ) {
            self.rates(graph, omega);
            let change = self.rates(graph, velocity);
            let turn = cross(graph, omega, velocity);
            add3(graph, change, turn);
        }
    }

    /// Returns ṙ + R (ω × p) and R ω, where ω̂ is the skew part of RᵀṘ, KR18 (36): the velocities for an arbitrary
    /// vector ẋ. Registers them in frame axes with the graph, too.
    pub(super) fn defining(
        &self,
        graph: &mut Graph,
        rotation: &Mat3,
        position: Vec3,
        point: Vec3,
    ) -> (Vec3, Vec3) {
        let back = transpose3(rotation);
        let turned = self.turning(graph, rotation);
        let product = multiply3(graph, &back, &turned);
        let half = graph.ratio(1, 2);
        let omega = [(2, 1), (0, 2), (1, 0)].map(|(i, j)| {
            let difference = graph.sub(product[i][j], product[j][i]);
            graph.mul(half, difference)
        });
        let moved = self.rates(graph, position);
        let lever = cross(graph, omega, point);
        let own = apply3(graph, &back, moved);
        add3(graph, own, lever);
        let lever = apply3(graph, rotation, lever);
        let velocity = add3(graph, moved, lever);
        (velocity, apply3(graph, rotation, omega))
    }

    fn turning(&self, graph: &mut Graph, rotation: &Mat3) -> Mat3 {
        let mut along = Derivation::new(self.seeds.iter().copied());
        rotation.map(|row| row.map(|entry| along.of(graph, entry)))
    }

    /// Returns ω with ω̂ = Ṙ Rᵀ.
    pub(super) fn spin(&self, graph: &mut Graph, rotation: &Mat3) -> Vec3 {
        let turned = self.turning(graph, rotation);
        let skew = multiply3(graph, &turned, &transpose3(rotation));
        [skew[2][1], skew[0][2], skew[1][0]]
    }
}
