//! Whole steps as machine code: a method is run once on numbers that write down what it does with them.

use super::taped::{Places, Taped, Tapes};
use super::{Instance, Mechanism};
use crate::method::Stepper;
use hamel::methods::{General, Method};
use hamel::{Grid, State, StepError, System};
use hamel_codegen::program::tape::{Source, Tape};
use hamel_codegen::program::{Argument, Cause};
use hamel_native::{Compiled, Constants, Traced, inlined, traced};
use std::cell::{Cell, OnceCell, RefCell};
use std::sync::{Mutex, PoisonError};

/// Steps of so many statements and more are not worth a compilation.
const MOST: usize = 20_000;
/// Nor are fewer steps of one length.
const FEWEST: f64 = 1000.0;
/// Lengths of steps that are kept.
const KEPT: usize = 64;

/// A method's step of one length as machine code; none where there can be none.
#[derive(Clone)]
pub struct Code {
    method: String,
    h: f64,
    compiled: Option<Compiled>,
    /// How often ξ̇ is evaluated in it.
    evaluations: u64,
}

/// A method whose steps are machine code where all of them are of one length and inputs are constant.
pub struct Whole<'a> {
    stepper: &'a Stepper,
    /// The code for steps of the length of the first.
    code: OnceCell<Option<(Compiled, Constants, f64, u64)>>,
    /// Room for x and ξ at its end.
    end: RefCell<Vec<f64>>,
    worthwhile: bool,
    length: f64,
}

impl<'a> Whole<'a> {
    /// A method for steps of this length over a time.
    pub fn new(system: &Instance, stepper: &'a Stepper, length: f64, time: f64) -> Self {
        Whole {
            stepper,
            code: OnceCell::new(),
            end: RefCell::default(),
            worthwhile: time / length >= FEWEST && system.given.is_none(),
            length,
        }
    }

    fn code(&self, system: &Instance, h: f64) -> Option<&(Compiled, Constants, f64, u64)> {
        if !self.worthwhile {
            return None;
        }
        let code = self.code.get_or_init(|| {
            let Stepper::General(method) = self.stepper else {
                return None;
            };
            let code = system.of.step(method, h);
            let compiled = code.compiled?;
            let constants = compiled.constants(system.functions.params());
            Some((compiled, constants, h, code.evaluations))
        });
        code.as_ref().filter(|(_, _, length, _)| *length == h)
    }

    /// Takes all steps to a time at once, where nobody looks at what is between and all of them are machine code; whether
    /// it did. Where one of them fails the state stays as it was, and steps one by one say why.
    pub fn run(&self, system: &Instance, state: &mut State<Instance>, until: f64) -> bool {
        // What a projection moves after a step, or an input that changes, is not in the code.
        if system.of.project_position.is_some() || system.of.project_velocity.is_some() {
            return false;
        }
        let Ok(grid) = Grid::new(state.t, until, self.length) else {
            return false;
        };
        let Some((compiled, constants, _, evaluations)) = self.code(system, grid.step()) else {
            return false;
        };
        let u = system.inputs(state.t, &state.x, &state.xi);
        let mut all = [&*state.x, &*state.xi].concat();
        if compiled.repeat(0, constants, &mut all, &u, grid.count()) < grid.count() {
            return false;
        }
        let evaluated = system.evaluations.get() + evaluations * grid.count();
        system.evaluations.set(evaluated);
        let (x, xi) = all.split_at(state.x.len());
        *state = State {
            t: until,
            x: x.into(),
            xi: xi.into(),
        };
        true
    }
}

impl Method<Instance> for Whole<'_> {
    fn order(&self) -> u32 {
        Method::<Instance>::order(self.stepper)
    }

    fn step<U>(
        &self,
        system: &Instance,
        state: &State<Instance>,
        h: f64,
        inputs: &U,
    ) -> Result<State<Instance>, StepError>
    where
        U: Fn(
            f64,
            &<Instance as System>::Coordinates,
            &<Instance as System>::Velocities,
        ) -> <Instance as System>::Inputs,
    {
        self.follow(system, state, h, inputs, &mut None)
    }

    fn follow<U>(
        &self,
        system: &Instance,
        state: &State<Instance>,
        h: f64,
        inputs: &U,
        force: &mut Option<<Instance as System>::Chart>,
    ) -> Result<State<Instance>, StepError>
    where
        U: Fn(
            f64,
            &<Instance as System>::Coordinates,
            &<Instance as System>::Velocities,
        ) -> <Instance as System>::Inputs,
    {
        if let Some((compiled, constants, _, evaluations)) = self.code(system, h) {
            let u = inputs(state.t, &state.x, &state.xi);
            let arguments: [&[f64]; 5] = [&state.x, &state.xi, &u, &[], &[]];
            let mut end = self.end.borrow_mut();
            end.resize(state.x.len() + state.xi.len(), f64::NAN);
            let ended = compiled.call(0, constants, arguments, &mut end);
            // Where it has no end, the method says why.
            if ended.is_ok() && end.iter().all(|number| number.is_finite()) {
                let evaluated = system.evaluations.get() + evaluations;
                system.evaluations.set(evaluated);
                let (x, xi) = end.split_at(state.x.len());
                return Ok(State {
                    t: state.t + h,
                    x: x.into(),
                    xi: xi.into(),
                });
            }
        }
        self.stepper.follow(system, state, h, inputs, force)
    }
}

impl Mechanism {
    /// A step of a method as machine code, made when it is first asked for.
    fn step(&self, method: &General, h: f64) -> Code {
        let name = format!("{method:?}");
        let mut known = self.steps.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |code: &&Code| code.method == name && code.h == h;
        if let Some(code) = known.iter().find(same) {
            return code.clone();
        }
        let tape = self.tape(method, h);
        let code = Code {
            method: name,
            h,
            evaluations: tape.as_ref().map_or(0, |(_, evaluations)| *evaluations),
            compiled: tape.and_then(|(tape, _)| {
                let tapes = hamel_native::Tapes {
                    functions: vec![tape],
                    ..self.compiled.tapes().clone()
                };
                let compiled = Compiled::of(tapes);
                // Step by step the method itself is as fast.
                compiled.interpreted_because().is_none().then_some(compiled)
            }),
        };
        if known.len() >= KEPT {
            known.clear();
        }
        known.push(code.clone());
        code
    }

    /// What a step does, and how often it evaluates ξ̇.
    fn tape(&self, method: &General, h: f64) -> Option<(Tape, u64)> {
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
                kinetic: self.kinetic.index(),
                potential: self.potential.index(),
                // A step of a method projects nothing: that is done behind it.
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
            Ok(end) => [end.x, end.xi].concat(),
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
pub type Steps = Mutex<Vec<Code>>;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::Numbers;
    use crate::robot::RobotOptions;
    use crate::source::Source;
    use crate::state::State as Start;
    use std::path::Path;
    use std::sync::Arc;

    const METHODS: [General; 6] = [
        General::Rkmk4,
        General::Cf4,
        General::Rkmk54,
        General::Rkmk8,
        General::SemiImplicitEuler,
        General::Rk4 { lambda: 3.0 },
    ];
    const H: f64 = 1e-2;

    fn instance(model: &str) -> Instance {
        let path = Path::new("../tests/models").join(model);
        let source = Source::open(&path, &RobotOptions::default()).expect("a description");
        let generated = source.derive_all().expect("derived");
        let mechanism = Mechanism::new(&generated, &source.text).expect("compiled");
        let start = Start::start(&generated.active);
        Instance::of(&Arc::new(mechanism), &start).expect("an instance")
    }

    fn end(
        system: &Instance,
        method: &impl Method<Instance>,
        state: &State<Instance>,
    ) -> State<Instance> {
        let u = system.inputs(state.t, &state.x, &state.xi);
        let held = |_, _: &Numbers, _: &Numbers| u.clone();
        let end = method.step(system, state, H, &held);
        end.expect("a step")
    }

    /// Code that is made of a method has its numbers: to the bit, but where a sine is rounded otherwise.
    #[test]
    fn steps_as_code_are_those_of_the_method() {
        let models = [
            "heavy_top.eom",
            "free_body.eom",
            "double_pendulum_angles.eom",
            "double_pendulum_circles.eom",
            "heavy_top_quaternion.eom",
            "rolling_disk.eom",
            "kapitza.eom",
            "four_bar_loop.eom",
            "lagging_drone.eom",
        ];
        for model in models {
            let system = instance(model);
            for method in METHODS {
                let stepper = Stepper::General(method);
                let whole = Whole::new(&system, &stepper, H, 1e3);
                let mut state = State::<Instance>::start(&system);
                for _ in 0..20 {
                    let before = system.evaluations();
                    let slow = end(&system, &stepper, &state);
                    let between = system.evaluations();
                    let fast = end(&system, &whole, &state);
                    assert_eq!(system.evaluations() - between, between - before);
                    let pairs = fast.x.iter().chain(&*fast.xi);
                    let pairs = pairs.zip(slow.x.iter().chain(&*slow.xi));
                    for (a, b) in pairs {
                        let off = (a - b).abs() / b.abs().max(1.0);
                        assert!(off < 1e-14, "{model} {method:?}: {a} {b}");
                    }
                    assert_eq!(fast.t, slow.t);
                    state = slow;
                }
                let code = whole.code.get().and_then(Option::as_ref);
                assert!(code.is_some(), "{model} {method:?} is no code");
            }
        }
    }

    /// What has no end is told by the method: the code ends where a pivot is not positive.
    #[test]
    fn steps_without_an_end_say_why() {
        let system = instance("heavy_top.eom");
        let stepper = Stepper::General(General::Rkmk4);
        let whole = Whole::new(&system, &stepper, H, 1e3);
        let mut state = State::<Instance>::start(&system);
        // Turned so far in one step that series do not hold, and faster than any number.
        for speed in [1e4, f64::MAX] {
            state.xi.as_mut().fill(speed);
            let held = |_, _: &Numbers, _: &Numbers| Numbers::filled(0.0, 0);
            let slow = stepper.step(&system, &state, H, &held);
            let fast = whole.step(&system, &state, H, &held);
            assert_eq!(format!("{slow:?}"), format!("{fast:?}"));
        }
    }

    /// All steps in one call are the steps one by one, to the bit; where one has no end nothing has moved.
    #[test]
    fn steps_at_once_are_the_steps() {
        let models = ["heavy_top.eom", "kapitza.eom", "lagging_drone.eom"];
        for model in models {
            let system = instance(model);
            let stepper = Stepper::General(General::Rkmk4);
            let until = 1234.0 * H;
            let whole = Whole::new(&system, &stepper, H, until);
            let mut fast = State::<Instance>::start(&system);
            let mut slow = fast.clone();
            let held = |t: f64, x: &Numbers, xi: &Numbers| system.inputs(t, x, xi);
            hamel::integrate(&system, &whole, &mut slow, H, until, held, |_| ()).expect("a run");
            let between = system.evaluations();
            assert!(whole.run(&system, &mut fast, until), "{model}");
            assert_eq!(system.evaluations(), 2 * between, "{model}");
            let bits = |state: &State<Instance>| -> Vec<u64> {
                let all = state.x.iter().chain(&*state.xi);
                all.map(|number| number.to_bits()).collect()
            };
            assert_eq!(bits(&fast), bits(&slow), "{model}");
            assert_eq!(fast.t, slow.t);

            fast.xi.as_mut().fill(f64::MAX);
            let before = fast.clone();
            assert!(!whole.run(&system, &mut fast, 2.0 * until), "{model}");
            assert_eq!((bits(&fast), fast.t), (bits(&before), before.t), "{model}");
        }
    }

    /// What is projected after every step is not run at once.
    #[test]
    fn loops_are_stepped_one_by_one() {
        let system = instance("four_bar_loop.eom");
        let stepper = Stepper::General(General::Rkmk4);
        let whole = Whole::new(&system, &stepper, H, 1e3);
        let mut state = State::<Instance>::start(&system);
        assert!(!whole.run(&system, &mut state, 20.0));
        assert_eq!(state.t, 0.0);
    }

    /// Iterations are no tapes, and few steps are not worth one.
    #[test]
    fn what_is_no_code() {
        let system = instance("heavy_top.eom");
        let state = State::<Instance>::start(&system);
        let implicit = Stepper::General(General::BackwardEuler);
        let few = Stepper::General(General::Rkmk4);
        for (stepper, time) in [(implicit, 1e3), (few, 1.0)] {
            let whole = Whole::new(&system, &stepper, H, time);
            end(&system, &whole, &state);
            assert!(whole.code.get().and_then(Option::as_ref).is_none());
        }
    }
}
