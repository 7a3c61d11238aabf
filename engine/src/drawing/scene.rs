//! What of a mechanism can be drawn at one state, as plain numbers: points, axes and sizes in the axes of the world.

use serde::Serialize;

/// A point or a direction, world axes (m, -).
pub type Vector = [f64; 3];

/// A mechanism at one state. Places of frames are places in [`Scene::frames`].
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scene {
    /// Frames, each behind the one that it was placed on.
    pub frames: Vec<Frame>,
    /// Rigid bodies.
    pub bodies: Vec<Body>,
    /// Point masses.
    pub particles: Vec<Particle>,
    /// Joints, in the order of the description.
    pub joints: Vec<Joint>,
    /// Springs, dampers and forces between two points.
    pub lines: Vec<Line>,
    /// Points that keep their distance and are not fixed to one frame, such as the ends of a massless rod.
    pub rods: Vec<[Vector; 2]>,
    /// Both points of each loop between points, which coincide where it is closed.
    pub loops: Vec<[Vector; 2]>,
    /// The centre of mass of everything; absent where nothing has a mass.
    pub centre: Option<Vector>,
    /// The acceleration of gravity; zero where there is none, or where it is no function of x and the parameters.
    pub gravity: Vector,
}

impl Scene {
    /// Whether there is nothing in it: a description may have energies alone.
    pub fn is_empty(&self) -> bool {
        let Scene {
            frames,
            bodies,
            particles,
            lines,
            loops,
            ..
        } = self;
        frames.is_empty()
            && bodies.is_empty()
            && particles.is_empty()
            && lines.is_empty()
            && loops.is_empty()
    }
}

/// A frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// Its name.
    pub name: String,
    /// The frame that it was placed on; absent where that is the world.
    pub parent: Option<usize>,
    /// Whether its origin always stays at the same point of that frame.
    pub attached: bool,
    /// Whether its axes turn in that frame.
    pub turns: bool,
    /// R, by rows: the columns are its axes.
    pub rotation: [Vector; 3],
    /// Its origin.
    pub position: Vector,
}

/// A rigid body, with the solid ellipsoid of the same mass and inertia.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Body {
    /// Its frame.
    pub frame: usize,
    /// Its mass (kg).
    pub mass: f64,
    /// Its centre of mass, the centre of the ellipsoid.
    pub centre: Vector,
    /// Three right-handed unit vectors along the principal axes.
    pub axes: [Vector; 3],
    /// The radii along them; 0 where the inertia is that of a plate, a rod or a point.
    pub radii: Vector,
}

/// A point mass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Particle {
    /// Its mass (kg).
    pub mass: f64,
    /// Where it is.
    pub position: Vector,
    /// The frame that it is fixed to, where there is one.
    pub frame: Option<usize>,
}

/// A joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// Its kind, as the language calls it.
    pub kind: &'static str,
    /// The frame that it carries.
    pub frame: usize,
    /// Where it is on the part that carries it; where it slides, the point from which it does.
    pub place: Vector,
    /// Unit vectors along its axes: one, two of a universal joint, none where it has no axis.
    pub axes: Vec<Vector>,
}

/// What acts along a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Acts {
    /// A spring.
    Spring,
    /// A damper.
    Damper,
    /// A force.
    Force,
}

/// A spring, a damper or a force between two points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Which of them it is.
    pub acts: Acts,
    /// Its two points.
    pub points: [Vector; 2],
    /// The frames that these are fixed to; absent where a point is fixed to the world.
    pub frames: [Option<usize>; 2],
}
