//! A description with everything that can be asked of it, as numbers: the interface for front ends and other programs.

mod event_systems;
mod function;
mod pull;

pub use function::Function;
pub use pull::Grip;

use crate::drawing::Drawing;
use crate::error::Error;
use crate::evaluate::{Evaluation, evaluate};
use crate::linearize::{Linearization, linearize};
use crate::mechanism::{self, Instance, Mechanism, SensitivityStepper};
use crate::method::{self, AUTO, ChosenMethod, Stepper};
use crate::names;
use crate::reporter::Reporter;
use crate::run::{Run, Simulation};
use crate::source::{OpenOptions, Source};
use crate::state::{State, StateFile, joints};
use crate::trim::{self, Trim, TrimOptions};
use event_systems::EventSystemCache;
use function::compile;
use hamel::methods::General;
use hamel::step;
use hamel_codegen::derive::regressor::regressor;
use hamel_codegen::functions::{Asked, FunctionId, Jacobian, SLOPES, Serves};
use hamel_codegen::generate::Generated;
use hamel_codegen::model::Model;
use hamel_codegen::program::Cause;
use hamel_codegen::proof::regressor::check_base_parameters;
use hamel_codegen::syntax::ast::CoordKind;
use hamel_codegen::syntax::suggest::closest;
use hamel_codegen::tables::regressor::BaseParameters;
use hamel_codegen::tables::{Table, Tables};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Derived description with its compiled functions.
pub struct Session {
    source: Source,
    generated: Arc<Generated>,
    /// The same with its linearisation.
    linearized: OnceLock<Generated>,
    mechanism: OnceLock<Arc<Mechanism>>,
    /// Steps with derivatives, for the last requested parameters.
    varied: Mutex<Option<Arc<SensitivityStepper>>>,
    functions: Mutex<BTreeMap<String, Function>>,
    /// Systems extended by the expressions of recent events.
    observed: EventSystemCache,
    drawing: OnceLock<Drawing>,
}

/// Names of the entries of x, ξ, u or the parameters, and their groups: name, index of the first entry, number of
/// entries.
#[derive(Clone, Debug, PartialEq)]
pub struct Names {
    /// Names of all entries, such as `w[2]`.
    pub entries: Vec<String>,
    /// Groups of entries, such as `w`.
    pub groups: Vec<(String, usize, usize)>,
}

/// Steps of a method from any state of a system, one at a time.
pub struct SingleStepper {
    instance: Instance,
    stepper: Stepper,
}

impl SingleStepper {
    /// Prepares steps of `rkmk4` from a state; the text of the description is for messages.
    pub(crate) fn of(generated: &Generated, state: &State, text: &str) -> Result<Self, Error> {
        let instance = Instance::new(generated, state, text)?;
        let structure = instance.structure(&generated.program);
        let ChosenMethod { stepper, .. } = ChosenMethod::new("rkmk4", &instance, &structure, 1)?;
        Ok(SingleStepper { instance, stepper })
    }

    /// Replaces x and ξ by their values after a step of length h.
    ///
    /// # Errors
    /// The step fails.
    pub fn step(&self, x: &mut [f64], xi: &mut [f64], u: &[f64], h: f64) -> Result<(), Error> {
        let mut state = hamel::State::<Instance> {
            t: 0.0,
            x: (&*x).into(),
            xi: (&*xi).into(),
        };
        let held = u.into();
        let inputs = |_, _: &_, _: &_| Clone::clone(&held);
        step(&self.instance, &self.stepper, &mut state, h, &inputs)
            .map_err(|error| self.instance.step_error(&error))?;
        x.copy_from_slice(&state.x);
        xi.copy_from_slice(&state.xi);
        Ok(())
    }
}

impl Session {
    /// Opens the file of a description, or of a robot in URDF.
    ///
    /// # Errors
    /// The text cannot be read, or has errors.
    pub fn open(
        path: &Path,
        options: &OpenOptions,
        reporter: Arc<dyn Reporter>,
    ) -> Result<Self, Error> {
        Session::from_source(Source::open(path, options, reporter)?)
    }

    /// Reads the text of a description, or of a robot in URDF, which messages call `name`.
    ///
    /// # Errors
    /// The text cannot be read, or has errors.
    pub fn read(
        text: String,
        name: &str,
        options: &OpenOptions,
        reporter: Arc<dyn Reporter>,
    ) -> Result<Self, Error> {
        Session::from_source(Source::new(name.into(), text, reporter).interpret(options)?)
    }

    /// Derives the default functions of a description that exist: those that contain M⁻¹ are left out, with a warning, if M is
    /// not positive definite.
    ///
    /// # Errors
    /// The description has errors.
    pub fn from_source(source: Source) -> Result<Self, Error> {
        let source = source.for_evaluation();
        let generated = source.derive_available(&[])?;
        Ok(Session::derived(source, generated))
    }

    /// Derives the functions that a description without `generate` gets, whatever its `generate` says.
    ///
    /// # Errors
    /// The description has errors, or lacks a function.
    pub fn with_default_functions(source: Source) -> Result<Self, Error> {
        let source = source.for_evaluation();
        let generated = source.derive_default_functions()?;
        Ok(Session::derived(source, generated))
    }

    /// Derives only positions and poses, for pictures: nothing can be run.
    ///
    /// # Errors
    /// The description has errors.
    pub fn for_drawing(source: Source) -> Result<Self, Error> {
        let source = source.for_evaluation();
        let generated = source.derive_places()?;
        Ok(Session::derived(source, generated))
    }

    fn derived(source: Source, generated: Generated) -> Self {
        Session {
            source,
            generated: Arc::new(generated),
            linearized: OnceLock::new(),
            mechanism: OnceLock::new(),
            varied: Mutex::default(),
            functions: Mutex::default(),
            observed: EventSystemCache::default(),
            drawing: OnceLock::new(),
        }
    }

    /// Returns the description.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Returns the derived equations.
    pub fn generated(&self) -> &Generated {
        &self.generated
    }

    /// Returns the name of the system.
    pub fn name(&self) -> &str {
        &self.generated.model.name
    }

    /// Returns the text of the description; for a robot, that of the importer.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    fn active(&self) -> &Model {
        &self.generated.active
    }

    /// Returns the names of the entries of x.
    pub fn coordinates(&self) -> Names {
        let coordinates = &self.generated.model.coordinates;
        let groups = coordinates.iter().map(|coordinate| {
            let entries = hamel_codegen::model::layout::entry_names("", coordinate.kind);
            (coordinate.name.clone(), coordinate.offset, entries.len())
        });
        Names {
            entries: names::coordinates(&self.generated.model),
            groups: groups.collect(),
        }
    }

    /// Returns the names of the entries of ξ, followed by those of the states of first order.
    pub fn velocities(&self) -> Names {
        Names {
            entries: names::velocities_and_states(self.active()),
            groups: groups(&self.generated.program.moving()),
        }
    }

    /// Returns the names of the entries of u.
    pub fn inputs(&self) -> Names {
        let inputs = &self.active().inputs;
        Names {
            entries: inputs.iter().flat_map(names::group).collect(),
            groups: groups(inputs),
        }
    }

    /// Returns the names of the parameters.
    pub fn parameters(&self) -> Names {
        let params = &self.generated.program.params;
        Names {
            entries: params.iter().flat_map(names::group).collect(),
            groups: groups(params),
        }
    }

    /// Returns the joints, each with the index of its first velocity in ξ and the number of its velocities.
    pub fn joints(&self) -> Vec<(String, usize, usize)> {
        let joints = joints(self.active(), self.source.joints()).into_iter();
        joints
            .map(|joint| (joint.name, joint.velocities.0, joint.velocities.1))
            .collect()
    }

    /// Returns the names of the frames of the description.
    pub fn frames(&self) -> Vec<String> {
        let frames = self.active().frames.iter();
        frames.map(|frame| frame.name.clone()).collect()
    }

    /// Returns the names of the outputs of the description.
    pub fn outputs(&self) -> Vec<String> {
        let outputs = self.active().outputs.iter();
        outputs.map(|(name, _)| name.clone()).collect()
    }

    /// Returns the start, with default parameters and zero inputs.
    pub fn start(&self) -> State {
        State::start(self.active())
    }

    /// Returns the start with these parameters, changed by a JSON text, which messages call `name`; see `hamel eval
    /// --help` for its form.
    ///
    /// # Errors
    /// All errors in the text.
    pub fn state(&self, params: &[f64], json: &str, name: &str) -> Result<State, Error> {
        let start = State {
            params: params.to_vec(),
            ..self.start()
        };
        self.change_state(start, json, name)
    }

    /// Returns the start, changed by a JSON file if there is one.
    ///
    /// # Errors
    /// The file cannot be read, or has errors.
    pub fn read_state(&self, path: Option<&Path>) -> Result<State, Error> {
        State::read(&self.source, &self.generated, path)
    }

    /// Changes a state by a JSON text.
    ///
    /// # Errors
    /// All errors in the text.
    pub fn change_state(&self, from: State, json: &str, name: &str) -> Result<State, Error> {
        StateFile::of(name.into(), json, &self.source)?.changes(from, &self.source, &self.generated)
    }

    /// Returns the names of all available functions, including those that are derived on request.
    pub fn functions(&self) -> Vec<String> {
        let program = &self.generated.program;
        let is_public = |id: Option<FunctionId>| id.is_none_or(|id| id.row().named);
        let there = program.functions.iter().filter(|f| is_public(f.id));
        let mut all: Vec<String> = there.map(|function| function.name.clone()).collect();
        let asked = FunctionId::ALL.iter();
        let asked = asked.filter(|id| id.row().serves == Serves::Asked && id.row().named);
        all.extend(asked.map(|id| id.name().to_string()));
        all.extend(self.frames().iter().flat_map(|frame| {
            let names = |own| {
                let frame = frame.clone();
                Jacobian { frame, own }.names().collect::<Vec<_>>()
            };
            [names(false), names(true)].concat()
        }));
        all.extend(self.outputs().iter().map(|name| format!("{name}{SLOPES}")));
        let mut known = std::collections::BTreeSet::new();
        all.retain(|name| known.insert(name.clone()));
        all
    }

    /// Compiles a function by its name.
    ///
    /// # Errors
    /// No function has this name, or it does not exist for this system.
    pub fn function(&self, name: &str) -> Result<Function, Error> {
        let known = || {
            self.functions
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        if let Some(function) = known().get(name) {
            return Ok(function.clone());
        }
        let function = match self.generated.program.function(name) {
            Some(_) => compile(&self.generated, name)?,
            None => compile(&self.asked(name)?, name)?,
        };
        known().insert(name.into(), function.clone());
        Ok(function)
    }

    /// Derives a function that is derived only on request.
    fn asked(&self, name: &str) -> Result<Generated, Error> {
        let mut wanted = Asked::only(&[]);
        let frames = self.frames();
        let frames = frames.iter().flat_map(|frame| {
            [false, true].map(|own| Jacobian {
                frame: frame.clone(),
                own,
            })
        });
        let id = FunctionId::from_name(name).filter(|id| id.row().named);
        let of_frame = frames
            .into_iter()
            .find(|one| one.names().any(|of| of == name));
        let output = name.strip_suffix(SLOPES);
        let output = output.filter(|of| self.outputs().iter().any(|known| known == of));
        match (id, of_frame, output) {
            (Some(id), ..) => wanted.functions.push(id),
            (_, Some(jacobian), _) => wanted.jacobians.push(jacobian),
            (.., Some(output)) => {
                wanted.slopes.push(output.into());
                wanted.functions.push(FunctionId::Linearize);
            }
            (None, None, None) => {
                let all = self.functions();
                let close = closest(name, all.iter().map(String::as_str));
                return Err(Error::UnknownFunction {
                    system: self.name().into(),
                    name: name.into(),
                    closest: close.map(String::from),
                });
            }
        }
        self.source.derive_asked(&wanted)
    }

    /// Composes the message for a cause that a failed call of a function returned, with the names and lines of the
    /// description; evaluates nothing.
    pub fn cause_message(&self, cause: Cause) -> String {
        let shown = self.source.shown();
        mechanism::cause_message(cause, self.active(), shown)
    }

    fn mechanism(&self) -> Result<&Arc<Mechanism>, Error> {
        if let Some(mechanism) = self.mechanism.get() {
            return Ok(mechanism);
        }
        let made = Mechanism::new(&self.generated, self.source.shown())?;
        Ok(self.mechanism.get_or_init(|| Arc::new(made)))
    }

    fn instance(&self, state: &State) -> Result<Instance, Error> {
        self.source.check_inertia(&self.generated)?;
        let instance = Instance::of(self.mechanism()?, state)?;
        instance.check_parameters(&state.x)?;
        Ok(instance)
    }

    /// Runs the system from a state; the run may end at an event, or be cancelled.
    ///
    /// # Errors
    /// The run cannot begin. The reason of a run that ends early is in [`Run::failure`].
    pub fn simulate(&self, state: &State, simulation: &Simulation) -> Result<Run, Error> {
        simulation.stepping.check()?;
        let given = simulation.prepare_inputs(&self.generated, state)?;
        let observed = self.observed.of(&self.source, &simulation.events)?;
        let (generated, system) = match &observed {
            None => (&self.generated, self.instance(state)?),
            Some(observed) => (&observed.generated, observed.instance(state)?),
        };
        simulation.run(
            generated,
            system.with_inputs(given),
            state,
            self.source.reporter(),
        )
    }

    /// Prepares single steps of a method, given by its name or `auto`, with the parameters of a state.
    ///
    /// # Errors
    /// The method does not fit the system.
    pub fn single_stepper(&self, state: &State, method: &str) -> Result<SingleStepper, Error> {
        let instance = self.instance(state)?;
        let structure = instance.structure(&self.generated.program);
        let mut chosen = ChosenMethod::new(method, &instance, &structure, 1)?;
        if method == AUTO && matches!(chosen.stepper, Stepper::Closed { .. }) {
            // The closed form always moves from the start.
            chosen = ChosenMethod::new("rkmk4", &instance, &structure, 1)?;
        }
        Ok(SingleStepper {
            instance,
            stepper: chosen.stepper,
        })
    }

    /// Linearises the motion at a state, in all displacements and velocities if `full`.
    ///
    /// # Errors
    /// The motion has no value there.
    pub fn linearize(&self, state: &State, full: bool) -> Result<Linearization, Error> {
        linearize(self.linearized()?, state, self.source.shown(), full)
    }

    /// Finds the equilibrium or steady motion to which a search from a state leads.
    ///
    /// # Errors
    /// An equation or a name is wrong, or there is no solution near the state.
    pub fn trim(&self, state: &State, options: &TrimOptions) -> Result<Trim, Error> {
        let derived;
        let generated = match options.fix.is_empty() {
            true => self.linearized()?,
            false => {
                derived = trim::derive(&self.source, options)?;
                &derived
            }
        };
        trim::trim(generated, state, options, self.source.shown())
    }

    fn linearized(&self) -> Result<&Generated, Error> {
        if let Some(generated) = self.linearized.get() {
            return Ok(generated);
        }
        let derived = self.source.derive_linearized()?;
        Ok(self.linearized.get_or_init(|| derived))
    }

    /// Prepares steps with derivatives, with the parameters of a state, by one of the methods for any system.
    ///
    /// # Errors
    /// There is no linearisation, or steps of the method have no derivatives.
    pub fn sensitivity_stepper(
        &self,
        state: &State,
        method: &str,
    ) -> Result<(Arc<SensitivityStepper>, General), Error> {
        let found = method::with_step_slopes().find(|one| one.name() == method);
        let Some(found) = found else {
            return Err(Error::NoStepSlopes {
                method: method.into(),
            });
        };
        let mut known = self.varied.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(varied) = known.as_ref().filter(|one| one.params() == state.params) {
            return Ok((Arc::clone(varied), found));
        }
        self.instance(state)?;
        let varied = Arc::new(SensitivityStepper::new(self.linearized()?, &state.params)?);
        *known = Some(Arc::clone(&varied));
        Ok((varied, found))
    }

    /// Evaluates everything at a state, including γ and Γ.
    ///
    /// # Errors
    /// Functions in Rust have no values.
    pub fn evaluate(&self, state: &State) -> Result<Evaluation, Error> {
        evaluate((&self.generated, self.source.shown()), state, &[], true)
    }

    /// Derives the base parameters.
    ///
    /// # Errors
    /// The system has none.
    pub fn base_parameters(&self) -> Result<BaseParameters, Error> {
        base_parameters(&self.source)
    }

    /// Derives tables of equations, such as γ or M, by their names; without names, those that matter.
    ///
    /// # Errors
    /// A table is unknown, or does not exist for the system.
    pub fn tables(&self, of: &[String]) -> Result<Tables, Error> {
        let named: Result<Vec<Table>, _> = of.iter().map(|name| Table::parse(name)).collect();
        let tables = named.and_then(|of| self.generated.tables(&of));
        tables.map_err(Error::Table)
    }

    /// Returns the kinds of the coordinates, as the language writes them: `real`, `R3`, `S1`, `S3`, `SO3` or `SE3`.
    pub fn kinds(&self) -> Vec<String> {
        let coordinates = self.generated.model.coordinates.iter();
        let named = coordinates.map(|coordinate| match coordinate.kind {
            CoordKind::Real => "real".into(),
            CoordKind::Euclidean(n) => format!("R{n}"),
            CoordKind::S1 => "S1".into(),
            CoordKind::S3 => "S3".into(),
            CoordKind::SO3 => "SO3".into(),
            CoordKind::SE3 => "SE3".into(),
        });
        named.collect()
    }

    /// Returns the drawable parts of the mechanism, compiled for any parameters and states.
    ///
    /// # Errors
    /// A frame depends on a function in Rust.
    pub fn drawing(&self) -> Result<&Drawing, Error> {
        if let Some(drawing) = self.drawing.get() {
            return Ok(drawing);
        }
        let made = Drawing::new(&self.generated)?;
        Ok(self.drawing.get_or_init(|| made))
    }

    /// Returns the names of the methods.
    pub fn methods() -> Vec<&'static str> {
        method::names()
    }
}

/// Derives the base parameters of a description.
///
/// # Errors
/// The system has constraints, or forces that robots do not have.
pub fn base_parameters(source: &Source) -> Result<BaseParameters, Error> {
    let model = source.model()?;
    let refused = |why: String| Error::NoRegressor {
        path: source.path.clone(),
        system: model.name.clone(),
        why,
    };
    let regressor = regressor(&model).map_err(|why| refused(why.to_string()))?;
    check_base_parameters(&model, &regressor).map_err(|why| refused(why.to_string()))?;
    Ok(BaseParameters::new(&regressor))
}

fn groups(groups: &[hamel_codegen::model::Group]) -> Vec<(String, usize, usize)> {
    let parts = groups.iter();
    parts
        .map(|group| (group.name.clone(), group.offset, group.len))
        .collect()
}
