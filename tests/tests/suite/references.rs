//! Compares generated systems with reference solutions computed in 240-bit arithmetic.
//!
//! Expected errors are those of an independent implementation of the same method with the same steps, for hand-written
//! systems; a correct one reproduces them to about 5 %. A wrong term gives errors of order 1.

use hamel::methods::Rkmk4;
use hamel::{State, System, integrate};
use hamel_tests::double_pendulum_circles::{CircleDoublePendulum, CircleDoublePendulumParameters};
use hamel_tests::heavy_top::{HeavyTop, HeavyTopParameters};
use hamel_tests::heavy_top_axis::AxisTop;
use hamel_tests::heavy_top_quaternion::{QuaternionTop, QuaternionTopParameters};
use hamel_tests::principal_axes::{PrincipalAxes, PrincipalAxesParameters};
use hamel_tests::reference::{Reference, distance, relative, run};

/// Relative tolerance of a measured error.
const ERROR_TOLERANCE: f64 = 0.10;

fn assert_size(what: &str, error: f64, expected: f64) {
    println!("{what}: {error:.3e}, expected {expected:.2e}");
    assert!(
        (error / expected - 1.0).abs() <= ERROR_TOLERANCE,
        "{what}: error {error:e}, expected {expected:e}"
    );
}

/// Returns the final state of a case after `n` steps of RKMK4.
fn ends<Sys: System>(
    system: &Sys,
    x: Sys::Coordinates,
    xi: Sys::Velocities,
    until: f64,
    n: u32,
) -> State<Sys> {
    let start = State { t: 0.0, x, xi };
    run(system, Rkmk4, start, until, n).expect("a run without failure")
}

fn heavy_top(reference: &Reference) -> HeavyTop<f64> {
    let [m] = reference.parameter("m");
    let s = reference.parameter("s");
    HeavyTop::new(HeavyTopParameters {
        m,
        g: reference.gravity(),
        s,
        theta: reference.matrix("J"),
    })
    .expect("a body")
}

fn principal_axes(reference: &Reference) -> PrincipalAxes<f64> {
    let [[j1, ..], [_, j2, _], [.., j3]] = reference.matrix("J");
    PrincipalAxes::new(PrincipalAxesParameters { j1, j2, j3 }).expect("a body")
}

/// Returns the error of R (Frobenius) of a body with x = R, ξ = ω.
fn rotation_error<Sys>(system: &Sys, case: &str, until: f64, n: u32) -> f64
where
    Sys: System<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3]>,
{
    let reference = Reference::read(case);
    let (x, xi) = (reference.initial("R"), reference.initial("omega"));
    let end = ends(system, x, xi, until, n);
    distance(&end.x, &reference.sample::<9>(until, "R"))
}

#[test]
fn tops_in_body_axes() {
    for (case, until, n, expected) in [
        ("heavy-top-benchmark-150", 1.0, 2000, 2.75e-5),
        ("kovalevskaya-top", 20.0, 2000, 3.70e-9),
        ("lagrange-fast-top", 5.0, 16000, 1.68e-5),
    ] {
        let system = heavy_top(&Reference::read(case));
        assert_size(case, rotation_error(&system, case, until, n), expected);
    }
}

#[test]
fn benchmark_top_with_its_own_start() {
    // The model has the parameters and the start of the benchmark.
    let case = "heavy-top-benchmark-150";
    let system = AxisTop::default();
    let end = run(&system, Rkmk4, State::start(&system), 1.0, 2000).expect(case);
    let expected = Reference::read(case).sample::<9>(1.0, "R");
    assert_size(case, distance(&end.x, &expected), 2.75e-5);
}

#[test]
fn tops_on_quaternions() {
    for (case, until, n, expected) in [
        ("heavy-top-benchmark-150", 1.0, 2000, 2.75e-5),
        ("kovalevskaya-top", 20.0, 2000, 3.70e-9),
    ] {
        let reference = Reference::read(case);
        let [m] = reference.parameter("m");
        let s = reference.parameter("s");
        let system = QuaternionTop::new(QuaternionTopParameters {
            m,
            g: reference.gravity(),
            s,
            theta: reference.matrix("J"),
        });
        let system = system.expect("a body");
        let q = hamel::s3::from_matrix(reference.initial("R"));
        let end = ends(&system, q, reference.initial("omega"), until, n);
        let r = hamel::s3::to_matrix(end.x);
        assert_size(
            case,
            distance(&r, &reference.sample::<9>(until, "R")),
            expected,
        );
    }
}

/// Concatenates two lists.
fn join<const A: usize, const B: usize, const C: usize>(a: [f64; A], b: [f64; B]) -> [f64; C] {
    assert_eq!(A + B, C);
    std::array::from_fn(|k| if k < A { a[k] } else { b[k - A] })
}

/// Errors of the chaotic double pendulum: the coarse run has lost the motion, the fine one almost, both in the same way
/// as the independent implementation.
const CHAOTIC_ERRORS: [(u32, f64); 2] = [(2000, 4.61), (4000, 0.366)];

#[test]
fn chaotic_double_pendulum_on_circles() {
    let reference = Reference::read("double-pendulum-planar-chaotic");
    let ([m1, m2], [l1, l2]) = (reference.parameter("m"), reference.parameter("l"));
    let system = CircleDoublePendulum::new(CircleDoublePendulumParameters {
        m1,
        m2,
        l1,
        l2,
        g: reference.gravity(),
    })
    .expect("a pendulum");
    let [a, b] = reference.initial::<2>("theta").map(hamel::s1::exp);
    let (x, xi) = (join(a, b), reference.initial("thetadot"));
    for (n, expected) in CHAOTIC_ERRORS {
        let mut end = State { t: 0.0, x, xi };
        // Circles do not count turns as the reference does: unwind them step by step.
        let mut theta = reference.initial::<2>("theta");
        let step = 10.0 / f64::from(n);
        let inputs = |_, _: &_, _: &_| [];
        integrate(&system, Rkmk4, &mut end, step, 10.0, inputs, |state| {
            for (k, theta) in theta.iter_mut().enumerate() {
                let (c, s) = (state.x[2 * k], state.x[2 * k + 1]);
                let (sin, cos) = theta.sin_cos();
                *theta += (cos * s - sin * c).atan2(cos * c + sin * s);
            }
        })
        .expect("a run without failure");
        assert_size(
            "on circles",
            planar_error(&reference, &theta, &end.xi),
            expected,
        );
    }
}

/// Returns the largest error of the state of the planar double pendulum at t = 10.
fn planar_error(reference: &Reference, theta: &[f64], rates: &[f64]) -> f64 {
    let theta = relative(theta, &reference.sample::<2>(10.0, "theta"));
    theta.max(relative(rates, &reference.sample::<2>(10.0, "thetadot")))
}

/// A body that spins about its middle axis flips at half the period of the closed form, and returns after the whole
/// period.
#[test]
fn flips_come_when_the_closed_form_says() {
    /// Error of the method at these steps, 1e-9, with margin.
    const FLIP_TOLERANCE: f64 = 1e-8;
    let reference = Reference::read("free-dzhanibekov-1e-3");
    let system = principal_axes(&reference);
    let (r0, w0) = (reference.initial("R"), reference.initial::<3>("omega"));
    let half = reference.extra("half_period_between_flips");
    let flipped = ends(&system, r0, w0, half, 2000);
    let back = ends(&system, r0, w0, 2.0 * half, 4000);
    println!("{:?} {:?}", flipped.xi, back.xi);
    assert!(
        (flipped.xi[1] + w0[1]).abs() < FLIP_TOLERANCE,
        "{:?}",
        flipped.xi
    );
    assert!(distance(&back.xi, &w0) < FLIP_TOLERANCE, "{:?}", back.xi);
}
