//! Frames and groups beyond the standard ones: the same motion in frames with constant and with varying γ, bodies given
//! by their particles, rotors, the Heisenberg group.

use hamel::methods::Rkmk4;
use hamel::{State, System, so3};
use hamel_tests::body_with_rotor::BodyWithRotor;
use hamel_tests::gyrostat::Gyrostat;
use hamel_tests::heavy_top::{HeavyTop, HeavyTopParameters};
use hamel_tests::heisenberg::{Heisenberg, HeisenbergParameters};
use hamel_tests::planar_body::{PlanarBody, PlanarBodyParameters};
use hamel_tests::planar_world::{PlanarWorld, PlanarWorldParameters};
use hamel_tests::reference::run;
use hamel_tests::spherical_angles::{SphericalAngles, SphericalAnglesParameters};
use hamel_tests::spherical_orthonormal::{SphericalOrthonormal, SphericalOrthonormalParameters};
use hamel_tests::spinning_particles::SpinningParticles;

/// Duration of the compared motions, in s.
const UNTIL: f64 = 1.0;
/// Number of steps of methods of order four, whose errors are below 1e-11 at these speeds.
const STEPS: u32 = 4000;
/// Method error of both motions, with margin; a wrong term gives 1e-3 and more.
const TOLERANCE: f64 = 1e-10;

fn end<Sys: System>(system: &Sys, x: Sys::Coordinates, xi: Sys::Velocities) -> State<Sys> {
    let start = State { t: 0.0, x, xi };
    run(system, Rkmk4, start, UNTIL, STEPS).expect("a run without failure")
}

#[track_caller]
fn assert_near(what: &str, value: f64, expected: f64) {
    println!("{what}: {value} off by {:.1e}", value - expected);
    assert!(
        (value - expected).abs() <= TOLERANCE * expected.abs().max(1.0),
        "{what}: {value}, expected {expected}"
    );
}

/// The Christoffel symbols of q̇ and the γ of orthonormal velocities describe the same motion.
#[test]
fn spherical_frames_agree() {
    let (m, k) = (1.3, 2.1);
    let plain = SphericalAngles::new(SphericalAnglesParameters { m, k }).expect("a particle");
    let orthonormal =
        SphericalOrthonormal::new(SphericalOrthonormalParameters { m, k }).expect("a particle");
    let x = [0.9, 1.1, 0.4];
    let rates = [0.3, -0.5, 1.2];
    let speeds = |x: [f64; 3], q: [f64; 3]| [q[0], x[0] * q[1], x[0] * x[1].sin() * q[2]];
    let a = end(&plain, x, rates);
    let b = end(&orthonormal, x, speeds(x, rates));
    let speed = speeds(a.x, a.xi);
    for i in 0..3 {
        assert_near("coordinate", a.x[i], b.x[i]);
        assert_near("velocity", speed[i], b.xi[i]);
    }
    // The angular momentum about the axis, m (r sin θ)² φ̇.
    let about_axis = |x: [f64; 3], q: [f64; 3]| m * (x[0] * x[1].sin()).powi(2) * q[2];
    assert_near("momentum", about_axis(a.x, a.xi), about_axis(x, rates));
}

/// The left- and right-invariant frames of SE(2): the velocity of the body's frame in body axes, and the velocity of
/// the body's point at the world's origin.
#[test]
fn planar_frames_agree() {
    let (m, j, a, b) = (2.0, 0.4, 0.3, 0.1);
    let body = PlanarBody::new(PlanarBodyParameters { m, j, a, b, g: 0.0 }).expect("a body");
    let world = PlanarWorld::new(PlanarWorldParameters { m, j, a, b }).expect("a body");
    let angle = 0.7_f64;
    let x = [0.5, -0.2, angle.cos(), angle.sin()];
    // ṙ and θ̇
    let (u, v, w) = (0.6, -0.3, 1.4);
    let into_body = |x: [f64; 4], u: f64, v: f64| [x[2] * u + x[3] * v, x[2] * v - x[3] * u];
    let local = into_body(x, u, v);
    let left = end(&body, x, [local[0], local[1], w]);
    let right = end(&world, x, [u + w * x[1], v - w * x[0], w]);
    for i in 0..4 {
        assert_near("coordinate", left.x[i], right.x[i]);
    }
    let (x, xi) = (right.x, right.xi);
    let local = into_body(x, xi[0] - xi[2] * x[1], xi[1] + xi[2] * x[0]);
    for (i, expected) in [local[0], local[1], xi[2]].into_iter().enumerate() {
        assert_near("velocity", left.xi[i], expected);
    }
}

/// A body given by its particles moves as the top with their inertia.
#[test]
fn particles_make_a_top() {
    let system = SpinningParticles::default();
    let particles = [
        (system.m1(), system.p1()),
        (system.m2(), system.p2()),
        (system.m3(), system.p3()),
        (system.m4(), system.p4()),
    ];
    let (mut mass, mut com, mut theta) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
    for (m, p) in particles {
        mass += m;
        let square: f64 = p.iter().map(|x| x * x).sum();
        for i in 0..3 {
            com[i] += m * p[i];
            for j in 0..3 {
                let unit = if i == j { square } else { 0.0 };
                theta[i][j] += m * (unit - p[i] * p[j]);
            }
        }
    }
    let top = HeavyTop::new(HeavyTopParameters {
        m: mass,
        g: system.g(),
        s: com.map(|c| c / mass),
        theta,
    })
    .expect("a top");
    let (x, xi) = (so3::exp([0.3, -0.4, 0.2]), [0.5, -0.7, 3.0]);
    let (a, b) = (end(&system, x, xi), end(&top, x, xi));
    for i in 0..9 {
        assert_near("R", a.x[i], b.x[i]);
    }
    for i in 0..3 {
        assert_near("w", a.xi[i], b.xi[i]);
    }
}

/// Without torque, a gyrostat conserves its angular momentum in the world, and each wheel its momentum.
#[test]
fn gyrostat_keeps_its_momenta() {
    let system = Gyrostat::default();
    let (x, xi) = system.start();
    let last = end(&system, x, xi);
    let (before, after) = (system.momentum(&x, &xi), system.momentum(&last.x, &last.xi));
    let turned = |x: &[f64; 15], p: &[f64; 6]| -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| x[3 * i + j] * p[j]).sum())
    };
    let (first, second) = (turned(&x, &before), turned(&last.x, &after));
    for i in 0..3 {
        assert_near("angular momentum", second[i], first[i]);
        assert_near("wheel", after[3 + i], before[3 + i]);
    }
    // It did rotate.
    assert!((0..3).any(|i| (last.xi[i] - xi[i]).abs() > 0.01));
}

/// A motor's torque is the rate of the rotor's momentum Ja (spin + w₃) and an internal torque: only external loads
/// change the total momentum about the axis.
#[test]
fn rotors_follow_their_motor() {
    let system = BodyWithRotor::default();
    let (x, mut xi) = system.start();
    xi[..6].copy_from_slice(&[0.3, -0.2, 0.1, 0.5, -0.4, 0.2]);
    let torque = 0.7;
    let rates = system.accel(&x, &xi, &[torque]).expect("regular");
    assert_near(
        "Ja (spin + w₃)̇",
        system.ja() * (rates[6] + rates[5]),
        torque,
    );
    // The input does not appear in the other rows of (30a).
    let needed = system.inverse_dynamics(&x, &xi, &rates);
    for (i, force) in needed.iter().enumerate() {
        assert_near("force", *force, if i == 6 { torque } else { 0.0 });
    }
}

/// On the Heisenberg group w is constant and rotates (x, y): with z = x + i y, z̈ = i w ż − ω² z, so that z = a
/// exp(iλ₁t) + b exp(iλ₂t), λ = (w ± √(w² + 4ω²))/2.
#[test]
fn heisenberg_motion() {
    let (m, k) = (1.5, 2.0);
    let system = Heisenberg::new(HeisenbergParameters { m, k }).expect("a particle");
    let (x0, y0, u0, v0, w) = (0.3, -0.1, 0.2, 1.0, 0.8);
    let last = end(&system, [x0, y0, 0.0], [u0, v0, w]);
    assert_near("w", last.xi[2], w);
    let root = f64::sqrt(w * w + 4.0 * k / m);
    let (first, second) = ((w + root) / 2.0, (w - root) / 2.0);
    // a + b = z and i (λ₁ a + λ₂ b) = ż
    let a = (
        (v0 - second * x0) / (first - second),
        (-u0 - second * y0) / (first - second),
    );
    let b = (x0 - a.0, y0 - a.1);
    let at = |(re, im): (f64, f64), rate: f64| {
        let (sin, cos) = (rate * UNTIL).sin_cos();
        (re * cos - im * sin, re * sin + im * cos)
    };
    let (p, q) = (at(a, first), at(b, second));
    assert_near("x", last.x[0], p.0 + q.0);
    assert_near("y", last.x[1], p.1 + q.1);
}
