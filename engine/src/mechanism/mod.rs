//! A described system as the integrators run it, with its functions compiled to machine code.

mod compiled_stepper;
mod functions;
mod momentum_functions;
mod numbers;
mod sensitivity_stepper;
mod singular;
mod step_code;
mod tape_system;
mod zero_divisors;

use crate::error::Error;
use crate::run::Inputs;
use crate::state::State;
pub use compiled_stepper::{CompiledStepper, StepEnergies};
pub use functions::{FunctionIndex, Functions, compile_functions, find_function};
use hamel::rotor::Rotor;
use hamel::{Block, Energies, Singular, System};
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::generate::Generated;
use hamel_codegen::model::layout;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::program::{Argument, Cause, Program, Shape};
use hamel_native::Compiled;
use momentum_functions::MomentumFunctions;
pub use numbers::Numbers;
pub use sensitivity_stepper::{SensitivityStepper, StepWithSensitivities};
use singular::FailedFunction;
pub use singular::{SingularState, cause_message, explain_singular_state};
use std::cell::{Cell, RefCell};
use std::sync::Arc;
use zero_divisors::Divisors;

/// Compiled functions of a description, shared by its runs for all parameters.
pub struct Mechanism {
    compiled: Compiled,
    /// Compiled steps of methods.
    steps: step_code::StepCache,
    blocks: Vec<Block>,
    chart: usize,
    rate: FunctionIndex,
    chart_rate: FunctionIndex,
    /// `None` if M is not positive definite.
    accel: Option<FunctionIndex>,
    correction: FunctionIndex,
    /// Index in x of the time that the description declares.
    clock: Option<usize>,
    /// Whether the correction restores constraints that no chart satisfies.
    embedded: bool,
    project_position: Option<FunctionIndex>,
    project_velocity: Option<FunctionIndex>,
    constraint: FunctionIndex,
    /// `None` if nothing has inertia.
    momentum: Option<FunctionIndex>,
    force: FunctionIndex,
    /// `None` if nothing has inertia.
    kinetic: Option<FunctionIndex>,
    potential: FunctionIndex,
    outputs: Vec<Output>,
    invariants: Vec<Output>,
    momenta: MomentumFunctions,
    velocity_labels: Vec<String>,
    /// The message for dependent constraints.
    dependent: String,
    /// The divisors of solved constraints.
    divisors: Option<Divisors>,
    constrained: bool,
    /// Whether energy changes by other causes than loads: with the time, or by drives.
    driven: bool,
}

/// Mechanism with its parameters set, as the integrators run it; x, ξ and u are [`Numbers`].
pub struct Instance {
    of: Arc<Mechanism>,
    functions: Functions,
    rotors: Vec<Rotor<f64>>,
    start: (Numbers, Numbers),
    inputs: Numbers,
    /// Inputs that vary during a run, if any.
    given: Option<Inputs>,
    /// The next time at which they jump.
    before: Cell<f64>,
    evaluations: Cell<u64>,
    constant_singular: bool,
    /// The message about a constraint that was divided by 0.
    divided: Option<String>,
    /// The function that last had no value.
    failed: RefCell<Option<FailedFunction>>,
}

/// Output or invariant of the description.
pub struct Output {
    /// Name.
    pub name: String,
    /// Shape.
    pub shape: Shape,
    function: FunctionIndex,
    accelerated: bool,
}

impl Mechanism {
    /// Compiles a complete program; the text of the description is for messages.
    pub fn new(generated: &Generated, text: &str) -> Result<Self, Error> {
        let program = &generated.program;
        let model = &generated.model;
        // The energy is monitored in any case.
        let invariants = model.invariants.iter().map(|claim| &claim.name);
        let invariants: Vec<&String> = invariants.filter(|name| *name != "energy").collect();
        let outputs: Vec<&String> = model.outputs.iter().map(|(name, _)| name).collect();
        let described = outputs.iter().chain(&invariants).map(|name| name.as_str());
        let names = SYSTEM.iter().chain(momentum_functions::NAMES).copied();
        let names: Vec<&str> = names.chain(described).collect();
        let compiled = compile_functions(program, &names)?;
        let function =
            |name: &str| find_function(&compiled, name).ok_or_else(|| missing(program, name));
        let output = |name: &&String| {
            let known = program.function(name.as_str());
            Ok(Output {
                name: name.to_string(),
                shape: known.map_or(Shape::Scalar, |function| function.shape),
                function: function(name)?,
                accelerated: known
                    .is_some_and(|function| function.arguments.contains(&Argument::Accelerations)),
            })
        };
        let list = |names: &[&String]| -> Result<Vec<Output>, Error> {
            names.iter().map(output).collect()
        };
        Ok(Mechanism {
            steps: step_code::StepCache::default(),
            blocks: program.blocks.iter().copied().map(block).collect(),
            chart: program.blocks.iter().map(|block| block.dimension()).sum(),
            rate: function("rate")?,
            chart_rate: function("chart_rate")?,
            accel: function("accel").ok(),
            correction: function("correction")?,
            clock: program.clock,
            embedded: program.embedded,
            project_position: function("project_position").ok(),
            project_velocity: function("project_velocity").ok(),
            constraint: function("constraint")?,
            momentum: function("momentum").ok(),
            force: function("generalized_force")?,
            kinetic: function("kinetic_energy").ok(),
            potential: function("potential_energy")?,
            outputs: list(&outputs)?,
            invariants: list(&invariants)?,
            momenta: MomentumFunctions::new(program, &compiled),
            velocity_labels: singular::velocity_labels(&generated.active, text),
            dependent: singular::dependent_message(&generated.active, text),
            divisors: Divisors::of(generated, text),
            constrained: model.is_constrained(),
            driven: model.clock.is_some() || !model.accelerated.is_empty(),
            compiled,
        })
    }

    /// Returns whether this machine has a fused multiply-add.
    pub fn is_fused(&self) -> bool {
        self.compiled.is_fused()
    }
}

impl Instance {
    /// Compiles a complete program for the parameters, start and constant inputs of a state; the text of the
    /// description is for messages.
    pub fn new(generated: &Generated, state: &State, text: &str) -> Result<Self, Error> {
        Instance::of(&Arc::new(Mechanism::new(generated, text)?), state)
    }

    /// Sets the parameters, start and constant inputs of a mechanism to those of a state.
    pub fn of(mechanism: &Arc<Mechanism>, state: &State) -> Result<Self, Error> {
        let functions = Functions::new(&mechanism.compiled, &state.params);
        let divisors = mechanism.divisors.as_ref();
        let divided = divisors.and_then(|all| all.message_if_zero(&state.params));
        Ok(Instance {
            divided: divided.map(str::to_owned),
            rotors: mechanism.momenta.rotors(&functions)?,
            constant_singular: functions.are_singular(),
            of: Arc::clone(mechanism),
            functions,
            start: (state.x.as_slice().into(), state.xi.as_slice().into()),
            inputs: state.u.as_slice().into(),
            given: None,
            before: Cell::new(f64::INFINITY),
            evaluations: Cell::new(0),
            failed: RefCell::new(None),
        })
    }

    /// Returns the number of evaluations of ξ̇, of kicks or of ṗ so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    /// Returns the names of the entries of ξ in messages.
    pub fn velocity_labels(&self) -> &[String] {
        &self.of.velocity_labels
    }

    /// Returns the message for dependent constraints.
    pub fn dependent_constraints_message(&self) -> &str {
        &self.of.dependent
    }

    /// Returns whether a mass matrix that is constant in time is not positive definite with these parameters.
    pub fn constant_singular(&self) -> bool {
        self.constant_singular
    }

    /// Returns the message about a constraint that was solved by dividing by 0, if any.
    pub fn zero_divisor_message(&self) -> Option<&str> {
        self.divided.as_deref()
    }

    /// Returns whether there are constraints on the velocities.
    pub fn is_constrained(&self) -> bool {
        self.of.constrained
    }

    /// Returns whether energy changes by other causes than loads: with the time, or by drives.
    pub fn is_driven(&self) -> bool {
        self.of.driven
    }

    /// Returns the function that last had no value, if any.
    pub fn last_failure(&self) -> Option<FailedFunction> {
        self.failed.borrow().clone()
    }

    fn projection(&self, cause: Cause) -> Singular {
        self.record_failure(FailedFunction::Projection);
        singular(cause)
    }

    /// Evaluates a function that is defined everywhere.
    fn value(&self, function: FunctionIndex, x: &[f64], xi: &[f64], u: &[f64]) -> Numbers {
        let value = self.functions.call(function, [x, xi, u, &[], &[]]);
        value.unwrap_or_else(|_| Numbers::filled(f64::NAN, function.length()))
    }

    fn scalar(&self, function: FunctionIndex, x: &[f64], xi: &[f64]) -> f64 {
        self.functions.number(function, [x, xi, &[], &[], &[]])
    }

    fn record_failure(&self, what: FailedFunction) {
        self.failed.replace(Some(what));
    }

    fn count(&self) {
        self.evaluations.set(self.evaluations.get() + 1);
    }

    /// Replaces the varying inputs.
    pub fn with_inputs(self, given: Option<Inputs>) -> Self {
        Instance { given, ..self }
    }

    /// Returns the varying inputs, if any.
    pub fn varying_inputs(&self) -> Option<&Inputs> {
        self.given.as_ref()
    }

    /// Returns the times at which inputs jump.
    pub fn jumps(&self) -> &[f64] {
        self.given.as_ref().map_or(&[], Inputs::jumps)
    }

    /// Tells the inputs that a run proceeds from this time to their next jump, before which they keep their values.
    pub fn begin_interval(&self, t: f64) {
        let next = self.jumps().iter().find(|jump| **jump > t);
        self.before.set(next.copied().unwrap_or(f64::INFINITY));
    }

    /// Returns the inputs u at a time and state.
    pub fn inputs(&self, t: f64, x: &[f64], xi: &[f64]) -> Numbers {
        let kept = self.inputs.clone();
        let t = match t >= self.before.get() {
            true => self.before.get().next_down(),
            false => t,
        };
        match &self.given {
            Some(given) => {
                let mut u = kept;
                given.set(t, x, xi, u.as_mut());
                u
            }
            None => kept,
        }
    }

    /// Returns p = M ξ; NaN if nothing has inertia.
    pub fn momentum(&self, x: &[f64], xi: &[f64]) -> Numbers {
        match self.of.momentum {
            Some(momentum) => self.value(momentum, x, xi, &[]),
            None => Numbers::filled(f64::NAN, xi.len()),
        }
    }

    /// Returns the power of the loads, f ξ.
    pub fn power(&self, t: f64, x: &[f64], xi: &[f64]) -> f64 {
        let force = self.value(self.of.force, x, xi, &self.inputs(t, x, xi));
        force.iter().zip(xi).map(|(f, v)| f * v).sum()
    }

    /// Returns φ(x).
    pub fn constraint(&self, x: &[f64]) -> Numbers {
        self.value(self.of.constraint, x, &[], &[])
    }

    /// Returns the outputs of the description.
    pub fn outputs(&self) -> &[Output] {
        &self.of.outputs
    }

    /// Returns the quantities that the description claims to be constant, except the energy.
    pub fn invariants(&self) -> &[Output] {
        &self.of.invariants
    }

    /// Evaluates an output, matrices by rows; accelerations are those of the forward dynamics, NaN if they do not
    /// exist.
    pub fn output(&self, output: &Output, t: f64, x: &[f64], xi: &[f64]) -> Numbers {
        let u = self.inputs(t, x, xi);
        let mut xi_dot = Numbers::filled(0.0, 0);
        if output.accelerated {
            let arguments = [x, xi, &u, &[], &[]];
            let accel = self
                .of
                .accel
                .map(|accel| self.functions.call(accel, arguments));
            let accel = accel.and_then(Result::ok);
            xi_dot = accel.unwrap_or_else(|| Numbers::filled(f64::NAN, xi.len()));
        }
        let arguments = [x, xi, &u, &xi_dot, &[]];
        let value = self.functions.call(output.function, arguments);
        value.unwrap_or_else(|_| Numbers::filled(f64::NAN, output.function.length()))
    }
}

/// The functions that every run needs.
const SYSTEM: &[&str] = &[
    "rate",
    "chart_rate",
    "accel",
    "correction",
    "project_position",
    "project_velocity",
    "constraint",
    "momentum",
    "generalized_force",
    "kinetic_energy",
    "potential_energy",
];

/// Converts the cause of a failed pivot to the error of a run.
fn singular(cause: Cause) -> Singular {
    match cause {
        Cause::Kinematics(pivot) => Singular::Kinematics { pivot },
        Cause::Constraint(row) => Singular::Constraints { row },
        // The message names the velocity and its line.
        Cause::Velocity(_) | Cause::Mass => Singular::Mass,
    }
}

/// Prepares one function of a program for interpretation.
pub fn function(program: &Program, name: &str, params: &[f64]) -> Result<Interpreter, Error> {
    match program.function(name) {
        Some(function) => Ok(Interpreter::new(program, function, params)),
        None => Err(missing(program, name)),
    }
}

fn missing(program: &Program, name: &str) -> Error {
    Error::MissingFunction {
        system: program.name.clone(),
        name: name.into(),
    }
}

/// Returns whether a mass matrix that is constant in time is not positive definite with these parameters.
pub fn constant_singular(program: &Program, params: &[f64]) -> bool {
    let mut symbols = vec![std::f64::consts::PI];
    symbols.extend_from_slice(params);
    symbols.resize(program.graph.symbols().len(), f64::NAN);
    let pivots = evaluate(&program.graph, &program.constant_guards, &symbols);
    pivots
        .iter()
        .any(|&pivot| !(pivot.is_finite() && pivot > 0.0))
}

/// Returns the largest absolute value of the entries; NaN if one is NaN.
fn largest(entries: &[f64]) -> f64 {
    let sizes = entries.iter().map(|entry| entry.abs());
    sizes.fold(0.0, |a, b| if b.is_nan() || b > a { b } else { a })
}

fn block(block: layout::Block) -> Block {
    match block {
        layout::Block::Flat(n) => Block::Flat(n),
        layout::Block::Circle => Block::Circle,
        layout::Block::Quaternion => Block::Quaternion,
        layout::Block::Rotation => Block::Rotation,
    }
}

impl System for Instance {
    type Scalar = f64;
    type Coordinates = Numbers;
    type Velocities = Numbers;
    type Chart = Numbers;
    type Inputs = Numbers;

    fn blocks(&self) -> &[Block] {
        &self.of.blocks
    }

    fn zero_velocities(&self) -> Numbers {
        Numbers::filled(0.0, self.start.1.len())
    }

    fn zero_inputs(&self) -> Numbers {
        Numbers::filled(0.0, self.inputs.len())
    }

    fn start(&self) -> (Numbers, Numbers) {
        self.start.clone()
    }

    fn clock(&self) -> Option<usize> {
        self.of.clock
    }

    fn rate(&self, x: &Numbers, xi: &Numbers) -> Numbers {
        self.value(self.of.rate, x, xi, &[])
    }

    fn chart_rate(&self, x: &Numbers, xi: &Numbers) -> Numbers {
        self.value(self.of.chart_rate, x, xi, &[])
    }

    fn forward_dynamics(
        &self,
        x: &Numbers,
        xi: &Numbers,
        u: &Numbers,
    ) -> Result<Numbers, Singular> {
        self.count();
        let Some(accel) = self.of.accel else {
            return Err(Singular::Mass);
        };
        let value = self.functions.call(accel, [x, xi, u, &[], &[]]);
        value.map_err(|cause| {
            self.record_failure(FailedFunction::Motion(x.to_vec()));
            singular(cause)
        })
    }

    fn correction(&self, x: &Numbers) -> Numbers {
        self.value(self.of.correction, x, &[], &[])
    }

    fn project_coordinates(&self, x: &Numbers) -> Option<Numbers> {
        self.of.embedded.then(|| self.correction(x))
    }

    fn project_position(&self, x: &Numbers) -> Result<Option<Numbers>, Singular> {
        let arguments = [&**x, &[], &[], &[], &[]];
        let function = self.of.project_position;
        let step = function.map(|function| self.functions.call(function, arguments));
        step.transpose().map_err(|cause| self.projection(cause))
    }

    fn project_velocity(&self, x: &Numbers, xi: &Numbers) -> Result<Option<Numbers>, Singular> {
        let arguments = [&**x, xi, &[], &[], &[]];
        let function = self.of.project_velocity;
        let projected = function.map(|function| self.functions.call(function, arguments));
        projected
            .transpose()
            .map_err(|cause| self.projection(cause))
    }

    fn constraint_norm(&self, x: &Numbers) -> f64 {
        largest(&self.constraint(x))
    }
}

impl Energies for Instance {
    fn kinetic_energy(&self, x: &Numbers, xi: &Numbers) -> f64 {
        match self.of.kinetic {
            Some(kinetic) => self.scalar(kinetic, x, xi),
            None => f64::NAN,
        }
    }

    fn potential_energy(&self, x: &Numbers) -> f64 {
        self.scalar(self.of.potential, x, &[])
    }
}
