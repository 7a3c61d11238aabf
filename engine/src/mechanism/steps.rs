//! Steps of methods as machine code: the method runs once on numbers that record its operations.

use super::Mechanism;
use super::taped::{Places, Taped, Tapes};
use hamel::State;
use hamel::methods::{General, Method};
use hamel_codegen::program::tape::{Source, Tape};
use hamel_codegen::program::{Argument, Cause};
use hamel_native::{Compiled, Paired, Traced, inlined, traced};
use std::cell::Cell;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Number of statements from which a step is not worth compiling.
const MOST: usize = 20_000;
/// Number of compiled steps that are kept.
const KEPT: usize = 64;

/// A step of a method with a fixed length, as machine code.
pub struct Code {
    method: General,
    /// The length of the step.
    pub h: f64,
    /// `None` if it cannot be compiled.
    pub compiled: Option<Compiled>,
    /// The step for two states at once, compiled on first use.
    paired: OnceLock<Option<Paired>>,
    /// The step followed by T, V and the entries of φ at its end, compiled on first use.
    watched: OnceLock<Option<Compiled>>,
    /// Number of evaluations of ξ̇ in the step.
    pub evaluations: u64,
}

impl Code {
    /// The step for two states at once, if the single step was compiled.
    pub fn paired(&self) -> Option<&Paired> {
        let make = || self.compiled.as_ref().and_then(Paired::new);
        self.paired.get_or_init(make).as_ref()
    }
}

impl Mechanism {
    /// A step of a method as machine code, compiled on first use.
    pub fn step(&self, method: General, h: f64) -> Arc<Code> {
        let mut known = self.steps.0.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |code: &&Arc<Code>| code.method == method && code.h == h;
        if let Some(code) = known.iter().find(same) {
            return Arc::clone(code);
        }
        let tape = self.tape(&method, h, false);
        let code = Arc::new(Code {
            method,
            h,
            paired: OnceLock::new(),
            watched: OnceLock::new(),
            evaluations: tape.as_ref().map_or(0, |(_, evaluations)| *evaluations),
            compiled: tape.and_then(|(tape, _)| self.alone(tape)),
        });
        if known.len() >= KEPT {
            known.clear();
        }
        known.push(Arc::clone(&code));
        code
    }

    /// The step with T, V and the entries of φ appended to the state at its end.
    pub fn watched<'c>(&self, code: &'c Code) -> Option<&'c Compiled> {
        let make = || {
            let (tape, _) = self.tape(&code.method, code.h, true)?;
            self.alone(tape)
        };
        code.watched.get_or_init(make).as_ref()
    }

    /// Compiles a tape to machine code.
    fn alone(&self, tape: Tape) -> Option<Compiled> {
        let tapes = hamel_native::Tapes {
            functions: vec![tape],
            ..self.compiled.tapes().clone()
        };
        let compiled = Compiled::of(tapes);
        // The interpreted step is no faster than the method itself.
        compiled.interpreted_because().is_none().then_some(compiled)
    }

    /// Records a step, and counts its evaluations of ξ̇. If the description declares a time, its value at the end is an
    /// argument, in place of accelerations, so that a run does not accumulate the lengths of steps. With `watched`, T,
    /// V and φ at the end are appended.
    fn tape(&self, method: &General, h: f64, watched: bool) -> Option<(Tape, u64)> {
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
        if tapes.functions.get(accel.index())?.steps.len() > MOST {
            return None;
        }
        let [x, xi, u, ..] = tapes.lengths;
        let entries = |argument: Argument, count: usize| -> Vec<Traced> {
            let entries = (0..count).map(|index| Source::Argument(argument, index));
            entries.map(Traced::argument).collect()
        };
        let written = Taped(Written {
            of: self,
            places: Places {
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
        let state = State::<Taped<Written>> {
            t: 0.0,
            x: entries(Argument::Coordinates, x),
            xi: entries(Argument::Velocities, xi),
        };
        let held = entries(Argument::Inputs, u);
        let inputs = |_, _: &Vec<Traced>, _: &Vec<Traced>| held.clone();
        let mut failed = false;
        let tape = traced("step", || match method.step(&written, &state, h, &inputs) {
            Ok(mut end) => {
                if let Some(time) = self.clock.and_then(|place| end.x.get_mut(place)) {
                    *time = Traced::argument(Source::Argument(Argument::Accelerations, 0));
                }
                let mut all = [&end.x[..], &end.xi].concat();
                if watched {
                    let Places {
                        kinetic,
                        potential,
                        constraint,
                        ..
                    } = written.0.places;
                    for function in [kinetic, potential, constraint] {
                        let value = written.0.call(function, [&end.x, &end.xi, &[]]);
                        all.extend(value.unwrap_or_default());
                    }
                }
                all
            }
            Err(_) => {
                failed = true;
                Vec::new()
            }
        });
        let tape = tape.filter(|tape| !failed && tape.steps.len() <= MOST)?;
        Some((tape, written.0.evaluations.get()))
    }
}

/// A mechanism whose numbers record the operations on them.
struct Written<'a> {
    of: &'a Mechanism,
    places: Places,
    evaluations: Cell<u64>,
}

impl Tapes for Written<'_> {
    type Number = Traced;

    fn places(&self) -> &Places {
        &self.places
    }

    fn call(&self, function: usize, [x, xi, u]: [&[Traced]; 3]) -> Result<Vec<Traced>, Cause> {
        if function == self.places.accel {
            self.evaluations.set(self.evaluations.get() + 1);
        }
        let tape = self.of.compiled.tapes().functions.get(function);
        Ok(tape.map_or_else(Vec::new, |tape| inlined(tape, [x, xi, u, &[], &[]])))
    }
}

/// The compiled steps of a mechanism.
#[derive(Default)]
pub struct Steps(Mutex<Vec<Arc<Code>>>);
