//! The model of a mechanical system: what a description means once it is read.
//!
//! Configuration, kinematics, inertia and loads are expressions of a graph whose points lie on X.

mod chart_difference;
pub mod charts;
pub mod class;
pub mod closest;
pub mod complete;
pub mod completion;
mod edges;
pub mod elements;
pub mod initial_conditions;
pub mod invariants;
pub mod joints;
pub mod layout;
pub mod loop_closure;
pub mod motion;
pub mod nearest;
pub mod pfaffian;
pub mod points;
pub mod rotations;
pub mod samples;
pub mod statements;
pub mod states;
pub mod twists;
pub mod value;

use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Mat3, Vec3};
use crate::diagnostics::Diagnostic;
use crate::dimensions::Dimensions;
use crate::functions::Asked;
use crate::syntax::ast::{CoordKind, Origins, ShapeKind, Span};
use completion::Completion;
use elements::Elements;
pub use elements::Wrench;
use initial_conditions::InitialConditions;
use layout::Block;
use motion::Observed;
use pfaffian::Pfaffian;
use points::Points;
use statements::Statements;
use std::sync::Arc;
use value::Value;

/// A named group of symbols, such as a parameter, a velocity or an input.
#[derive(Clone, Debug)]
pub struct Group {
    /// Name as written.
    pub name: String,
    /// Shape as written.
    pub shape: ShapeKind,
    /// Value in terms of its symbols.
    pub value: Value,
    /// Index of its first entry among those of its class.
    pub offset: usize,
    /// Number of its symbols.
    pub len: usize,
    /// Its unit in SI, if the description has units and its entries have one dimension; none for numbers and angles.
    pub unit: Option<String>,
}

impl Group {
    /// Returns the name in code quotes, with the unit if it has one: "`m` in `kg`".
    pub fn quoted(&self) -> String {
        match &self.unit {
            Some(unit) => format!("`{}` in `{unit}`", self.name),
            None => format!("`{}`", self.name),
        }
    }
}

/// Returns the name of an entry of the groups, as the language writes it: `q_dot`, `w[2]`.
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
    /// Kind of coordinate.
    pub kind: CoordKind,
    /// Index of its first entry in x.
    pub offset: usize,
    /// Where it was declared.
    pub span: Span,
}

/// A frame, with its pose in the world and in its parent frame.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Name as written.
    pub name: String,
    /// Index of the parent frame, which comes before this one; `None` for the world.
    pub parent: Option<usize>,
    /// Pose in the parent frame: axes by columns, and origin (m).
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
    /// Place of its statement.
    pub span: Span,
}

/// Contribution of a kinetic energy that the user wrote, if ξ does not span the tangent space.
#[derive(Clone, Debug)]
pub struct KineticTerms {
    /// Its mass matrix.
    pub mass: Vec<Vec<Edge>>,
    /// Its bias forces, derived before the constraints were substituted.
    pub bias: Vec<Edge>,
}

/// Place of the time, a coordinate whose velocity is ξ⁰ = 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    /// Index of the time in x.
    pub x: usize,
    /// Index of ξ⁰ in ξ of the full frame.
    pub xi: usize,
}

/// The full frame of a system whose other velocities are all given, by the time or by prescribed motion.
#[derive(Clone, Debug)]
pub struct FullFrame {
    /// The system in the full frame, in a graph of its own.
    pub full: Arc<Model>,
    /// For each symbol of that graph, its expression in the graph of the system.
    pub images: Vec<Edge>,
    /// Indices of the system's velocities in the full frame.
    pub active: Vec<usize>,
}

/// A mechanical system with its configuration, kinematics, inertia and loads.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name of the generated type.
    pub name: String,
    /// Whether the generated type is `pub`.
    pub public: bool,
    /// Documentation of the generated type.
    pub docs: Vec<String>,
    /// The graph, with points on X.
    pub graph: Graph,
    /// The manifold X: φ itself, and a way to find further points.
    pub points: Points,
    /// Run-time parameters.
    pub params: Vec<Group>,
    /// Default values of the parameters' symbols.
    pub defaults: Vec<f64>,
    /// Configuration coordinates.
    pub coordinates: Vec<Coordinate>,
    /// Blocks of the coordinates.
    pub blocks: Vec<Block>,
    /// Symbols of x.
    pub x: Vec<Edge>,
    /// Rows of φ in the graph with unconstrained points, each with its text.
    pub phi: Vec<(Edge, String)>,
    /// Velocity coordinates.
    pub velocities: Vec<Group>,
    /// Symbols of ξ.
    pub xi: Vec<Edge>,
    /// Where each ξⁱ was declared, for errors that are found later.
    pub velocity_spans: Vec<Span>,
    /// Symbols of ξ̇.
    pub xi_dot: Vec<Edge>,
    /// Symbols of p.
    pub momenta: Vec<Edge>,
    /// Inputs.
    pub inputs: Vec<Group>,
    /// Inputs u followed by the states z: both act on the motion like inputs.
    pub u: Vec<Edge>,
    /// First-order states, with their offsets in z.
    pub states: Vec<Group>,
    /// Rates ż of the states.
    pub state_rates: Vec<Edge>,
    /// Rates ẋ = A ξ.
    pub rate: Vec<Edge>,
    /// Matrix A, ν rows of n entries.
    pub a: Vec<Vec<Edge>>,
    /// Constraints B(x) ξ = 0 in addition to the choice of ξ.
    pub constraints: Vec<Pfaffian>,
    /// Place of the time, if the description declares it.
    pub clock: Option<Clock>,
    /// Coordinates with prescribed values, by index in x.
    pub prescribed: Vec<(usize, Edge)>,
    /// Velocities with prescribed rates ξ̇ⁱ, by index in ξ.
    pub accelerated: Vec<(usize, Edge)>,
    /// Velocities that the constraints must not be solved for, by index in ξ, and where that was stated.
    pub independent: Vec<(usize, Span)>,
    /// The full frame, if all velocities that were solved for are known functions of the time or prescribed.
    pub full_frame: Option<FullFrame>,
    /// Whether A spans the tangent space of X; it does not once constraints have been solved.
    pub spans: bool,
    /// Whether constraints that are kept are dependent along the whole motion.
    pub overconstrained: bool,
    /// Whether M + w BᵀB replaces M, because M is singular at the start and constraints are kept: some velocities
    /// have inertia only through the constraints.
    pub augmented: bool,
    /// Whether the user has not chosen the start, so that M may be singular there if it is regular nearby.
    pub starts_anywhere: bool,
    /// The user's kinetic energy, if A does not span the tangent space.
    pub kinetic_terms: Option<KineticTerms>,
    /// Y as it was given, the rows of Φ, and the divisors of `[Y; Φ]⁻¹`.
    pub completion: Completion,
    /// Frames.
    pub frames: Vec<Frame>,
    /// Joints, in the order of the text.
    pub joints: Vec<joints::Joint>,
    /// Pairs of points that loops bring together, world axes (m): the two sides of each loop equation between
    /// 3-vectors, or between those of their components that differ.
    pub closures: Vec<(Vec3, Vec3)>,
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Particles.
    pub particles: Vec<Particle>,
    /// Kinetic energy beyond that of bodies and particles; it includes that of armatures.
    pub kinetic: Edge,
    /// Whether the description has any inertia; otherwise there are kinematics and loads, but no equations of motion.
    pub has_inertia: bool,
    /// T₁ + 2 T₀ of `kinetic`, where Tₖ are its terms of degree k in the rates of coordinates: the difference between
    /// T and its part T₂ − T₀ of the energy ẋ · ∂L/∂ẋ − L. It is known once velocities are solved for.
    pub gyroscopic: Edge,
    /// Armature J of each velocity, with kinetic energy ½ J ξⁱ² (kg m², kg). Such a velocity is the rate of a
    /// coordinate, so that its armature adds J ξ̇ⁱ to the forces and nothing else.
    pub armature: Vec<Edge>,
    /// Potential energy beyond that of gravity.
    pub potential: Edge,
    /// Acceleration of gravity, world axes (m/s²).
    pub gravity: Vec3,
    /// Forces, torques and wrenches.
    pub wrenches: Vec<Wrench>,
    /// Generalised forces, dual to ξ.
    pub generalized: Vec<Edge>,
    /// Rayleigh's dissipation function D(x, ξ) (W); its force −∂D/∂ξ is part of `generalized`.
    pub dissipation: Edge,
    /// Springs, dampers and forces along lines; they are included in the energies and forces above.
    pub elements: Elements,
    /// Motions of frames that expressions use.
    pub observed: Vec<Observed>,
    /// Outputs.
    pub outputs: Vec<(String, Value)>,
    /// Where each external Rust function is declared, by its index in the graph.
    pub externals: Vec<Span>,
    /// Quantities that are claimed to be constant along the motion.
    pub invariants: Vec<invariants::Invariant>,
    /// Named expressions of the user.
    pub lets: Vec<(String, Value)>,
    /// x at the start.
    pub start_x: Vec<f64>,
    /// ξ at the start.
    pub start_xi: Vec<f64>,
    /// z at the start.
    pub start_z: Vec<f64>,
    /// The start as the description gives it, in the full frame; the rest is computed from it.
    pub initial_conditions: InitialConditions,
    /// The functions to generate.
    pub asked: Asked,
    /// Dimensions of the names, if the description has units.
    pub dimensions: Option<Dimensions>,
    /// Span for errors about the start that are found later.
    pub span: Span,
    /// Places of the statements that define frames, bodies, loads and named expressions.
    pub statements: Statements,
    /// Origin of statements that do not come from the description itself.
    pub origins: Origins,
    /// Warnings about legal statements that look like mistakes.
    pub warnings: Vec<Diagnostic>,
}

impl Model {
    /// Records what is known of the dimensions.
    pub(crate) fn measure(&mut self, dimensions: Dimensions) {
        let groups = [
            &mut self.params,
            &mut self.velocities,
            &mut self.inputs,
            &mut self.states,
        ];
        for group in groups.into_iter().flatten() {
            let unit = dimensions.units.get(&group.name);
            group.unit = unit.filter(|unit| *unit != "1").cloned();
        }
        self.dimensions = Some(dimensions);
    }

    /// Returns n, the number of velocities.
    pub fn n(&self) -> usize {
        self.xi.len()
    }

    /// Returns whether some velocities of the full frame are not free: constraints or drives act on them, or one of
    /// them is the rate of time.
    pub fn is_constrained(&self) -> bool {
        self.has_multipliers() || self.clock.is_some()
    }

    /// Returns whether constraints or drives act on the velocities.
    pub fn has_multipliers(&self) -> bool {
        !self.constraints.is_empty() || !self.accelerated.is_empty()
    }

    /// Returns whether ẋ, and with it the velocities of points, has terms without ξ, since ξ⁰ = 1 was substituted.
    pub fn is_affine(&self) -> bool {
        self.clock.is_some() && !self.spans
    }

    /// Returns ν, the number of coordinates.
    pub fn nu(&self) -> usize {
        self.x.len()
    }

    /// Returns the number of inputs, without the states that follow them in `u`.
    pub fn m(&self) -> usize {
        self.u.len() - self.state_rates.len()
    }

    /// Returns the first-order states with offsets that place them after the velocities.
    pub fn states_behind(&self) -> Vec<Group> {
        behind(&self.states, self.n())
    }

    /// Returns the symbols of z.
    pub fn z(&self) -> &[Edge] {
        &self.u[self.m()..]
    }

    /// Returns the values of all symbols, in the order of the graph, for given parameters, x, ξ, u and ξ̇; z follows ξ
    /// in `xi`, or u in `u`.
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

/// Returns groups of symbols with offsets that place them after n others.
pub fn behind(groups: &[Group], n: usize) -> Vec<Group> {
    let moved = |group: &Group| Group {
        offset: n + group.offset,
        ..group.clone()
    };
    groups.iter().map(moved).collect()
}
