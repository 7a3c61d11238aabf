//! Runs by whole steps as machine code: step by step, many in one call, or those of two systems side by side.

use super::steps::Code;
use super::{Instance, largest};
use crate::method::Stepper;
use hamel::methods::Method;
use hamel::{Grid, State, StepError, System};
use hamel_native::{Compiled, Constants};
use std::cell::{OnceCell, RefCell};
use std::sync::Arc;

/// Fewer steps of one length are not worth a compilation.
const FEWEST: f64 = 1000.0;

/// Code with the parameters of one system.
struct Ready {
    code: Arc<Code>,
    compiled: Compiled,
    constants: Constants,
    /// Steps with energies at their ends.
    watched: OnceCell<Option<(Compiled, Constants)>>,
}

/// Energies and constraints at the end of a step.
#[derive(Clone, Copy, Debug)]
pub struct Glance {
    /// T.
    pub kinetic: f64,
    /// V.
    pub potential: f64,
    /// The largest |φ|.
    pub constraint: f64,
}

/// A method whose steps are machine code where all of them are of one length and inputs are constant.
pub struct Whole<'a> {
    stepper: &'a Stepper,
    /// The code for steps of the length of the first.
    code: OnceCell<Option<Ready>>,
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

    fn code(&self, system: &Instance, h: f64) -> Option<&Ready> {
        if !self.worthwhile {
            return None;
        }
        let ready = self.code.get_or_init(|| {
            let Stepper::General(method) = self.stepper else {
                return None;
            };
            let code = system.of.step(*method, h);
            let compiled = code.compiled.clone()?;
            let constants = compiled.constants(system.functions.params());
            Some(Ready {
                code,
                compiled,
                constants,
                watched: OnceCell::new(),
            })
        });
        ready.as_ref().filter(|ready| ready.code.h == h)
    }

    /// The code of all steps to a time, and how many there are, where they can be taken at once.
    fn at_once(&self, system: &Instance, from: f64, until: f64) -> Option<(&Ready, u64)> {
        // What a projection moves after a step, or an input that changes, is not in the code.
        let of = &system.of;
        if of.embedded || of.project_position.is_some() || of.project_velocity.is_some() {
            return None;
        }
        let grid = Grid::new(from, until, self.length).ok()?;
        Some((self.code(system, grid.step())?, grid.count()))
    }

    /// Takes all steps to a time at once, where nobody looks at what is between and all of them are machine code; whether
    /// it did. Where one of them fails the state stays as it was, and steps one by one say why.
    pub fn run(&self, system: &Instance, state: &mut State<Instance>, until: f64) -> bool {
        let Some((ready, count)) = self.at_once(system, state.t, until) else {
            return false;
        };
        let u = system.inputs(state.t, &state.x, &state.xi);
        let mut all = [&*state.x, &*state.xi].concat();
        let Ready {
            compiled,
            constants,
            ..
        } = ready;
        if compiled.repeat(0, constants, &mut all, &u, count) < count {
            return false;
        }
        ready.end(system, state, &all, (until, count));
        true
    }

    /// Whether all of the equal steps to a time can be taken by [`glide`](Self::glide).
    pub fn glides(&self, system: &Instance, from: f64, until: f64) -> bool {
        let ready = self.at_once(system, from, until);
        ready.is_some_and(|(ready, _)| ready.watched(system).is_some())
    }

    /// Takes so many steps of a grid from one of its times on, where nobody looks at more than energies and constraints at
    /// their ends; how many there were. The next one, if one is missing, has no end by code.
    pub fn glide(
        &self,
        system: &Instance,
        state: &mut State<Instance>,
        (grid, from, count): (&Grid, u64, u64),
        mut see: impl FnMut(Glance),
    ) -> u64 {
        let ready = self.code(system, grid.step());
        let Some((ready, (compiled, constants))) =
            ready.and_then(|ready| Some((ready, ready.watched(system)?)))
        else {
            return 0;
        };
        let u = system.inputs(state.t, &state.x, &state.xi);
        let mut all = [&*state.x, &*state.xi].concat();
        let done = compiled.repeat_watched(0, constants, (&mut all, &u), count, |more| {
            if let [kinetic, potential, residuals @ ..] = more {
                see(Glance {
                    kinetic: *kinetic,
                    potential: *potential,
                    constraint: largest(residuals),
                });
            }
        });
        if done > 0 {
            ready.end(system, state, &all, (grid.time(from + done), done));
        }
        done
    }

    /// The same for two systems of one mechanism, by code that takes both of their steps at once. Where a step of either
    /// fails, both states stay as they were.
    pub fn run_both(
        of: &[Whole; 2],
        systems: [&Instance; 2],
        states: [&mut State<Instance>; 2],
        until: f64,
    ) -> bool {
        let at_once = |lane: usize| of[lane].at_once(systems[lane], states[lane].t, until);
        let (Some((first, count)), Some((second, others))) = (at_once(0), at_once(1)) else {
            return false;
        };
        if count != others || !Arc::ptr_eq(&first.code, &second.code) {
            return false;
        }
        let Some(paired) = first.code.paired() else {
            return false;
        };
        let constants = paired.constants([&first.constants, &second.constants]);
        let u = [0, 1].map(|lane| {
            let state = &states[lane];
            systems[lane].inputs(state.t, &state.x, &state.xi)
        });
        let [mut one, mut other] =
            [0, 1].map(|lane| [&*states[lane].x, &*states[lane].xi].concat());
        let both = [one.as_mut_slice(), other.as_mut_slice()];
        if paired.repeat(0, &constants, both, [&u[0], &u[1]], count) < count {
            return false;
        }
        let [state, another] = states;
        first.end(systems[0], state, &one, (until, count));
        second.end(systems[1], another, &other, (until, count));
        true
    }
}

impl Ready {
    fn watched(&self, system: &Instance) -> Option<&(Compiled, Constants)> {
        let make = || {
            let compiled = system.of.watched(&self.code)?.clone();
            let constants = compiled.constants(system.functions.params());
            Some((compiled, constants))
        };
        self.watched.get_or_init(make).as_ref()
    }

    /// Where a state is after so many steps.
    fn end(
        &self,
        system: &Instance,
        state: &mut State<Instance>,
        all: &[f64],
        (until, count): (f64, u64),
    ) {
        let evaluated = system.evaluations.get() + self.code.evaluations * count;
        system.evaluations.set(evaluated);
        let (x, xi) = all.split_at(state.x.len());
        *state = State {
            t: until,
            x: x.into(),
            xi: xi.into(),
        };
    }
}

impl Method<Instance> for Whole<'_> {
    fn order(&self) -> u32 {
        Method::<Instance>::order(self.stepper)
    }

    fn stays_near(&self) -> bool {
        Method::<Instance>::stays_near(self.stepper)
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
        if let Some(Ready {
            code,
            compiled,
            constants,
            ..
        }) = self.code(system, h)
        {
            let u = inputs(state.t, &state.x, &state.xi);
            let arguments: [&[f64]; 5] = [&state.x, &state.xi, &u, &[], &[]];
            let mut end = self.end.borrow_mut();
            end.resize(state.x.len() + state.xi.len(), f64::NAN);
            let ended = compiled.call(0, constants, arguments, &mut end);
            // Where it has no end, the method says why.
            if ended.is_ok() && end.iter().all(|number| number.is_finite()) {
                let evaluated = system.evaluations.get() + code.evaluations;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::{Mechanism, Numbers};
    use crate::robot::RobotOptions;
    use crate::source::Source;
    use crate::state::State as Start;
    use hamel::methods::General;
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

    fn bits(state: &State<Instance>) -> Vec<u64> {
        let all = state.x.iter().chain(&*state.xi);
        all.map(|number| number.to_bits()).collect()
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
            assert_eq!(bits(&fast), bits(&slow), "{model}");
            assert_eq!(fast.t, slow.t);

            fast.xi.as_mut().fill(f64::MAX);
            let before = fast.clone();
            assert!(!whole.run(&system, &mut fast, 2.0 * until), "{model}");
            assert_eq!((bits(&fast), fast.t), (bits(&before), before.t), "{model}");
        }
    }

    /// Two systems side by side end, to the bit, where each of them ends alone; where one has no end neither has moved.
    #[test]
    fn two_at_once_are_each_alone() {
        let models = [
            "heavy_top.eom",
            "kapitza.eom",
            "lagging_drone.eom",
            "heavy_top_quaternion.eom",
            "rolling_disk.eom",
            "double_pendulum_angles.eom",
        ];
        let until = 1100.0 * H;
        for model in models {
            let first = instance(model);
            let mut other = Start {
                params: first.functions.params().to_vec(),
                x: first.start.0.to_vec(),
                xi: first.start.1.to_vec(),
                u: first.inputs.to_vec(),
            };
            other.params[0] *= 1.25;
            for u in &mut other.u {
                *u += 0.01;
            }
            let second = Instance::of(&first.of, &other).expect("an instance");
            let systems = [&first, &second];
            for method in METHODS {
                let stepper = Stepper::General(method);
                let wholes = systems.map(|system| Whole::new(system, &stepper, H, until));
                let starts = systems.map(State::<Instance>::start);
                let [mut one, mut two] = starts.clone();
                let both = [&mut one, &mut two];
                assert!(
                    Whole::run_both(&wholes, systems, both, until),
                    "{model} {method:?}"
                );
                for ((system, mut alone), found) in
                    systems.into_iter().zip(starts.clone()).zip([&one, &two])
                {
                    let whole = Whole::new(system, &stepper, H, until);
                    let evaluations = system.evaluations();
                    assert!(whole.run(system, &mut alone, until));
                    assert_eq!(system.evaluations(), 2 * evaluations);
                    assert_eq!(bits(&alone), bits(found), "{model} {method:?}");
                    assert_eq!(alone.t, found.t);
                    system.evaluations.set(0);
                }
                assert_ne!(bits(&one), bits(&two), "{model} {method:?}");
                for broken in 0..2 {
                    let mut states = starts.clone();
                    states[broken].xi.as_mut().fill(f64::MAX);
                    let before = states.clone();
                    let [one, two] = &mut states;
                    assert!(!Whole::run_both(&wholes, systems, [one, two], until));
                    for (before, after) in before.iter().zip(&states) {
                        assert_eq!((bits(before), before.t), (bits(after), after.t));
                    }
                }
            }
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
