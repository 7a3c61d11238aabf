//! Generated systems against reference solutions computed in 240-bit arithmetic.
//!
//! Expected sizes are errors of an independent implementation of the same method with the same steps,
//! of systems written by hand; a correct one gives them to about 5 %. A wrong term gives errors of
//! order 1.

use hamel::methods::General;
use hamel::{State, System, integrate, so3};
use hamel_tests::double_pendulum_angles::DoublePendulum;
use hamel_tests::double_pendulum_circles::CircleDoublePendulum;
use hamel_tests::free_body::FreeBody;
use hamel_tests::heavy_top::HeavyTop;
use hamel_tests::heavy_top_axis::AxisTop;
use hamel_tests::heavy_top_quaternion::QuaternionTop;
use hamel_tests::heavy_top_world::WorldTop;
use hamel_tests::principal_axes::PrincipalAxes;
use hamel_tests::reference::{Reference, distance, relative, run};
use hamel_tests::satellite::Satellite;
use hamel_tests::two_bodies::TwoBodies;

/// How far a measured error may be from the expected one.
const SIZE: f64 = 0.10;

fn assert_size(what: &str, error: f64, expected: f64) {
    println!("{what}: {error:.3e}, expected {expected:.2e}");
    assert!(
        (error / expected - 1.0).abs() <= SIZE,
        "{what}: error {error:e}, expected {expected:e}"
    );
}

/// Steps of one method over the whole of a case.
fn ends<Sys: System>(
    system: &Sys,
    x: Sys::Coordinates,
    xi: Sys::Velocities,
    until: f64,
    n: u32,
) -> State<Sys> {
    let start = State { t: 0.0, x, xi };
    run(system, General::Rkmk4, start, until, n).expect("a run without failure")
}

fn heavy_top(reference: &Reference) -> HeavyTop<f64> {
    let [m] = reference.parameter("m");
    let s = reference.parameter("s");
    HeavyTop::new(m, reference.gravity(), s, reference.matrix("J")).expect("a body")
}

fn principal_axes(reference: &Reference) -> PrincipalAxes<f64> {
    let [[j1, ..], [_, j2, _], [.., j3]] = reference.matrix("J");
    PrincipalAxes::new(j1, j2, j3).expect("a body")
}

/// Error of R (Frobenius) of a body with x = R, ξ = ω.
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
fn free_bodies_in_principal_axes() {
    for (case, until, n, expected) in [
        ("free-dzhanibekov-1e-3", 100.0, 2000, 4.27e-7),
        ("free-elongated-1000", 5.0, 16000, 1.99e-4),
        ("free-fast-spin-1000", 0.5, 16000, 2.23e-7),
    ] {
        let system = principal_axes(&Reference::read(case));
        assert_size(case, rotation_error(&system, case, until, n), expected);
    }
}

#[test]
fn benchmark_top_with_its_own_start() {
    // The model carries the parameters and the start of the benchmark.
    let case = "heavy-top-benchmark-150";
    let system = AxisTop::default();
    let end = run(&system, General::Rkmk4, State::start(&system), 1.0, 2000).expect(case);
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
        let system = QuaternionTop::new(m, reference.gravity(), s, reference.matrix("J"));
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

/// A bob on a rod whose inertia is made isotropic about the joint has ω̇ = n × g / l, n' = ω × n
/// (all in world axes): the spherical pendulum, without any pole.
#[test]
fn spherical_pendulum_through_the_poles() {
    let case = "spherical-pendulum-through-poles";
    let reference = Reference::read(case);
    let ([m], [l]) = (reference.parameter("m"), reference.parameter("l"));
    let isotropic =
        std::array::from_fn(|i| std::array::from_fn(|j| if i == j { m * l * l } else { 0.0 }));
    let system = WorldTop::new(m, reference.gravity(), [0.0, 0.0, l], isotropic).expect("a body");

    let x0: [f64; 3] = reference.initial("x");
    let v0: [f64; 3] = reference.initial("xdot");
    let n0 = x0.map(|x| x / l);
    let tilt = so3::cross([0.0, 0.0, 1.0], n0);
    let (sin, cos) = (so3::dot(tilt, tilt).sqrt(), n0[2]);
    let r0 = so3::exp(tilt.map(|t| t / sin * sin.atan2(cos)));
    let w0 = so3::cross(n0, v0).map(|w| w / l);
    for (n, expected) in [(1000, 7.38e-7), (2000, 3.21e-8), (4000, 1.57e-9)] {
        let end = ends(&system, r0, w0, 10.0, n);
        let x = so3::apply(end.x, [0.0, 0.0, l]);
        let v = so3::cross(end.xi, x);
        let error = relative(&x, &reference.sample::<3>(10.0, "x"));
        let error = error.max(relative(&v, &reference.sample::<3>(10.0, "xdot")));
        assert_size(case, error, expected);
    }
}

#[test]
fn free_bodies_off_their_centre_and_under_a_wrench() {
    for (case, expected) in [
        ("free-body-offset-gravity", [3.26e-7, 2.01e-8, 1.25e-9]),
        ("quadrotor-constant-wrench", [3.00e-6, 1.88e-7, 1.18e-8]),
    ] {
        let reference = Reference::read(case);
        let [m] = reference.parameter("m");
        let s = reference.parameter("s");
        let system = FreeBody::new(m, reference.gravity(), s, reference.matrix("Theta"));
        let system = system.expect("a body");
        let wrench = join(
            reference.parameter::<3>("F"),
            reference.parameter::<3>("tau"),
        );
        let x = join(reference.initial::<3>("r"), reference.initial::<9>("R"));
        let xi = join(reference.initial::<3>("v"), reference.initial::<3>("omega"));
        for (n, expected) in [1000, 2000, 4000].into_iter().zip(expected) {
            let mut end: State<FreeBody<f64>> = State { t: 0.0, x, xi };
            let step = 10.0 / f64::from(n);
            let inputs = |_, _: &_, _: &_| wrench;
            integrate(
                &system,
                General::Rkmk4,
                &mut end,
                step,
                10.0,
                inputs,
                |_| {},
            )
            .expect(case);
            let error = [
                relative(&end.x[..3], &reference.sample::<3>(10.0, "r")),
                relative(&end.x[3..], &reference.sample::<9>(10.0, "R")),
                relative(&end.xi[..3], &reference.sample::<3>(10.0, "v")),
                relative(&end.xi[3..], &reference.sample::<3>(10.0, "omega")),
            ];
            assert_size(case, error.into_iter().fold(0.0, f64::max), expected);
        }
    }
}

/// Two lists in a row.
fn join<const A: usize, const B: usize, const C: usize>(a: [f64; A], b: [f64; B]) -> [f64; C] {
    assert_eq!(A + B, C);
    std::array::from_fn(|k| if k < A { a[k] } else { b[k - A] })
}

#[test]
fn two_bodies_on_ball_joints() {
    let case = "two-bodies-ball-joints";
    let reference = Reference::read(case);
    let [m1, m2] = reference.parameter("m");
    let system = TwoBodies::new(
        m1,
        m2,
        reference.gravity(),
        reference.parameter("s1"),
        reference.parameter("s2"),
        reference.parameter("d"),
        reference.matrix("Theta1"),
        reference.matrix("Theta2"),
    )
    .expect("two bodies");
    let x = join(reference.initial::<9>("R1"), reference.initial::<9>("R2"));
    let xi = join(
        reference.initial::<3>("omega1"),
        reference.initial::<3>("omega2"),
    );
    for (n, expected) in [(1000, 8.84e-6), (2000, 5.62e-7), (4000, 4.12e-8)] {
        let end = ends(&system, x, xi, 5.0, n);
        let error = [
            relative(&end.x[..9], &reference.sample::<9>(5.0, "R1")),
            relative(&end.x[9..], &reference.sample::<9>(5.0, "R2")),
            relative(&end.xi[..3], &reference.sample::<3>(5.0, "omega1")),
            relative(&end.xi[3..], &reference.sample::<3>(5.0, "omega2")),
        ];
        assert_size(case, error.into_iter().fold(0.0, f64::max), expected);
    }
}

#[test]
fn satellite_under_gravity_gradient() {
    let case = "satellite-gravity-gradient";
    let reference = Reference::read(case);
    let [rate] = reference.parameter("orbit_rate_n");
    let [[j1, ..], [_, j2, _], [.., j3]] = reference.matrix("J");
    let system = Satellite::new(j1, j2, j3, rate).expect("a body");
    let until = 20000.0;
    for (n, expected) in [(1000, 1.77e-6), (2000, 1.81e-7), (4000, 1.36e-8)] {
        let (x, xi) = (reference.initial("R"), reference.initial("omega"));
        let mut end: State<Satellite<f64>> = State { t: 0.0, x, xi };
        let outward = |t: f64, _: &_, _: &_| [(rate * t).cos(), (rate * t).sin(), 0.0];
        let step = until / f64::from(n);
        integrate(
            &system,
            General::Rkmk4,
            &mut end,
            step,
            until,
            outward,
            |_| {},
        )
        .expect(case);
        let error = relative(&end.x, &reference.sample::<9>(until, "R"));
        let error = error.max(relative(&end.xi, &reference.sample::<3>(until, "omega")));
        assert_size(case, error, expected);
    }
}

/// Errors of the chaotic double pendulum: the coarse run has lost the motion, the fine one nearly so,
/// and both do it in the same way as the independent implementation.
const CHAOTIC: [(u32, f64); 2] = [(2000, 4.61), (4000, 0.366)];

#[test]
fn chaotic_double_pendulum_in_angles() {
    let reference = Reference::read("double-pendulum-planar-chaotic");
    let ([m1, m2], [l1, l2]) = (reference.parameter("m"), reference.parameter("l"));
    let system = DoublePendulum::new(m1, m2, l1, l2, reference.gravity()).expect("a pendulum");
    let (x, xi) = (reference.initial("theta"), reference.initial("thetadot"));
    for (n, expected) in CHAOTIC {
        let end = ends(&system, x, xi, 10.0, n);
        assert_size(
            "in angles",
            planar_error(&reference, &end.x, &end.xi),
            expected,
        );
    }
}

#[test]
fn chaotic_double_pendulum_on_circles() {
    let reference = Reference::read("double-pendulum-planar-chaotic");
    let ([m1, m2], [l1, l2]) = (reference.parameter("m"), reference.parameter("l"));
    let system =
        CircleDoublePendulum::new(m1, m2, l1, l2, reference.gravity()).expect("a pendulum");
    let [a, b] = reference.initial::<2>("theta").map(hamel::s1::exp);
    let (x, xi) = (join(a, b), reference.initial("thetadot"));
    for (n, expected) in CHAOTIC {
        let mut end = State { t: 0.0, x, xi };
        // The circle forgets the turns that the reference counts: unwind them step by step.
        let mut theta = reference.initial::<2>("theta");
        let step = 10.0 / f64::from(n);
        let inputs = |_, _: &_, _: &_| [];
        integrate(
            &system,
            General::Rkmk4,
            &mut end,
            step,
            10.0,
            inputs,
            |state| {
                for (k, theta) in theta.iter_mut().enumerate() {
                    let (c, s) = (state.x[2 * k], state.x[2 * k + 1]);
                    let (sin, cos) = theta.sin_cos();
                    *theta += (cos * s - sin * c).atan2(cos * c + sin * s);
                }
            },
        )
        .expect("a run without failure");
        assert_size(
            "on circles",
            planar_error(&reference, &theta, &end.xi),
            expected,
        );
    }
}

/// Largest error over the state of the planar double pendulum at t = 10.
fn planar_error(reference: &Reference, theta: &[f64], rates: &[f64]) -> f64 {
    let theta = relative(theta, &reference.sample::<2>(10.0, "theta"));
    theta.max(relative(rates, &reference.sample::<2>(10.0, "thetadot")))
}

/// A body that turns about its middle axis flips over at the half period of the closed form, and comes
/// back after the whole one.
#[test]
fn flips_come_when_the_closed_form_says() {
    /// Error of the method at these steps, 1e-9, with margin.
    const FLIP: f64 = 1e-8;
    let reference = Reference::read("free-dzhanibekov-1e-3");
    let system = principal_axes(&reference);
    let (r0, w0) = (reference.initial("R"), reference.initial::<3>("omega"));
    let half = reference.extra("half_period_between_flips");
    let flipped = ends(&system, r0, w0, half, 2000);
    let back = ends(&system, r0, w0, 2.0 * half, 4000);
    println!("{:?} {:?}", flipped.xi, back.xi);
    assert!((flipped.xi[1] + w0[1]).abs() < FLIP, "{:?}", flipped.xi);
    assert!(distance(&back.xi, &w0) < FLIP, "{:?}", back.xi);
}
