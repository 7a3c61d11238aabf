//! Every method for any system where numbers are extreme: no step, a step back, rest, subnormal
//! velocities, steps far too long, turns of 6 rad, stiffness.

use crate::common::points::Points;
use crate::common::{QuaternionTop, Reference, Top, distance, slopes};
use hamel::methods::{BackwardEuler, General};
use hamel::{Method, State, StepError, System, integrate, so3};

fn kovalevskaya() -> Top<f64> {
    Top(Reference::read("kovalevskaya-top").body())
}

fn none(_: f64, _: &[f64; 9], _: &[f64; 3]) -> [f64; 0] {
    []
}

#[test]
fn a_zero_step_changes_nothing() {
    let system = kovalevskaya();
    let start = State::start(&system);
    for method in General::ALL {
        let name = method.name();
        let mut state = start.clone();
        hamel::step(&system, method, &mut state, 0.0, &none).expect(name);
        // Bringing x back onto its manifold may touch the last place.
        assert!(distance(state.x, start.x) < 1e-15, "{}", name);
        assert_eq!(
            (state.t, state.xi),
            (start.t, start.xi),
            "{}",
            method.name()
        );
    }
}

#[test]
fn a_step_back_undoes_a_step_to_one_order_more_than_the_step() {
    let system = kovalevskaya();
    let start = State::start(&system);
    for method in General::ALL {
        let name = method.name();
        let undone = |h: f64| {
            let mut state = start.clone();
            hamel::step(&system, method, &mut state, h, &none).expect(name);
            hamel::step(&system, method, &mut state, -h, &none).expect(name);
            assert_eq!(state.t, 0.0);
            distance(state.x, start.x) + distance(state.xi, start.xi)
        };
        let h = if Method::<Top<f64>>::order(method) > 5 {
            0.8
        } else {
            0.1
        };
        let errors = [undone(h), undone(h / 2.0), undone(h / 4.0)];
        let slopes = slopes(&errors);
        println!("{}: {errors:?} {slopes:?}", name);
        // Each of the two steps errs by h^(p+1).
        let order = f64::from(Method::<Top<f64>>::order(method));
        assert!(
            slopes.iter().all(|slope| *slope > order + 0.8),
            "{}",
            method.name()
        );
    }
}

#[test]
fn bodies_at_rest_or_hardly_moving_stay() {
    let mut body = Reference::read("free-dzhanibekov-1e-3").body();
    for velocity in [0.0, 5e-324, 1e-310, 1e-160] {
        body.w0 = [velocity; 3];
        let (matrix, unit) = (Top(body.clone()), QuaternionTop(body.clone()));
        for method in General::ALL {
            let name = method.name();
            let (mut by_matrix, mut by_unit) = (State::start(&matrix), State::start(&unit));
            let first = by_unit.x;
            for _ in 0..10 {
                hamel::step(&matrix, method, &mut by_matrix, 1e3, &none).expect(name);
                hamel::step(&unit, method, &mut by_unit, 1e3, &|_, _, _| []).expect(name);
            }
            assert!(distance(by_matrix.x, body.r0) < 1e-15, "{}", name);
            assert!(distance(by_unit.x, first) < 1e-15, "{}", name);
            // A product of velocities is zero here: nothing changes them.
            assert_eq!(by_matrix.xi, body.w0, "{}", name);
        }
    }
}

#[test]
fn a_step_far_too_long_ends_in_a_state_or_a_typed_error() {
    let system = Top(Reference::read("heavy-top-benchmark-150").body());
    let mut refused = 0;
    for method in General::ALL {
        let name = method.name();
        for h in [1.0, 1e3, 1e80, 1e160, 1e300, f64::INFINITY, f64::NAN] {
            let start = State::start(&system);
            let mut state = start.clone();
            let mut outcome = Ok(());
            for _ in 0..200 {
                outcome = hamel::step(&system, method, &mut state, h, &none);
                // A step is taken whole or not at all.
                assert!(state.is_finite(), "{}, h = {h}", name);
                if outcome.is_err() {
                    break;
                }
            }
            match outcome {
                Ok(()) => assert!(system.constraint_norm(&state.x).is_finite()),
                Err(StepError::NonFinite { .. } | StepError::NotConverged { .. }) => refused += 1,
                Err(other) => panic!("{}, h = {h}: {other}", name),
            }
        }
    }
    // At the least the infinite steps are errors of every method.
    assert!(refused >= 2 * General::ALL.len());
}

#[test]
fn rotations_stay_orthonormal_at_six_radians_a_step() {
    let mut body = Reference::read("kovalevskaya-top").body();
    body.inertia = so3::identity();
    body.m = 0.0;
    body.w0 = [1.0, 2.0, 2.0].map(|w| 2.0 * w);
    let (matrix, unit) = (Top(body.clone()), QuaternionTop(body));
    for method in General::ALL {
        let name = method.name();
        if let General::Rk4 { .. } = method {
            continue; // not on the manifold within a step: useless at such steps
        }
        let (mut by_matrix, mut by_unit) = (State::start(&matrix), State::start(&unit));
        for _ in 0..5_000 {
            hamel::step(&matrix, method, &mut by_matrix, 1.0, &none).expect(name);
            hamel::step(&unit, method, &mut by_unit, 1.0, &|_, _, _| []).expect(name);
            assert!(
                matrix.constraint_norm(&by_matrix.x) <= 1e-14,
                "{}",
                method.name()
            );
            assert!(
                unit.constraint_norm(&by_unit.x) <= 1e-14,
                "{}",
                method.name()
            );
        }
    }
}

/// Two masses on a line, one on a stiff spring and damper: ẍ₁ = −10⁸ x₁ − 10⁵ ẋ₁, ẍ₂ = x₁ − x₂.
const STIFF: Points<2> = Points {
    start: ([1e-3, 1.0], [1.0, 0.0]),
    accel: |x, xi| Ok([-1e8 * x[0] - 1e5 * xi[0], x[0] - x[1]]),
};

#[test]
fn backward_euler_solves_what_is_stiff_and_explicit_methods_say_that_they_cannot() {
    let stiff = |_: f64, _: &[f64; 2], _: &[f64; 2]| [];
    let run = |method: General, n: f64| {
        let mut state = State::start(&STIFF);
        integrate(&STIFF, method, &mut state, 1.0 / n, 1.0, stiff, |_| {}).map(|()| state)
    };
    // x₁ is gone after a millisecond; x₂ = cos t but for what x₁ did to it, below 1e-6.
    let errors = [100.0, 200.0, 400.0].map(|n| {
        let state = run(General::BackwardEuler, n).expect("a run");
        assert!(state.x[0].abs() < 1e-6);
        (state.x[1] - 1.0_f64.cos()).abs()
    });
    println!("{errors:?} {:?}", slopes(&errors));
    assert!(
        slopes(&errors)
            .iter()
            .all(|slope| (slope - 1.0).abs() < 0.1)
    );
    let end = run(General::Rkmk4, 400.0).map(|state| state.t);
    assert!(matches!(end, Err(StepError::NonFinite { .. })), "{end:?}");
}

#[test]
fn an_implicit_step_without_solution_is_a_typed_error() {
    // ξ₁ = 1 + h (1 + ξ₁²) has no real solution above h = 0.207.
    let growing = Points {
        start: ([0.0], [1.0]),
        accel: |_, xi| Ok([1.0 + xi[0] * xi[0]]),
    };
    let mut state = State::start(&growing);
    let outcome = hamel::step(&growing, BackwardEuler, &mut state, 1.0, &|_, _, _| []);
    assert!(
        matches!(outcome, Err(StepError::NotConverged { .. })),
        "{outcome:?}"
    );
    assert_eq!(state.t, 0.0);
    let outcome = hamel::step(&growing, BackwardEuler, &mut state, 0.1, &|_, _, _| []);
    assert_eq!(outcome, Ok(()));
    let expected = (1.0 - (1.0 - 0.4 * 1.1_f64).sqrt()) / 0.2;
    assert!((state.xi[0] - expected).abs() < 1e-12);
}
