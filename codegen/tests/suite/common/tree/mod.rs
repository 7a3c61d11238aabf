//! Random trees of bodies on joints: their text, and their dynamics by the recursive Newton-Euler algorithm.
#![allow(dead_code, unused_imports)] // each test file uses a part

mod humanoid;
mod newton;
mod spatial;
mod text;

use super::Random;
pub use humanoid::humanoid;
pub use newton::Tree;
pub use text::text;

/// Acceleration of gravity.
const GRAVITY: [f64; 3] = [0.5, -0.25, -9.81];

/// The kind of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Revolute,
    Continuous,
    Prismatic,
    /// A rotation matrix.
    Spherical,
    /// A unit quaternion.
    Quaternion,
    Cylindrical,
    Planar,
    Universal,
    Free,
    Fixed,
}

/// Joints of all kinds, with more hinges than others.
pub const ALL: [Kind; 12] = [
    Kind::Revolute,
    Kind::Revolute,
    Kind::Revolute,
    Kind::Continuous,
    Kind::Prismatic,
    Kind::Spherical,
    Kind::Quaternion,
    Kind::Cylindrical,
    Kind::Planar,
    Kind::Universal,
    Kind::Free,
    Kind::Fixed,
];

/// A joint whose coordinate is a + b q + c q², where q is the coordinate of another one.
#[derive(Clone, Debug)]
pub struct Follow {
    pub source: usize,
    pub law: [f64; 3],
}

/// A joint with the body that it carries.
#[derive(Clone, Debug)]
pub struct Link {
    pub kind: Kind,
    /// The link on which it is mounted, or the world.
    pub parent: Option<usize>,
    /// The joint that its coordinate follows.
    pub follows: Option<Follow>,
    axis: [f64; 3],
    rpy: [f64; 3],
    place: [f64; 3],
    /// Rotation and position of a further frame, which carries the body and sometimes the next link.
    user: Option<([f64; 3], [f64; 3])>,
    /// Whether it is mounted on the further frame of its parent, if there is one.
    far: bool,
    mass: f64,
    com: [f64; 3],
    /// Diagonal of the inertia about the centre of mass, and its products.
    inertia: [f64; 6],
    /// A point mass in addition to the body.
    particle: Option<(f64, [f64; 3])>,
    damping: f64,
    armature: f64,
    stiffness: f64,
    rest: f64,
    /// Force of its drive for one unit of the input.
    force: f64,
    /// Force in the axes of the frame for one unit of the input, and its point of application.
    push: Option<([f64; 3], [f64; 3])>,
}

/// Rounds to two decimals, so that text and test have the same number.
fn short(number: f64) -> f64 {
    (number * 100.0).round() / 100.0
}

fn three(random: &mut Random, size: f64) -> [f64; 3] {
    [(); 3].map(|()| short(size * random.number()))
}

/// Returns an axis perpendicular to another one.
fn second(axis: [f64; 3]) -> [f64; 3] {
    match axis[1] {
        0.0 => [0.0, 1.0, 0.0],
        _ => [0.0, 0.0, 1.0],
    }
}

impl Link {
    /// Returns a link on an earlier one, or on the world.
    pub fn random(random: &mut Random, links: &[Link], kinds: &[Kind]) -> Self {
        let before = links.len();
        let kind = kinds[random.below(kinds.len())];
        let branch = random.below(before + 1).max(before.saturating_sub(2));
        Link::on(random, links, kind, branch.checked_sub(1))
    }

    /// Returns a link of a kind on another one.
    pub fn on(random: &mut Random, links: &[Link], kind: Kind, parent: Option<usize>) -> Self {
        // Coordinate axes, and sometimes another direction.
        let axis = match random.below(5) {
            0 if kind != Kind::Planar => [0.6, 0.0, -0.8],
            1 if kind != Kind::Planar => [0.0, -1.0, 0.0],
            1 => [0.0, 1.0, 0.0],
            2 => [1.0, 0.0, 0.0],
            _ => [0.0, 0.0, 1.0],
        };
        let (rpy, place) = (three(random, 1.5), three(random, 0.5));
        let (com, products) = (three(random, 0.3), three(random, 0.02));
        let moments = [0.21, 0.32, 0.27].map(|m| m + short(0.05 * random.number()));
        let user = (random.below(4) == 0).then(|| (three(random, 1.0), three(random, 0.2)));
        let far = random.below(2) == 0;
        let mass = short(1.5 + random.number());
        let [yz, xz, xy] = products;
        let body = Link::body(kind, parent, place, mass, com, moments);
        Link {
            axis,
            rpy: if rpy[0] < 0.0 { [0.0; 3] } else { rpy },
            user,
            far,
            inertia: [moments[0], moments[1], moments[2], yz, xz, xy],
            ..body
        }
        .driven(random, links)
    }

    /// Adds friction, armature, springs and drives, as far as its kind permits; sometimes it follows another joint.
    fn driven(mut self, random: &mut Random, links: &[Link]) -> Self {
        let straight = matches!(self.kind, Kind::Revolute | Kind::Prismatic);
        let single = straight || self.kind == Kind::Continuous;
        let leads = |link: &Link| {
            matches!(link.kind, Kind::Revolute | Kind::Prismatic) && link.follows.is_none()
        };
        let leaders: Vec<usize> = (0..links.len()).filter(|&i| leads(&links[i])).collect();
        if single && !leaders.is_empty() && random.below(4) == 0 {
            let [a, b, c] = three(random, 1.0);
            let source = leaders[random.below(leaders.len())];
            let law = [a, b, if c > 0.0 { 0.0 } else { c }];
            self.follows = Some(Follow { source, law });
        }
        let value = |random: &mut Random, most: f64, can: bool| {
            let value = short(most * random.number()).max(0.0);
            if can { value } else { 0.0 }
        };
        let own = self.follows.is_none();
        let turning = matches!(self.kind, Kind::Spherical | Kind::Quaternion);
        self.damping = value(random, 0.5, own && (single || turning));
        self.armature = value(random, 0.2, own && single);
        self.stiffness = value(random, 5.0, straight);
        self.rest = short(random.number());
        self.force = value(random, 2.0, own && single);
        if random.below(4) == 0 {
            self.push = Some((three(random, 3.0), three(random, 0.3)));
        }
        self
    }

    /// Adds a point mass.
    pub fn with_particle(mut self, random: &mut Random) -> Self {
        self.particle = Some((short(1.0 + 0.5 * random.number()), three(random, 0.4)));
        self
    }

    /// Returns a link about the third axis whose principal axes are those of its frame.
    pub fn body(
        kind: Kind,
        parent: Option<usize>,
        place: [f64; 3],
        mass: f64,
        com: [f64; 3],
        [x, y, z]: [f64; 3],
    ) -> Self {
        Link {
            kind,
            parent,
            follows: None,
            axis: [0.0, 0.0, 1.0],
            rpy: [0.0; 3],
            place,
            user: None,
            far: false,
            mass,
            com,
            inertia: [x, y, z, 0.0, 0.0, 0.0],
            particle: None,
            damping: 0.0,
            armature: 0.0,
            stiffness: 0.0,
            rest: 0.0,
            force: 0.0,
            push: None,
        }
    }

    /// Changes the axis of the joint.
    pub fn about(mut self, axis: [f64; 3]) -> Self {
        self.axis = axis;
        self
    }

    /// Rotates the mounting about the third axis.
    pub fn turned(mut self, yaw: f64) -> Self {
        self.rpy = [0.0, 0.0, yaw];
        self
    }

    /// Returns whether it is mounted on the further frame of its parent.
    fn beyond(&self, links: &[Link]) -> bool {
        self.far
            && self
                .parent
                .is_some_and(|parent| links[parent].user.is_some())
    }

    /// Returns the number of its entries in x.
    pub fn coordinates(&self) -> usize {
        match self.kind {
            _ if self.follows.is_some() => 0,
            Kind::Fixed => 0,
            Kind::Revolute | Kind::Prismatic => 1,
            Kind::Continuous | Kind::Cylindrical | Kind::Universal => 2,
            Kind::Planar => 3,
            Kind::Quaternion => 4,
            Kind::Spherical => 9,
            Kind::Free => 12,
        }
    }

    /// Returns the number of its velocities.
    pub fn freedoms(&self) -> usize {
        match self.kind {
            _ if self.follows.is_some() => 0,
            Kind::Fixed => 0,
            Kind::Revolute | Kind::Prismatic | Kind::Continuous => 1,
            Kind::Cylindrical | Kind::Universal => 2,
            Kind::Spherical | Kind::Quaternion | Kind::Planar => 3,
            Kind::Free => 6,
        }
    }
}
