//! Forward dynamics by the articulated-body algorithm (Featherstone 1983), linear in the number of
//! links.
//!
//! The articulated inertia of a link and its descendants, [[J, H], [Hᵀ, M]], is reduced by the
//! freedoms of the link's own joint and transformed to the parent link. The forces at ξ̇ = 0 come
//! from recursive inverse dynamics, so that only the accelerations due to ξ̇ are propagated here.

use super::inverse::to_parent;
use super::link::{Freedom, Link, Tree};
use super::mass::LinkInertia;
use super::wrench::Wrench;
use crate::accel::solve::Solution;
use hamel_algebra::graph::{Edge, Graph, Label};
use hamel_algebra::linear::{Mat3, Vec3, add3, cross, identity3, scale3, zero3};
use hamel_language::model::rotations::hat;
use hamel_program::provenance::Quantity;

/// Articulated inertia: torque = J α + H a, force = Hᵀ α + M a.
#[derive(Clone, Copy, Debug)]
struct Inertia {
    j: Mat3,
    h: Mat3,
    m: Mat3,
}

/// Quantities from the elimination of one freedom.
struct Pivot {
    /// Wrench that a unit acceleration of the freedom requires, divided by the pivot.
    share: Wrench,
    /// 1 / pivot.
    inverse: Edge,
    /// Joint force minus the generalised force of the bias wrench.
    residual: Edge,
}

/// Derives ξ̇ of a tree of links by the articulated-body algorithm, for wrenches on links and generalised forces; rates
/// of the velocities in `given` are prescribed.
///
/// `wrenches` are the wrenches that the links require at ξ̇ = 0 (apart from prescribed
/// accelerations); `load` are all other generalised forces. Returns `None` if a pivot vanishes
/// identically. Every velocity has to be the rate of exactly one freedom, except for the prescribed
/// velocities `given`: their accelerations are contained in `wrenches`, and they do not yield to
/// forces (Featherstone 2008, 9.2).
pub fn articulated_body_dynamics(
    graph: &mut Graph,
    tree: &Tree,
    given: &[usize],
    wrenches: &[Wrench],
    load: &[Edge],
) -> Option<Solution> {
    let zero = graph.zero();
    let mut inertia: Vec<Inertia> = Vec::with_capacity(tree.links.len());
    for link in &tree.links {
        inertia.push(Inertia::rigid(graph, &link.mass));
    }
    let mut bias = wrenches.to_vec();
    let mut pivots: Vec<Vec<Pivot>> = tree.links.iter().map(|_| Vec::new()).collect();
    let mut guards = vec![graph.one(); load.len()];
    for (index, link) in tree.links.iter().enumerate().rev() {
        inertia[index].label(graph, Quantity::ArticulatedInertia.of(link.frame));
        for freedom in link.freedoms.iter().filter(|f| !f.is_given(given)) {
            let response = inertia[index].wrench(graph, freedom.angular, freedom.linear);
            let &[(i, _)] = freedom.rate.as_slice() else {
                return None;
            };
            let apparent = freedom.force_of(graph, &response);
            let pivot = graph.add(apparent, tree.armature[i]);
            let inverse = graph.div(graph.one(), pivot)?;
            guards[i] = pivot;
            let bias_force = freedom.force_of(graph, &bias[index]);
            let residual = graph.sub(load[i], bias_force);
            let share = response.scale(graph, inverse);
            graph.label(&[residual], Quantity::JointResidual.of(link.frame));
            share.label(graph, Quantity::JointShare.of(link.frame));
            inertia[index].reduce(graph, &response, &share);
            let yielded = share.scale(graph, residual);
            bias[index] = bias[index].plus(graph, &yielded);
            bias[index].label(graph, Quantity::ArticulatedWrench.of(link.frame));
            pivots[index].push(Pivot {
                share,
                inverse,
                residual,
            });
        }
        if let Some(parent) = link.parent {
            let moved = inertia[index].to_parent(graph, link);
            inertia[parent].add(graph, &moved);
            let moved = to_parent(graph, link, &bias[index]);
            bias[parent] = bias[parent].plus(graph, &moved);
        }
    }
    let mut xi_dot = vec![zero; load.len()];
    let mut motions: Vec<(Vec3, Vec3)> = Vec::with_capacity(tree.links.len());
    for (index, link) in tree.links.iter().enumerate() {
        let none = zero3(graph);
        let (alpha, a) = link.parent.map_or((none, none), |parent| motions[parent]);
        let tangential = cross(graph, alpha, link.position);
        let a = add3(graph, a, tangential);
        let mut motion = (
            link.from_parent_axes(graph, alpha),
            link.from_parent_axes(graph, a),
        );
        let freedoms = link.freedoms.iter().filter(|f| !f.is_given(given));
        let freedoms: Vec<&Freedom> = freedoms.collect();
        for (freedom, pivot) in freedoms.into_iter().zip(&pivots[index]).rev() {
            let alone = graph.mul(pivot.residual, pivot.inverse);
            let (t, f) = (
                graph.dot(&pivot.share.torque, &motion.0),
                graph.dot(&pivot.share.force, &motion.1),
            );
            let from_parent = graph.add(t, f);
            let rate = graph.sub(alone, from_parent);
            let (w, v) = (
                scale3(graph, rate, freedom.angular),
                scale3(graph, rate, freedom.linear),
            );
            motion = (add3(graph, motion.0, w), add3(graph, motion.1, v));
            if let Some(&(i, _)) = freedom.rate.first() {
                xi_dot[i] = rate;
            }
        }
        let acceleration = [motion.0, motion.1].concat();
        graph.label(&acceleration, Quantity::JointAcceleration.of(link.frame));
        motions.push(motion);
    }
    Some(Solution {
        xi_dot,
        pivots: guards,
    })
}

impl Inertia {
    fn rigid(graph: &mut Graph, mass: &LinkInertia) -> Self {
        let j = mass.inertia_matrix(graph);
        let identity = identity3(graph);
        Inertia {
            j,
            h: hat(graph, mass.first),
            m: identity.map(|row| row.map(|entry| graph.mul(entry, mass.mass))),
        }
    }

    fn label(&self, graph: &mut Graph, label: Option<Label>) {
        for block in [&self.j, &self.h, &self.m] {
            graph.label(&block.concat(), label);
        }
    }

    fn wrench(&self, graph: &mut Graph, alpha: Vec3, a: Vec3) -> Wrench {
        let torque = std::array::from_fn(|i| {
            let (x, y) = (graph.dot(&self.j[i], &alpha), graph.dot(&self.h[i], &a));
            graph.add(x, y)
        });
        let force = std::array::from_fn(|i| {
            let column = self.h.map(|row| row[i]);
            let (x, y) = (graph.dot(&column, &alpha), graph.dot(&self.m[i], &a));
            graph.add(x, y)
        });
        Wrench { force, torque }
    }

    /// Subtracts the part of the inertia to which the freedom yields.
    fn reduce(&mut self, graph: &mut Graph, response: &Wrench, share: &Wrench) {
        for i in 0..3 {
            for k in 0..3 {
                if k <= i {
                    let product = graph.mul(response.torque[i], share.torque[k]);
                    self.j[i][k] = graph.sub(self.j[i][k], product);
                    self.j[k][i] = self.j[i][k];
                    let product = graph.mul(response.force[i], share.force[k]);
                    self.m[i][k] = graph.sub(self.m[i][k], product);
                    self.m[k][i] = self.m[i][k];
                }
                let product = graph.mul(response.torque[i], share.force[k]);
                self.h[i][k] = graph.sub(self.h[i][k], product);
            }
        }
    }

    /// Transforms the inertia to the origin and the axes of the parent link.
    ///
    /// H' = H + p̂ M, J' = J + p̂ Hᵀ − H' p̂.
    fn to_parent(self, graph: &mut Graph, link: &Link) -> Self {
        let mut turned = self;
        for turn in link.turns.iter().rev() {
            turned = Inertia {
                j: turn.rotate_symmetric(graph, &turned.j),
                h: turn.rotate_matrix(graph, &turned.h),
                m: turn.rotate_symmetric(graph, &turned.m),
            };
        }
        let p = link.position;
        let mut h = turned.h;
        for column in 0..3 {
            let lever = cross(graph, p, turned.m.map(|row| row[column]));
            for (row, term) in h.iter_mut().zip(lever) {
                row[column] = graph.add(row[column], term);
            }
        }
        let mut j = turned.j;
        // (p̂ Hᵀ)ᵢₖ = (p × row k of H)ᵢ and (−H' p̂)ᵢₖ = (p × row i of H')ₖ.
        for i in 0..3 {
            for k in 0..=i {
                let left = cross(graph, p, turned.h[k])[i];
                let right = cross(graph, p, h[i])[k];
                j[i][k] = graph.sum(&[j[i][k], left, right]);
                j[k][i] = j[i][k];
            }
        }
        Inertia { j, h, m: turned.m }
    }

    fn add(&mut self, graph: &mut Graph, other: &Inertia) {
        for i in 0..3 {
            self.h[i] = add3(graph, self.h[i], other.h[i]);
            for k in 0..=i {
                for (mine, other) in [(&mut self.j, &other.j), (&mut self.m, &other.m)] {
                    mine[i][k] = graph.add(mine[i][k], other[i][k]);
                    mine[k][i] = mine[i][k];
                }
            }
        }
    }
}
