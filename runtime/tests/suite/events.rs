//! Events against closed forms: the pendulum's period, bouncing, order and direction.

use crate::common::Pendulum;
use crate::common::points::Points;
use hamel::adaptive::{Adaptive, Event, Report};
use hamel::methods::Rkmk4;
use hamel::{State, StepError, integrate, integrate_while};
use std::ops::ControlFlow;

/// T = 4 K(sin(θ₀/2)) √(l/g) = 2π √(l/g) / M(1, cos(θ₀/2)), M the arithmetic-geometric mean.
fn period(g: f64, l: f64, amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, (0.5 * amplitude).cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    std::f64::consts::TAU * (l / g).sqrt() / a
}

fn pendulum() -> Pendulum {
    Pendulum {
        g: 9.81,
        l: 0.7,
        theta0: 2.5,
        rate0: 0.0,
    }
}

/// Times of the events of a pendulum's lowest point.
fn crossings<const M: usize, const D: usize>(
    method: Adaptive<M, D>,
    until: f64,
    choose: fn(Event<'_, Pendulum>) -> Event<'_, Pendulum>,
) -> Vec<f64> {
    let system = pendulum();
    let mut state = State::start(&system);
    let lowest = |state: &State<Pendulum>| state.x[1];
    let mut times = Vec::new();
    let observe = |report: Report<'_, Pendulum, D>| {
        if let Report::Event { index, state } = report {
            assert_eq!(index, 0);
            times.push(state.t);
        }
    };
    let events = [choose(Event::new(&lowest))];
    method
        .integrate(
            &system,
            &mut state,
            until,
            |_, _, _| vec![0.0],
            &events,
            observe,
        )
        .expect("a run");
    times
}

#[test]
fn the_pendulum_has_the_period_of_the_elliptic_integral() {
    let period = period(9.81, 0.7, 2.5);
    let both = crossings(Adaptive::rkmk54(1e-11), 10.0, |event| event);
    assert_eq!(both.len(), (10.0 / (0.5 * period) + 0.5) as usize);
    for (index, time) in both.iter().enumerate() {
        let expected = (0.25 + 0.5 * index as f64) * period;
        // A thousand tolerances, over velocities of some rad/s.
        assert!((time - expected).abs() < 1e-8, "{time} {expected}");
    }
    let sharp = crossings(Adaptive::rkmk8(1e-12), 10.0, |event| event);
    assert_eq!(sharp.len(), both.len());
    for (index, time) in sharp.iter().enumerate() {
        let expected = (0.25 + 0.5 * index as f64) * period;
        assert!((time - expected).abs() < 1e-9, "{time} {expected}");
    }
}

#[test]
fn directions_select_and_together_make_all() {
    let method = Adaptive::rkmk54(1e-8);
    let both = crossings(method, 10.0, |event| event);
    let rising = crossings(method, 10.0, |event| event.rising());
    let falling = crossings(method, 10.0, |event| event.falling());
    // It starts at θ > 0 and falls first.
    let take = |first: usize| -> Vec<f64> { both.iter().copied().skip(first).step_by(2).collect() };
    assert_eq!(falling, take(0));
    assert_eq!(rising, take(1));
    assert_eq!(rising.len(), 3);
}

#[test]
fn events_are_found_backwards_too() {
    let system = pendulum();
    let lowest = |state: &State<Pendulum>| state.x[1];
    let mut state = State::start(&system);
    let events = [Event::new(&lowest).stopping()];
    let outcome = Adaptive::rkmk8(1e-11)
        .integrate(
            &system,
            &mut state,
            -10.0,
            |_, _, _| vec![0.0],
            &events,
            |_| {},
        )
        .expect("a run");
    assert_eq!(outcome.stopped_by, Some(0));
    assert!((state.t + 0.25 * period(9.81, 0.7, 2.5)).abs() < 1e-9);
    // Continued from there, it does not stop again at once.
    let outcome = Adaptive::rkmk8(1e-11)
        .integrate(
            &system,
            &mut state,
            -1.0,
            |_, _, _| vec![0.0],
            &events,
            |_| {},
        )
        .expect("a run");
    assert_eq!(outcome.stopped_by, None);
    assert_eq!(state.t, -1.0);
}

/// A ball in free fall, z = x.
type Ball = Points<1>;

const GRAVITY: f64 = 9.81;

const BALL: Ball = Points {
    start: ([1.0], [0.0]),
    accel: |_, _| Ok([-GRAVITY]),
};

fn free(_: f64, _: &[f64; 1], _: &[f64; 1]) -> [f64; 0] {
    []
}

#[test]
fn a_ball_bounces_when_it_should() -> Result<(), StepError> {
    const RESTITUTION: f64 = 0.8;
    let ground = |state: &State<Ball>| state.x[0];
    let events = [Event::new(&ground).falling().stopping()];
    let mut state = State::start(&BALL);
    let fall = (2.0 / GRAVITY).sqrt();
    let mut expected = fall;
    for bounce in 0..8 {
        let outcome =
            Adaptive::rkmk54(1e-10).integrate(&BALL, &mut state, 100.0, free, &events, |_| {})?;
        assert_eq!(outcome.stopped_by, Some(0));
        assert!(
            (state.t - expected).abs() < 1e-12,
            "{bounce}: {} {expected}",
            state.t
        );
        assert!(state.x[0].abs() < 1e-12);
        state.xi[0] *= -RESTITUTION;
        expected += 2.0 * fall * RESTITUTION.powi(bounce + 1);
    }
    Ok(())
}

#[test]
fn events_of_one_step_come_in_order_of_time_and_the_stop_ends_it() -> Result<(), StepError> {
    // Heights 0.2, 0.6, 0.4 and 0.1, passed within one long step.
    let at = [0.2, 0.6, 0.4, 0.1];
    let heights = at.map(|z| move |state: &State<Ball>| state.x[0] - z);
    let mut events = [
        Event::new(&heights[0]),
        Event::new(&heights[1]),
        Event::new(&heights[2]).stopping(),
        Event::new(&heights[3]),
    ];
    let time = |z: f64| (2.0 * (1.0 - z) / GRAVITY).sqrt();
    let mut method = Adaptive::rkmk54(1e-6);
    method.first = Some(1.0);
    for stopping in [true, false] {
        if !stopping {
            events[2] = Event::new(&heights[2]);
        }
        let mut state = State::start(&BALL);
        let mut seen = Vec::new();
        let mut ends = Vec::new();
        let outcome = method.integrate(&BALL, &mut state, 1.0, free, &events, |report| {
            match report {
                Report::Event { index, state } => {
                    assert!((state.t - time(at[index])).abs() < 1e-14);
                    assert!(ends.is_empty(), "events come before the step that has them");
                    seen.push(index);
                }
                Report::Step(step) => {
                    // A step that an event has cut short tells nothing from beyond it.
                    assert_eq!(step.at(2.0).t, step.end().t);
                    ends.push(step.end().t);
                }
            }
        })?;
        if stopping {
            assert_eq!(seen, [1, 2]);
            assert_eq!(outcome.stopped_by, Some(2));
            assert_eq!(ends, [state.t]);
            assert!((state.x[0] - 0.4).abs() < 1e-14 && state.x[0] <= 0.4);
        } else {
            assert_eq!(seen, [1, 2, 0, 3]);
            assert_eq!((outcome.stopped_by, state.t), (None, 1.0));
        }
    }
    Ok(())
}

#[test]
fn a_coarse_precision_needs_fewer_evaluations_and_is_kept() -> Result<(), StepError> {
    let count = std::cell::Cell::new(0);
    let ground = |state: &State<Ball>| {
        count.set(count.get() + 1);
        // Steep on one side: the secant alone would creep.
        (40.0 * state.x[0]).exp() - 1.0
    };
    let events = [Event::new(&ground).stopping()];
    let mut spent = Vec::new();
    for precision in [1e-2, 1e-6, 0.0] {
        let mut method = Adaptive::rkmk54(1e-6);
        method.precision = precision;
        method.first = Some(1.0);
        let mut state = State::start(&BALL);
        count.set(0);
        method.integrate(&BALL, &mut state, 1.0, free, &events, |_| {})?;
        let late = state.t - (2.0 / GRAVITY).sqrt();
        assert!(late > -1e-14 && late <= precision + 1e-14, "{late:e}");
        spent.push(count.get());
    }
    println!("{spent:?}");
    assert!(spent[0] < spent[1] && spent[1] <= spent[2]);
    // Bisection of one unit of time to 4e-16 takes 52; the ends are looked at twice.
    assert!(spent[2] <= 60);
    Ok(())
}

#[test]
fn an_event_that_is_not_a_number_is_a_typed_error() {
    let nothing = |_: &State<Ball>| f64::NAN;
    let mut state = State::start(&BALL);
    let end = Adaptive::rkmk54(1e-6).integrate(
        &BALL,
        &mut state,
        1.0,
        free,
        &[Event::new(&nothing)],
        |_| {},
    );
    assert!(matches!(end, Err(StepError::NonFinite { .. })));
    assert_eq!(state.t, 0.0);
}

/// A run that its observer breaks off is the beginning of the whole one, to the bit; also where it ends at its start.
#[test]
fn equal_steps_end_where_their_observer_says_so() {
    let system = pendulum();
    let held = |_, _: &_, _: &_| vec![0.0];
    let mut all = Vec::new();
    let mut whole = State::start(&system);
    integrate(&system, Rkmk4, &mut whole, 0.01, 1.0, held, |state| {
        all.push(state.clone());
    })
    .expect("a run");
    for last in [0, 1, 57, 100] {
        let mut state = State::start(&system);
        let mut seen = 0;
        let observe = |_: &State<Pendulum>| {
            seen += 1;
            match seen > last {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        integrate_while(&system, Rkmk4, &mut state, 0.01, 1.0, held, observe).expect("a run");
        assert_eq!(seen, last + 1);
        assert_eq!((&state.t, &state.x, &state.xi), {
            let wanted = &all[last];
            (&wanted.t, &wanted.x, &wanted.xi)
        });
    }
}
