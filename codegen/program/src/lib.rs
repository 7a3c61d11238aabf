//! Straight-line programs: the generated functions as graphs, their schedule and their operation counts.
//!
#![doc = include_str!("../README.md")]

pub mod count;
pub mod interpret;
pub mod origins;
pub mod places;
pub mod provenance;
pub mod rounding;
pub mod schedule;
mod seeds;
pub mod sparsity;
pub mod statements;
pub mod structure;
mod sums;
pub mod tape;
pub mod together;

use hamel_algebra::graph::{Edge, Graph};
use hamel_language::model::joints::Joint;
use hamel_language::model::layout::Block;
use hamel_language::model::{Coordinate, Group, behind, entry};
use provenance::Provenance;
use structure::Structure;

use hamel_language::functions::Returns;
pub use hamel_language::functions::{Argument, FunctionId};

/// Shape of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One number.
    Scalar,
    /// `[S; n]`
    Vector(usize),
    /// `[[S; columns]; rows]`
    Matrix(usize, usize),
}

impl Shape {
    /// Returns the number of entries.
    pub fn entries(self) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Vector(n) => n,
            Shape::Matrix(rows, columns) => rows * columns,
        }
    }
}

/// Reason why a pivot is not positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// The velocity at this index has no inertia: with the velocities eliminated before it free to follow and the
    /// others held, it can change without effort.
    Velocity(usize),
    /// The mass matrix, or an inertia given by parameters, is not positive definite.
    Mass,
    /// The constraint at this index, one of those kept by multipliers, depends on the others.
    Constraint(usize),
    /// The pivot at this index of [Y; Φ] has changed its sign, KR18 (5): a kinematic singularity.
    Kinematics(usize),
}

/// One generated function.
#[derive(Clone, Debug)]
pub struct Function {
    /// Identity of the function; `None` for outputs and invariants of the description.
    pub id: Option<FunctionId>,
    /// Rust name.
    pub name: String,
    /// Documentation: the equation it evaluates, shapes, units; one string a line.
    pub docs: Vec<String>,
    /// Arguments.
    pub arguments: Vec<Argument>,
    /// Shape of the result.
    pub shape: Shape,
    /// Entries of the result, matrices by rows.
    pub outputs: Vec<Edge>,
    /// Pivots that have to be positive; otherwise the function returns the error `Singular`.
    pub guards: Vec<Edge>,
    /// Whether the function returns a `Result`.
    pub fallible: bool,
    /// ξ̇ as an intermediate result of [A B]; empty where that is the ξ̇ of `accel`.
    pub rates: Vec<Edge>,
}

impl Function {
    /// Creates one of the functions in the generator's table, without guards.
    pub fn known(id: FunctionId, n: usize, outputs: Vec<Edge>) -> Self {
        let row = id.row();
        let matrix = |rows: usize| Shape::Matrix(rows, outputs.len() / rows.max(1));
        let shape = match row.returns {
            Returns::Number => Shape::Scalar,
            Returns::Vector => Shape::Vector(outputs.len()),
            Returns::Rows => matrix(n),
            // The shape depends on inputs and constraints as well; it is set where the function is derived.
            Returns::Linear => matrix(2 * n),
        };
        Function {
            id: Some(id),
            name: row.name.into(),
            docs: row.docs.iter().map(|line| line.to_string()).collect(),
            arguments: row.arguments.to_vec(),
            shape,
            outputs,
            guards: Vec::new(),
            fallible: false,
            rates: Vec::new(),
        }
    }

    /// Creates the function of an output or invariant of the description.
    pub fn described(
        name: &str,
        docs: String,
        arguments: &[Argument],
        shape: Shape,
        outputs: Vec<Edge>,
    ) -> Self {
        Function {
            id: None,
            name: name.into(),
            docs: vec![docs],
            arguments: arguments.to_vec(),
            shape,
            outputs,
            guards: Vec::new(),
            fallible: false,
            rates: Vec::new(),
        }
    }
}

/// Everything that is emitted for a system.
#[derive(Clone, Debug)]
pub struct Program {
    /// Name of the generated type.
    pub name: String,
    /// Whether the type is `pub`.
    pub public: bool,
    /// Documentation of the type, as the user wrote it.
    pub docs: Vec<String>,
    /// Graph that contains all functions.
    pub graph: Graph,
    /// Parameters.
    pub params: Vec<Group>,
    /// Default values of the parameters, in the order of their symbols.
    pub defaults: Vec<f64>,
    /// Coordinates.
    pub coordinates: Vec<Coordinate>,
    /// Blocks of x.
    pub blocks: Vec<Block>,
    /// Velocities.
    pub velocities: Vec<Group>,
    /// Inputs.
    pub inputs: Vec<Group>,
    /// States of first order, z, which follow ξ in the argument of velocities.
    pub states: Vec<Group>,
    /// Joints, whose limits become constants of the type.
    pub joints: Vec<Joint>,
    /// Number ν of coordinates.
    pub nu: usize,
    /// Number n of velocities.
    pub n: usize,
    /// Number of inputs.
    pub m: usize,
    /// Number of states of first order.
    pub n_z: usize,
    /// Number of rows of the constraint function φ(x).
    pub phi: usize,
    /// Index of the time in x, if the description declares it.
    pub clock: Option<usize>,
    /// Whether φ has rows that the kinds of coordinates do not satisfy by themselves, so that integrators have to
    /// project x onto φ = 0.
    pub embedded: bool,
    /// Initial x.
    pub start_x: Vec<f64>,
    /// Initial (ξ, z).
    pub start_xi: Vec<f64>,
    /// The user's named expressions, which give names to temporaries.
    pub names: Vec<(String, Edge)>,
    /// Pivots of a mass matrix that is constant at run time; they are checked when parameters are set.
    pub constant_guards: Vec<Edge>,
    /// Reasons for guards that are not positive, by guard.
    pub causes: Vec<(Edge, Cause)>,
    /// Generated functions.
    pub functions: Vec<Function>,
    /// Properties of the equations that decide which integration methods apply.
    pub structure: Structure,
    /// Names and places of all that the labels of the graph refer to.
    pub provenance: Provenance,
}

impl Program {
    /// Returns the reason why a guard is not positive; [`Cause::Mass`] if none is recorded.
    pub fn cause(&self, guard: Edge) -> Cause {
        let known = self.causes.iter().find(|(pivot, _)| *pivot == guard);
        known.map_or(Cause::Mass, |(_, cause)| *cause)
    }

    /// Returns the name of a velocity as the language writes it: `q_dot`, `w[2]`.
    pub fn velocity(&self, place: usize) -> String {
        entry(&self.velocities, place)
    }

    /// Returns the length of an argument: states of first order follow the velocities, and their rates follow ξ̇.
    pub fn length(&self, argument: Argument) -> usize {
        match argument {
            Argument::Coordinates => self.nu,
            Argument::Velocities | Argument::Accelerations => self.n + self.n_z,
            Argument::Momenta => self.n,
            Argument::Inputs => self.m,
        }
    }

    /// Returns the first symbols of the parameters, x, ξ, u, z, ξ̇ and p, in this order, and the end of the last group.
    /// Symbol 0 is π.
    pub fn symbols(&self) -> [usize; 8] {
        let params = self.params.iter().map(|group| group.len).sum();
        let sizes = [params, self.nu, self.n, self.m, self.n_z, self.n, self.n];
        let mut starts = [1; 8];
        for (i, size) in sizes.into_iter().enumerate() {
            starts[i + 1] = starts[i] + size;
        }
        starts
    }

    /// Returns the groups of the argument ξ: the velocities, followed by the states of first order.
    pub fn moving(&self) -> Vec<Group> {
        [self.velocities.clone(), behind(&self.states, self.n)].concat()
    }

    /// Returns the emitted ξ̇, if `accel` is generated.
    pub fn xi_dot(&self) -> Option<&[Edge]> {
        let accel = self.function(FunctionId::Accel)?;
        accel.outputs.get(..self.n)
    }

    /// Returns the emitted ż, if `accel` is generated.
    pub fn state_rates(&self) -> Option<&[Edge]> {
        let accel = self.function(FunctionId::Accel)?;
        accel.outputs.get(self.n..)
    }

    /// Returns the function with this name, be it of the generator's table, an output or an invariant.
    pub fn function(&self, name: impl AsRef<str>) -> Option<&Function> {
        let name = name.as_ref();
        self.functions.iter().find(|function| function.name == name)
    }
}
