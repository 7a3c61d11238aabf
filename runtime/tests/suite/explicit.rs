//! Orders and error sizes of the explicit methods, against reference solutions.
//!
//! Expected sizes are measurements of an independent prototype of the same method with the same steps;
//! a correct implementation gives them to about 5 %.

use crate::common::{Body, FreeBody, QuaternionTop, Reference, Top, distance, relative, slopes};
use crate::size::size;
use hamel::methods::General;
use hamel::methods::tableau::{Rkmk, Row, Tableau};
use hamel::{Method, State, System, integrate, s3};

/// How far an error may be from the expected one.
const SIZE: f64 = 0.10;
/// The same as a factor where rounding takes part, below 1e-9.
const SMALL: f64 = 3.0;
/// What rounding alone leaves, in whatever order an implementation adds.
const ROUNDING: f64 = 1e-11;
/// The same near a separatrix, which magnifies it by 10⁷: a bound.
const SEPARATRIX: f64 = 3e-9;
/// Errors above are not small, errors below have rounding in them: no slope is taken there.
const ASYMPTOTIC: std::ops::Range<f64> = 1e-10..5e-2;

fn assert_size(what: &str, error: f64, expected: f64) {
    println!("{what}: {error:.3e}, expected {expected:.2e}");
    let ratio = error / expected;
    let fits = if expected == SEPARATRIX {
        error <= SEPARATRIX
    } else if expected < 1e-9 {
        // Nearer to the truth than the prototype is no fault.
        error < SMALL * expected.max(ROUNDING)
    } else {
        (ratio - 1.0).abs() <= SIZE
    };
    assert!(fits, "{what}: error {error:e}, expected {expected:e}");
}

fn ends<Sys: System>(system: &Sys, method: impl Method<Sys>, until: f64, n: u32) -> State<Sys> {
    let mut state = State::start(system);
    let none = |_, _: &_, _: &_| system.zero_inputs();
    let step = until / f64::from(n);
    integrate(system, method, &mut state, step, until, none, |_| {}).expect("a run");
    state
}

/// Error of R (Frobenius) of a body with a fixed point.
fn top_error(case: &str, method: impl Method<Top<f64>>, until: f64, n: u32) -> f64 {
    let reference = Reference::read(case);
    let state = ends(&Top(reference.body()), method, until, n);
    distance(state.x, reference.sample(until, "R"))
}

/// Largest error over the fields of a free body.
fn free_body_error(case: &str, method: General, until: f64, n: u32) -> f64 {
    let reference = Reference::read(case);
    let system: FreeBody = reference.free_body();
    let force: [f64; 3] = reference.parameter("F").expect("F");
    let torque: [f64; 3] = reference.parameter("tau").expect("tau");
    let mut wrench = [0.0; 6];
    wrench[..3].copy_from_slice(&force);
    wrench[3..].copy_from_slice(&torque);
    let mut state = State::start(&system);
    let step = until / f64::from(n);
    integrate(
        &system,
        method,
        &mut state,
        step,
        until,
        |_, _, _| wrench,
        |_| {},
    )
    .expect(case);
    let vector = |values: &[f64], name| relative(values, &reference.sample::<3>(until, name));
    vector(&state.x[..3], "r")
        .max(relative(&state.x[3..], &reference.sample::<9>(until, "R")))
        .max(vector(&state.xi[..3], "v"))
        .max(vector(&state.xi[3..], "omega"))
}

#[test]
fn errors_of_tops_and_free_rotation() {
    use General::{Cf4, Rkmk8, Rkmk54};
    for (case, until, n, sizes) in [
        (
            "heavy-top-benchmark-150",
            1.0,
            2000,
            [2.75e-5, 2.11e-7, 7e-14],
        ),
        ("kovalevskaya-top", 20.0, 2000, [3.84e-9, 5.8e-12, 1e-13]),
        (
            "free-dzhanibekov-1e-3",
            100.0,
            2000,
            [4.52e-7, 3.5e-9, SEPARATRIX],
        ),
        ("lagrange-fast-top", 5.0, 16000, [1.66e-5, 3.27e-8, 1e-12]),
        ("free-elongated-1000", 5.0, 16000, [1.99e-4, 5.30e-7, 1e-11]),
        ("free-fast-spin-1000", 0.5, 16000, [2.40e-7, 4.5e-9, 8e-12]),
    ] {
        for (method, expected) in [Cf4, Rkmk54, Rkmk8].into_iter().zip(sizes) {
            let what = format!("{}, {case}", method.name());
            assert_size(&what, top_error(case, method, until, n), expected);
        }
    }
}

#[test]
fn errors_of_free_bodies() {
    for (case, fifth, eighth) in [
        (
            "free-body-offset-gravity",
            [4.54e-10, 1.4e-11],
            [5e-12, 2e-12, 5e-12],
        ),
        (
            "quadrotor-constant-wrench",
            [6.95e-9, 2.2e-10],
            [5.9e-11, 2e-12, 4e-12],
        ),
    ] {
        for (n, expected) in [1000, 2000].into_iter().zip(fifth) {
            let error = free_body_error(case, General::Rkmk54, 10.0, n);
            assert_size(&format!("rkmk54, {case}, {n}"), error, expected);
        }
        for (n, expected) in [250, 500, 1000].into_iter().zip(eighth) {
            let error = free_body_error(case, General::Rkmk8, 10.0, n);
            assert_size(&format!("rkmk8, {case}, {n}"), error, expected);
        }
    }
}

/// The orders that neighbouring errors show, where errors are neither large nor rounding.
fn assert_order(what: &str, errors: &[f64], order: f64, within: f64) {
    let range = |error: &f64| ASYMPTOTIC.contains(error);
    let clean: Vec<f64> = errors.iter().copied().filter(range).collect();
    let slopes = slopes(&clean);
    println!("{what}: {errors:?}, slopes {slopes:.3?}");
    assert!(slopes.len() >= 2, "{what}: {errors:?}");
    for slope in slopes {
        assert!(
            (slope - order).abs() <= within,
            "{what}: slope {slope} of {errors:?}"
        );
    }
}

#[test]
fn orders_on_the_benchmark_top_and_on_kovalevskayas() {
    for (method, order, within, benchmark, kovalevskaya) in [
        (General::Cf4, 4.0, 0.1, 2000, 1000),
        (General::Rkmk54, 5.0, 0.15, 1000, 250),
        (General::Rkmk8, 8.0, 0.7, 125, 25),
    ] {
        for (case, until, coarsest) in [
            ("heavy-top-benchmark-150", 1.0, benchmark),
            ("kovalevskaya-top", 20.0, kovalevskaya),
        ] {
            let errors = [1, 2, 4, 8].map(|f| top_error(case, method, until, f * coarsest));
            assert_order(
                &format!("{}, {case}", method.name()),
                &errors,
                order,
                within,
            );
        }
    }
}

#[test]
fn the_implicit_methods_of_euler_have_order_one() {
    let until = size(5, 20).min(20) as u32;
    for method in [General::BackwardEuler, General::SemiImplicitEuler] {
        let errors = [1, 2, 4].map(|f| {
            top_error(
                "kovalevskaya-top",
                method,
                f64::from(until),
                f * 2_000 * until,
            )
        });
        assert_order(method.name(), &errors, 1.0, 0.1);
    }
}

#[test]
fn quaternions_and_matrices_agree() {
    let reference = Reference::read("kovalevskaya-top");
    for method in General::ALL.iter().copied() {
        if let General::Rk4 { .. } = method {
            continue; // on the entries: other errors
        }
        let unit = ends(&QuaternionTop(reference.body()), method, 2.0, 200);
        let matrix = ends(&Top(reference.body()), method, 2.0, 200);
        let difference = distance(s3::to_matrix(unit.x), matrix.x);
        // The same chart: rounding, and what ends the iteration of the implicit method.
        assert!(difference < 1e-11, "{}: {difference:e}", method.name());
    }
}

#[test]
fn any_tableau_can_be_run() {
    /// The classical tableau.
    static CLASSICAL: Tableau<4> = Tableau {
        order: 4,
        rows: [
            Row {
                node: 0.0,
                weights: &[],
            },
            Row {
                node: 0.5,
                weights: &[(0, 0.5)],
            },
            Row {
                node: 0.5,
                weights: &[(1, 0.5)],
            },
            Row {
                node: 1.0,
                weights: &[(2, 1.0)],
            },
        ],
        closing: &[
            (0, 1.0 / 6.0),
            (1, 1.0 / 3.0),
            (2, 1.0 / 3.0),
            (3, 1.0 / 6.0),
        ],
    };
    let system = Top(Reference::read("kovalevskaya-top").body());
    let by_table = ends(&system, Rkmk(&CLASSICAL), 2.0, 200);
    let by_hand = ends(&system, General::Rkmk4, 2.0, 200);
    assert!(distance(by_table.x, by_hand.x) < 1e-13);
    assert!(distance(by_table.xi, by_hand.xi) < 1e-13);
    assert_eq!(Method::<Top<f64>>::order(&Rkmk(&CLASSICAL)), 4);
}

#[test]
fn single_precision_reaches_its_own_rounding() {
    let double = Reference::read("kovalevskaya-top").body();
    let single = Top(Body {
        inertia: double.inertia.map(|v| v as f32),
        m: double.m as f32,
        s: double.s.map(|v| v as f32),
        g: double.g.map(|v| v as f32),
        r0: double.r0.map(|v| v as f32),
        w0: double.w0.map(|v| v as f32),
    });
    for method in [General::Cf4, General::Rkmk54, General::Rkmk8] {
        let wide = ends(&Top(double.clone()), method, 5.0, 500);
        let narrow = ends(&single, method, 5.0, 500);
        let error = distance(narrow.x.map(f64::from), wide.x);
        // 500 steps of a few roundings of 6e-8 each, amplified by the motion.
        assert!(error < 1e-4, "{}: {error:e}", method.name());
        assert!(single.constraint_norm(&narrow.x) < 1e-6);
    }
}

#[test]
fn names_are_unique_and_found() {
    for method in General::ALL.iter().copied() {
        assert_eq!(General::named(method.name()), Some(method));
    }
    assert_eq!(General::named("rkmk5"), None);
}
