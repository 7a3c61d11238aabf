//! The commands for use by other programs: a description as an object, with numbers instead of text.

mod function;
mod motion;
mod observed;
mod pull;
mod reports;

pub use function::Function;
pub use motion::{Happened, Motion};
pub use pull::Grip;
pub use reports::imported;

use crate::added;
use crate::drawing::Drawing;
use crate::eval::numbers;
use crate::failure::{Failure, Said, collected};
use crate::linearize::{self, Linear};
use crate::mechanism::{Instance, Mechanism, Varied};
use crate::method::{self, AUTO, Chosen, Stepper};
use crate::names;
use crate::regressor::base;
use crate::robot::RobotOptions;
use crate::simulate::events::{Event, Events};
use crate::simulate::inputs::{Asked, Inputs, Law};
use crate::simulate::plan::{Every, Spacing};
use crate::simulate::record::Run;
use crate::simulate::stepping::Stepping;
use crate::simulate::stop::Stop;
use crate::singular;
use crate::source::Source;
use crate::state::State;
use crate::state::file::File;
use crate::state::joints::joints;
use crate::tables::Format;
use function::compiled;
use hamel::methods::General;
use hamel::step;
use hamel_codegen::functions::{Asked as Wanted, FunctionId, Jacobian, SLOPES, Serves};
use hamel_codegen::generate::Generated;
use hamel_codegen::model::Model;
use hamel_codegen::program::Cause;
use hamel_codegen::tables::Table;
use hamel_codegen::tables::regressor::BaseParameters;
use observed::AllObserved;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A derived description with its compiled functions.
pub struct Session {
    source: Source,
    generated: Generated,
    /// The same with its linearisation.
    linearized: OnceLock<Generated>,
    mechanism: OnceLock<Arc<Mechanism>>,
    /// Steps with derivatives, for the last requested parameters.
    varied: Mutex<Option<Arc<Varied>>>,
    functions: Mutex<BTreeMap<String, Function>>,
    /// Systems extended by the expressions of recent events.
    observed: AllObserved,
    drawing: OnceLock<Drawing>,
}

/// Names of entries, and their groups: name, index of the first entry, number of entries.
#[derive(Clone, Debug, PartialEq)]
pub struct Names {
    /// Names of all entries, such as `w[2]`.
    pub entries: Vec<String>,
    /// Groups of entries, such as `w`.
    pub groups: Vec<(String, usize, usize)>,
}

/// A method with a system, for single steps.
pub struct Stepped {
    instance: Instance,
    stepper: Stepper,
}

impl Stepped {
    /// Replaces x and ξ by their values after a step of length h.
    ///
    /// # Errors
    /// The reason why the step fails.
    pub fn step(&self, x: &mut [f64], xi: &mut [f64], u: &[f64], h: f64) -> Result<(), String> {
        let mut state = hamel::State::<Instance> {
            t: 0.0,
            x: (&*x).into(),
            xi: (&*xi).into(),
        };
        let held = u.into();
        let inputs = |_, _: &_, _: &_| Clone::clone(&held);
        step(&self.instance, &self.stepper, &mut state, h, &inputs)
            .map_err(|error| self.instance.said(&error))?;
        x.copy_from_slice(&state.x);
        xi.copy_from_slice(&state.xi);
        Ok(())
    }
}

impl Session {
    /// Reads a description or a robot in URDF from a file; returns it with its warnings.
    ///
    /// # Errors
    /// Errors in the file, with its source underlined.
    pub fn open(path: &Path, options: &RobotOptions) -> Result<(Self, String), Failure> {
        let (read, said) = Session::of(|| Source::open(path, options));
        Ok((read?, said.warnings))
    }

    /// Reads a description or a robot in URDF from a text, called `name` in messages; returns it with its warnings.
    ///
    /// # Errors
    /// Errors in the text, with its source underlined.
    pub fn read(
        text: String,
        name: &str,
        options: &RobotOptions,
    ) -> Result<(Self, String), Failure> {
        let (read, said) = Session::marked(text, name, options);
        Ok((read?, said.warnings))
    }

    /// Like [`read`](Self::read), with the places of errors and warnings.
    pub fn marked(
        text: String,
        name: &str,
        options: &RobotOptions,
    ) -> (Result<Self, Failure>, Said) {
        Session::of(|| Source::new(name.into(), text).given(options))
    }

    fn of(source: impl FnOnce() -> Result<Source, Failure>) -> (Result<Self, Failure>, Said) {
        collected(|| {
            let source = source()?.in_numbers();
            let generated = source.derive_available(&[])?;
            Ok(Session {
                source,
                generated,
                linearized: OnceLock::new(),
                mechanism: OnceLock::new(),
                varied: Mutex::default(),
                functions: Mutex::default(),
                observed: AllObserved::default(),
                drawing: OnceLock::new(),
            })
        })
    }

    /// The name of the system.
    pub fn name(&self) -> &str {
        &self.generated.model.name
    }

    /// The text of the description; for a robot, that of the importer.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    fn active(&self) -> &Model {
        &self.generated.active
    }

    /// Names of the entries of x.
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

    /// Names of the entries of ξ, followed by those of the states of first order.
    pub fn velocities(&self) -> Names {
        Names {
            entries: names::moving(self.active()),
            groups: groups(&self.generated.program.moving()),
        }
    }

    /// Names of the entries of u.
    pub fn inputs(&self) -> Names {
        let inputs = &self.active().inputs;
        Names {
            entries: inputs.iter().flat_map(names::group).collect(),
            groups: groups(inputs),
        }
    }

    /// Names of the parameters.
    pub fn parameters(&self) -> Names {
        let params = &self.generated.program.params;
        Names {
            entries: params.iter().flat_map(names::group).collect(),
            groups: groups(params),
        }
    }

    /// Joints, each with the index of its first velocity in ξ and the number of its velocities.
    pub fn joints(&self) -> Vec<(String, usize, usize)> {
        let joints = joints(self.active(), self.source.joints()).into_iter();
        joints
            .map(|joint| (joint.name, joint.velocities.0, joint.velocities.1))
            .collect()
    }

    /// Names of the frames of the description.
    pub fn frames(&self) -> Vec<String> {
        let frames = self.active().frames.iter();
        frames.map(|frame| frame.name.clone()).collect()
    }

    /// Names of the outputs of the description.
    pub fn outputs(&self) -> Vec<String> {
        let outputs = self.active().outputs.iter();
        outputs.map(|(name, _)| name.clone()).collect()
    }

    /// Default parameters, start and zero inputs.
    pub fn start(&self) -> State {
        State::start(self.active())
    }

    /// The start with these parameters, changed by a JSON text, which messages call `name`; see `hamel eval --help` for
    /// its form.
    ///
    /// # Errors
    /// All errors in the text.
    pub fn state(&self, params: &[f64], json: &str, name: &str) -> Result<State, Failure> {
        let start = State {
            params: params.to_vec(),
            ..self.start()
        };
        self.changed(start, json, name)
    }

    /// A state, changed by a JSON text.
    ///
    /// # Errors
    /// All errors in the text.
    pub fn changed(&self, from: State, json: &str, name: &str) -> Result<State, Failure> {
        File::of(name.into(), json, &self.source)?.changes(from, &self.source, &self.generated)
    }

    /// Names of all available functions, including those that are derived on request.
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
    /// If no function has this name, or it does not exist for this system.
    pub fn function(&self, name: &str) -> Result<Function, Failure> {
        let known = || {
            self.functions
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        if let Some(function) = known().get(name) {
            return Ok(function.clone());
        }
        let function = match self.generated.program.function(name) {
            Some(_) => compiled(&self.generated, name)?,
            None => compiled(&self.asked(name)?, name)?,
        };
        known().insert(name.into(), function.clone());
        Ok(function)
    }

    /// Derives a function that is derived only on request.
    fn asked(&self, name: &str) -> Result<Generated, Failure> {
        let mut wanted = Wanted::only(&[]);
        let frames = self.frames();
        let frames = frames.iter().flat_map(|frame| {
            [false, true].map(|own| Jacobian {
                frame: frame.clone(),
                own,
            })
        });
        let id = FunctionId::named(name).filter(|id| id.row().named);
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
                let close =
                    hamel_codegen::syntax::suggest::closest(name, all.iter().map(String::as_str));
                let meant =
                    close.map_or_else(String::new, |close| format!("; did you mean `{close}`?"));
                return Err(Failure::usage(format!(
                    "{} has no function `{name}`{meant}",
                    self.name()
                )));
            }
        }
        self.source.derive_asked(&wanted)
    }

    /// Explains a pivot that is not positive, in the names of the description.
    pub fn meaning(&self, cause: Cause) -> String {
        let shown = self.source.shown();
        singular::meaning(cause, self.active(), shown)
    }

    fn mechanism(&self) -> Result<&Arc<Mechanism>, Failure> {
        if let Some(mechanism) = self.mechanism.get() {
            return Ok(mechanism);
        }
        let made = Mechanism::new(&self.generated, self.source.shown())?;
        Ok(self.mechanism.get_or_init(|| Arc::new(made)))
    }

    fn instance(&self, state: &State) -> Result<Instance, Failure> {
        self.source.moves(&self.generated)?;
        let instance = Instance::of(self.mechanism()?, state)?;
        instance.check_parameters(&state.x)?;
        Ok(instance)
    }

    /// Runs from a state; inputs are those of the state, of `asked`, or of a law. The run may end at an event, or be
    /// cancelled.
    ///
    /// # Errors
    /// If the run is impossible; a run that ends early has its reason in [`Motion::failure`].
    pub fn simulate(
        &self,
        state: &State,
        stepping: &Stepping,
        (every, times): (Option<Every>, Option<Vec<f64>>),
        (asked, law): (&Asked, Option<Law>),
        events: &[Event],
        stop: Option<Stop>,
    ) -> Result<Motion, Failure> {
        stepping.check()?;
        let until = stepping.until;
        let given = match law {
            Some(law) => Some(law.into()),
            None => Inputs::new(asked, until, &self.generated, state)?,
        };
        let observed = self.observed.of(&self.source, events)?;
        let (generated, system) = match &observed {
            None => (&self.generated, self.instance(state)?),
            Some(observed) => (&observed.generated, observed.instance(state)?),
        };
        let system = system.with(given);
        let mut plan = stepping.plan(generated, &system, every)?;
        // All requested samples are kept.
        if let Some(times) = times {
            plan.spacing = Spacing::at(times, until)?;
        }
        plan.stop = stop;
        let events = Events::new(events.to_vec(), &system, added::name);
        let run = Run::watched(generated, &system, plan, events)?;
        Ok(Motion::of(&run, &system))
    }

    /// Prepares single steps of a method, given by its name or `auto`, with the parameters of a state.
    ///
    /// # Errors
    /// If the method does not fit.
    pub fn stepped(&self, state: &State, method: &str) -> Result<Stepped, Failure> {
        let instance = self.instance(state)?;
        let structure = instance.structure(&self.generated.program);
        let mut chosen = Chosen::new(method, &instance, &structure, 1)?;
        if method == AUTO && matches!(chosen.stepper, Stepper::Closed { .. }) {
            // The closed form always moves from the start.
            chosen = Chosen::new("rkmk4", &instance, &structure, 1)?;
        }
        Ok(Stepped {
            instance,
            stepper: chosen.stepper,
        })
    }

    /// The linearisation at a state, of all displacements and velocities if `full`.
    ///
    /// # Errors
    /// If the motion has no value there.
    pub fn linearize(&self, state: &State, full: bool) -> Result<Linear, Failure> {
        linearize::linear(self.linearized()?, state, self.source.shown(), full)
    }

    fn linearized(&self) -> Result<&Generated, Failure> {
        if let Some(generated) = self.linearized.get() {
            return Ok(generated);
        }
        let derived = self.source.derive_linearized()?;
        Ok(self.linearized.get_or_init(|| derived))
    }

    /// Prepares steps with derivatives, with the parameters of a state, by one of the methods for any system.
    ///
    /// # Errors
    /// If there is no linearisation, or the method has no derivatives.
    pub fn varied(&self, state: &State, method: &str) -> Result<(Arc<Varied>, General), Failure> {
        let mut general = General::ALL.iter();
        let in_chart = |method: &&General| !matches!(method, General::Rk4 { .. });
        let found = general.find(|one| one.name() == method).filter(in_chart);
        let Some(found) = found else {
            let names = General::ALL.iter().filter(in_chart).map(|one| one.name());
            return Err(Failure::usage(format!(
                "steps of `{method}` have no slopes here; use {}",
                names.collect::<Vec<_>>().join(", ")
            )));
        };
        let mut known = self.varied.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(varied) = known.as_ref().filter(|one| one.params() == state.params) {
            return Ok((Arc::clone(varied), *found));
        }
        self.instance(state)?;
        let varied = Arc::new(Varied::new(self.linearized()?, &state.params)?);
        *known = Some(Arc::clone(&varied));
        Ok((varied, *found))
    }

    /// The output of `hamel eval` for a state, including γ and Γ; missing values are `null`.
    ///
    /// # Errors
    /// If functions in Rust have no values.
    pub fn evaluate(&self, state: &State) -> Result<String, Failure> {
        let shown = self.source.shown();
        let (value, _) = numbers((&self.generated, shown), state, &[], true)?;
        Ok(value.pretty())
    }

    /// The base parameters.
    ///
    /// # Errors
    /// If the system has none.
    pub fn base_parameters(&self) -> Result<BaseParameters, Failure> {
        base(&self.source)
    }

    /// Tables by name, the most important ones if none is named; with `all`, every entry.
    ///
    /// # Errors
    /// If a table is unknown, or does not exist.
    pub fn tables(&self, of: &[String], format: Format, all: bool) -> Result<String, Failure> {
        let named = of.iter().map(|name| Table::parse(name));
        let named: Result<Vec<Table>, String> = named.collect();
        let tables = named.and_then(|of| self.generated.tables(&of));
        let tables = tables.map_err(Failure::usage)?;
        Ok(crate::tables::written(&tables, format, all))
    }

    /// The drawable parts of the mechanism, compiled for any parameters and states.
    ///
    /// # Errors
    /// If a frame depends on a function in Rust.
    pub fn drawing(&self) -> Result<&Drawing, Failure> {
        if let Some(drawing) = self.drawing.get() {
            return Ok(drawing);
        }
        let made = Drawing::new(&self.generated)?;
        Ok(self.drawing.get_or_init(|| made))
    }

    /// The names of the methods.
    pub fn methods() -> Vec<&'static str> {
        method::names()
    }
}

fn groups(groups: &[hamel_codegen::model::Group]) -> Vec<(String, usize, usize)> {
    let parts = groups.iter();
    parts
        .map(|group| (group.name.clone(), group.offset, group.len))
        .collect()
}
