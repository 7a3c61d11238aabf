//! Forward dynamics by articulated bodies (Featherstone 1983): linear in the number of links.
//!
//! The inertia that a joint feels of all that hangs on it freely, [[J, H], [Hᵀ, M]], is reduced by
//! the joint's own freedom and carried to the link before. Forces at ξ̇ = 0 come from the recursion of
//! inverse dynamics, so that only accelerations due to ξ̇ are propagated here.

use super::inverse::{Wrench, carried};
use super::mass::Mass;
use super::{Link, Tree};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Mat3, Vec3, add3, cross, identity3, scale3, zero3};
use crate::derive::accel::solve::Solution;

/// Torque = J α + H a, force = Hᵀ α + M a.
#[derive(Clone, Copy, Debug)]
struct Inertia {
    j: Mat3,
    h: Mat3,
    m: Mat3,
}

/// How a freedom was eliminated.
struct Pivot {
    /// The wrench of one unit of its acceleration, over the pivot.
    share: (Vec3, Vec3),
    /// 1 / pivot.
    inverse: Edge,
    /// What is left of its force.
    rest: Edge,
}

/// ξ̇ for forces that the joints have to bring up (load − bias at ξ̇ = 0 less the links' wrenches);
/// `None` where a pivot vanishes identically. Every velocity has to be the rate of one freedom.
pub fn forward(
    graph: &mut Graph,
    tree: &Tree,
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
    let mut guards = Vec::new();
    for (index, link) in tree.links.iter().enumerate().rev() {
        for freedom in &link.freedoms {
            let (torque, force) = inertia[index].wrench(graph, freedom.angular, freedom.linear);
            let &[(i, _)] = freedom.rate.as_slice() else {
                return None;
            };
            let pivot = {
                let terms = [
                    graph.dot(&freedom.angular, &torque),
                    graph.dot(&freedom.linear, &force),
                    tree.armature[i],
                ];
                graph.sum(&terms)
            };
            let inverse = graph.div(graph.one(), pivot)?;
            guards.push(pivot);
            let felt = {
                let (a, b) = (
                    graph.dot(&freedom.angular, &bias[index].torque),
                    graph.dot(&freedom.linear, &bias[index].force),
                );
                graph.add(a, b)
            };
            let rest = graph.sub(load[i], felt);
            let share = (
                scale3(graph, inverse, torque),
                scale3(graph, inverse, force),
            );
            inertia[index].reduce(graph, (torque, force), share);
            let wrench = &mut bias[index];
            let (t, f) = (scale3(graph, rest, share.0), scale3(graph, rest, share.1));
            wrench.torque = add3(graph, wrench.torque, t);
            wrench.force = add3(graph, wrench.force, f);
            pivots[index].push(Pivot {
                share,
                inverse,
                rest,
            });
        }
        if let Some(parent) = link.parent {
            let moved = inertia[index].carried(graph, link);
            inertia[parent].add(graph, &moved);
            let moved = carried(graph, link, &bias[index]);
            let sum = &mut bias[parent];
            sum.torque = add3(graph, sum.torque, moved.torque);
            sum.force = add3(graph, sum.force, moved.force);
        }
    }
    let mut xi_dot = vec![zero; load.len()];
    let mut motions: Vec<(Vec3, Vec3)> = Vec::with_capacity(tree.links.len());
    for (index, link) in tree.links.iter().enumerate() {
        let none = zero3(graph);
        let (alpha, a) = link.parent.map_or((none, none), |parent| motions[parent]);
        let swing = cross(graph, alpha, link.position);
        let a = add3(graph, a, swing);
        let mut motion = (link.back(graph, alpha), link.back(graph, a));
        for (freedom, pivot) in link.freedoms.iter().zip(&pivots[index]).rev() {
            let own = graph.mul(pivot.rest, pivot.inverse);
            let (t, f) = (
                graph.dot(&pivot.share.0, &motion.0),
                graph.dot(&pivot.share.1, &motion.1),
            );
            let carried = graph.add(t, f);
            let rate = graph.sub(own, carried);
            let (w, v) = (
                scale3(graph, rate, freedom.angular),
                scale3(graph, rate, freedom.linear),
            );
            motion = (add3(graph, motion.0, w), add3(graph, motion.1, v));
            if let Some(&(i, _)) = freedom.rate.first() {
                xi_dot[i] = rate;
            }
        }
        motions.push(motion);
    }
    Some(Solution {
        xi_dot,
        pivots: guards,
    })
}

impl Inertia {
    fn rigid(graph: &mut Graph, mass: &Mass) -> Self {
        let zero = graph.zero();
        let s = &mass.second;
        let [x, y, z] = mass.first;
        let j = std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                if i == k {
                    graph.add(s[(i + 1) % 3][(i + 1) % 3], s[(i + 2) % 3][(i + 2) % 3])
                } else {
                    -s[i][k]
                }
            })
        });
        let identity = identity3(graph);
        Inertia {
            j,
            h: [[zero, -z, y], [z, zero, -x], [-y, x, zero]],
            m: identity.map(|row| row.map(|entry| graph.mul(entry, mass.mass))),
        }
    }

    fn wrench(&self, graph: &mut Graph, alpha: Vec3, a: Vec3) -> (Vec3, Vec3) {
        let torque = std::array::from_fn(|i| {
            let (x, y) = (graph.dot(&self.j[i], &alpha), graph.dot(&self.h[i], &a));
            graph.add(x, y)
        });
        let force = std::array::from_fn(|i| {
            let column = self.h.map(|row| row[i]);
            let (x, y) = (graph.dot(&column, &alpha), graph.dot(&self.m[i], &a));
            graph.add(x, y)
        });
        (torque, force)
    }

    /// Less the part that the freedom yields.
    fn reduce(&mut self, graph: &mut Graph, whole: (Vec3, Vec3), share: (Vec3, Vec3)) {
        for i in 0..3 {
            for k in 0..3 {
                if k <= i {
                    let product = graph.mul(whole.0[i], share.0[k]);
                    self.j[i][k] = graph.sub(self.j[i][k], product);
                    self.j[k][i] = self.j[i][k];
                    let product = graph.mul(whole.1[i], share.1[k]);
                    self.m[i][k] = graph.sub(self.m[i][k], product);
                    self.m[k][i] = self.m[i][k];
                }
                let product = graph.mul(whole.0[i], share.1[k]);
                self.h[i][k] = graph.sub(self.h[i][k], product);
            }
        }
    }

    /// About the origin and in the axes of the link before: H' = H + p̂ M,
    /// J' = J + p̂ Hᵀ − H' p̂.
    fn carried(&self, graph: &mut Graph, link: &Link) -> Self {
        let mut turned = *self;
        for turn in link.turns.iter().rev() {
            turned = Inertia {
                j: turn.symmetric(graph, &turned.j),
                h: turn.general(graph, &turned.h),
                m: turn.symmetric(graph, &turned.m),
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
        // Column k of p̂ Hᵀ is p × (row k of H); column k of −H' p̂ᵀ… is row-wise −(H' p̂).
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
                for (own, other) in [(&mut self.j, &other.j), (&mut self.m, &other.m)] {
                    own[i][k] = graph.add(own[i][k], other[i][k]);
                    own[k][i] = own[i][k];
                }
            }
        }
    }
}
