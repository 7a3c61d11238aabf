//! Recursive inverse dynamics (Luh, Walker and Paul 1980): velocities and accelerations from the
//! root outwards, forces inwards.
//!
//! With U = α̂ + ω̂ ω̂, mass m, first moment h and second moment S, a link needs, about its origin,
//! force m a + U h, torque vee(U S − (U S)ᵀ) + h × a.
//!
//! For a hinge about an axis e the column U e equals that of the parent link, since ê e = 0. Given
//! U e, ω and α·e, the rest of U takes fewer operations than from ω and α.

use super::link::{Link, TensorRoute, Tree};
use super::mass::LinkInertia;
use super::wrench::Wrench;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{
    Mat3, Vec3, add3, apply3, cross, identity3, multiply3, scale3, transpose3, zero3,
};
use hamel_program::count::count;
use hamel_program::provenance::Quantity;

/// Motion of a link in its own axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkMotion {
    /// Angular velocity.
    pub(crate) omega: Vec3,
    /// Angular acceleration.
    pub(crate) alpha: Vec3,
    /// Acceleration of the origin minus gravity.
    pub(crate) a: Vec3,
    /// U = α̂ + ω̂ ω̂.
    pub(crate) u: Mat3,
    /// U_zz − U_yy, U_xx − U_zz and U_yy − U_xx.
    differences: Vec3,
    /// The link's ω, α and a if its joint were locked, that is, if it moved with its parent.
    pub(crate) from_parent: [Vec3; 3],
    /// Angular velocity and velocity relative to the parent.
    pub(crate) relative: (Vec3, Vec3),
}

impl LinkMotion {
    /// Returns U_jj − U_kk for two different axes j, k.
    pub(crate) fn difference(&self, j: usize, k: usize) -> Edge {
        let difference = self.differences[3 - j - k];
        if (j + 1) % 3 == k {
            -difference
        } else {
            difference
        }
    }
}

/// Returns for each link the wrench that its motion and gravity require, about its origin and in its axes, without that
/// of its children.
///
/// `xi` are the velocities ξ (those of the model, or zero), `xi_dot` their derivatives, and
/// `gravity` is given in world axes.
pub fn required_wrenches(
    graph: &mut Graph,
    tree: &Tree,
    xi: &[Edge],
    xi_dot: &[Edge],
    gravity: Vec3,
) -> Vec<Wrench> {
    let motions = motions(graph, tree, xi, xi_dot, gravity);
    let links = tree.links.iter().zip(&motions);
    let wrenches: Vec<Wrench> = links
        .map(|(link, motion)| wrench(graph, &link.mass, motion))
        .collect();
    if let Some(made) = LinkQuantities::of(graph, xi, xi_dot) {
        for (link, wrench) in tree.links.iter().zip(&wrenches) {
            wrench.label(graph, made.wrench.of(link.frame));
        }
    }
    wrenches
}

/// Quantities that the recursion makes for each link.
struct LinkQuantities {
    alpha: Quantity,
    acceleration: Quantity,
    wrench: Quantity,
}

impl LinkQuantities {
    /// Returns the quantities of a motion with these velocities and accelerations. `None` if velocities stand in the
    /// place of accelerations, for a momentum.
    fn of(graph: &Graph, xi: &[Edge], xi_dot: &[Edge]) -> Option<Self> {
        let is_zero = |&rate: &Edge| rate == graph.zero();
        let rests = xi.iter().all(is_zero);
        // Accelerations that are still unknown are set to zero, those of drives are not.
        match xi_dot.iter().any(is_zero) {
            true if rests && !xi_dot.iter().all(is_zero) => None,
            true => Some(LinkQuantities {
                alpha: Quantity::LinkBiasAngularAcceleration,
                acceleration: Quantity::LinkBiasAcceleration,
                wrench: Quantity::LinkBiasWrench,
            }),
            false if rests => None,
            false => Some(LinkQuantities {
                alpha: Quantity::LinkAngularAcceleration,
                acceleration: Quantity::LinkAcceleration,
                wrench: Quantity::LinkWrench,
            }),
        }
    }
}

/// All variants, the simplest first.
pub(crate) const TENSOR_ROUTES: [TensorRoute; 3] = [
    TensorRoute::Each,
    TensorRoute::Carried,
    TensorRoute::Chained,
];
/// Variants that compute α of every link, too.
pub(crate) const TENSOR_ROUTES_WITH_ALPHA: [TensorRoute; 2] =
    [TensorRoute::Each, TensorRoute::Carried];

/// Velocities ξ, their derivatives ξ̇ and gravity.
pub(crate) type Motion<'a> = (&'a [Edge], &'a [Edge], Vec3);

impl Tree {
    /// Returns the tree with the variant for U by which M ξ̇ + Γ ξ ξ + ∂V of a motion is cheapest.
    ///
    /// The cost is that of adding these forces to (a copy of) the graph.
    pub(crate) fn cheapest(&self, ways: &[TensorRoute], graph: &Graph, motion: Motion) -> Tree {
        let with = |&tensors: &TensorRoute| Tree {
            tensors,
            ..self.clone()
        };
        let cost = |tree: &Tree| {
            let mut graph = graph.clone();
            let (xi, xi_dot, gravity) = motion;
            let forces = inverse_dynamics(&mut graph, tree, xi, xi_dot, gravity);
            count(&graph, &forces).weight()
        };
        let cheapest = ways.iter().map(with).min_by_key(cost);
        cheapest.unwrap_or_else(|| self.clone())
    }
}

/// Computes the motion of every link.
pub(crate) fn motions(
    graph: &mut Graph,
    tree: &Tree,
    xi: &[Edge],
    xi_dot: &[Edge],
    gravity: Vec3,
) -> Vec<LinkMotion> {
    let zero = zero3(graph);
    let ground = LinkMotion {
        omega: zero,
        alpha: zero,
        a: gravity.map(|entry| -entry),
        u: [zero; 3],
        differences: zero,
        from_parent: [zero; 3],
        relative: (zero, zero),
    };
    // At rest, U = α̂.
    let rest = xi.iter().all(|&rate| rate == graph.zero());
    let tensors = if rest {
        TensorRoute::Each
    } else {
        tree.tensors
    };
    // Links whose α is needed by a child.
    let mut passing = vec![false; tree.links.len()];
    for link in &tree.links {
        let is_chained = tensors == TensorRoute::Chained && kept_axes(graph, link).is_some();
        if let Some(parent) = link.parent.filter(|_| !is_chained) {
            passing[parent] = true;
        }
    }
    let mut motions: Vec<LinkMotion> = Vec::with_capacity(tree.links.len());
    for (link, passes) in tree.links.iter().zip(passing) {
        let before = link.parent.map_or(ground, |parent| motions[parent]);
        let way = (tensors, passes);
        let motion = outward(graph, link, &before, (xi, xi_dot), way);
        if let Some(made) = LinkQuantities::of(graph, xi, xi_dot) {
            let of = |quantity: Quantity| quantity.of(link.frame);
            graph.label(&motion.omega, of(Quantity::LinkAngularVelocity));
            graph.label(&motion.alpha, of(made.alpha));
            graph.label(&motion.u.concat(), of(Quantity::LinkTensor));
            graph.label(&motion.differences, of(Quantity::LinkTensor));
            graph.label(&motion.a, of(made.acceleration));
        }
        motions.push(motion);
    }
    motions
}

fn outward(
    graph: &mut Graph,
    link: &Link,
    before: &LinkMotion,
    (xi, xi_dot): (&[Edge], &[Edge]),
    (tensors, passes): (TensorRoute, bool),
) -> LinkMotion {
    let zero = zero3(graph);
    let mut relative = (zero, zero);
    // The velocity-product acceleration holds for the model's ξ; at rest it is zero.
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
    let alpha_before = link.from_parent_axes(graph, before.alpha);
    let turning = match tensors {
        TensorRoute::Each => None,
        TensorRoute::Chained if kept_axes(graph, link).is_some() => None,
        TensorRoute::Carried | TensorRoute::Chained => {
            let along = add3(graph, alpha_before, change.0);
            carry_tensor(graph, link, before, (omega, along), passes)
        }
    };
    let turning = turning.unwrap_or_else(|| {
        let gyro = cross(graph, omega_before, relative.0);
        let alpha = add3(graph, alpha_before, gyro);
        let alpha = add3(graph, alpha, change.0);
        let chained = match tensors {
            TensorRoute::Each | TensorRoute::Carried => None,
            TensorRoute::Chained => chain_tensor(graph, link, before, omega_before, (xi, xi_dot)),
        };
        match chained {
            Some(u) => RotationalMotion::with(graph, alpha, u),
            None => RotationalMotion::of(graph, omega, alpha),
        }
    });
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
    let RotationalMotion {
        alpha,
        u,
        differences,
    } = turning;
    LinkMotion {
        omega,
        alpha,
        a,
        u,
        differences,
        from_parent,
        relative,
    }
}

/// Rotational motion of a link: α and U.
pub(crate) struct RotationalMotion {
    alpha: Vec3,
    /// α̂ + ω̂ ω̂ = α̂ + ω ωᵀ − |ω|² I.
    pub(crate) u: Mat3,
    /// Differences of the diagonal entries of U, as in [`LinkMotion`].
    pub(crate) differences: Vec3,
}

impl RotationalMotion {
    pub(crate) fn of(graph: &mut Graph, omega: Vec3, alpha: Vec3) -> Self {
        let square = omega.map(|w| graph.mul(w, w));
        let mut differences = zero3(graph);
        let mut u = [zero3(graph); 3];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            differences[i] = graph.sub(square[k], square[j]);
            u[i][i] = -graph.add(square[j], square[k]);
            let product = graph.mul(omega[j], omega[k]);
            u[j][k] = graph.sub(product, alpha[i]);
            u[k][j] = graph.add(product, alpha[i]);
        }
        RotationalMotion {
            alpha,
            u,
            differences,
        }
    }

    fn with(graph: &mut Graph, alpha: Vec3, u: Mat3) -> Self {
        let difference = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            graph.sub(u[k][k], u[j][j])
        };
        RotationalMotion {
            alpha,
            u,
            differences: [0, 1, 2].map(difference),
        }
    }
}

/// Returns the axes of the parent in those of a link on a hinge about its third axis, if the two
/// differ only in sign and order.
fn kept_axes(graph: &mut Graph, link: &Link) -> Option<Mat3> {
    let (zero, one) = (graph.zero(), graph.one());
    let [freedom] = link.freedoms.as_slice() else {
        return None;
    };
    if freedom.angular != [zero, zero, one] || freedom.linear != zero3(graph) {
        return None;
    }
    let axes = identity3(graph).map(|axis| link.from_parent_axes(graph, axis));
    let is_kept = |entry: &Edge| *entry == zero || entry.abs() == one;
    axes.iter().flatten().all(is_kept).then_some(axes)
}

/// Computes U of a link on a hinge from U₀ of its parent: U₀ + θ̈ ẑ + 2 θ̇ ω̂₀ ẑ + θ̇² ẑ ẑ.
///
/// Here ω₀ is in the axes of this link, and the third column is that of U₀. Returns `None` for
/// other joints, and if the axes of link and parent do not just differ in sign and order.
fn chain_tensor(
    graph: &mut Graph,
    link: &Link,
    before: &LinkMotion,
    [x, y, z]: Vec3,
    (xi, xi_dot): (&[Edge], &[Edge]),
) -> Option<Mat3> {
    let axes = kept_axes(graph, link)?;
    let [freedom] = link.freedoms.as_slice() else {
        return None;
    };
    let mut u = multiply3(graph, &before.u, &axes);
    u = multiply3(graph, &transpose3(&axes), &u);
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

/// Computes α and U of a link from U h, ω and α·h, where h is the axis of its hinge.
///
/// Returns `None` unless the joint is a hinge whose axis is a coordinate axis of both the link and
/// its parent. `passes` says whether a child needs α, which decides what is cheaper.
fn carry_tensor(
    graph: &mut Graph,
    link: &Link,
    before: &LinkMotion,
    (omega, along): (Vec3, Vec3),
    passes: bool,
) -> Option<RotationalMotion> {
    let zero = zero3(graph);
    let [freedom] = link.freedoms.as_slice() else {
        return None;
    };
    if freedom.linear != zero || link.velocity_product.0 != zero {
        return None;
    }
    let units = identity3(graph);
    let is_unit = |v: Vec3| units.contains(&v.map(Edge::abs));
    let h = (0..3).find(|&h| freedom.angular.map(Edge::abs) == units[h])?;
    let (j, l) = ((h + 1) % 3, (h + 2) % 3);
    let axis = link.to_parent_axes(graph, units[h]);
    if !is_unit(axis) {
        return None;
    }
    let column = apply3(graph, &before.u, axis);
    let column = link.from_parent_axes(graph, column);
    let mut u = [zero; 3];
    for k in 0..3 {
        u[k][h] = column[k];
    }
    // Row h: U_hk + U_kh = 2 ω_h ω_k.
    if !passes {
        let twice = graph.add(omega[h], omega[h]);
        for k in [j, l] {
            let both = graph.mul(twice, omega[k]);
            u[h][k] = graph.sub(both, u[k][h]);
        }
    }
    let (hj, hl) = (graph.mul(omega[h], omega[j]), graph.mul(omega[h], omega[l]));
    let mut alpha = along;
    alpha[j] = graph.sub(hl, u[l][h]);
    alpha[l] = graph.sub(u[j][h], hj);
    if passes {
        u[h][l] = graph.add(hl, alpha[j]);
        u[h][j] = graph.sub(hj, alpha[l]);
    }
    let product = graph.mul(omega[j], omega[l]);
    u[j][l] = graph.sub(product, alpha[h]);
    u[l][j] = graph.add(product, alpha[h]);
    // Diagonal: U_hh is known, and U_jj − U_hh = ω_j² − ω_h².
    let (hh, jj) = (graph.mul(omega[h], omega[h]), graph.mul(omega[j], omega[j]));
    let mut differences = zero;
    differences[l] = graph.sub(jj, hh);
    u[j][j] = graph.add(u[h][h], differences[l]);
    u[l][l] = -graph.add(hh, jj);
    // After the first hinge of a chain, U_hh is the square of that hinge's rate, which may be
    // needed nowhere else.
    let is_plane = before.omega.iter().filter(|w| **w == graph.zero()).count() == 2;
    (differences[h], differences[j]) = if is_plane {
        let ll = graph.mul(omega[l], omega[l]);
        (graph.sub(ll, jj), graph.sub(hh, ll))
    } else {
        (graph.sub(u[l][l], u[j][j]), graph.sub(u[h][h], u[l][l]))
    };
    Some(RotationalMotion {
        alpha,
        u,
        differences,
    })
}

pub(super) fn wrench(graph: &mut Graph, mass: &LinkInertia, motion: &LinkMotion) -> Wrench {
    let LinkMotion { a, u, .. } = motion;
    let s = &mass.second;
    let push = scale3(graph, mass.mass, *a);
    let across = apply3(graph, u, mass.first);
    let lever = cross(graph, mass.first, *a);
    let spin: Vec3 = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let difference = motion.difference(k, j);
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

/// Returns the n generalised forces of wrenches on links: at each joint, that of the sum over its subtree.
pub fn generalized_forces(
    graph: &mut Graph,
    tree: &Tree,
    wrenches: &[Wrench],
    n: usize,
) -> Vec<Edge> {
    generalized_forces_with(graph, tree, wrenches, n, |_, _, total| *total)
}

/// As [`generalized_forces`], with a function that maps the wrench on a joint's subtree to the one that acts
/// on the joint.
pub(super) fn generalized_forces_with(
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

/// Transforms a wrench on a link to its parent, about the origin and in the axes of the parent.
pub fn to_parent(graph: &mut Graph, link: &Link, wrench: &Wrench) -> Wrench {
    let force = link.to_parent_axes(graph, wrench.force);
    let torque = link.to_parent_axes(graph, wrench.torque);
    let lever = cross(graph, link.position, force);
    Wrench {
        force,
        torque: add3(graph, torque, lever),
    }
}

/// Returns the inverse dynamics M ξ̇ + Γ ξ ξ + ∂V, where V is the potential of gravity.
pub fn inverse_dynamics(
    graph: &mut Graph,
    tree: &Tree,
    xi: &[Edge],
    xi_dot: &[Edge],
    gravity: Vec3,
) -> Vec<Edge> {
    let wrenches = required_wrenches(graph, tree, xi, xi_dot, gravity);
    let forces = match LinkQuantities::of(graph, xi, xi_dot) {
        None => generalized_forces(graph, tree, &wrenches, xi.len()),
        Some(_) => {
            generalized_forces_with(graph, tree, &wrenches, xi.len(), |graph, index, total| {
                let frame = tree.links[index].frame;
                total.label(graph, Quantity::JointWrench.of(frame));
                *total
            })
        }
    };
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
