//! Compiles whole steps of methods to machine code: the method runs once on numbers that record its operations.

use super::Mechanism;
use super::tape_system::{TapeEvaluator, TapeIndices, TapeSystem};
use hamel::State;
use hamel::methods::{General, Method};
use hamel_codegen::program::tape::{Source, Tape};
use hamel_codegen::program::{Argument, Cause};
use hamel_native::{Compiled, Paired, Traced, inlined, traced};
use std::cell::Cell;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Largest number of statements of a step; longer steps are not worth compiling.
const MAX_STATEMENTS: usize = 20_000;
/// Largest number of compiled steps that a mechanism keeps.
const MAX_CACHED_STEPS: usize = 64;

/// A step of a method with a fixed length, as machine code.
pub struct StepCode {
    method: General,
    /// The length of the step.
    pub h: f64,
    /// `None` if it cannot be compiled.
    pub compiled: Option<Compiled>,
    /// The step for two states at once, compiled on first use.
    paired: OnceLock<Option<Paired>>,
    /// The step followed by T, V and the entries of φ at its end, compiled on first use.
    with_energies: OnceLock<Option<Compiled>>,
    /// Number of evaluations of ξ̇ in the step.
    pub evaluations: u64,
}

impl StepCode {
    /// Returns the step for two states at once, if the single step was compiled.
    pub fn paired(&self) -> Option<&Paired> {
        let make = || self.compiled.as_ref().and_then(Paired::new);
        self.paired.get_or_init(make).as_ref()
    }
}

impl Mechanism {
    /// Returns a step of a method as machine code, compiled on first use.
    pub fn compiled_step(&self, method: General, h: f64) -> Arc<StepCode> {
        let mut known = self.steps.0.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |code: &&Arc<StepCode>| code.method == method && code.h == h;
        if let Some(code) = known.iter().find(same) {
            return Arc::clone(code);
        }
        let tape = self.record(&method, h, false);
        let code = Arc::new(StepCode {
            method,
            h,
            paired: OnceLock::new(),
            with_energies: OnceLock::new(),
            evaluations: tape.as_ref().map_or(0, |(_, evaluations)| *evaluations),
            compiled: tape.and_then(|(tape, _)| self.compile(tape)),
        });
        if known.len() >= MAX_CACHED_STEPS {
            known.clear();
        }
        known.push(Arc::clone(&code));
        code
    }

    /// Returns the step with T, V and the entries of φ appended to the state at its end.
    pub fn compiled_step_with_energies<'c>(&self, code: &'c StepCode) -> Option<&'c Compiled> {
        let make = || {
            let (tape, _) = self.record(&code.method, code.h, true)?;
            self.compile(tape)
        };
        code.with_energies.get_or_init(make).as_ref()
    }

    /// Compiles a tape to machine code.
    fn compile(&self, tape: Tape) -> Option<Compiled> {
        let tapes = hamel_native::Tapes {
            functions: vec![tape],
            ..self.compiled.tapes().clone()
        };
        let compiled = Compiled::of(tapes);
        // The interpreted step is no faster than the method itself.
        compiled.interpreted_because().is_none().then_some(compiled)
    }

    /// Records a step, and counts its evaluations of ξ̇. If the description declares a time, its value at the end is an
    /// argument, in place of accelerations, so that a run does not accumulate the lengths of steps. With
    /// `with_energies`, T, V and φ at the end are appended.
    fn record(&self, method: &General, h: f64, with_energies: bool) -> Option<(Tape, u64)> {
        // Only machine code is of use here, which some builds do not have.
        if cfg!(not(feature = "machine")) {
            return None;
        }
        let explicit = matches!(
            method,
            General::Rkmk4
                | General::Cf4
                | General::Rkmk54
                | General::Rkmk8
                | General::SemiImplicitEuler
                | General::Rk4 { .. }
        );
        let accel = self.accel.filter(|_| explicit)?;
        let tapes = self.compiled.tapes();
        // Check the size before recording: a step has a few evaluations.
        if tapes.functions.get(accel.index())?.steps.len() > MAX_STATEMENTS {
            return None;
        }
        let [x, xi, u, ..] = tapes.lengths;
        let entries = |argument: Argument, count: usize| -> Vec<Traced> {
            let entries = (0..count).map(|index| Source::Argument(argument, index));
            entries.map(Traced::argument).collect()
        };
        let recording = TapeSystem(RecordingMechanism {
            of: self,
            indices: TapeIndices {
                blocks: self.blocks.clone(),
                chart: self.chart,
                lengths: [x, xi, u],
                rate: self.rate.index(),
                chart_rate: self.chart_rate.index(),
                accel: accel.index(),
                correction: self.correction.index(),
                constraint: self.constraint.index(),
                kinetic: self.kinetic?.index(),
                potential: self.potential.index(),
                // A step of a method does not project: projections follow it.
                embedded: false,
                project_position: None,
                project_velocity: None,
            },
            evaluations: Cell::new(0),
        });
        let state = State::<TapeSystem<RecordingMechanism>> {
            t: 0.0,
            x: entries(Argument::Coordinates, x),
            xi: entries(Argument::Velocities, xi),
        };
        let held = entries(Argument::Inputs, u);
        let inputs = |_, _: &Vec<Traced>, _: &Vec<Traced>| held.clone();
        let mut failed = false;
        let tape = traced("step", || {
            match method.step(&recording, &state, h, &inputs) {
                Ok(mut end) => {
                    if let Some(time) = self.clock.and_then(|place| end.x.get_mut(place)) {
                        *time = Traced::argument(Source::Argument(Argument::Accelerations, 0));
                    }
                    let mut all = [&end.x[..], &end.xi].concat();
                    if with_energies {
                        let TapeIndices {
                            kinetic,
                            potential,
                            constraint,
                            ..
                        } = recording.0.indices;
                        for function in [kinetic, potential, constraint] {
                            let value = recording.0.call(function, [&end.x, &end.xi, &[]]);
                            all.extend(value.unwrap_or_default());
                        }
                    }
                    all
                }
                Err(_) => {
                    failed = true;
                    Vec::new()
                }
            }
        });
        let tape = tape.filter(|tape| !failed && tape.steps.len() <= MAX_STATEMENTS)?;
        Some((tape, recording.0.evaluations.get()))
    }
}

/// Mechanism over numbers that record the operations on them.
struct RecordingMechanism<'a> {
    of: &'a Mechanism,
    indices: TapeIndices,
    evaluations: Cell<u64>,
}

impl TapeEvaluator for RecordingMechanism<'_> {
    type Number = Traced;

    fn indices(&self) -> &TapeIndices {
        &self.indices
    }

    fn call(&self, function: usize, [x, xi, u]: [&[Traced]; 3]) -> Result<Vec<Traced>, Cause> {
        if function == self.indices.accel {
            self.evaluations.set(self.evaluations.get() + 1);
        }
        let tape = self.of.compiled.tapes().functions.get(function);
        Ok(tape.map_or_else(Vec::new, |tape| inlined(tape, [x, xi, u, &[], &[]])))
    }
}

/// Cache of the compiled steps of a mechanism.
#[derive(Default)]
pub struct StepCache(Mutex<Vec<Arc<StepCode>>>);
