//! A step of a method as machine code: the method is run once on numbers that write down what it does with them.

use super::Mechanism;
use super::taped::{Places, Taped, Tapes};
use hamel::State;
use hamel::methods::{General, Method};
use hamel_codegen::program::tape::{Source, Tape};
use hamel_codegen::program::{Argument, Cause};
use hamel_native::{Compiled, Paired, Traced, inlined, traced};
use std::cell::Cell;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Steps of so many statements and more are not worth a compilation.
const MOST: usize = 20_000;
/// Lengths of steps that are kept.
const KEPT: usize = 64;

/// A method's step of one length as machine code.
pub struct Code {
    method: General,
    /// The length of the step.
    pub h: f64,
    /// None where there can be none.
    pub compiled: Option<Compiled>,
    /// The same for two states at once, made when it is first asked for.
    paired: OnceLock<Option<Paired>>,
    /// The same with T, V and the entries of φ at its end, made when it is first asked for.
    watched: OnceLock<Option<Compiled>>,
    /// How often ξ̇ is evaluated in it.
    pub evaluations: u64,
}

impl Code {
    /// The same for two states at once, where there is code for one.
    pub fn paired(&self) -> Option<&Paired> {
        let make = || self.compiled.as_ref().and_then(Paired::new);
        self.paired.get_or_init(make).as_ref()
    }
}

impl Mechanism {
    /// A step of a method as machine code, made when it is first asked for.
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

    /// Such a step with T, V and the entries of φ behind the state at its end.
    pub fn watched<'c>(&self, code: &'c Code) -> Option<&'c Compiled> {
        let make = || {
            let (tape, _) = self.tape(&code.method, code.h, true)?;
            self.alone(tape)
        };
        code.watched.get_or_init(make).as_ref()
    }

    /// A tape as machine code.
    fn alone(&self, tape: Tape) -> Option<Compiled> {
        let tapes = hamel_native::Tapes {
            functions: vec![tape],
            ..self.compiled.tapes().clone()
        };
        let compiled = Compiled::of(tapes);
        // Step by step the method itself is as fast.
        compiled.interpreted_because().is_none().then_some(compiled)
    }

    /// What a step does, and how often it evaluates ξ̇. Where the description declares a time, its value at the end is given,
    /// in the place of accelerations, so that a run does not add up the lengths of steps. With T, V and φ at its end where it is
    /// `watched`.
    fn tape(&self, method: &General, h: f64, watched: bool) -> Option<(Tape, u64)> {
        // What follows is for machine code alone, which some builds never have.
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
        // Before it is written: a step has a few evaluations.
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
                // A step of a method projects nothing: that is done behind it.
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

/// A mechanism whose numbers write down what is done with them.
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

/// Steps that were made of a mechanism.
#[derive(Default)]
pub struct Steps(Mutex<Vec<Arc<Code>>>);
