//! Inverse dynamics by recursion: velocities and accelerations outwards, forces inwards
//! (Luh, Walker and Paul 1980), with U = α̂ + ω̂ ω̂ and second moments S:
//! force m a + U h, torque vee(U S − (U S)ᵀ) + h × a about the origin of each link.
//!
//! Behind a hinge about an axis e the column U e is that of the link before, since ê e = 0. With it, ω and α·e the rest of U takes
//! fewer operations than with ω and α.

use super::mass::Mass;
use super::{Link, Tree};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{
    Mat3, Vec3, add3, apply3, cross, identity3, multiply3, scale3, transpose3, zero3,
};
use hamel_program::count::count;

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
    /// U_zz − U_yy, U_xx − U_zz and U_yy − U_xx.
    differences: Vec3,
    /// Its motion if its joint were locked, ω, α and a: that of the link before.
    pub(crate) from_parent: [Vec3; 3],
    /// Its joint's own angular velocity and velocity.
    pub(crate) relative: (Vec3, Vec3),
}

impl LinkMotion {
    /// U_jj − U_kk of two axes.
    pub(crate) fn difference(&self, j: usize, k: usize) -> Edge {
        let difference = self.differences[3 - j - k];
        if (j + 1) % 3 == k {
            -difference
        } else {
            difference
        }
    }
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
pub enum Tensors {
    /// From ω and α of each link.
    Each,
    /// Behind a hinge about an axis of the link before, with the column along it from there.
    Carried,
    /// All of it from the link before where only signs and order of the axes change between them, and its column elsewhere.
    Chained,
}

/// All of them, the plainest first.
pub(crate) const TENSORS: [Tensors; 3] = [Tensors::Each, Tensors::Carried, Tensors::Chained];
/// Those by which α of every link is there, too.
pub(crate) const WITH_ALPHA: [Tensors; 2] = [Tensors::Each, Tensors::Carried];

/// ξ, ξ̇ and gravity.
pub(crate) type Motion<'a> = (&'a [Edge], &'a [Edge], Vec3);

impl Tree {
    /// The tree with U of its links computed as M ξ̇ + Γ ξ ξ + ∂V of a motion costs least in a graph.
    pub(crate) fn cheapest(&self, ways: &[Tensors], graph: &Graph, motion: Motion) -> Tree {
        let with = |&tensors: &Tensors| Tree {
            tensors,
            ..self.clone()
        };
        let cost = |tree: &Tree| {
            let mut graph = graph.clone();
            let (xi, xi_dot, gravity) = motion;
            let forces = inverse(&mut graph, tree, xi, xi_dot, gravity);
            count(&graph, &forces).weight()
        };
        let cheapest = ways.iter().map(with).min_by_key(cost);
        cheapest.unwrap_or_else(|| self.clone())
    }
}

/// The motion of every link.
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
    // At rest U is α̂.
    let rest = xi.iter().all(|&rate| rate == graph.zero());
    let tensors = if rest { Tensors::Each } else { tree.tensors };
    // The links behind which α is needed.
    let mut passing = vec![false; tree.links.len()];
    for link in &tree.links {
        let is_chained = tensors == Tensors::Chained && kept_axes(graph, link).is_some();
        if let Some(parent) = link.parent.filter(|_| !is_chained) {
            passing[parent] = true;
        }
    }
    let mut motions: Vec<LinkMotion> = Vec::with_capacity(tree.links.len());
    for (link, passes) in tree.links.iter().zip(passing) {
        let before = link.parent.map_or(ground, |parent| motions[parent]);
        let way = (tensors, passes);
        motions.push(outward(graph, link, &before, (xi, xi_dot), way));
    }
    motions
}

fn outward(
    graph: &mut Graph,
    link: &Link,
    before: &LinkMotion,
    (xi, xi_dot): (&[Edge], &[Edge]),
    (tensors, passes): (Tensors, bool),
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
    let alpha_before = link.from_parent_axes(graph, before.alpha);
    let turning = match tensors {
        Tensors::Each => None,
        Tensors::Chained if kept_axes(graph, link).is_some() => None,
        Tensors::Carried | Tensors::Chained => {
            let along = add3(graph, alpha_before, change.0);
            carried(graph, link, before, (omega, along), passes)
        }
    };
    let turning = turning.unwrap_or_else(|| {
        let gyro = cross(graph, omega_before, relative.0);
        let alpha = add3(graph, alpha_before, gyro);
        let alpha = add3(graph, alpha, change.0);
        let chained = match tensors {
            Tensors::Each | Tensors::Carried => None,
            Tensors::Chained => chained(graph, link, before, omega_before, (xi, xi_dot)),
        };
        match chained {
            Some(u) => Turning::with(graph, alpha, u),
            None => Turning::of(graph, omega, alpha),
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
    let Turning {
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

/// How a link turns: α and U, computed in one way.
pub(crate) struct Turning {
    alpha: Vec3,
    /// α̂ + ω̂ ω̂ = α̂ + ω ωᵀ − |ω|² I.
    pub(crate) u: Mat3,
    /// Of its diagonal, as in the motion of a link.
    pub(crate) differences: Vec3,
}

impl Turning {
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
        Turning {
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
        Turning {
            alpha,
            u,
            differences: [0, 1, 2].map(difference),
        }
    }
}

/// The axes of the link before in those of a link on a hinge about its third one, where only signs and order are others.
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

/// U of a link on a hinge from U₀ of the link before: U₀ + θ̈ ẑ + 2 θ̇ ω̂₀ ẑ + θ̇² ẑ ẑ, whose third column is that of U₀,
/// with ω₀ in the axes of this link; `None` for other joints, and where the axes in between are turned.
fn chained(
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

/// α and U of a link on a hinge about its axis h, which is an axis of the link before, too, by U h, ω and α·h; `None` for others.
/// Whether a link behind needs α decides what is cheaper.
fn carried(
    graph: &mut Graph,
    link: &Link,
    before: &LinkMotion,
    (omega, along): (Vec3, Vec3),
    passes: bool,
) -> Option<Turning> {
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
    // The row: U_hk + U_kh = 2 ω_h ω_k.
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
    // The diagonal: U_hh is known, and U_jj − U_hh = ω_j² − ω_h².
    let (hh, jj) = (graph.mul(omega[h], omega[h]), graph.mul(omega[j], omega[j]));
    let mut differences = zero;
    differences[l] = graph.sub(jj, hh);
    u[j][j] = graph.add(u[h][h], differences[l]);
    u[l][l] = -graph.add(hh, jj);
    // Behind a first hinge U_hh is the square of its rate, which nothing else may need.
    let is_plane = before.omega.iter().filter(|w| **w == graph.zero()).count() == 2;
    (differences[h], differences[j]) = if is_plane {
        let ll = graph.mul(omega[l], omega[l]);
        (graph.sub(ll, jj), graph.sub(hh, ll))
    } else {
        (graph.sub(u[l][l], u[j][j]), graph.sub(u[h][h], u[l][l]))
    };
    Some(Turning {
        alpha,
        u,
        differences,
    })
}

pub(super) fn wrench(graph: &mut Graph, mass: &Mass, motion: &LinkMotion) -> Wrench {
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
