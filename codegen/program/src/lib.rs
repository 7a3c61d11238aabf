//! Straight-line programs: what is computed when, and at what cost.
//!
#![doc = include_str!("../README.md")]

pub mod count;
pub mod interpret;
pub mod places;
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
use structure::Structure;

use hamel_language::functions::Returns;
pub use hamel_language::functions::{Argument, FunctionId};

/// The shape of a result.
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
    /// How many numbers it consists of.
    pub fn entries(self) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Vector(n) => n,
            Shape::Matrix(rows, columns) => rows * columns,
        }
    }
}

/// What it means where a pivot is not positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// This velocity has no inertia where those that were eliminated before it follow freely, and the others are held.
    Velocity(usize),
    /// The mass matrix, or an inertia that parameters give, is not positive definite.
    Mass,
    /// This constraint of those that multipliers keep depends on others.
    Constraint(usize),
    /// This pivot of [Y; Φ] has changed its sign, KR18 (5): a kinematic singularity.
    Kinematics(usize),
}

/// One generated function.
#[derive(Clone, Debug)]
pub struct Function {
    /// Which one it is; none for outputs and invariants of the description.
    pub id: Option<FunctionId>,
    /// Rust name.
    pub name: String,
    /// Documentation: the equation it evaluates, shapes, units; one string a line.
    pub docs: Vec<String>,
    /// Its arguments.
    pub arguments: Vec<Argument>,
    /// Shape of the result.
    pub shape: Shape,
    /// The result, matrices by rows.
    pub outputs: Vec<Edge>,
    /// Pivots that have to be positive, or the function returns the error `Singular`.
    pub guards: Vec<Edge>,
    /// Whether it returns a `Result`.
    pub fallible: bool,
    /// ξ̇ as it comes out on the way to [A B]; empty where it is that of `accel`.
    pub rates: Vec<Edge>,
}

impl Function {
    /// A function that the generator knows, without guards.
    pub fn known(id: FunctionId, n: usize, outputs: Vec<Edge>) -> Self {
        let row = id.row();
        let matrix = |rows: usize| Shape::Matrix(rows, outputs.len() / rows.max(1));
        let shape = match row.returns {
            Returns::Number => Shape::Scalar,
            Returns::Vector => Shape::Vector(outputs.len()),
            Returns::Rows => matrix(n),
            // Its shape depends on inputs and constraints, too, and is set where it is derived.
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

    /// An output or invariant of the description.
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
    /// Name of the type.
    pub name: String,
    /// Whether it is `pub`.
    pub public: bool,
    /// Its documentation, as the user wrote it.
    pub docs: Vec<String>,
    /// The graph of all functions.
    pub graph: Graph,
    /// Parameters, with their default values by symbol.
    pub params: Vec<Group>,
    /// Default values, in order of the parameters' symbols.
    pub defaults: Vec<f64>,
    /// Coordinates.
    pub coordinates: Vec<Coordinate>,
    /// Blocks of x.
    pub blocks: Vec<Block>,
    /// Velocities.
    pub velocities: Vec<Group>,
    /// Inputs.
    pub inputs: Vec<Group>,
    /// States of first order, which stand behind ξ.
    pub states: Vec<Group>,
    /// Joints, whose limits are constants of the type.
    pub joints: Vec<Joint>,
    /// ν.
    pub nu: usize,
    /// n.
    pub n: usize,
    /// Number of inputs.
    pub m: usize,
    /// Number of states of first order.
    pub n_z: usize,
    /// Number of rows of φ.
    pub phi: usize,
    /// The place of the time in x, where the description declares it.
    pub clock: Option<usize>,
    /// Whether φ has rows that the kinds of coordinates do not keep by themselves: integrators lead x back to them.
    pub embedded: bool,
    /// x at the start.
    pub start_x: Vec<f64>,
    /// (ξ, z) at the start.
    pub start_xi: Vec<f64>,
    /// The user's named expressions, for names of temporaries.
    pub names: Vec<(String, Edge)>,
    /// Pivots of a mass matrix that is constant at run time: checked when parameters are set.
    pub constant_guards: Vec<Edge>,
    /// What it means where a guard is not positive.
    pub causes: Vec<(Edge, Cause)>,
    /// The functions.
    pub functions: Vec<Function>,
    /// What methods of integration ask of the system.
    pub structure: Structure,
}

impl Program {
    /// What it means where a guard is not positive.
    pub fn cause(&self, guard: Edge) -> Cause {
        let known = self.causes.iter().find(|(pivot, _)| *pivot == guard);
        known.map_or(Cause::Mass, |(_, cause)| *cause)
    }

    /// The name of a velocity as the language writes it: `q_dot`, `w[2]`.
    pub fn velocity(&self, place: usize) -> String {
        entry(&self.velocities, place)
    }

    /// The length of an argument: states of first order stand behind the velocities, their rates behind ξ̇.
    pub fn length(&self, argument: Argument) -> usize {
        match argument {
            Argument::Coordinates => self.nu,
            Argument::Velocities | Argument::Accelerations => self.n + self.n_z,
            Argument::Momenta => self.n,
            Argument::Inputs => self.m,
        }
    }

    /// Where the symbols of parameters, x, ξ, u, z, ξ̇ and p begin, in this order, after π: and the end of all.
    pub fn symbols(&self) -> [usize; 8] {
        let params = self.params.iter().map(|group| group.len).sum();
        let sizes = [params, self.nu, self.n, self.m, self.n_z, self.n, self.n];
        let mut starts = [1; 8];
        for (i, size) in sizes.into_iter().enumerate() {
            starts[i + 1] = starts[i] + size;
        }
        starts
    }

    /// What the argument ξ consists of: the velocities, and behind them the states of first order.
    pub fn moving(&self) -> Vec<Group> {
        [self.velocities.clone(), behind(&self.states, self.n)].concat()
    }

    /// The emitted ξ̇.
    pub fn xi_dot(&self) -> Option<&[Edge]> {
        let accel = self.function(FunctionId::Accel)?;
        accel.outputs.get(..self.n)
    }

    /// The emitted ż.
    pub fn state_rates(&self) -> Option<&[Edge]> {
        let accel = self.function(FunctionId::Accel)?;
        accel.outputs.get(self.n..)
    }

    /// A function: one that the generator knows, or an output or invariant by its name.
    pub fn function(&self, name: impl AsRef<str>) -> Option<&Function> {
        let name = name.as_ref();
        self.functions.iter().find(|function| function.name == name)
    }
}
