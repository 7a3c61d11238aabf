//! Errors and orders of the methods for bodies in potentials, and of the Gauss methods.
//!
//! Expected errors are measurements of an independent prototype of the same method with the same steps; a correct
//! implementation reproduces them to about 5 %.

use hamel::flows::Flow;
use hamel::methods::{Gauss4, Gauss6, Lgvi, Scheme, Splitting, free};
use hamel::{Method, State, StepError};
use hamel_cases::by_hand::{Reference, Spin, Top, distance, run, slopes};
use hamel_engine::baselines::{Buss, Slide};

/// Relative tolerance of a measured error.
const ERROR_TOLERANCE: f64 = 0.10;
/// Tolerance as a factor if the expected error is below 1e-9, near rounding.
const ROUNDING_FACTOR: f64 = 3.0;

const TOPS: [(&str, f64, u32); 3] = [
    ("heavy-top-benchmark-150", 1.0, 2000),
    ("kovalevskaya-top", 20.0, 2000),
    ("lagrange-fast-top", 5.0, 16000),
];
const SPINS: [(&str, f64, u32); 3] = [
    ("free-dzhanibekov-1e-3", 100.0, 2000),
    ("free-elongated-1000", 5.0, 16000),
    ("free-fast-spin-1000", 0.5, 16000),
];

fn top_error<M: Method<Top<f64>>>(
    case: &str,
    until: f64,
    n: u32,
    method: impl Fn(&Top<f64>) -> M,
) -> f64 {
    let reference = Reference::read(case);
    let top = Top(reference.body());
    let state = run(&top, method(&top), until, n).expect(case);
    distance(state.x, reference.sample(until, "R"))
}

fn spin_error<M: Method<Spin<Top<f64>>>>(
    case: &str,
    until: f64,
    n: u32,
    method: impl Fn(&Spin<Top<f64>>) -> M,
) -> f64 {
    let reference = Reference::read(case);
    let top = Spin(Top(reference.body()));
    let state = run(&top, method(&top), until, n).expect(case);
    distance(state.x, reference.sample(until, "R"))
}

/// Asserts the expected errors of R, in the order of [`TOPS`] and [`SPINS`]; zero where rounding hides them.
macro_rules! assert_sizes {
    ($what:expr, $method:expr, $tops:expr, $spins:expr) => {
        let tops: [f64; 3] = $tops;
        let spins: [f64; 3] = $spins;
        for ((case, until, n), expected) in TOPS.into_iter().zip(tops) {
            if expected > 0.0 {
                compare($what, case, top_error(case, until, n, $method), expected);
            }
        }
        for ((case, until, n), expected) in SPINS.into_iter().zip(spins) {
            if expected > 0.0 {
                compare($what, case, spin_error(case, until, n, $method), expected);
            }
        }
    };
}

fn compare(what: &str, case: &str, error: f64, expected: f64) {
    println!("{what}, {case}: {error:.3e}, expected {expected:.2e}");
    if expected >= 1e-9 {
        assert!(
            (error / expected - 1.0).abs() <= ERROR_TOLERANCE,
            "{what}, {case}: {error:e}"
        );
    } else {
        assert!(
            error <= ROUNDING_FACTOR * expected,
            "{what}, {case}: {error:e}"
        );
    }
}

#[test]
fn sizes_of_the_variational_integrator() {
    assert_sizes!(
        "LGVI",
        |_| Lgvi,
        [2.00e-1, 1.43e-3, 9.1e-1],
        [6.40e-2, 9.1e-1, 1.15e-1]
    );
}

#[test]
fn sizes_of_splitting_by_turns_about_axes() {
    assert_sizes!(
        "axes",
        |top| Splitting::with_flow(top, Scheme::Strang, Flow::Axes),
        [4.21e-3, 1.58e-4, 4.71e-6],
        [4.32e-3, 4.59e-7, 5.93e-5]
    );
    assert_sizes!(
        "axes, Suzuki",
        |top| Splitting::with_flow(top, Scheme::Suzuki4, Flow::Axes),
        [4.76e-7, 1.15e-9, 0.0],
        [0.0, 0.0, 1.7e-8]
    );
}

#[test]
fn sizes_of_splitting_by_the_symmetric_flow() {
    assert_sizes!(
        "pair",
        |top| Splitting::with_flow(top, Scheme::Strang, Flow::Pair),
        [1.00e-6, 1.29e-4, 8.33e-7],
        [5.50e-4, 9.18e-7, 1.30e-4]
    );
    assert_sizes!(
        "symmetric, Suzuki",
        |top| Splitting::with_flow(top, Scheme::Suzuki4, Flow::Pair),
        [1e-12, 1.89e-10, 2e-12],
        [0.0; 3]
    );
}

#[test]
fn sizes_of_collocation() {
    assert_sizes!(
        "Gauss 4",
        |_| Gauss4,
        [4.32e-6, 6.28e-10, 3.56e-6],
        [1.8e-7, 3.26e-5, 1.07e-7]
    );
    assert_sizes!("Gauss 6", |_| Gauss6, [1.56e-10, 0.0, 7.8e-11], [0.0; 3]);
}

#[test]
fn sizes_of_baselines() {
    assert_sizes!(
        "Buss augmented 2",
        |_| Buss::AugmentedSecond,
        [2.02e-4, 2.31e-5, 2.4e-4],
        [2.8, 4.7e-5, 2.8]
    );
    assert_sizes!(
        "Buss 4",
        |_| Buss::Fourth,
        [3.38e-7, 1.29e-4, 8.4e-7],
        [6.9e-3, 4.0e-6, 4.7e-6]
    );
}

/// Smaller errors show rounding in the slopes.
const MIN_CLEAN_ERROR: f64 = 5e-13;

/// Asserts the slopes of errors between halvings, as far as they exceed rounding.
fn assert_order(what: &str, errors: &[f64], order: f64, tolerance: f64) {
    let clean: Vec<f64> = errors
        .iter()
        .copied()
        .filter(|e| *e > MIN_CLEAN_ERROR)
        .collect();
    assert!(clean.len() >= 3, "{what}: {errors:?}");
    let slopes = slopes(&clean);
    println!("{what}: errors {errors:?}, slopes {slopes:.3?}");
    for slope in slopes {
        assert!(
            (slope - order).abs() <= tolerance,
            "{what}: {slope} of {errors:?}"
        );
    }
}

/// Returns four errors with halved steps, from `coarsest` on, which give three slopes.
fn errors<M: Method<Top<f64>>>(
    case: (&str, f64),
    coarsest: u32,
    method: impl Fn(&Top<f64>) -> M,
) -> Vec<f64> {
    let of = |factor| top_error(case.0, case.1, coarsest * factor, &method);
    [1, 2, 4, 8].map(of).to_vec()
}

const BC: (&str, f64) = ("heavy-top-benchmark-150", 1.0);
const KOV: (&str, f64) = ("kovalevskaya-top", 20.0);

#[test]
fn orders_of_compositions() {
    for (scheme, flow, tolerance, bc, kov) in [
        (Scheme::Strang, Flow::Exact, 0.03, 250, 1000),
        (Scheme::Strang, Flow::Axes, 0.03, 4000, 1000),
        (Scheme::Suzuki4, Flow::Axes, 0.1, 1000, 250),
        (Scheme::Nystrom4, Flow::Exact, 0.1, 20, 400),
        (Scheme::KahanLi6, Flow::Axes, 0.2, 250, 125),
        (Scheme::Nystrom6, Flow::Exact, 0.2, 6, 50),
    ] {
        for (case, coarsest) in [(BC, bc), (KOV, kov)] {
            let method = |top: &Top<f64>| Splitting::with_flow(top, scheme, flow);
            let what = format!("{scheme:?}, {flow:?}, {}", case.0);
            let order = f64::from(scheme.order());
            assert_order(&what, &errors(case, coarsest, method), order, tolerance);
        }
    }
}

#[test]
fn a_flow_of_order_two_limits_nystrom_schemes() {
    let top = Top(Reference::read(KOV.0).body());
    let limited = Splitting::with_flow(&top, Scheme::Nystrom4, Flow::Axes);
    assert_eq!(Method::<Top<f64>>::order(&limited), 2);
    let errors = errors(KOV, 250, |_| limited);
    assert_order("Nystrom 4 by axes", &errors, 2.0, 0.03);
    // Symmetric rotors have an exact flow by composed rotations.
    let exact = Splitting::with_flow(&top, Scheme::Nystrom4, Flow::Turns);
    assert_eq!(Method::<Top<f64>>::order(&exact), 4);
}

#[test]
fn orders_of_the_variational_integrator_and_of_collocation() {
    for (case, lgvi, gauss4, gauss6) in [(BC, 8000, 1000, 250), (KOV, 1000, 250, 75)] {
        assert_order("LGVI", &errors(case, lgvi, |_| Lgvi), 2.0, 0.03);
        assert_order("Gauss 4", &errors(case, gauss4, |_| Gauss4), 4.0, 0.05);
        assert_order("Gauss 6", &errors(case, gauss6, |_| Gauss6), 6.0, 0.1);
    }
}

#[test]
fn orders_of_baselines() -> Result<(), StepError> {
    assert_order("slide", &errors(KOV, 4000, |_| Slide), 1.0, 0.1);
    // Compares free rotation with its closed form.
    let mut body = Reference::read("free-dzhanibekov-1e-3").body();
    body.w0 = [0.4, -0.7, 1.1];
    let top = Spin(Top(body));
    let exact = free::at(&top, &State::start(&top), 2.0)?;
    for (method, order) in [
        (Buss::First, 1.0),
        (Buss::Second, 2.0),
        (Buss::AugmentedSecond, 2.0),
        (Buss::Fourth, 4.0),
    ] {
        let mut errors = Vec::new();
        for n in [200, 400, 800] {
            errors.push(distance(run(&top, method, 2.0, n)?.x, exact.x));
        }
        assert_order(&format!("{method:?}"), &errors, order, 0.15);
    }
    Ok(())
}

#[test]
fn stepped_splitting_passes_the_flips() {
    // The separatrix at a distance of 1e-6 amplifies the rounding of every step, so the bound is 1e-7.
    let (case, until, n) = SPINS[0];
    for (scheme, flow) in [
        (Scheme::KahanLi6, Flow::Axes),
        (Scheme::KahanLi6, Flow::Pair),
        (Scheme::Strang, Flow::Exact),
    ] {
        let method = |top: &Spin<Top<f64>>| Splitting::with_flow(top, scheme, flow);
        let error = spin_error(case, until, n, method);
        println!("{scheme:?}, {flow:?}: {error:e}");
        assert!(error <= 1e-7, "{scheme:?}, {flow:?}: {error:e}");
    }
}
