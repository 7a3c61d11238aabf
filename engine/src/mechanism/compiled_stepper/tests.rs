//! Compares steps as machine code with the method, one by one and at once.

use super::*;
use crate::mechanism::{Mechanism, Numbers};
use crate::reporter::Quiet;
use crate::source::{OpenOptions, Source};
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

/// Every second method, alternating over a list of models; all of them with `HAMEL_ATTACK`.
fn some(place: usize) -> impl Iterator<Item = General> {
    let all = std::env::var_os("HAMEL_ATTACK").is_some();
    let methods = METHODS.into_iter().enumerate();
    let wanted = methods.filter(move |(method, _)| all || (method + place).is_multiple_of(2));
    wanted.map(|(_, method)| method)
}

fn instance(model: &str) -> Instance {
    let path = Path::new("../tests/models").join(model);
    let source = Source::open(&path, &OpenOptions::default(), Arc::new(Quiet));
    let source = source.expect("a description");
    let generated = source.derive_default_functions().expect("derived");
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

/// Compiled steps give the numbers of the method: bitwise, except where a sine is rounded differently.
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
    for (place, model) in models.into_iter().enumerate() {
        let system = instance(model);
        for method in some(place) {
            let stepper = Stepper::General(method);
            let compiled = CompiledStepper::new(&system, &stepper, H, 1e3);
            let mut state = State::<Instance>::start(&system);
            for _ in 0..20 {
                let before = system.evaluations();
                let slow = end(&system, &stepper, &state);
                let between = system.evaluations();
                let fast = end(&system, &compiled, &state);
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
            let code = compiled.code.get().and_then(Option::as_ref);
            assert!(code.is_some(), "{model} {method:?} is no code");
        }
    }
}

/// The method reports steps without an end: the code stops at a pivot that is not positive.
#[test]
fn steps_without_an_end_say_why() {
    let system = instance("heavy_top.eom");
    let stepper = Stepper::General(General::Rkmk4);
    let compiled = CompiledStepper::new(&system, &stepper, H, 1e3);
    let mut state = State::<Instance>::start(&system);
    // A rotation too large for the series in one step, and a speed that overflows.
    for speed in [1e4, f64::MAX] {
        state.xi.as_mut().fill(speed);
        let held = |_, _: &Numbers, _: &Numbers| Numbers::filled(0.0, 0);
        let slow = stepper.step(&system, &state, H, &held);
        let fast = compiled.step(&system, &state, H, &held);
        assert_eq!(format!("{slow:?}"), format!("{fast:?}"));
    }
}

fn bits(state: &State<Instance>) -> Vec<u64> {
    let all = state.x.iter().chain(&*state.xi);
    all.map(|number| number.to_bits()).collect()
}

/// All steps in one call equal single steps bitwise; if one has no end the state is unchanged.
#[test]
fn steps_at_once_are_the_steps() {
    let models = ["heavy_top.eom", "kapitza.eom", "lagging_drone.eom"];
    for model in models {
        let system = instance(model);
        let stepper = Stepper::General(General::Rkmk4);
        let until = 1234.0 * H;
        let compiled = CompiledStepper::new(&system, &stepper, H, until);
        let mut fast = State::<Instance>::start(&system);
        let mut slow = fast.clone();
        let held = |t: f64, x: &Numbers, xi: &Numbers| system.inputs(t, x, xi);
        hamel::integrate(&system, &compiled, &mut slow, H, until, held, |_| ()).expect("a run");
        let between = system.evaluations();
        assert!(compiled.run(&system, &mut fast, until), "{model}");
        assert_eq!(system.evaluations(), 2 * between, "{model}");
        assert_eq!(bits(&fast), bits(&slow), "{model}");
        assert_eq!(fast.t, slow.t);

        fast.xi.as_mut().fill(f64::MAX);
        let before = fast.clone();
        assert!(!compiled.run(&system, &mut fast, 2.0 * until), "{model}");
        assert_eq!((bits(&fast), fast.t), (bits(&before), before.t), "{model}");
    }
}

/// Two systems together end bitwise where each of them ends alone; if one has no end neither state changes.
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
    for (place, model) in models.into_iter().enumerate() {
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
        for method in some(place) {
            let stepper = Stepper::General(method);
            let steppers = systems.map(|system| CompiledStepper::new(system, &stepper, H, until));
            let starts = systems.map(State::<Instance>::start);
            let [mut one, mut two] = starts.clone();
            let both = [&mut one, &mut two];
            assert!(
                CompiledStepper::run_pair(&steppers, systems, both, until),
                "{model} {method:?}"
            );
            for ((system, mut alone), found) in
                systems.into_iter().zip(starts.clone()).zip([&one, &two])
            {
                let compiled = CompiledStepper::new(system, &stepper, H, until);
                let evaluations = system.evaluations();
                assert!(compiled.run(system, &mut alone, until));
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
                assert!(!CompiledStepper::run_pair(
                    &steppers,
                    systems,
                    [one, two],
                    until
                ));
                for (before, after) in before.iter().zip(&states) {
                    assert_eq!((bits(before), before.t), (bits(after), after.t));
                }
            }
        }
    }
}

/// Steps followed by projections are not run at once.
#[test]
fn loops_are_stepped_one_by_one() {
    let system = instance("four_bar_loop.eom");
    let stepper = Stepper::General(General::Rkmk4);
    let compiled = CompiledStepper::new(&system, &stepper, H, 1e3);
    let mut state = State::<Instance>::start(&system);
    assert!(!compiled.run(&system, &mut state, 20.0));
    assert_eq!(state.t, 0.0);
}

/// Iterative methods are not recorded as tapes, and few steps are not worth compiling.
#[test]
fn what_is_no_code() {
    let system = instance("heavy_top.eom");
    let state = State::<Instance>::start(&system);
    let implicit = Stepper::General(General::BackwardEuler);
    let few = Stepper::General(General::Rkmk4);
    for (stepper, time) in [(implicit, 1e3), (few, 1.0)] {
        let compiled = CompiledStepper::new(&system, &stepper, H, time);
        end(&system, &compiled, &state);
        assert!(compiled.code.get().and_then(Option::as_ref).is_none());
    }
}
