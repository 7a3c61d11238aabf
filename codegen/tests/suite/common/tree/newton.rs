//! Dynamics of trees by the recursive Newton-Euler algorithm in numbers.
//!
//! The recursion is Featherstone's (*Rigid Body Dynamics Algorithms*, 2008, table 5.1) in body coordinates. Joints of
//! several axes are chains of massless bodies, so that every column is constant in the axes of its body. It shares
//! nothing with the generator.

use super::spatial::{
    Pose, Six, about, add, apply, back, bracket, compose, cross, dual, halves, into, of_quaternion,
    rows, turn, unit, whole,
};
use super::{GRAVITY, Kind, Link, second};

/// A degree of freedom: the twist per unit of its rate, which is factor · ξⁱ; its acceleration is factor · ξ̇ⁱ + drift.
struct Column {
    twist: Six,
    index: usize,
    factor: f64,
    drift: f64,
}

/// A body that moves relative to the previous one.
struct Element {
    parent: Option<usize>,
    pose: Pose,
    columns: Vec<Column>,
    /// Mass, centre of mass, and inertia about it.
    masses: Vec<(f64, [f64; 3], [f64; 6])>,
    /// The wrench for one unit of u.
    push: Six,
}

/// A load on a joint: its index in ξ, its coordinate, and the factor of that ξ in the coordinate's rate.
struct Drive<'a> {
    link: &'a Link,
    index: usize,
    coordinate: f64,
    factor: f64,
}

/// A tree at a state.
pub struct Tree<'a> {
    /// Acceleration of gravity in world axes.
    pub gravity: [f64; 3],
    elements: Vec<Element>,
    drives: Vec<Drive<'a>>,
    twists: Vec<Six>,
    xi: &'a [f64],
}

impl<'a> Tree<'a> {
    /// Returns a tree at (x, ξ).
    pub fn new(links: &'a [Link], x: &[f64], xi: &'a [f64]) -> Self {
        let mut tree = Tree {
            gravity: GRAVITY,
            elements: Vec::new(),
            drives: Vec::new(),
            twists: Vec::new(),
            xi,
        };
        let (mut place, mut speed) = (0, 0);
        // For each link: first entries in x and ξ, and the elements of its frame and of the further frame.
        let mut known: Vec<(usize, usize, usize, usize)> = Vec::new();
        for link in links {
            let mut on = link.parent.map(|parent| match link.beyond(links) {
                true => known[parent].3,
                false => known[parent].2,
            });
            let (start, mut q) = (speed, x[place..place + link.coordinates()].to_vec());
            let (mut index, mut factor, mut drift) = (start, 1.0, 0.0);
            if let Some(follow) = &link.follows {
                let [a, b, c] = follow.law;
                let (from, rate, ..) = known[follow.source];
                let (value, change) = (x[from], xi[rate]);
                let angle = a + b * value + c * value * value;
                q = vec![angle];
                (index, factor, drift) = (rate, b + 2.0 * c * value, 2.0 * c * change * change);
            }
            if let Some(&coordinate) = q.first() {
                tree.drives.push(Drive {
                    link,
                    index,
                    coordinate,
                    factor,
                });
            }
            let mut count = 0;
            for (pose, twists) in steps(link, &q) {
                let columns = twists.into_iter().enumerate().map(|(k, twist)| Column {
                    twist,
                    index: index + count + k,
                    factor,
                    drift,
                });
                let columns: Vec<Column> = columns.collect();
                count += columns.len();
                on = Some(tree.push(on, pose, columns));
            }
            let frame = tree.elements.len() - 1;
            let beyond = match &link.user {
                Some((rpy, place)) => tree.push(Some(frame), (turn(*rpy), *place), Vec::new()),
                None => frame,
            };
            let element = &mut tree.elements[beyond];
            element.masses.push((link.mass, link.com, link.inertia));
            if let Some((mass, at)) = link.particle {
                element.masses.push((mass, at, [0.0; 6]));
            }
            if let Some((force, point)) = link.push {
                element.push = whole(cross(point, force), force);
            }
            known.push((place, start, frame, beyond));
            place += link.coordinates();
            speed += link.freedoms();
        }
        assert_eq!((place, speed), (x.len(), xi.len()));
        tree
    }

    fn push(&mut self, parent: Option<usize>, pose: Pose, columns: Vec<Column>) -> usize {
        let before = parent.map_or([0.0; 6], |parent| self.twists[parent]);
        let own = sum(&columns, |column| column.factor * self.xi[column.index]);
        self.twists.push(add(&into(&pose, &before), &own));
        self.elements.push(Element {
            parent,
            pose,
            columns,
            masses: Vec::new(),
            push: [0.0; 6],
        });
        self.elements.len() - 1
    }

    /// Returns the forces for accelerations ξ̇, with gravity as an acceleration of the world.
    pub fn needed(&self, xi_dot: &[f64], gravity: f64) -> Vec<f64> {
        let world = whole([0.0; 3], self.gravity.map(|g| -gravity * g));
        let mut accelerations: Vec<Six> = Vec::new();
        let mut wrenches: Vec<Six> = Vec::new();
        for (element, twist) in self.elements.iter().zip(&self.twists) {
            let own = sum(&element.columns, |c| c.factor * self.xi[c.index]);
            let change = sum(&element.columns, |c| c.factor * xi_dot[c.index] + c.drift);
            let before = element.parent.map_or(world, |parent| accelerations[parent]);
            let acceleration = add(&into(&element.pose, &before), &change);
            let acceleration = add(&acceleration, &bracket(twist, &own));
            let inertial = element.momentum(&acceleration);
            accelerations.push(acceleration);
            wrenches.push(add(&inertial, &dual(twist, &element.momentum(twist))));
        }
        let mut forces = self.collected(wrenches);
        for drive in self.drives.iter().filter(|d| d.link.follows.is_none()) {
            forces[drive.index] += drive.link.armature * xi_dot[drive.index];
        }
        forces
    }

    /// Returns the generalised forces of wrenches on the elements.
    fn collected(&self, mut wrenches: Vec<Six>) -> Vec<f64> {
        let mut forces = vec![0.0; self.xi.len()];
        for (index, element) in self.elements.iter().enumerate().rev() {
            for column in &element.columns {
                let power: f64 = (0..6).map(|i| column.twist[i] * wrenches[index][i]).sum();
                forces[column.index] += column.factor * power;
            }
            if let Some(parent) = element.parent {
                let moved = back(&element.pose, &wrenches[index]);
                wrenches[parent] = add(&wrenches[parent], &moved);
            }
        }
        forces
    }

    /// Returns ∂V of springs.
    pub fn springs(&self) -> Vec<f64> {
        let mut forces = vec![0.0; self.xi.len()];
        for drive in &self.drives {
            let stretch = drive.coordinate - drive.link.rest;
            forces[drive.index] += drive.factor * drive.link.stiffness * stretch;
        }
        forces
    }

    /// Returns the forces of dampers and of an input, on joints and at points of links.
    pub fn applied(&self, u: f64) -> Vec<f64> {
        let pushes = self.elements.iter().map(|element| element.push);
        let mut forces = self.collected(pushes.map(|push| push.map(|p| u * p)).collect());
        for drive in &self.drives {
            for k in 0..drive.link.freedoms() {
                let i = drive.index + k;
                forces[i] += drive.link.force * u - drive.link.damping * self.xi[i];
            }
        }
        forces
    }

    /// Returns the generalised forces of forces at the origins of bodies, in body axes. Links are bodies if there are
    /// neither further frames nor joints of several axes.
    pub fn pushed(&self, forces: &[[f64; 3]]) -> Vec<f64> {
        assert_eq!(forces.len(), self.elements.len());
        self.collected(forces.iter().map(|&force| whole([0.0; 3], force)).collect())
    }

    /// Returns T + V.
    pub fn energy(&self) -> f64 {
        let mut frames: Vec<Pose> = Vec::new();
        let mut energy = 0.0;
        for (element, twist) in self.elements.iter().zip(&self.twists) {
            let pose = match element.parent {
                Some(parent) => compose(&frames[parent], &element.pose),
                None => element.pose,
            };
            let momentum = element.momentum(twist);
            energy += (0..6).map(|i| twist[i] * momentum[i]).sum::<f64>() / 2.0;
            for (mass, com, _) in &element.masses {
                let arm = apply(&pose.0, *com);
                let height = |i: usize| self.gravity[i] * (pose.1[i] + arm[i]);
                energy -= mass * (0..3).map(height).sum::<f64>();
            }
            frames.push(pose);
        }
        for drive in &self.drives {
            let (speed, stretch) = (self.xi[drive.index], drive.coordinate - drive.link.rest);
            energy += drive.link.armature * speed * speed / 2.0;
            energy += drive.link.stiffness * stretch * stretch / 2.0;
        }
        energy
    }
}

impl Element {
    /// Returns the product of its inertia and a twist.
    fn momentum(&self, v: &Six) -> Six {
        let (w, u) = halves(v);
        let mut sum = [0.0; 6];
        for &(mass, com, [x, y, z, yz, xz, xy]) in &self.masses {
            let inertia = [[x, xy, xz], [xy, y, yz], [xz, yz, z]];
            let lever = cross(w, com);
            let linear: [f64; 3] = std::array::from_fn(|i| mass * (u[i] + lever[i]));
            let (own, moved) = (apply(&inertia, w), cross(com, linear));
            let angular = std::array::from_fn(|i| own[i] + moved[i]);
            sum = add(&sum, &whole(angular, linear));
        }
        sum
    }
}

fn sum(columns: &[Column], rate: impl Fn(&Column) -> f64) -> Six {
    columns.iter().fold([0.0; 6], |sum, column| {
        add(&sum, &column.twist.map(|entry| rate(column) * entry))
    })
}

/// Returns the poses along a joint at its coordinates, each with the columns of its motion.
fn steps(link: &Link, q: &[f64]) -> Vec<(Pose, Vec<Six>)> {
    let (n, still) = (link.axis, [0.0; 3]);
    let (turning, sliding) = (whole(n, still), whole(still, n));
    let at = |pose: Pose| compose(&(turn(link.rpy), link.place), &pose);
    let shift = |length: f64| n.map(|n| n * length);
    let spins = [0, 1, 2].map(|k| whole(unit(k), still));
    match link.kind {
        Kind::Continuous if link.follows.is_none() => {
            vec![(at((about(n, q[0], q[1]), still)), vec![turning])]
        }
        Kind::Revolute | Kind::Continuous => {
            vec![(at((about(n, q[0].cos(), q[0].sin()), still)), vec![turning])]
        }
        Kind::Prismatic => vec![(at((turn(still), shift(q[0]))), vec![sliding])],
        Kind::Cylindrical => vec![(
            at((about(n, q[0].cos(), q[0].sin()), shift(q[1]))),
            vec![turning, sliding],
        )],
        Kind::Spherical => vec![(at((rows(q), still)), spins.to_vec())],
        Kind::Quaternion => vec![(at((of_quaternion(q), still)), spins.to_vec())],
        Kind::Free => {
            let slides = [0, 1, 2].map(|k| whole(still, unit(k)));
            let pose = (rows(&q[3..]), [q[0], q[1], q[2]]);
            vec![(at(pose), [slides, spins].concat())]
        }
        Kind::Planar => {
            let k = n.iter().position(|&n| n == 1.0).expect("an axis");
            let (a, b) = (unit((k + 1) % 3), unit((k + 2) % 3));
            let moved = std::array::from_fn(|i| q[0] * a[i] + q[1] * b[i]);
            let turned = about(n, q[2].cos(), q[2].sin());
            vec![
                (
                    at((turn(still), moved)),
                    vec![whole(still, a), whole(still, b)],
                ),
                ((turned, still), vec![turning]),
            ]
        }
        Kind::Universal => {
            let m = second(n);
            vec![
                (at((about(n, q[0].cos(), q[0].sin()), still)), vec![turning]),
                (
                    (about(m, q[1].cos(), q[1].sin()), still),
                    vec![whole(m, still)],
                ),
            ]
        }
        Kind::Fixed => vec![(at((turn(still), still)), Vec::new())],
    }
}
