//! Errors and orders against reference solutions.
//!
//! Expected sizes are measurements of an independent prototype of the same method with the same steps;
//! a correct implementation gives them to about 5 %.

use crate::common::{FreeBody, QuaternionTop, Reference, Top, distance, relative, run, slopes};
use hamel::methods::General;
use hamel::{State, StepError, System, integrate, s3};

/// How far a measured error may be from the expected one.
const SIZE: f64 = 0.10;
/// How far a slope may be from the order.
const SLOPE: f64 = 0.1;

fn assert_size(what: &str, error: f64, expected: f64) {
    println!("{what}: {error:.3e}, expected {expected:.2e}");
    assert!(
        (error / expected - 1.0).abs() <= SIZE,
        "{what}: error {error:e}, expected {expected:e}"
    );
}

fn assert_order(what: &str, errors: &[f64], order: f64) {
    let slopes = slopes(errors);
    println!("{what}: errors {errors:?}, slopes {slopes:.3?}");
    for slope in slopes {
        assert!(
            (slope - order).abs() <= SLOPE,
            "{what}: slope {slope} of {errors:?}"
        );
    }
}

/// Error of R (Frobenius) of a body with a fixed point.
fn top_error(case: &str, method: General, until: f64, n: u32) -> f64 {
    let reference = Reference::read(case);
    let state = run(&Top(reference.body()), method, until, n).expect(case);
    assert_eq!(state.t, until);
    distance(state.x, reference.sample(until, "R"))
}

/// Largest error over the fields of a free body, and the state it ends in.
fn free_body_error(case: &str, until: f64, n: u32) -> f64 {
    let reference = Reference::read(case);
    let system: FreeBody = reference.free_body();
    let force: [f64; 3] = reference.parameter("F").expect("F");
    let torque: [f64; 3] = reference.parameter("tau").expect("tau");
    let wrench = [
        force[0], force[1], force[2], torque[0], torque[1], torque[2],
    ];
    let mut state = State::start(&system);
    let step = until / f64::from(n);
    integrate(
        &system,
        General::Rkmk4,
        &mut state,
        step,
        until,
        |_, _, _| wrench,
        |_| {},
    )
    .expect(case);
    let fields: [(&[f64], &str); 4] = [
        (&state.x[..3], "r"),
        (&state.x[3..], "R"),
        (&state.xi[..3], "v"),
        (&state.xi[3..], "omega"),
    ];
    fields
        .into_iter()
        .map(|(values, name)| match values.len() {
            3 => relative(values, &reference.sample::<3>(until, name)),
            _ => relative(values, &reference.sample::<9>(until, name)),
        })
        .fold(0.0, f64::max)
}

#[test]
fn rkmk4_error_of_tops_and_free_rotation() {
    for (case, until, n, expected) in [
        ("heavy-top-benchmark-150", 1.0, 2000, 2.75e-5),
        ("kovalevskaya-top", 20.0, 2000, 3.70e-9),
        ("free-dzhanibekov-1e-3", 100.0, 2000, 4.27e-7),
        ("lagrange-fast-top", 5.0, 16000, 1.68e-5),
        ("free-elongated-1000", 5.0, 16000, 1.99e-4),
        ("free-fast-spin-1000", 0.5, 16000, 2.23e-7),
    ] {
        assert_size(case, top_error(case, General::Rkmk4, until, n), expected);
    }
}

#[test]
fn rkmk4_error_of_free_bodies() {
    for (case, expected) in [
        ("free-body-offset-gravity", [3.26e-7, 2.01e-8, 1.25e-9]),
        ("quadrotor-constant-wrench", [3.00e-6, 1.88e-7, 1.18e-8]),
    ] {
        for (n, expected) in [1000, 2000, 4000].into_iter().zip(expected) {
            assert_size(case, free_body_error(case, 10.0, n), expected);
        }
    }
}

#[test]
fn rkmk4_has_order_four() {
    for (case, until) in [("heavy-top-benchmark-150", 1.0), ("kovalevskaya-top", 20.0)] {
        let coarsest = if until < 2.0 { 2000 } else { 1000 };
        let errors = [1, 2, 4, 8].map(|f| top_error(case, General::Rkmk4, until, f * coarsest));
        // Rounding shows below 1e-12: leave such errors out of the slopes.
        let clean: Vec<f64> = errors.into_iter().filter(|e| *e > 1e-11).collect();
        assert!(clean.len() >= 3, "{case}: {errors:?}");
        assert_order(case, &clean, 4.0);
    }
}

#[test]
fn rkmk4_on_quaternions_equals_rkmk4_on_matrices() {
    for (case, until, n, expected) in [
        ("heavy-top-benchmark-150", 1.0, 2000, 2.75e-5),
        ("kovalevskaya-top", 20.0, 2000, 3.70e-9),
    ] {
        let reference = Reference::read(case);
        let by_quaternion = run(&QuaternionTop(reference.body()), General::Rkmk4, until, n);
        let by_matrix = run(&Top(reference.body()), General::Rkmk4, until, n).expect(case);
        let r = s3::to_matrix(by_quaternion.expect(case).x);
        assert_size(case, distance(r, reference.sample(until, "R")), expected);
        // The same chart: the two differ by rounding, amplified by the motion.
        assert!(distance(r, by_matrix.x) < 1e-11, "{case}");
    }
}

#[test]
fn rk4_on_entries_keeps_order_four_when_stabilised() {
    for method in [0.0, 10.0].map(|lambda| General::Rk4 { lambda }) {
        for (case, until, coarsest) in [
            ("heavy-top-benchmark-150", 1.0, 4000),
            ("kovalevskaya-top", 20.0, 2000),
        ] {
            let errors = [1, 2, 4].map(|f| top_error(case, method, until, f * coarsest));
            assert_order(&format!("{method:?}, {case}"), &errors, 4.0);
        }
    }
}

#[test]
fn stabilisation_like_one_over_h_costs_two_orders() {
    let errors = [500, 1000, 2000, 4000].map(|n| {
        let lambda = 1.0 / (20.0 / f64::from(n));
        top_error("kovalevskaya-top", General::Rk4 { lambda }, 20.0, n)
    });
    println!("{errors:?} {:?}", slopes(&errors));
    assert!(slopes(&errors).into_iter().all(|slope| slope < 3.0));
}

#[test]
fn stabilisation_decays_a_defect_exponentially() -> Result<(), StepError> {
    let system = QuaternionTop(Reference::read("kovalevskaya-top").body());
    let mut state = State::start(&system);
    state.x = state.x.map(|q| q * 1.001);
    let before = system.constraint_norm(&state.x);
    let method = General::Rk4 { lambda: 10.0 };
    integrate(&system, method, &mut state, 1e-3, 1.0, |_, _, _| [], |_| {})?;
    let after = system.constraint_norm(&state.x);
    // φ = q·q − 1 obeys φ̇ = −λ φ (1 + φ): exp(−λ t) but for terms of φ².
    assert!((after / before / (-10.0_f64).exp() - 1.0).abs() < 5e-3);
    // Backwards in time the defect decays as well.
    integrate(&system, method, &mut state, 1e-3, 0.0, |_, _, _| [], |_| {})?;
    assert!(system.constraint_norm(&state.x) < 1e-3 * after);
    Ok(())
}

#[test]
fn single_precision_reaches_its_own_rounding() {
    let reference = Reference::read("kovalevskaya-top");
    let double = reference.body();
    let system = Top(crate::common::Body {
        inertia: double.inertia.map(|v| v as f32),
        m: double.m as f32,
        s: double.s.map(|v| v as f32),
        g: double.g.map(|v| v as f32),
        r0: double.r0.map(|v| v as f32),
        w0: double.w0.map(|v| v as f32),
    });
    let state = run(&system, General::Rkmk4, 20.0, 2000).expect("a run of f32");
    let error = distance(state.x.map(f64::from), reference.sample(20.0, "R"));
    println!("f32: {error:e}");
    assert!(error < 2e-4);
    assert!(system.constraint_norm(&state.x) < 1e-6);
}
