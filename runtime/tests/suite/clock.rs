//! The time among the coordinates is the time of the run: of a driven mass whose clock shows seconds since 1970.

use hamel::adaptive::Adaptive;
use hamel::methods::Rkmk4;
use hamel::{Block, Clock, Energies, Scalar, Singular, State, System, ZeroOrderHold};
use std::marker::PhantomData;

/// Where the clock starts.
const BEGIN: f64 = 1.7e9;
/// How far a run may be off: numbers of that size are 2.4e-7 apart.
const CLOSE: f64 = 1e-6;
const H: f64 = 1e-4;

/// x = (t, q), q̈ = cos(t − t₀): q = 1 − cos(t − t₀).
#[derive(Clone)]
struct Driven<S>(PhantomData<S>);

impl<S: Scalar> System for Driven<S> {
    type Scalar = S;
    type Coordinates = [S; 2];
    type Velocities = [S; 1];
    type Chart = [S; 2];
    type Inputs = [S; 0];

    fn blocks(&self) -> &[Block] {
        &[Block::Flat(2)]
    }
    fn start(&self) -> ([S; 2], [S; 1]) {
        ([S::from_f64(BEGIN), S::default()], [S::default()])
    }
    fn clock(&self) -> Option<usize> {
        Some(0)
    }
    fn chart_rate(&self, _: &[S; 2], xi: &[S; 1]) -> [S; 2] {
        [S::from_f64(1.0), xi[0]]
    }
    fn forward_dynamics(&self, x: &[S; 2], _: &[S; 1], _: &[S; 0]) -> Result<[S; 1], Singular> {
        Ok([(x[0] - S::from_f64(BEGIN)).sin_cos().1])
    }
}

impl<S: Scalar> Energies for Driven<S> {
    fn kinetic_energy(&self, _: &[S; 2], xi: &[S; 1]) -> S {
        S::from_f64(0.5) * xi[0] * xi[0]
    }
    fn potential_energy(&self, _: &[S; 2]) -> S {
        S::default()
    }
}

const ALONE: Driven<f64> = Driven(PhantomData);

fn none<S>(_: f64, _: &[S; 2], _: &[S; 1]) -> [S; 0] {
    []
}

/// The clock of a state that has run from t = `from`, and its motion.
fn check(state: &State<Driven<f64>>, from: f64) {
    assert_eq!(state.x[0], BEGIN + (state.t - from));
    let t = state.t - from;
    assert!((state.x[1] - (1.0 - t.cos())).abs() < CLOSE, "{state:?}");
    assert!((state.xi[0] - t.sin()).abs() < CLOSE, "{state:?}");
}

/// From a time that is not 0, forwards and back.
#[test]
fn equal_steps() {
    let mut state = State {
        t: 5.0,
        ..State::start(&ALONE)
    };
    let mut seen = 0;
    for until in [6.0, 5.5] {
        let clock = Clock::new(&ALONE, &state).expect("a clock");
        hamel::integrate(&ALONE, Rkmk4, &mut state, H, until, none, |state| {
            assert_eq!(state.x[0], clock.at(state.t));
            seen += 1;
        })
        .expect("a run");
        check(&state, 5.0);
    }
    assert_eq!(seen, 15_002);
}

/// Steps that are shorter than what the clock can tell apart.
#[test]
fn short_steps() {
    let mut state = State::start(&ALONE);
    hamel::integrate(&ALONE, Rkmk4, &mut state, 1e-7, 1e-3, none, |_| {}).expect("a run");
    check(&state, 0.0);
    // So it is for who sets the clock between steps; steps alone would leave it where it was.
    let mut state = State::start(&ALONE);
    let clock = Clock::new(&ALONE, &state).expect("a clock");
    for _ in 0..1000 {
        hamel::step(&ALONE, Rkmk4, &mut state, 1e-7, &none).expect("a step");
        clock.set(&mut state);
    }
    assert!((state.x[0] - BEGIN - 1e-4).abs() < CLOSE / 2.0, "{state:?}");
}

#[test]
fn a_tolerance() {
    let method = Adaptive::rkmk54(1e-6);
    let mut state = State::start(&ALONE);
    method
        .integrate(&ALONE, &mut state, 1.0, none, &[], |report| {
            if let hamel::adaptive::Report::Step(step) = report {
                let (from, to) = (step.start().t, step.end().t);
                check(&step.at(0.5 * (from + to)), 0.0);
                check(step.end(), 0.0);
            }
        })
        .expect("a run");
    check(&state, 0.0);
}

#[test]
fn a_controller() {
    let mut state = State::start(&ALONE);
    let mut idle = ZeroOrderHold::new(0.003, |_: &State<Driven<f64>>| []);
    idle.integrate(&ALONE, Rkmk4, &mut state, 1e-3, 1.0, |_| {})
        .expect("a run");
    check(&state, 0.0);
}

#[cfg(feature = "ensemble")]
mod together {
    use super::*;
    use core::ops::ControlFlow;
    use hamel::ensemble::{self, Progress};
    use hamel::wide::f64x4;

    /// Members are what they are alone, to the bit; one of them has another clock.
    #[test]
    fn an_ensemble() {
        let wide = Driven::<f64x4>(PhantomData);
        let mut states: Vec<_> = (0..5).map(|_| State::start(&ALONE)).collect();
        states[1].x[0] += 0.5;
        // This one has no end.
        states[2].xi[0] = f64::MAX;
        states[2].x[1] = f64::MAX;
        let mut alone = states.clone();
        let inputs = |_: &ensemble::Group, _: f64, _: &[f64x4; 2], _: &[f64x4; 1]| [];
        let on = |_: Progress| ControlFlow::Continue(());
        let outcome = ensemble::integrate(&wide, &Rkmk4, &mut states, H, 1.0, inputs, on);
        assert_eq!(outcome.failures.len(), 1);
        for (index, (member, alone)) in states.iter().zip(&mut alone).enumerate() {
            let run = hamel::integrate(&ALONE, Rkmk4, alone, H, 1.0, none, |_| {});
            assert_eq!(run.is_err(), index == 2);
            if run.is_ok() {
                assert_eq!(member.x[0], alone.x[0]);
                assert_eq!(member.x[0], BEGIN + if index == 1 { 1.5 } else { 1.0 });
            }
        }
        check(&states[0], 0.0);
    }
}
