//! The baselines have their documented orders and defects, and no others.

use hamel::methods::Rkmk4;
use hamel::{Method, State, StepError, System, so3};
use hamel_cases::by_hand::{QuaternionTop, Reference, Spin, Top, distance, run, slopes};
use hamel_engine::baselines::{BaselineMethod, Buss, Rk4Added, Slide};
use std::cell::Cell;

const BUSS: [Buss; 4] = [
    Buss::First,
    Buss::Second,
    Buss::AugmentedSecond,
    Buss::Fourth,
];

fn kovalevskaya() -> Top<f64> {
    Top(Reference::read("kovalevskaya-top").body())
}

/// Error of R (Frobenius) of a body with a fixed point.
fn top_error(case: &str, method: impl Method<Top<f64>>, until: f64, n: u32) -> f64 {
    let reference = Reference::read(case);
    let state = run(&Top(reference.body()), method, until, n).expect(case);
    distance(state.x, reference.sample(until, "R"))
}

fn assert_order(what: &str, errors: &[f64], order: f64) {
    let slopes = slopes(errors);
    println!("{what}: errors {errors:?}, slopes {slopes:.3?}");
    let fit = slopes.iter().all(|slope| (slope - order).abs() <= 0.1);
    assert!(fit, "{what}: slopes {slopes:?} of {errors:?}");
}

#[test]
fn baselines_have_the_orders_that_they_are_kept_to_show() {
    for (method, order, coarsest) in [
        (BaselineMethod::ForwardEuler, 1.0, 40_000),
        (BaselineMethod::Rk4Added, 2.0, 2000),
        (BaselineMethod::Rk4Projected, 4.0, 2000),
    ] {
        assert_eq!(f64::from(Method::<Top<f64>>::order(&method)), order);
        let errors = [1, 2, 4].map(|f| top_error("kovalevskaya-top", method, 20.0, f * coarsest));
        assert_order(&format!("{method:?}"), &errors, order);
    }
    let benchmark = |f: u32| {
        let case = "heavy-top-benchmark-150";
        top_error(case, BaselineMethod::Rk4Projected, 1.0, f * 4000)
    };
    assert_order("projected, benchmark", &[1, 2, 4].map(benchmark), 4.0);
}

#[test]
fn leaving_out_dexpinv_costs_two_orders_and_more_than_ninety_times_the_error() {
    for (case, until) in [("heavy-top-benchmark-150", 1.0), ("kovalevskaya-top", 20.0)] {
        let added = top_error(case, Rk4Added, until, 8000);
        let right = top_error(case, Rkmk4, until, 8000);
        assert!(added > 90.0 * right, "{case}: {added:e} against {right:e}");
    }
}

#[test]
fn quaternions_and_matrices_agree() {
    let reference = Reference::read("kovalevskaya-top");
    for &method in BaselineMethod::ALL {
        if method == BaselineMethod::Rk4Projected {
            continue; // it integrates the entries: other errors
        }
        let unit = run(&QuaternionTop(reference.body()), method, 2.0, 200).expect("a run");
        let matrix = run(&Top(reference.body()), method, 2.0, 200).expect("a run");
        let difference = distance(hamel::s3::to_matrix(unit.x), matrix.x);
        assert!(difference < 1e-11, "{method:?}: {difference:e}");
    }
}

/// Integrates `n` steps forwards and back; returns the distance of x and ξ from the start.
fn there_and_back(top: &Top<f64>, method: impl Method<Top<f64>>, h: f64, n: u32) -> f64 {
    let start = State::start(top);
    let mut state = start.clone();
    for h in [h, -h] {
        for _ in 0..n {
            hamel::step(top, &method, &mut state, h, &|_, _, _| []).expect("a step");
        }
    }
    distance(state.x, start.x).max(distance(state.xi, start.xi))
}

#[test]
fn a_step_of_zero_changes_nothing_and_a_step_back_is_no_inverse() {
    let top = kovalevskaya();
    for &method in BaselineMethod::ALL {
        assert!(there_and_back(&top, method, 0.0, 1) < 2e-15, "{method:?}");
    }
    assert!(there_and_back(&top, Slide, 0.0, 1) < 2e-15);
    assert!(there_and_back(&top, Buss::Fourth, 0.0, 1) < 2e-15);
    assert!(there_and_back(&top, Slide, 0.02, 100) > 1e-3);
}

#[test]
fn a_step_back_undoes_a_step_to_one_order_more_than_the_step() {
    let top = kovalevskaya();
    for &method in BaselineMethod::ALL {
        let undone = |h: f64| there_and_back(&top, method, h, 1);
        let errors = [undone(0.1), undone(0.05), undone(0.025)];
        let slopes = slopes(&errors);
        println!("{method:?}: {errors:?} {slopes:?}");
        // Each of the two steps errs by h^(p+1).
        let order = f64::from(Method::<Top<f64>>::order(&method));
        let fit = slopes.iter().all(|slope| *slope > order + 0.8);
        assert!(fit, "{method:?}: {slopes:?}");
    }
}

/// Takes extremely long, infinite and NaN steps; returns the number of refusals.
fn overstep(top: &Top<f64>, method: impl Method<Top<f64>>) -> u32 {
    let mut refused = 0;
    for h in [1.0, 1e3, 1e80, 1e160, 1e300, f64::INFINITY, f64::NAN] {
        let mut state = State::start(top);
        for _ in 0..20 {
            let outcome = hamel::step(top, &method, &mut state, h, &|_, _, _| []);
            // A failed step leaves the state unchanged.
            assert!(state.is_finite(), "h = {h}");
            match outcome {
                Ok(()) => assert!(top.constraint_norm(&state.x).is_finite(), "h = {h}"),
                Err(StepError::NonFinite { .. }) => {
                    refused += 1;
                    break;
                }
                Err(other) => panic!("h = {h}: {other}"),
            }
        }
    }
    refused
}

#[test]
fn steps_far_too_long_end_in_a_state_or_a_typed_error() {
    for case in ["heavy-top-benchmark-150", "kovalevskaya-top"] {
        let mut body = Reference::read(case).body();
        for stretch in [1.0, 1.3] {
            body.inertia[0] *= stretch;
            let top = Top(body.clone());
            // All methods refuse infinite and NaN steps.
            for &method in BaselineMethod::ALL {
                assert!(overstep(&top, method) >= 2, "{method:?}");
            }
            for method in BUSS {
                assert!(overstep(&top, method) >= 2, "{method:?}");
            }
            assert!(overstep(&top, Slide) >= 2);
        }
    }
}

#[test]
fn rotations_stay_orthonormal_at_six_radians_a_step() {
    let mut body = kovalevskaya().0;
    body.inertia = so3::identity();
    body.m = 0.0;
    body.w0 = [1.0, 2.0, 2.0].map(|w| 2.0 * w);
    let top = Top(body);
    fn stays(top: &Top<f64>, name: &str, method: impl Method<Top<f64>>) {
        let mut state = State::start(top);
        for _ in 0..5_000 {
            hamel::step(top, &method, &mut state, 1.0, &|_, _, _| []).expect(name);
            assert!(top.constraint_norm(&state.x) <= 1e-14, "{name}");
        }
    }
    for &method in BaselineMethod::ALL {
        // Within a step, this method leaves the manifold: it is useless for such steps.
        if method != BaselineMethod::Rk4Projected {
            stays(&top, &format!("{method:?}"), method);
        }
    }
    stays(&top, "slide", Slide);
    for method in BUSS {
        stays(&top, &format!("{method:?}"), method);
    }
}

/// At rest without torque, a body of any symmetry stays at rest.
#[test]
fn bodies_at_rest_or_hardly_moving_stay() {
    let double = Reference::read("free-dzhanibekov-1e-3").body();
    for moments in [[2.0; 3], [2.0, 2.0, 1.0], [1.0, 1.7, 2.4]] {
        for velocity in [0.0, 5e-324, 1e-310, 1e-160] {
            let mut body = double.clone();
            for axis in 0..3 {
                body.inertia[4 * axis] = moments[axis];
            }
            body.w0 = [velocity, -velocity, velocity];
            let spin = Spin(Top(body.clone()));
            let stays = |name: &str, state: Result<State<Spin<Top<f64>>>, StepError>| {
                let off = distance(state.expect(name).x, body.r0);
                let said = format!("{name} {moments:?} {velocity:e}: {off:e}");
                assert!(off < 110.0 * f64::EPSILON, "{said}");
            };
            for &method in BaselineMethod::ALL {
                stays(&format!("{method:?}"), run(&spin, method, 10.0, 10));
            }
            stays("slide", run(&spin, Slide, 10.0, 10));
            stays("Buss", run(&spin, Buss::Fourth, 10.0, 10));
        }
    }
}

#[test]
fn a_state_of_nan_is_an_error() {
    let mut top = kovalevskaya();
    top.0.w0[1] = f64::NAN;
    let none = |_: f64, _: &_, _: &_| [];
    let refused = Err(StepError::NonFinite { time: 0.0 });
    let mut state = State::start(&top);
    for method in BaselineMethod::ALL {
        assert_eq!(
            hamel::step(&top, method, &mut state, 0.1, &none),
            refused,
            "{method:?}"
        );
    }
    assert_eq!(hamel::step(&top, Slide, &mut state, 0.1, &none), refused);
    assert_eq!(
        hamel::step(&top, Buss::Fourth, &mut state, 0.1, &none),
        refused
    );
}

/// In runs of 50 steps, the force at the end of a step is reused at the start of the next, bit by bit.
#[test]
fn a_run_by_buss_evaluates_the_force_between_two_steps_once() -> Result<(), StepError> {
    const STEPS: u32 = 50;
    let top = kovalevskaya();
    let count = Cell::new(0);
    let inputs = |_: f64, _: &_, _: &_| {
        count.set(count.get() + 1);
        []
    };
    let mut together = State::start(&top);
    hamel::integrate(&top, Buss::Fourth, &mut together, 0.04, 2.0, inputs, |_| {})?;
    assert_eq!(count.take(), STEPS + 1);
    let mut stepped = State::start(&top);
    for _ in 0..STEPS {
        hamel::step(&top, Buss::Fourth, &mut stepped, 0.04, &inputs)?;
    }
    assert_eq!(count.get(), STEPS * 2);
    assert_eq!((together.x, together.xi), (stepped.x, stepped.xi));
    Ok(())
}
