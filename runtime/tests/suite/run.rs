//! Built runs against the plain functions beneath them: the same states, to the bit.

use crate::oscillator::Oscillator;
use hamel::adaptive::{Adaptive, Event, Report};
use hamel::methods::{Rkmk4, Rkmk8};
use hamel::{Run, State, StepError, ZeroOrderHold, integrate};

const OSCILLATOR: Oscillator = Oscillator {
    frequency: 3.0,
    damping: 0.1,
};

fn push(t: f64, _: &[f64; 1], xi: &[f64; 1]) -> [f64; 1] {
    [t - xi[0]]
}

fn bits(state: &State<Oscillator>) -> [u64; 3] {
    [state.t, state.x[0], state.xi[0]].map(f64::to_bits)
}

#[test]
fn equal_steps_are_those_of_integrate() -> Result<(), StepError> {
    let mut state = State::start(&OSCILLATOR);
    let (mut expected, mut seen) = (Vec::new(), Vec::new());
    integrate(&OSCILLATOR, Rkmk8, &mut state, 0.01, 1.0, push, |state| {
        expected.push(bits(state));
    })?;
    let run = Run::new(&OSCILLATOR).method(Rkmk8).step(0.01).inputs(push);
    let end = run.observe(|state| seen.push(bits(state))).until(1.0)?;
    assert_eq!(seen, expected);
    assert_eq!(bits(&end), bits(&state));
    Ok(())
}

#[test]
fn runs_start_at_rest_without_inputs_unless_told_otherwise() -> Result<(), StepError> {
    let mut state = State::start(&OSCILLATOR);
    integrate(
        &OSCILLATOR,
        Rkmk4,
        &mut state,
        0.01,
        1.0,
        |_, _, _| [0.0],
        |_| {},
    )?;
    let end = Run::new(&OSCILLATOR).method(Rkmk4).step(0.01).until(1.0)?;
    assert_eq!(bits(&end), bits(&state));
    let back = Run::new(&OSCILLATOR)
        .from(end)
        .method(Rkmk4)
        .step(0.01)
        .until(0.0)?;
    assert!((back.x[0] - 1.0).abs() < 1e-7);
    Ok(())
}

#[test]
fn a_run_stops_where_its_condition_holds() -> Result<(), StepError> {
    let mut seen = 0;
    let end = Run::new(&OSCILLATOR)
        .method(Rkmk4)
        .step(0.125)
        .observe(|_| seen += 1)
        .stop_when(|state| state.t >= 0.5)
        .observe(|state| assert!(state.t < 0.5))
        .until(1.0)?;
    assert_eq!((end.t, seen), (0.5, 5));
    let run = Run::new(&OSCILLATOR).adaptive(Adaptive::rkmk54(1e-6));
    let (end, outcome) = run.stop_when(|state| state.t > 0.5).until(1.0)?;
    assert!(end.t > 0.5 && end.t < 1.0);
    assert_eq!(outcome.stopped_by, None);
    let run = Run::new(&OSCILLATOR).method(Rkmk4).step(0.125);
    let run = run.zero_order_hold(0.25, |state| [state.t]);
    assert_eq!(run.stop_when(|state| state.t >= 0.5).until(1.0)?.t, 0.5);
    Ok(())
}

#[test]
fn error_control_is_that_of_adaptive() -> Result<(), StepError> {
    let method = Adaptive::rkmk8(1e-9);
    let mut state = State::start(&OSCILLATOR);
    let statistics = method.run(&OSCILLATOR, &mut state, 2.0, push)?;
    let mut seen = 0;
    let run = Run::new(&OSCILLATOR).adaptive(method).inputs(push);
    let (end, outcome) = run.observe(|_| seen += 1).until(2.0)?;
    assert_eq!(bits(&end), bits(&state));
    assert_eq!(outcome.statistics, statistics);
    assert_eq!(seen, statistics.accepted + 1);

    let mut state = State::start(&OSCILLATOR);
    let zero = |state: &State<Oscillator>| state.x[0];
    let events = [Event::new(&zero), Event::new(&zero).rising().stopping()];
    let mut reported = Vec::new();
    let expected = method.integrate(&OSCILLATOR, &mut state, 9.0, push, &events, |report| {
        if let Report::Event { index, state } = report {
            reported.push((index, bits(state)));
        }
    })?;
    let mut told = Vec::new();
    let (end, outcome) = Run::new(&OSCILLATOR)
        .adaptive(method)
        .inputs(push)
        .events(&events)
        .report(|report| {
            if let Report::Event { index, state } = report {
                told.push((index, bits(state)));
            }
        })
        .until(9.0)?;
    assert_eq!((bits(&end), outcome), (bits(&state), expected));
    assert_eq!(told, reported);
    assert_eq!(outcome.stopped_by, Some(1));
    Ok(())
}

#[test]
fn a_controller_acts_as_in_the_plain_functions() -> Result<(), StepError> {
    let control = |state: &State<Oscillator>| [1.0 - state.x[0]];
    let mut state = State::start(&OSCILLATOR);
    ZeroOrderHold::new(0.1, control).integrate(
        &OSCILLATOR,
        Rkmk4,
        &mut state,
        0.03,
        1.0,
        |_| {},
    )?;
    let run = Run::new(&OSCILLATOR).method(Rkmk4).step(0.03);
    let end = run.zero_order_hold(0.1, control).until(1.0)?;
    assert_eq!(bits(&end), bits(&state));

    let method = Adaptive::rkmk54(1e-8);
    let mut state = State::start(&OSCILLATOR);
    let statistics =
        ZeroOrderHold::new(0.1, control).adapt(&OSCILLATOR, &method, &mut state, 1.0, |_| {})?;
    let run = Run::new(&OSCILLATOR).adaptive(method);
    let (end, outcome) = run.zero_order_hold(0.1, control).until(1.0)?;
    assert_eq!(bits(&end), bits(&state));
    assert_eq!(outcome.statistics, statistics);

    let run = Run::new(&OSCILLATOR).adaptive(method);
    let zero = |state: &State<Oscillator>| state.x[0];
    let (end, outcome) = run
        .zero_order_hold(0.1, control)
        .events(&[Event::new(&zero).stopping()])
        .until(5.0)?;
    assert_eq!(outcome.stopped_by, Some(0));
    assert!(end.x[0].abs() < 1e-7 && end.t < 1.0);
    Ok(())
}
