//! Random trees of bodies on joints: their text, and their dynamics by Newton and Euler in numbers.
//!
//! The recursion is Featherstone's (*Rigid Body Dynamics Algorithms*, 2008, table 5.1) in body
//! coordinates, angular parts first. It shares nothing with the generator.

use super::Random;
use std::fmt::Write;

/// A twist or a wrench: angular part, linear part.
type Six = [f64; 6];
type M3 = [[f64; 3]; 3];

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Revolute,
    Continuous,
    Prismatic,
    Spherical,
    Cylindrical,
    Free,
}

/// A joint with the body that it carries.
pub struct Link {
    pub kind: Kind,
    /// The link that it stands on, the world where absent.
    pub parent: Option<usize>,
    axis: [f64; 3],
    rpy: [f64; 3],
    place: [f64; 3],
    mass: f64,
    com: [f64; 3],
    /// Diagonal of the inertia about the centre of mass, and its products.
    inertia: [f64; 6],
    damping: f64,
    armature: f64,
}

/// Acceleration of gravity.
const GRAVITY: [f64; 3] = [0.5, -0.25, -9.81];

/// A number of two decimals, so that text and test mean the same.
fn short(number: f64) -> f64 {
    (number * 100.0).round() / 100.0
}

impl Link {
    /// A link on one of those before it, or on the world.
    pub fn random(random: &mut Random, before: usize, kinds: &[Kind]) -> Self {
        let kind = kinds[random.below(kinds.len())];
        let branch = random.below(before + 1).max(before.saturating_sub(2));
        let parent = branch.checked_sub(1).filter(|_| kind != Kind::Free);
        // Chains of coordinate axes, and now and then any direction.
        let axis = match random.below(5) {
            0 => [0.6, 0.0, -0.8],
            1 => [0.0, -1.0, 0.0],
            2 => [1.0, 0.0, 0.0],
            _ => [0.0, 0.0, 1.0],
        };
        let mut three = |size: f64| [(); 3].map(|()| short(size * random.number()));
        let (rpy, place, com, products) = (three(1.5), three(0.5), three(0.3), three(0.02));
        let rpy = if rpy[0] < 0.0 { [0.0; 3] } else { rpy };
        let moments = [0.21, 0.32, 0.27].map(|m| m + short(0.05 * random.number()));
        let simple = matches!(kind, Kind::Revolute | Kind::Continuous | Kind::Prismatic);
        let field = |most: f64, random: &mut Random| {
            let value = short(most * random.number());
            if simple { value.max(0.0) } else { 0.0 }
        };
        Link {
            kind,
            parent,
            axis,
            rpy,
            place,
            mass: short(1.5 + random.number()),
            com,
            inertia: [
                moments[0],
                moments[1],
                moments[2],
                products[0],
                products[1],
                products[2],
            ],
            damping: field(0.5, random),
            armature: field(0.2, random),
        }
    }

    /// Its entries in x.
    fn coordinates(&self) -> usize {
        match self.kind {
            Kind::Revolute | Kind::Prismatic => 1,
            Kind::Continuous | Kind::Cylindrical => 2,
            Kind::Spherical => 9,
            Kind::Free => 12,
        }
    }

    /// Its velocities.
    fn freedoms(&self) -> usize {
        match self.kind {
            Kind::Revolute | Kind::Prismatic | Kind::Continuous => 1,
            Kind::Cylindrical => 2,
            Kind::Spherical => 3,
            Kind::Free => 6,
        }
    }

    /// Rotation and origin of its frame in the frame before, at its coordinates.
    fn pose(&self, q: &[f64]) -> (M3, [f64; 3]) {
        let fixed = turn(self.rpy);
        let (rotation, shift) = match self.kind {
            Kind::Revolute => (about(self.axis, q[0].cos(), q[0].sin()), [0.0; 3]),
            Kind::Continuous => (about(self.axis, q[0], q[1]), [0.0; 3]),
            Kind::Prismatic => (turn([0.0; 3]), self.axis.map(|n| n * q[0])),
            Kind::Cylindrical => (
                about(self.axis, q[0].cos(), q[0].sin()),
                self.axis.map(|n| n * q[1]),
            ),
            Kind::Spherical => (rows(q), [0.0; 3]),
            Kind::Free => (rows(&q[3..]), [q[0], q[1], q[2]]),
        };
        let moved = apply(&fixed, shift);
        (
            product(&fixed, &rotation),
            std::array::from_fn(|i| self.place[i] + moved[i]),
        )
    }

    /// Columns of its motion, in its own axes: constant for all of these kinds.
    fn columns(&self) -> Vec<Six> {
        let [a, b, c] = self.axis;
        let unit = |k: usize| std::array::from_fn(|i| f64::from(u8::from(i == k)));
        match self.kind {
            Kind::Revolute | Kind::Continuous => vec![[a, b, c, 0.0, 0.0, 0.0]],
            Kind::Prismatic => vec![[0.0, 0.0, 0.0, a, b, c]],
            Kind::Cylindrical => vec![[a, b, c, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, a, b, c]],
            Kind::Spherical => (0..3).map(unit).collect(),
            // v first, then ω.
            Kind::Free => [3, 4, 5, 0, 1, 2].map(unit).to_vec(),
        }
    }

    /// Wrench of its inertia on a twist.
    fn momentum(&self, v: &Six) -> Six {
        let (w, u) = halves(v);
        let [x, y, z, yz, xz, xy] = self.inertia;
        let inertia = [[x, xy, xz], [xy, y, yz], [xz, yz, z]];
        let lever = cross(w, self.com);
        let linear: [f64; 3] = std::array::from_fn(|i| self.mass * (u[i] + lever[i]));
        let own = apply(&inertia, w);
        let moved = cross(self.com, linear);
        whole(std::array::from_fn(|i| own[i] + moved[i]), linear)
    }
}

/// The description of a tree.
pub fn text(links: &[Link]) -> String {
    let mut text = String::from("system Tree {\n");
    let list = |v: &[f64; 3]| format!("[{}, {}, {}]", v[0], v[1], v[2]);
    for (index, link) in links.iter().enumerate() {
        let on = link
            .parent
            .map_or(String::new(), |parent| format!(" on f{parent}"));
        let [r, p, y] = link.rpy;
        let rotation = match link.rpy {
            [0.0, 0.0, 0.0] => "identity(3)".to_owned(),
            _ => format!("rpy({r}, {p}, {y})"),
        };
        let axis = list(&link.axis);
        let kind = match link.kind {
            Kind::Revolute => format!("revolute {axis}"),
            Kind::Continuous => format!("continuous {axis}"),
            Kind::Prismatic => format!("prismatic {axis}"),
            Kind::Cylindrical => format!("cylindrical {axis}"),
            Kind::Spherical => "spherical".to_owned(),
            Kind::Free => "free".to_owned(),
        };
        let (d, j) = (link.damping, link.armature);
        let fields = match (d, j) {
            (0.0, 0.0) => ";".to_owned(),
            _ => format!(" {{ damping {d}; armature {j}; }}"),
        };
        let [x, y, z, yz, xz, xy] = link.inertia;
        let _ = writeln!(
            text,
            "    joint q{index}: {kind}{on} at pose({rotation}, {}) moves f{index}{fields}\n    \
             body on f{index} {{ mass {}; com {}; inertia [[{x}, {xy}, {xz}], [{xy}, {y}, {yz}], [{xz}, {yz}, {z}]] about com; }}",
            list(&link.place),
            link.mass,
            list(&link.com),
        );
    }
    let _ = writeln!(
        text,
        "    gravity {};\n    generate accel, inverse_dynamics, mass_matrix, bias, potential_force, energy, momentum;\n}}",
        list(&GRAVITY)
    );
    text
}

/// A tree at a state.
pub struct Tree<'a> {
    links: &'a [Link],
    /// Rotation and origin of each frame in the one before.
    poses: Vec<(M3, [f64; 3])>,
    twists: Vec<Six>,
    xi: &'a [f64],
}

impl<'a> Tree<'a> {
    /// A tree at (x, ξ).
    pub fn new(links: &'a [Link], x: &[f64], xi: &'a [f64]) -> Self {
        let mut tree = Tree {
            links,
            poses: Vec::new(),
            twists: Vec::new(),
            xi,
        };
        let (mut place, mut speed) = (0, 0);
        for link in links {
            let pose = link.pose(&x[place..place + link.coordinates()]);
            place += link.coordinates();
            tree.poses.push(pose);
            let own = combine(link, &xi[speed..speed + link.freedoms()]);
            speed += link.freedoms();
            let before = link.parent.map_or([0.0; 6], |parent| tree.twists[parent]);
            let carried = into(&pose, &before);
            tree.twists.push(add(&carried, &own));
        }
        tree
    }

    /// The forces that the accelerations ξ̇ need, gravity as an acceleration of the world.
    pub fn needed(&self, xi_dot: &[f64], gravity: f64) -> Vec<f64> {
        let world = whole([0.0; 3], GRAVITY.map(|g| -gravity * g));
        let mut accelerations: Vec<Six> = Vec::new();
        let mut wrenches: Vec<Six> = Vec::new();
        let mut speed = 0;
        for (index, link) in self.links.iter().enumerate() {
            let range = speed..speed + link.freedoms();
            speed = range.end;
            let own = combine(link, &self.xi[range.clone()]);
            let twist = &self.twists[index];
            let before = link.parent.map_or(world, |parent| accelerations[parent]);
            let mut acceleration = into(&self.poses[index], &before);
            acceleration = add(&acceleration, &combine(link, &xi_dot[range]));
            acceleration = add(&acceleration, &bracket(twist, &own));
            accelerations.push(acceleration);
            let inertial = link.momentum(&acceleration);
            wrenches.push(add(&inertial, &dual(twist, &link.momentum(twist))));
        }
        let mut forces = vec![0.0; self.xi.len()];
        for (index, link) in self.links.iter().enumerate().rev() {
            speed -= link.freedoms();
            for (k, column) in link.columns().iter().enumerate() {
                let power: f64 = (0..6).map(|i| column[i] * wrenches[index][i]).sum();
                forces[speed + k] = power + link.armature * xi_dot[speed + k];
            }
            if let Some(parent) = link.parent {
                let moved = back(&self.poses[index], &wrenches[index]);
                wrenches[parent] = add(&wrenches[parent], &moved);
            }
        }
        forces
    }

    /// The forces of dampers.
    pub fn friction(&self) -> Vec<f64> {
        let mut forces = Vec::new();
        for link in self.links {
            for _ in 0..link.freedoms() {
                let speed = self.xi[forces.len()];
                forces.push(-link.damping * speed);
            }
        }
        forces
    }

    /// T + V.
    pub fn energy(&self) -> f64 {
        let mut frames: Vec<(M3, [f64; 3])> = Vec::new();
        let (mut energy, mut speed) = (0.0, 0);
        for (index, link) in self.links.iter().enumerate() {
            let (rotation, origin) = &self.poses[index];
            let pose = match link.parent {
                Some(parent) => {
                    let (r, p) = &frames[parent];
                    let moved = apply(r, *origin);
                    (
                        product(r, rotation),
                        std::array::from_fn(|i| p[i] + moved[i]),
                    )
                }
                None => (*rotation, *origin),
            };
            let twist = &self.twists[index];
            let momentum = link.momentum(twist);
            energy += (0..6).map(|i| twist[i] * momentum[i]).sum::<f64>() / 2.0;
            let arm = apply(&pose.0, link.com);
            energy -= (0..3)
                .map(|i| link.mass * GRAVITY[i] * (pose.1[i] + arm[i]))
                .sum::<f64>();
            for _ in 0..link.freedoms() {
                energy += link.armature * self.xi[speed] * self.xi[speed] / 2.0;
                speed += 1;
            }
            frames.push(pose);
        }
        energy
    }
}

fn combine(link: &Link, speeds: &[f64]) -> Six {
    let columns = link.columns();
    std::array::from_fn(|i| columns.iter().zip(speeds).map(|(c, s)| c[i] * s).sum())
}

fn add(a: &Six, b: &Six) -> Six {
    std::array::from_fn(|i| a[i] + b[i])
}

fn halves(a: &Six) -> ([f64; 3], [f64; 3]) {
    ([a[0], a[1], a[2]], [a[3], a[4], a[5]])
}

fn whole(a: [f64; 3], b: [f64; 3]) -> Six {
    [a[0], a[1], a[2], b[0], b[1], b[2]]
}

/// A twist of the frame before, in the axes and about the origin of the next.
fn into((rotation, origin): &(M3, [f64; 3]), twist: &Six) -> Six {
    let (w, v) = halves(twist);
    let lever = cross(w, *origin);
    let moved = std::array::from_fn(|i| v[i] + lever[i]);
    whole(transposed(rotation, w), transposed(rotation, moved))
}

/// A wrench on the next frame, in the axes and about the origin of the one before.
fn back((rotation, origin): &(M3, [f64; 3]), wrench: &Six) -> Six {
    let (torque, force) = halves(wrench);
    let (torque, force) = (apply(rotation, torque), apply(rotation, force));
    let lever = cross(*origin, force);
    whole(std::array::from_fn(|i| torque[i] + lever[i]), force)
}

/// v × m of two twists.
fn bracket(v: &Six, m: &Six) -> Six {
    let ((w, u), (a, b)) = (halves(v), halves(m));
    let (first, second, third) = (cross(w, a), cross(w, b), cross(u, a));
    whole(first, std::array::from_fn(|i| second[i] + third[i]))
}

/// v ×* f of a twist and a wrench.
fn dual(v: &Six, f: &Six) -> Six {
    let ((w, u), (torque, force)) = (halves(v), halves(f));
    let (first, second) = (cross(w, torque), cross(u, force));
    whole(
        std::array::from_fn(|i| first[i] + second[i]),
        cross(w, force),
    )
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn apply(m: &M3, a: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * a[0] + row[1] * a[1] + row[2] * a[2])
}

fn transposed(m: &M3, a: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|j| m[j][i] * a[j]).sum())
}

fn product(a: &M3, b: &M3) -> M3 {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn rows(q: &[f64]) -> M3 {
    std::array::from_fn(|i| std::array::from_fn(|j| q[3 * i + j]))
}

/// Rz(yaw) Ry(pitch) Rx(roll).
fn turn([roll, pitch, yaw]: [f64; 3]) -> M3 {
    let about = |k: usize, angle: f64| {
        let axis = std::array::from_fn(|i| f64::from(u8::from(i == k)));
        about(axis, angle.cos(), angle.sin())
    };
    product(&product(&about(2, yaw), &about(1, pitch)), &about(0, roll))
}

/// Rodrigues' formula, by its action on the coordinate axes.
fn about(n: [f64; 3], c: f64, s: f64) -> M3 {
    let columns: [[f64; 3]; 3] = std::array::from_fn(|j| {
        let e = std::array::from_fn(|i| f64::from(u8::from(i == j)));
        let (across, along) = (cross(n, e), n[j]);
        std::array::from_fn(|i| c * e[i] + s * across[i] + (1.0 - c) * along * n[i])
    });
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}
