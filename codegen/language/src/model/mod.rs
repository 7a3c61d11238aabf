//! A mechanical system in terms of a graph: configuration, kinematics, inertia, loads, as expressions with their
//! points on X. What a description means, once it is read.

pub mod charts;
pub mod closest;
pub mod closure;
pub mod complete;
pub mod completion;
mod edges;
pub mod elements;
pub mod invariants;
pub mod joints;
pub mod layout;
pub mod motion;
pub mod nearest;
pub mod opening;
pub mod pfaffian;
pub mod points;
pub mod rotations;
pub mod samples;
pub mod states;
pub mod twists;
pub mod value;
mod way;

use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Mat3, Vec3};
use crate::diagnostics::Diagnostic;
use crate::functions::Asked;
use crate::syntax::ast::{Axes, CoordKind, Origins, ShapeKind, Span};
use completion::Completion;
use elements::Elements;
use layout::Block;
use motion::Observed;
use opening::Opening;
use pfaffian::Pfaffian;
use points::Points;
use std::sync::Arc;
use value::Value;

/// Classes of symbols, one bit each.
pub mod class {
    /// Run-time parameters: constant while the system moves.
    pub const PARAM: u8 = 1;
    /// Configuration coordinates x.
    pub const COORD: u8 = 2;
    /// Velocity coordinates ξ.
    pub const VELOCITY: u8 = 4;
    /// Inputs u, and states of first order z: what forces may depend on that no motion changes by itself.
    pub const INPUT: u8 = 8;
    /// Accelerations ξ̇, the argument of inverse dynamics.
    pub const ACCEL: u8 = 16;
    /// Momenta p, the argument of what is a function of them.
    pub const MOMENTUM: u8 = 32;
    /// The time, which is a coordinate, too.
    pub const TIME: u8 = 64;
    /// What a configuration is given by: coordinates and time.
    pub const CONFIGURATION: u8 = COORD | TIME;
    /// Rates ẋ, while definitions of velocities are read; never in a model's graph.
    pub const RATE: u8 = 128;
}

/// A named group of symbols: a parameter, a velocity, an input.
#[derive(Clone, Debug)]
pub struct Group {
    /// Name as written.
    pub name: String,
    /// Shape as written.
    pub shape: ShapeKind,
    /// Its value, in symbols.
    pub value: Value,
    /// Place of its first entry among those of its class.
    pub offset: usize,
    /// Number of its symbols.
    pub len: usize,
}

/// The name of an entry of groups as the language writes it: `q_dot`, `w[2]`.
pub fn entry(groups: &[Group], place: usize) -> String {
    match groups.iter().rev().find(|group| group.offset <= place) {
        Some(group) if group.len == 1 => group.name.clone(),
        Some(group) => format!("{}[{}]", group.name, 1 + place - group.offset),
        None => String::new(),
    }
}

/// A configuration coordinate.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// Name as written.
    pub name: String,
    /// Kind.
    pub kind: CoordKind,
    /// Place of its first entry in x.
    pub offset: usize,
    /// Where it was declared.
    pub span: Span,
}

/// A frame: its pose in the world, and in the frame that it was placed on.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Name as written.
    pub name: String,
    /// Index of the frame that it was placed on, which stands before it; the world where absent.
    pub parent: Option<usize>,
    /// Its pose in that frame: axes by columns, origin (m).
    pub relative: (Mat3, Vec3),
    /// Frame axes in world axes, by columns.
    pub rotation: Mat3,
    /// Origin in world axes (m).
    pub position: Vec3,
}

/// A rigid body fixed to a frame.
#[derive(Clone, Debug)]
pub struct Body {
    /// Index of its frame.
    pub frame: usize,
    /// Mass m (kg).
    pub mass: Edge,
    /// Centre of mass s, frame axes (m).
    pub com: Vec3,
    /// Inertia about the centre of mass, frame axes (kg m²).
    pub inertia_com: Mat3,
    /// Inertia Θ about the frame's origin, frame axes (kg m²).
    pub inertia_origin: Mat3,
}

/// A point mass.
#[derive(Clone, Debug)]
pub struct Particle {
    /// Mass (kg).
    pub mass: Edge,
    /// Position in world axes (m).
    pub position: Vec3,
}

/// A wrench on a frame, acting at a point of it.
#[derive(Clone, Debug)]
pub struct Wrench {
    /// Index of the frame.
    pub frame: usize,
    /// Point of attack, frame axes (m).
    pub at: Vec3,
    /// Force (N).
    pub force: Vec3,
    /// Torque (N m).
    pub torque: Vec3,
    /// Axes of force and torque.
    pub axes: Axes,
}

/// What a kinetic energy that the user wrote contributes where ξ does not span the tangent space.
#[derive(Clone, Debug)]
pub struct KineticTerms {
    /// Its metric.
    pub mass: Vec<Vec<Edge>>,
    /// Its bias, derived before the constraints were put in.
    pub bias: Vec<Edge>,
}

/// Where the time is: a coordinate whose velocity is ξ⁰ = 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    /// Its place in x.
    pub x: usize,
    /// The place of ξ⁰ in ξ of the full frame.
    pub xi: usize,
}

/// The full frame of a system whose other velocities are all given: by the time, or prescribed.
#[derive(Clone, Debug)]
pub struct FullFrame {
    /// The system in the full frame, in a graph of its own.
    pub full: Arc<Model>,
    /// What every symbol of that graph becomes, in the graph of the system.
    pub images: Vec<Edge>,
    /// Places of the system's velocities in the full frame.
    pub active: Vec<usize>,
}

/// A mechanical system: configuration, kinematics, inertia, loads.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name of the generated type.
    pub name: String,
    /// Whether that type is `pub`.
    pub public: bool,
    /// Its documentation.
    pub docs: Vec<String>,
    /// The graph, with points on X.
    pub graph: Graph,
    /// How to find further points of X, and φ itself.
    pub points: Points,
    /// Run-time parameters.
    pub params: Vec<Group>,
    /// Default values of the parameters' symbols.
    pub defaults: Vec<f64>,
    /// Configuration coordinates.
    pub coordinates: Vec<Coordinate>,
    /// Their blocks.
    pub blocks: Vec<Block>,
    /// x.
    pub x: Vec<Edge>,
    /// φ, in the graph with unconstrained points, and how each row reads.
    pub phi: Vec<(Edge, String)>,
    /// Velocity coordinates.
    pub velocities: Vec<Group>,
    /// ξ.
    pub xi: Vec<Edge>,
    /// Where each ξⁱ was declared, for errors found later.
    pub velocity_spans: Vec<Span>,
    /// ξ̇ as symbols.
    pub xi_dot: Vec<Edge>,
    /// p as symbols.
    pub momenta: Vec<Edge>,
    /// Inputs.
    pub inputs: Vec<Group>,
    /// u, and after it z: both act on a motion as what is given from outside.
    pub u: Vec<Edge>,
    /// States of first order, by their places in z.
    pub states: Vec<Group>,
    /// ż.
    pub state_rates: Vec<Edge>,
    /// ẋ = A ξ.
    pub rate: Vec<Edge>,
    /// A, ν rows of n.
    pub a: Vec<Vec<Edge>>,
    /// Constraints B(x) ξ = 0 beyond the choice of ξ.
    pub constraints: Vec<Pfaffian>,
    /// The time, where the description declares it.
    pub clock: Option<Clock>,
    /// Coordinates whose value is given, by their places in x.
    pub prescribed: Vec<(usize, Edge)>,
    /// Velocities whose rates ξ̇ⁱ are given, by their places in ξ.
    pub accelerated: Vec<(usize, Edge)>,
    /// Velocities that constraints are not solved for, by their places in ξ, and where that was said.
    pub independent: Vec<(usize, Span)>,
    /// The full frame, where all that was solved for is given ahead.
    pub full_frame: Option<FullFrame>,
    /// Whether A spans the tangent space of X: not so where constraints have been solved.
    pub spans: bool,
    /// Whether constraints that are kept depend on one another along the whole motion.
    pub overconstrained: bool,
    /// Whether M is singular at the start and constraints are kept, so that M + w BᵀB takes its place: some velocities have
    /// inertia through constraints alone.
    pub augmented: bool,
    /// Whether nobody has chosen the start, so that M may be singular there if it is regular close by.
    pub starts_anywhere: bool,
    /// The user's kinetic energy where A does not span the tangent space.
    pub kinetic_terms: Option<KineticTerms>,
    /// Y as it was given, the rows of Φ, and what [Y; Φ]⁻¹ divides by.
    pub completion: Completion,
    /// Frames.
    pub frames: Vec<Frame>,
    /// Joints, in the order of the text.
    pub joints: Vec<joints::Joint>,
    /// Points that loops bring together, world axes (m): both sides of each loop between vectors of three, or between those of
    /// their components that differ.
    pub closures: Vec<(Vec3, Vec3)>,
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Particles.
    pub particles: Vec<Particle>,
    /// Kinetic energy beyond that of bodies and particles; that of armatures is a part of it.
    pub kinetic: Edge,
    /// Whether the description says anything of inertia; else there are kinematics and loads, and no motion.
    pub has_inertia: bool,
    /// T₁ + 2 T₀ of that, by its terms of first degree and of none in the rates of coordinates: what T has beyond its part
    /// T₂ − T₀ of the energy ẋ · ∂L/∂ẋ − L. It is known once velocities are solved for.
    pub gyroscopic: Edge,
    /// J of ½ J ξⁱ², the armatures of joints, for every velocity; each of these is the rate of a
    /// coordinate, so that they add J ξ̇ⁱ to the forces and nothing else (kg m², kg).
    pub armature: Vec<Edge>,
    /// Potential beyond that of gravity.
    pub potential: Edge,
    /// Acceleration of gravity, world axes (m/s²).
    pub gravity: Vec3,
    /// Forces, torques and wrenches.
    pub wrenches: Vec<Wrench>,
    /// Generalised forces, dual to ξ.
    pub generalized: Vec<Edge>,
    /// Rayleigh's function D(x, ξ); its force −∂D/∂ξ is part of `generalized` (W).
    pub dissipation: Edge,
    /// Springs, dampers and forces along lines, which are part of the energies and forces above.
    pub elements: Elements,
    /// The motions of frames that expressions asked for.
    pub observed: Vec<Observed>,
    /// Outputs.
    pub outputs: Vec<(String, Value)>,
    /// Where the functions in Rust are declared, by their places in the graph.
    pub externals: Vec<Span>,
    /// What is claimed to be constant along the motion.
    pub invariants: Vec<invariants::Invariant>,
    /// Named expressions of the user.
    pub lets: Vec<(String, Value)>,
    /// x at the start.
    pub start_x: Vec<f64>,
    /// ξ at the start.
    pub start_xi: Vec<f64>,
    /// z at the start.
    pub start_z: Vec<f64>,
    /// What the description gives of the start in the full frame; the rest follows.
    pub opening: Opening,
    /// The functions to generate.
    pub asked: Asked,
    /// The statements that the start is about, for errors found later.
    pub span: Span,
    /// Where statements come from that do not stand in the description itself.
    pub origins: Origins,
    /// What is legal and looks like a mistake.
    pub warnings: Vec<Diagnostic>,
}

impl Model {
    /// n, the number of velocities.
    pub fn n(&self) -> usize {
        self.xi.len()
    }

    /// Whether not all velocities of the full frame are free: constraints or drives act on them, or one is that of
    /// time.
    pub fn is_constrained(&self) -> bool {
        self.has_multipliers() || self.clock.is_some()
    }

    /// Whether constraints act on the velocities, or drives.
    pub fn has_multipliers(&self) -> bool {
        !self.constraints.is_empty() || !self.accelerated.is_empty()
    }

    /// Whether ẋ, and velocities of points with it, have terms without ξ: so it is where ξ⁰ = 1 was put in.
    pub fn is_affine(&self) -> bool {
        self.clock.is_some() && !self.spans
    }

    /// ν, the number of coordinates.
    pub fn nu(&self) -> usize {
        self.x.len()
    }

    /// The number of inputs, without the states that stand behind them.
    pub fn m(&self) -> usize {
        self.u.len() - self.state_rates.len()
    }

    /// The states of first order, by their places behind the velocities.
    pub fn states_behind(&self) -> Vec<Group> {
        behind(&self.states, self.n())
    }

    /// z.
    pub fn z(&self) -> &[Edge] {
        &self.u[self.m()..]
    }

    /// The number that every symbol stands for, given x, ξ, u and ξ̇ and the parameters; z stands behind ξ, or
    /// behind u.
    pub fn numbers(
        &self,
        params: &[f64],
        x: &[f64],
        xi: &[f64],
        u: &[f64],
        xi_dot: &[f64],
    ) -> Vec<f64> {
        let mut numbers = vec![std::f64::consts::PI];
        let (xi, z) = xi.split_at(xi.len().min(self.n()));
        let xi_dot = &xi_dot[..xi_dot.len().min(self.n())];
        for part in [params, x, xi, u, z, xi_dot] {
            numbers.extend_from_slice(part);
        }
        numbers
    }
}

/// Groups of symbols that stand behind n others.
pub fn behind(groups: &[Group], n: usize) -> Vec<Group> {
    let moved = |group: &Group| Group {
        offset: n + group.offset,
        ..group.clone()
    };
    groups.iter().map(moved).collect()
}
