//! A drawn mechanism at one state, as plain numbers: points, axes and sizes in world axes.

use serde::Serialize;

/// A point (m) or a direction, in world axes.
pub type Vector = [f64; 3];

/// A mechanism at one state. Indices of frames refer to [`Scene::frames`].
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scene {
    /// Frames, each after the one that it was placed on.
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
    /// Both points of each loop between points, which coincide if it is closed.
    pub loops: Vec<[Vector; 2]>,
    /// The centre of mass of the mechanism; absent if nothing has a mass.
    pub centre: Option<Vector>,
    /// The acceleration of gravity; zero if there is none, or if it is not a function of x and the parameters.
    pub gravity: Vector,
}

impl Scene {
    /// Returns whether the scene is empty: a description may consist of energies alone.
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

/// A frame of the description, with its axes and origin in the world.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// Name.
    pub name: String,
    /// The frame that it was placed on; absent for the world.
    pub parent: Option<usize>,
    /// Whether its origin is fixed in that frame.
    pub attached: bool,
    /// Whether its axes turn in that frame.
    pub turns: bool,
    /// R, by rows: the columns are the axes of the frame.
    pub rotation: [Vector; 3],
    /// Origin.
    pub position: Vector,
}

/// A rigid body, with the solid ellipsoid of the same mass and inertia.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Body {
    /// The frame of the body.
    pub frame: usize,
    /// Mass (kg).
    pub mass: f64,
    /// Centre of mass, which is the centre of the ellipsoid.
    pub centre: Vector,
    /// Three right-handed unit vectors along the principal axes.
    pub axes: [Vector; 3],
    /// The radii along the axes; 0 for the inertia of a plate, a rod or a point.
    pub radii: Vector,
}

/// A point mass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Particle {
    /// Mass (kg).
    pub mass: f64,
    /// Position.
    pub position: Vector,
    /// The frame that it is fixed to, if any.
    pub frame: Option<usize>,
}

/// A joint, with its place and axes in the world.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Joint {
    /// Name.
    pub name: String,
    /// Kind, as in the language.
    pub kind: &'static str,
    /// The frame that it carries.
    pub frame: usize,
    /// Position on the part that carries it; for a sliding joint, the zero of the displacement.
    pub place: Vector,
    /// Unit vectors along its axes: one, two for a universal joint, none for a joint without an axis.
    pub axes: Vec<Vector>,
}

/// Kind of element that acts along a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum LineKind {
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
    /// Kind.
    pub acts: LineKind,
    /// End points.
    pub points: [Vector; 2],
    /// The frames to which the end points are fixed; absent for the world.
    pub frames: [Option<usize>; 2],
}
