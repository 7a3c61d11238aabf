//! Controllers with a period of their own against the exact motion under inputs that are held.

use crate::oscillator::Oscillator;
use hamel::adaptive::Adaptive;
use hamel::methods::General;
use hamel::{State, StepError, ZeroOrderHold};

const W: f64 = 1.7;
const FREE: Oscillator = Oscillator {
    frequency: W,
    damping: 0.0,
};
const PERIOD: f64 = 0.25;

/// u = −k (q + integral), the integral by the controller's own sums.
fn law(integral: &mut f64, q: f64, rate: f64) -> f64 {
    *integral += PERIOD * q;
    -0.8 * q - 0.3 * *integral - 0.5 * rate
}

/// The state after a number of periods, each solved in closed form, the last one shortened.
fn exact(until: f64) -> (f64, f64) {
    let (mut q, mut rate, mut integral, mut t) = (1.0_f64, 0.0_f64, 0.0, 0.0);
    while until - t > 1e-12 {
        let u = law(&mut integral, q, rate);
        let h = PERIOD.min(until - t);
        let (s, c) = (W * h).sin_cos();
        let rest = u / (W * W);
        (q, rate) = (
            rest + (q - rest) * c + rate / W * s,
            rate * c - (q - rest) * W * s,
        );
        t += h;
    }
    (q, rate)
}

/// Every general method keeps its order, though u jumps: steps end there.
#[test]
fn methods_keep_their_orders() {
    let until = 2.1;
    let (q, rate) = exact(until);
    for &method in General::ALL {
        let order = hamel::Method::<Oscillator>::order(&method);
        // Periods are cut in so many steps; the last one is shorter.
        let errors = [1.0, 2.0, 4.0].map(|parts| {
            let system = FREE;
            let mut state = State::start(&system);
            let (mut integral, mut calls, mut seen) = (0.0, 0, Vec::new());
            let mut controller = ZeroOrderHold::new(PERIOD, |state: &State<Oscillator>| {
                calls += 1;
                [law(&mut integral, state.x[0], state.xi[0])]
            });
            controller
                .integrate(
                    &system,
                    method,
                    &mut state,
                    PERIOD / parts,
                    until,
                    |state| {
                        seen.push(state.t);
                    },
                )
                .expect("a run");
            assert_eq!((calls, state.t), (9, until));
            assert!(seen.is_sorted() && seen.windows(2).all(|pair| pair[0] < pair[1]));
            assert_eq!((seen[0], seen[seen.len() - 1]), (0.0, until));
            (state.x[0] - q).abs().max((state.xi[0] - rate).abs())
        });
        let slope = (errors[0] / errors[2]).log2() / 2.0;
        assert!(
            slope > f64::from(order) - 0.5 || errors[2] < 1e-12,
            "{}: {errors:?}",
            method.name()
        );
    }
}

#[test]
fn error_control_meets_no_jump() {
    let system = FREE;
    let mut state = State::start(&system);
    let mut integral = 0.0;
    let mut controller = ZeroOrderHold::new(PERIOD, |state: &State<Oscillator>| {
        [law(&mut integral, state.x[0], state.xi[0])]
    });
    let mut ends = 0;
    let statistics = controller
        .adapt(&system, &Adaptive::rkmk8(1e-11), &mut state, 2.0, |_| {
            ends += 1
        })
        .expect("a run");
    let (q, rate) = exact(2.0);
    assert!((state.x[0] - q).abs().max((state.xi[0] - rate).abs()) < 1e-9);
    assert_eq!((ends, statistics.rejected), (9, 0));
    assert!(statistics.evaluations > 8 * 12);
}

#[test]
fn periods_are_positive_and_finite() {
    let system = FREE;
    for (period, until) in [
        (0.0, 1.0),
        (-1.0, 1.0),
        (f64::NAN, 1.0),
        (f64::INFINITY, 1.0),
        (0.1, -1.0),
        (0.1, f64::NAN),
        (1e-300, 1.0),
    ] {
        let mut state = State::start(&system);
        let mut controller = ZeroOrderHold::new(period, |_: &State<Oscillator>| [0.0]);
        let result = controller.integrate(&system, General::Rkmk4, &mut state, 0.1, until, |_| {});
        assert!(
            matches!(result, Err(StepError::InvalidStep { .. })),
            "{period}, {until}: {result:?}"
        );
        assert_eq!(state.t, 0.0);
    }
    // No time, no question.
    let mut state = State::start(&system);
    let mut controller =
        ZeroOrderHold::new(0.1, |_: &State<Oscillator>| -> [f64; 1] { panic!("asked") });
    let result = controller.integrate(&system, General::Rkmk4, &mut state, 0.1, 0.0, |_| {});
    assert_eq!(result, Ok(()));
}

/// A run of less than 1e-9 periods is a run: it ends at its end, with the controller asked once.
#[test]
fn spans_far_below_a_period_are_reached() {
    let system = FREE;
    let mut state = State::start(&system);
    let mut calls = 0;
    let until = 1e-12 * PERIOD;
    let mut controller = ZeroOrderHold::new(PERIOD, |_: &State<Oscillator>| {
        calls += 1;
        [0.0]
    });
    controller
        .integrate(&system, General::Rkmk4, &mut state, PERIOD, until, |_| {})
        .expect("a run");
    assert_eq!((state.t, calls), (until, 1));
}
