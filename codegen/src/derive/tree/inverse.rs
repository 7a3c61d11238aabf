//! Inverse dynamics by recursion: velocities and accelerations outwards, forces inwards
//! (Luh, Walker and Paul 1980), with U = α̂ + ω̂ ω̂ and second moments S:
//! force m a + U h, torque vee(U S − (U S)ᵀ) + h × a about the origin of each link.

use super::mass::Mass;
use super::{Link, Tree};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{
    Mat3, Vec3, add3, apply3, cross, identity3, multiply3, scale3, transpose3, zero3,
};

/// Force and torque about the origin of a link, in its axes.
#[derive(Clone, Copy, Debug)]
pub struct Wrench {
    /// Force (N).
    pub force: Vec3,
    /// Torque (N m).
    pub torque: Vec3,
}

impl Wrench {
    /// Both together.
    pub fn plus(&self, graph: &mut Graph, other: &Wrench) -> Self {
        Wrench {
            force: add3(graph, self.force, other.force),
            torque: add3(graph, self.torque, other.torque),
        }
    }

    /// k times the wrench.
    pub fn scaled(&self, graph: &mut Graph, k: Edge) -> Self {
        Wrench {
            torque: scale3(graph, k, self.torque),
            force: scale3(graph, k, self.force),
        }
    }
}

/// A link's motion in its axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkMotion {
    /// Angular velocity.
    pub(crate) omega: Vec3,
    /// Angular acceleration.
    pub(crate) alpha: Vec3,
    /// Acceleration of the origin, less gravity.
    pub(crate) a: Vec3,
    /// α̂ + ω̂ ω̂.
    pub(crate) u: Mat3,
    /// Its motion if its joint were locked, ω, α and a: that of the link before.
    pub(crate) from_parent: [Vec3; 3],
    /// Its joint's own angular velocity and velocity.
    pub(crate) relative: (Vec3, Vec3),
}

/// What the motion of every link needs, at rates ξ (the model's, or zero) and ξ̇ and under gravity (world
/// axes).
pub fn wrenches(
    graph: &mut Graph,
    tree: &Tree,
    xi: &[Edge],
    xi_dot: &[Edge],
    gravity: Vec3,
) -> Vec<Wrench> {
    let motions = motions(graph, tree, xi, xi_dot, gravity);
    let links = tree.links.iter().zip(&motions);
    links
        .map(|(link, motion)| wrench(graph, &link.mass, motion))
        .collect()
}

/// How U = α̂ + ω̂ ω̂ is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tensors {
    /// From ω and α of each link.
    Each,
    /// From U of the link before, where only signs and order of the axes change between them.
    Chained,
}

/// The motion of every link.
pub(crate) fn motions(
    graph: &mut Graph,
    tree: &Tree,
    xi: &[Edge],
    xi_dot: &[Edge],
    gravity: Vec3,
) -> Vec<LinkMotion> {
    motions_by(Tensors::Each, graph, tree, (xi, xi_dot), gravity)
}

/// The same, with U computed in one way or the other.
pub(crate) fn motions_by(
    tensors: Tensors,
    graph: &mut Graph,
    tree: &Tree,
    (xi, xi_dot): (&[Edge], &[Edge]),
    gravity: Vec3,
) -> Vec<LinkMotion> {
    let zero = zero3(graph);
    let ground = LinkMotion {
        omega: zero,
        alpha: zero,
        a: gravity.map(|entry| -entry),
        u: [zero; 3],
        from_parent: [zero; 3],
        relative: (zero, zero),
    };
    let mut motions: Vec<LinkMotion> = Vec::with_capacity(tree.links.len());
    for link in &tree.links {
        let before = link.parent.map_or(ground, |parent| motions[parent]);
        motions.push(outward(graph, link, &before, (xi, xi_dot), tensors));
    }
    motions
}

fn outward(
    graph: &mut Graph,
    link: &Link,
    before: &LinkMotion,
    (xi, xi_dot): (&[Edge], &[Edge]),
    tensors: Tensors,
) -> LinkMotion {
    let zero = zero3(graph);
    let mut relative = (zero, zero);
    // The velocity product is that of the model's ξ: at rest there is none.
    let rest = xi.iter().all(|&rate| rate == graph.zero());
    let mut change = if rest {
        (zero, zero)
    } else {
        link.velocity_product
    };
    for freedom in &link.freedoms {
        let rate = freedom.rate_of(graph, xi);
        let acceleration = freedom.rate_of(graph, xi_dot);
        let (w, v) = (
            scale3(graph, rate, freedom.angular),
            scale3(graph, rate, freedom.linear),
        );
        relative = (add3(graph, relative.0, w), add3(graph, relative.1, v));
        let (w, v) = (
            scale3(graph, acceleration, freedom.angular),
            scale3(graph, acceleration, freedom.linear),
        );
        change = (add3(graph, change.0, w), add3(graph, change.1, v));
    }
    let omega_before = link.from_parent_axes(graph, before.omega);
    let omega = add3(graph, omega_before, relative.0);
    let gyro = cross(graph, omega_before, relative.0);
    let alpha_before = link.from_parent_axes(graph, before.alpha);
    let alpha = add3(graph, alpha_before, gyro);
    let alpha = add3(graph, alpha, change.0);
    let across = apply3(graph, &before.u, link.position);
    let a = add3(graph, before.a, across);
    let mut a = link.from_parent_axes(graph, a);
    let from_parent = [omega_before, alpha_before, a];
    if relative.1 != zero {
        let twice = add3(graph, omega_before, omega);
        let coriolis = cross(graph, twice, relative.1);
        a = add3(graph, a, coriolis);
    }
    let a = add3(graph, a, change.1);
    // One of the two: equal expressions are computed as the first of them says.
    let u = match tensors {
        Tensors::Each => None,
        Tensors::Chained => chained(graph, link, before, omega_before, (xi, xi_dot)),
    };
    LinkMotion {
        omega,
        alpha,
        a,
        u: u.unwrap_or_else(|| tensor(graph, omega, alpha)),
        from_parent,
        relative,
    }
}

/// U of a link on a hinge from U₀ of the link before: U₀ + θ̈ ẑ + 2 θ̇ ω̂₀ ẑ + θ̇² ẑ ẑ, whose third column is that of U₀,
/// with ω₀ in the axes of this link; `None` for other joints, and where the axes in between are turned.
fn chained(
    graph: &mut Graph,
    link: &Link,
    before: &LinkMotion,
    [x, y, z]: Vec3,
    (xi, xi_dot): (&[Edge], &[Edge]),
) -> Option<Mat3> {
    let (zero, one) = (graph.zero(), graph.one());
    let [freedom] = link.freedoms.as_slice() else {
        return None;
    };
    if freedom.angular != [zero, zero, one] || freedom.linear != zero3(graph) {
        return None;
    }
    let turn = identity3(graph).map(|axis| link.from_parent_axes(graph, axis));
    let is_kept = |entry: &Edge| *entry == zero || entry.abs() == one;
    if !turn.iter().flatten().all(is_kept) {
        return None;
    }
    let mut u = multiply3(graph, &before.u, &turn);
    u = multiply3(graph, &transpose3(&turn), &u);
    let (rate, acceleration) = (freedom.rate_of(graph, xi), freedom.rate_of(graph, xi_dot));
    let twice = graph.add(rate, rate);
    let (along_x, along_y) = (graph.mul(twice, x), graph.mul(twice, y));
    let along_z = {
        let both = graph.add(z, z);
        let sum = graph.add(both, rate);
        graph.mul(sum, rate)
    };
    u[0][0] = graph.sub(u[0][0], along_z);
    u[1][1] = graph.sub(u[1][1], along_z);
    u[1][0] = graph.add(u[1][0], acceleration);
    u[0][1] = graph.sub(u[0][1], acceleration);
    u[2][0] = graph.add(u[2][0], along_x);
    u[2][1] = graph.add(u[2][1], along_y);
    Some(u)
}

/// α̂ + ω̂ ω̂ = α̂ + ω ωᵀ − |ω|² I.
pub(crate) fn tensor(graph: &mut Graph, omega: Vec3, alpha: Vec3) -> Mat3 {
    let square = omega.map(|w| graph.mul(w, w));
    let mut u = [zero3(graph); 3];
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        u[i][i] = -graph.add(square[j], square[k]);
        let product = graph.mul(omega[j], omega[k]);
        u[j][k] = graph.sub(product, alpha[i]);
        u[k][j] = graph.add(product, alpha[i]);
    }
    u
}

pub(super) fn wrench(graph: &mut Graph, mass: &Mass, motion: &LinkMotion) -> Wrench {
    let LinkMotion { a, u, .. } = motion;
    let s = &mass.second;
    let push = scale3(graph, mass.mass, *a);
    let across = apply3(graph, u, mass.first);
    let lever = cross(graph, mass.first, *a);
    let spin: Vec3 = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let difference = graph.sub(u[k][k], u[j][j]);
        let terms = [
            graph.mul(u[k][j], s[j][j]),
            -graph.mul(u[j][k], s[k][k]),
            graph.mul(difference, s[j][k]),
            graph.mul(u[k][i], s[i][j]),
            -graph.mul(u[j][i], s[i][k]),
        ];
        graph.sum(&terms)
    });
    Wrench {
        force: add3(graph, push, across),
        torque: add3(graph, spin, lever),
    }
}

/// The generalised force of wrenches on links: Σ over what hangs on each joint.
pub fn collect(graph: &mut Graph, tree: &Tree, wrenches: &[Wrench], n: usize) -> Vec<Edge> {
    collect_with(graph, tree, wrenches, n, |_, _, total| *total)
}

/// The same of what becomes of the wrench on all that hangs on a joint, before it acts on the joint.
pub(super) fn collect_with(
    graph: &mut Graph,
    tree: &Tree,
    wrenches: &[Wrench],
    n: usize,
    mut becomes: impl FnMut(&mut Graph, usize, &Wrench) -> Wrench,
) -> Vec<Edge> {
    let mut totals = wrenches.to_vec();
    let mut forces = vec![graph.zero(); n];
    for (index, link) in tree.links.iter().enumerate().rev() {
        let total = totals[index];
        let acting = becomes(graph, index, &total);
        link.add_forces(graph, &acting, &mut forces);
        if let Some(parent) = link.parent {
            let total = to_parent(graph, link, &total);
            totals[parent] = totals[parent].plus(graph, &total);
        }
    }
    forces
}

/// A wrench on a link as one on the link before, about the origin and in the axes of that one.
pub fn to_parent(graph: &mut Graph, link: &Link, wrench: &Wrench) -> Wrench {
    let force = link.to_parent_axes(graph, wrench.force);
    let torque = link.to_parent_axes(graph, wrench.torque);
    let lever = cross(graph, link.position, force);
    Wrench {
        force,
        torque: add3(graph, torque, lever),
    }
}

/// M ξ̇ + Γ ξ ξ + ∂V of gravity.
pub fn inverse(
    graph: &mut Graph,
    tree: &Tree,
    xi: &[Edge],
    xi_dot: &[Edge],
    gravity: Vec3,
) -> Vec<Edge> {
    let wrenches = wrenches(graph, tree, xi, xi_dot, gravity);
    let forces = collect(graph, tree, &wrenches, xi.len());
    let rotors = tree.armature.iter().zip(xi_dot);
    forces
        .iter()
        .zip(rotors)
        .map(|(&force, (&armature, &rate))| {
            let rotor = graph.mul(armature, rate);
            graph.add(force, rotor)
        })
        .collect()
}
