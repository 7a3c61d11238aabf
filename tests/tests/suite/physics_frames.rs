//! One body in many descriptions: the motion is independent of coordinates, velocities and frames.

use hamel::methods::Rkmk4;
use hamel::{State, System, s1, s3, so3};
use hamel_tests::double_pendulum_angles::{DoublePendulum, DoublePendulumParameters};
use hamel_tests::double_pendulum_circles::{CircleDoublePendulum, CircleDoublePendulumParameters};
use hamel_tests::free_body::{FreeBody, FreeBodyParameters};
use hamel_tests::free_body_no_wrench::FallingBody;
use hamel_tests::free_body_world::WorldBody;
use hamel_tests::free_body_world_velocity::WorldVelocityBody;
use hamel_tests::heavy_top::{HeavyTop, HeavyTopParameters};
use hamel_tests::heavy_top_axis::{AxisTop, AxisTopParameters};
use hamel_tests::heavy_top_quaternion::QuaternionTop;
use hamel_tests::heavy_top_world::WorldTop;
use hamel_tests::pendulum::{Pendulum, PendulumParameters};
use hamel_tests::pendulum_circle::{CirclePendulum, CirclePendulumParameters};
use hamel_tests::reference::{relative, run};
use hamel_tests::six_particles::SixParticles;

/// Duration of the compared motions, in s.
const UNTIL: f64 = 1.0;
/// Number of steps: h |ω| is below 4e-3, where the error of RKMK4 is below 1e-11.
const STEPS: u32 = 2000;
/// Method error of both motions, with margin; a wrong term gives 1e-3 and more.
const TOLERANCE: f64 = 1e-10;

type Vector = [f64; 3];
type Matrix = [f64; 9];

fn end<Sys: System>(system: &Sys, x: Sys::Coordinates, xi: Sys::Velocities) -> State<Sys> {
    let start = State { t: 0.0, x, xi };
    run(system, Rkmk4, start, UNTIL, STEPS).expect("a run without failure")
}

fn join<const A: usize, const B: usize, const C: usize>(a: [f64; A], b: [f64; B]) -> [f64; C] {
    assert_eq!(A + B, C);
    std::array::from_fn(|k| if k < A { a[k] } else { b[k - A] })
}

#[track_caller]
fn assert_same(what: &str, a: &[f64], b: &[f64]) {
    let difference = relative(a, b);
    println!("{what}: {difference:.1e}");
    assert!(difference <= TOLERANCE, "{what}: {a:?} against {b:?}");
}

/// The start of a free body, far from the identity: r, R, and v, ω in world axes.
fn pose() -> (Vector, Matrix) {
    ([0.4, -1.0, 2.0], so3::exp([0.7, -1.1, 0.6]))
}
const SPEED: Vector = [1.0, -2.0, 3.0];
const SPIN: Vector = [2.0, 3.0, -1.5];

/// Returns the motion of the free body with velocities in body axes, as (x, v and ω in world axes).
fn free_body(system: &FreeBody<f64>) -> ([f64; 12], Vector, Vector) {
    let (r, rotation) = pose();
    let body = |v| so3::apply_transpose(rotation, v);
    let end = end(system, join(r, rotation), join(body(SPEED), body(SPIN)));
    let rotation: Matrix = std::array::from_fn(|k| end.x[3 + k]);
    let [a, b, c, d, e, f] = end.xi;
    let world = |v| so3::apply(rotation, v);
    (end.x, world([a, b, c]), world([d, e, f]))
}

#[test]
fn free_body_in_world_and_body_axes() {
    let (x, v, w) = free_body(&FreeBody::default());
    let (r, rotation) = pose();

    let both = end(&WorldBody::default(), join(r, rotation), join(SPEED, SPIN));
    assert_same("world, x", &both.x, &x);
    assert_same("world, v", &both.xi[..3], &v);
    assert_same("world, ω", &both.xi[3..], &w);

    let spin = so3::apply_transpose(rotation, SPIN);
    let mixed = WorldVelocityBody::default();
    let mixed = end(&mixed, join(r, rotation), join(SPEED, spin));
    let rotation: Matrix = std::array::from_fn(|k| x[3 + k]);
    assert_same("mixed, x", &mixed.x, &x);
    assert_same("mixed, v", &mixed.xi[..3], &v);
    let spin = so3::apply_transpose(rotation, w);
    assert_same("mixed, ω", &mixed.xi[3..], &spin);
}

#[test]
fn no_wrench_is_a_wrench_of_zero() {
    let (x, v, w) = free_body(&FreeBody::default());
    let (r, rotation) = pose();
    let body = |v| so3::apply_transpose(rotation, v);
    let falling = FallingBody::default();
    let falling = end(&falling, join(r, rotation), join(body(SPEED), body(SPIN)));
    let rotation: Matrix = std::array::from_fn(|k| x[3 + k]);
    let body = |v| so3::apply_transpose(rotation, v);
    assert_same("x", &falling.x, &x);
    assert_same("ξ", &falling.xi, &join::<3, 3, 6>(body(v), body(w)));
}

/// KR18 (33): the body of six particles has the mass, the centre and the inertia of their sums.
#[test]
fn six_particles_are_a_body() {
    let particles = SixParticles::default();
    let a = particles.a();
    let masses = [
        particles.m1(),
        particles.m2(),
        particles.m3(),
        particles.m4(),
        particles.m5(),
        particles.m6(),
    ];
    let m: f64 = masses.iter().sum();
    let mut s = [0.0; 3];
    let mut theta = [[0.0; 3]; 3];
    for (k, mass) in masses.into_iter().enumerate() {
        let (axis, sign) = (k / 2, if k % 2 == 0 { 1.0 } else { -1.0 });
        s[axis] += mass * sign * a / m;
        for other in (0..3).filter(|i| *i != axis) {
            theta[other][other] += mass * a * a;
        }
    }
    let body = FreeBody::new(FreeBodyParameters {
        m,
        g: particles.g(),
        s,
        theta,
    })
    .expect("a body");
    let (x, v, w) = free_body(&body);

    let (r, rotation) = pose();
    let axes = |v| so3::apply_transpose(rotation, v);
    let end = end(&particles, join(r, rotation), join(axes(SPEED), axes(SPIN)));
    let rotation: Matrix = std::array::from_fn(|k| x[3 + k]);
    let axes = |v| so3::apply_transpose(rotation, v);
    assert_same("x", &end.x, &x);
    assert_same("ξ", &end.xi, &join::<3, 3, 6>(axes(v), axes(w)));
}

#[test]
fn heavy_top_in_three_descriptions() {
    let r0 = so3::exp([0.4, -0.9, 0.3]);
    let w0 = [0.3, 0.2, 5.0];
    let body = end(&HeavyTop::default(), r0, w0);
    let spin = so3::apply(body.x, body.xi);

    let world = end(&WorldTop::default(), r0, so3::apply(r0, w0));
    assert_same("world axes, R", &world.x, &body.x);
    assert_same("world axes, ω", &world.xi, &spin);

    let quaternion = end(&QuaternionTop::default(), s3::from_matrix(r0), w0);
    assert_same("quaternion, R", &s3::to_matrix(quaternion.x), &body.x);
    assert_same("quaternion, ω", &quaternion.xi, &body.xi);
}

/// The top specialised to principal axes and a centre of mass on one of them, and the general one with these numbers.
#[test]
fn top_on_its_axis_is_a_top() {
    let (r0, w0) = (so3::exp([0.4, -0.9, 0.3]), [0.5, 3.0, -2.0]);
    let axis = AxisTop::new(AxisTopParameters {
        m: 1.5,
        g: 9.81,
        l: 0.4,
        j1: 0.9,
        j2: 0.3,
        j3: 0.8,
    })
    .expect("a top");
    let theta = [[0.9, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.8]];
    let general = HeavyTop::new(HeavyTopParameters {
        m: 1.5,
        g: 9.81,
        s: [0.0, 0.4, 0.0],
        theta,
    })
    .expect("a top");
    let (axis, general) = (end(&axis, r0, w0), end(&general, r0, w0));
    assert_same("R", &axis.x, &general.x);
    assert_same("ω", &axis.xi, &general.xi);
}

/// The motion of a free body is independent of whether its frame is at the centre of mass.
#[test]
fn free_body_does_not_depend_on_the_place_of_its_frame() {
    let body = FreeBody::default();
    let (m, s, about_origin) = (body.m(), body.s(), body.theta());
    let about_centre = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let square = if i == j { so3::dot(s, s) } else { 0.0 };
            about_origin[i][j] - m * (square - s[i] * s[j])
        })
    });
    let central = FreeBody::new(FreeBodyParameters {
        m,
        g: body.g(),
        s: [0.0; 3],
        theta: about_centre,
    })
    .expect("a body");
    let (r, rotation) = pose();
    let arm = so3::apply(rotation, s);
    let turning = so3::cross(SPIN, arm);
    let axes = |v| so3::apply_transpose(rotation, v);
    let start: Vector = std::array::from_fn(|i| r[i] + arm[i]);
    let speed = std::array::from_fn(|i| SPEED[i] + turning[i]);
    let central = end(
        &central,
        join(start, rotation),
        join(axes(speed), axes(SPIN)),
    );

    let (x, _, w) = free_body(&body);
    let rotation: Matrix = std::array::from_fn(|k| x[3 + k]);
    let arm = so3::apply(rotation, s);
    let centre: Vector = std::array::from_fn(|i| x[i] + arm[i]);
    assert_same("centre of mass", &central.x[..3], &centre);
    assert_same("R", &central.x[3..], &rotation);
    assert_same("ω", &central.xi[3..], &so3::apply_transpose(rotation, w));
}

#[test]
fn double_pendulum_in_angles_and_on_circles() {
    let (theta, rates) = ([2.0, -0.7], [1.5, -2.0]);
    let angles = DoublePendulum::new(DoublePendulumParameters {
        m1: 1.1,
        m2: 0.7,
        l1: 0.9,
        l2: 0.6,
        g: 9.81,
    })
    .expect("a pendulum");
    let circles = CircleDoublePendulum::new(CircleDoublePendulumParameters {
        m1: 1.1,
        m2: 0.7,
        l1: 0.9,
        l2: 0.6,
        g: 9.81,
    })
    .expect("a pendulum");
    let angles = end(&angles, theta, rates);
    let [a, b] = theta.map(s1::exp);
    let circles = end(&circles, join(a, b), rates);
    let [a, b] = angles.x.map(s1::exp);
    assert_same("x", &circles.x, &join::<2, 2, 4>(a, b));
    assert_same("ξ", &circles.xi, &angles.xi);
}

#[test]
fn pendulum_with_raw_coordinates_and_on_a_circle() {
    let raw = Pendulum::new(PendulumParameters {
        m: 1.3,
        l: 0.6,
        g: 9.81,
        d: 0.2,
    })
    .expect("a pendulum");
    let circle = CirclePendulum::new(CirclePendulumParameters {
        m: 1.3,
        l: 0.6,
        g: 9.81,
        d: 0.2,
    })
    .expect("a pendulum");
    let x0 = s1::exp(2.0);
    let (raw, circle) = (end(&raw, x0, [1.0]), end(&circle, x0, [1.0]));
    assert_same("x", &raw.x, &circle.x);
    assert_same("ξ", &raw.xi, &circle.xi);
}
