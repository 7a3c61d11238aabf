//! Motions with closed forms from textbooks.

use hamel::methods::Rkmk4;
use hamel::{State, System, integrate, s1, so3};
use hamel_tests::cart_pole::{CartPole, CartPoleParameters};
use hamel_tests::free_body::{FreeBody, FreeBodyParameters};
use hamel_tests::heavy_top::{HeavyTop, HeavyTopParameters};
use hamel_tests::heavy_top_axis::{AxisTop, AxisTopParameters};
use hamel_tests::hoop_bead::{HoopBead, HoopBeadParameters};
use hamel_tests::pendulum::{Pendulum, PendulumParameters};
use hamel_tests::pendulum_circle::{CirclePendulum, CirclePendulumParameters};
use hamel_tests::planar_body::{PlanarBody, PlanarBodyParameters};
use hamel_tests::polar_particle::{PolarParticle, PolarParticleParameters};
use hamel_tests::principal_axes::{PrincipalAxes, PrincipalAxesParameters};
use hamel_tests::reference::run;
use std::f64::consts::{PI, TAU};

/// Steps of about 1/4000 of the motion's period, with which the error of RKMK4 is below 1e-11.
const STEPS: u32 = 4000;
/// Method error of such runs, with margin.
const METHOD_TOLERANCE: f64 = 1e-10;

fn end<Sys: System>(
    system: &Sys,
    x: Sys::Coordinates,
    xi: Sys::Velocities,
    until: f64,
) -> State<Sys> {
    let start = State { t: 0.0, x, xi };
    run(system, Rkmk4, start, until, STEPS).expect("a run without failure")
}

#[track_caller]
fn assert_near(what: &str, value: f64, expected: f64, bound: f64) {
    println!("{what}: {value} off by {:.1e}", value - expected);
    assert!(
        (value - expected).abs() <= bound,
        "{what}: {value}, expected {expected}"
    );
}

/// The complete elliptic integral K(sin α) = π / (2 agm(1, cos α)).
fn complete_elliptic(alpha: f64) -> f64 {
    let (mut a, mut b) = (1.0, alpha.cos());
    for _ in 0..10 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    PI / (2.0 * a)
}

/// T = 4 √(l/g) K(sin θ₀/2) = 2π √(l/g) (1 + θ₀²/16 + 11 θ₀⁴/3072 + 173 θ₀⁶/737280 + …)
#[test]
fn pendulum_period() {
    let (l, g) = (0.8_f64, 9.81);
    let raw = Pendulum::new(PendulumParameters {
        m: 1.0,
        l,
        g,
        d: 0.0,
    })
    .expect("a pendulum");
    let circle = CirclePendulum::new(CirclePendulumParameters {
        m: 1.0,
        l,
        g,
        d: 0.0,
    })
    .expect("a pendulum");
    for angle in [0.05_f64, 1.0, 2.5] {
        let period = 4.0 * (l / g).sqrt() * complete_elliptic(angle / 2.0);
        if angle < 0.1 {
            let z = angle * angle;
            let correction = 1.0 + z / 16.0 + 11.0 * z * z / 3072.0;
            let series = TAU * (l / g).sqrt() * correction;
            // The next term of the series is 4e-12.
            assert_near("series", period / series, 1.0, 1e-11);
        }
        let x0 = s1::exp(angle);
        // After a quarter of the period, the pendulum is at the lowest point, with the speed given by the energy.
        let speed = 2.0 * (g / l).sqrt() * (angle / 2.0).sin();
        for (part, theta, rate) in [(0.25, 0.0, -speed), (0.5, -angle, 0.0), (1.0, angle, 0.0)] {
            let by_raw = end(&raw, x0, [0.0], part * period);
            let by_circle = end(&circle, x0, [0.0], part * period);
            for (x, xi) in [(by_raw.x, by_raw.xi), (by_circle.x, by_circle.xi)] {
                assert_near("θ", x[1].atan2(x[0]), theta, METHOD_TOLERANCE);
                assert_near("θ̇", xi[0], rate, 10.0 * METHOD_TOLERANCE);
            }
        }
    }
}

/// Kepler: T = 2π √(a³ m / k), a = k / (2 |E|); the position at any time by Kepler's equation.
#[test]
fn particle_on_a_kepler_orbit() {
    let (m, k) = (0.7_f64, 2.0);
    let system = PolarParticle::new(PolarParticleParameters { m, k }).expect("a particle");
    // The start is the pericentre: ρ = 0.8 and more than the circular speed √(k / (m ρ)).
    let (rho, v) = (0.8, 2.2);
    let energy = 0.5 * m * v * v - k / rho;
    let a = -k / (2.0 * energy);
    let period = TAU * (a * a * a * m / k).sqrt();
    let eccentricity = 1.0 - rho / a;
    assert!(eccentricity > 0.3 && eccentricity < 0.8, "{eccentricity}");

    let (x0, xi0) = ([rho, 0.3], [0.0, v]);
    let once = end(&system, x0, xi0, period);
    assert_near("ρ after a period", once.x[0], rho, METHOD_TOLERANCE);
    assert_near("φ after a period", once.x[1], 0.3 + TAU, METHOD_TOLERANCE);
    assert_near("radial speed", once.xi[0], 0.0, 10.0 * METHOD_TOLERANCE);

    for part in [0.1, 0.35, 0.8] {
        let state = end(&system, x0, xi0, part * period);
        let mean = TAU * part;
        let mut anomaly = mean;
        for _ in 0..50 {
            let residual = anomaly - eccentricity * anomaly.sin() - mean;
            anomaly -= residual / (1.0 - eccentricity * anomaly.cos());
        }
        let distance = a * (1.0 - eccentricity * anomaly.cos());
        let angular_momentum = m * state.x[0] * state.xi[1];
        assert_near("ρ", state.x[0], distance, METHOD_TOLERANCE);
        assert_near("m ρ v", angular_momentum, m * rho * v, METHOD_TOLERANCE);
        let factor = ((1.0 + eccentricity) / (1.0 - eccentricity)).sqrt();
        let (sin, cos) = (0.5 * anomaly).sin_cos();
        let anomaly = 2.0 * (factor * sin).atan2(cos);
        let turned = (state.x[1] - 0.3 - anomaly).rem_euclid(TAU);
        assert_near("φ", turned.min(TAU - turned), 0.0, METHOD_TOLERANCE);
    }
}

/// Near the upright, to first order: θ̈ = λ² θ with λ² = (m_c + m_p) g / (m_c l), p̈ = −(m_p / m_c) g θ, and a push F
/// gives p̈ = F / m_c, θ̈ = −F / (m_c l).
#[test]
fn cart_pole_near_the_upright() {
    /// Nonlinear terms are of the third order in the angle: 1e-12 relative.
    const SMALL_ANGLE: f64 = 1e-6;
    let (mc, mp, l, g) = (1.2, 0.3, 0.5, 9.81);
    let system = CartPole::new(CartPoleParameters { mc, mp, l, g }).expect("a cart");
    let square = (mc + mp) * g / (mc * l);
    let still = [0.0; 2];
    let accel = |x, u| system.accel(x, &still, u).expect("M is regular");
    let [p, th] = accel(&[0.4, SMALL_ANGLE], &[0.0]);
    assert_near(
        "eigenvalue",
        (th / SMALL_ANGLE).sqrt(),
        square.sqrt(),
        1e-10,
    );
    assert_near("cart", p / SMALL_ANGLE, -mp / mc * g, 1e-10);
    let [p, th] = accel(&[0.4, 0.0], &[2.0]);
    assert_near("push, cart", p, 2.0 / mc, 1e-13);
    assert_near("push, pole", th, -2.0 / (mc * l), 1e-13);

    let until = 2.0 / square.sqrt();
    let state = end(&system, [0.4, SMALL_ANGLE], still, until);
    assert_near("growth", state.x[1] / SMALL_ANGLE, 2.0_f64.cosh(), 1e-9);
}

/// The centre of mass of a free planar body falls on a parabola, and the body rotates uniformly.
#[test]
fn planar_body_in_free_fall() {
    let (m, j, a, b, g) = (2.0, 0.4, 0.3, 0.1, 9.81);
    let system = PlanarBody::new(PlanarBodyParameters { m, j, a, b, g }).expect("a body");
    let (r0, angle, spin) = ([0.5, -0.2], 0.9, 3.0);
    let v0 = [1.0, 4.0];
    let centre = |r: [f64; 2], q: [f64; 2]| {
        let [c, s] = q;
        [r[0] + c * a - s * b, r[1] + s * a + c * b]
    };
    let q0 = s1::exp(angle);
    let xi0 = [
        q0[0] * v0[0] + q0[1] * v0[1],
        q0[0] * v0[1] - q0[1] * v0[0],
        spin,
    ];
    let until = 2.0;
    let state = end(&system, [r0[0], r0[1], q0[0], q0[1]], xi0, until);
    let q = [state.x[2], state.x[3]];

    let start = centre(r0, q0);
    let arm = [start[0] - r0[0], start[1] - r0[1]];
    let speed = [v0[0] - spin * arm[1], v0[1] + spin * arm[0]];
    let [x, y] = centre([state.x[0], state.x[1]], q);
    assert_near("x", x, start[0] + speed[0] * until, METHOD_TOLERANCE);
    let fall = start[1] + speed[1] * until - 0.5 * g * until * until;
    assert_near("y", y, fall, METHOD_TOLERANCE);
    assert_near("spin", state.xi[2], spin, METHOD_TOLERANCE);
    let [c, s] = s1::exp(angle + spin * until);
    assert_near("cosine", q[0], c, METHOD_TOLERANCE);
    assert_near("sine", q[1], s, METHOD_TOLERANCE);
}

/// Steady precession of a symmetric top with tilt θ against the vertical at the rate Ω:
/// Ω (J₃ ω₃ − J₁ Ω cos θ) = m g l, with ω₃ the spin about the axis.
#[test]
fn symmetric_top_in_steady_precession() {
    /// h |ω| is at most 0.02, and the error of RKMK4 is 6e-3 (h |ω|)⁴ per radian, over 70 radians.
    const PRECESSION_TOLERANCE: f64 = 1e-7;
    let (m, g, l, j1, j3) = (1.0, 9.81, 0.5, 0.3, 0.05);
    let theta = [[j1, 0.0, 0.0], [0.0, j1, 0.0], [0.0, 0.0, j3]];
    let third = HeavyTop::new(HeavyTopParameters {
        m,
        g,
        s: [0.0, 0.0, l],
        theta,
    })
    .expect("a top");
    let second = AxisTop::new(AxisTopParameters {
        m,
        g,
        l,
        j1,
        j2: j3,
        j3: j1,
    })
    .expect("a top");
    for (tilt, precession) in [(0.5_f64, 2.0), (1.2, -3.0), (2.4, 4.0)] {
        let spin = (m * g * l / precession + j1 * precession * tilt.cos()) / j3;
        let until = 0.4 * TAU / precession.abs();

        // World z in body axes, with the axis e₃ tilted about x.
        let r0 = so3::exp([tilt, 0.0, 0.0]);
        let up = so3::apply_transpose(r0, [0.0, 0.0, 1.0]);
        let w0 = up.map(|u| precession * u);
        let end3 = end(&third, r0, [w0[0], w0[1], spin], until);

        // The same top with its axis along e₂ of its frame.
        let swap = so3::exp([PI / 2.0, 0.0, 0.0]);
        let r2 = so3::product(r0, swap);
        let up = so3::apply_transpose(r2, [0.0, 0.0, 1.0]);
        let w2 = up.map(|u| precession * u);
        let end2 = end(&second, r2, [w2[0], spin, w2[2]], until);

        let start = so3::apply(r0, [0.0, 0.0, 1.0]);
        let turned = so3::apply(so3::exp([0.0, 0.0, precession * until]), start);
        let by3 = so3::apply(end3.x, [0.0, 0.0, 1.0]);
        let by2 = so3::apply(end2.x, [0.0, 1.0, 0.0]);
        for k in 0..3 {
            assert_near("axis along e₃", by3[k], turned[k], PRECESSION_TOLERANCE);
            assert_near("axis along e₂", by2[k], turned[k], PRECESSION_TOLERANCE);
        }
        assert_near("spin along e₃", end3.xi[2], spin, 1e-9 * spin.abs());
        assert_near("spin along e₂", end2.xi[1], spin, 1e-9 * spin.abs());
    }
}

/// A free symmetric body: in body axes, ω rotates about the symmetry axis at the rate (J₃ − J₁) ω₃ / J₁.
#[test]
fn free_symmetric_body_precesses_evenly() {
    let (j1, j3) = (1.0, 1.8);
    let system = PrincipalAxes::new(PrincipalAxesParameters { j1, j2: j1, j3 }).expect("a body");
    let w0 = [0.8, 0.0, 1.5];
    let rate = (j3 - j1) / j1 * w0[2];
    let until = 3.0;
    let state = end(&system, so3::identity(), w0, until);
    let (sin, cos) = (rate * until).sin_cos();
    assert_near("ω₁", state.xi[0], 0.8 * cos, METHOD_TOLERANCE);
    assert_near("ω₂", state.xi[1], 0.8 * sin, METHOD_TOLERANCE);
    assert_near("ω₃", state.xi[2], w0[2], METHOD_TOLERANCE);
}

/// A thrust F = m g against gravity and a torque τ about a principal axis from rest: φ = τ t² / 2 J.
#[test]
fn hovering_body_under_a_torque() {
    let theta = [[0.02, 0.0, 0.0], [0.0, 0.025, 0.0], [0.0, 0.0, 0.04]];
    let (m, g, tau) = (1.5, 9.81, 0.03);
    let system = FreeBody::new(FreeBodyParameters {
        m,
        g,
        s: [0.0; 3],
        theta,
    })
    .expect("a body");
    let mut state = State::start(&system);
    state.xi = [0.0; 6];
    let (x0, until) = (state.x, 2.0);
    let inputs = |_, _: &_, _: &_| [0.0, 0.0, m * g, 0.0, 0.0, tau];
    integrate(&system, Rkmk4, &mut state, 1e-3, until, inputs, |_| {}).expect("a run");
    let (sin, cos) = (0.5 * tau / 0.04 * until * until).sin_cos();
    let expected = [cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0];
    for k in 0..9 {
        assert_near("R", state.x[3 + k], expected[k], METHOD_TOLERANCE);
    }
    for k in 0..3 {
        assert_near("r", state.x[k], x0[k], METHOD_TOLERANCE);
    }
}

/// The bead is in equilibrium on the hoop at cos θ = g / (a W²).
#[test]
fn bead_on_a_turning_hoop() {
    let (m, a, j, g) = (0.2, 0.4, 0.05, 9.81);
    let system = HoopBead::new(HoopBeadParameters { m, a, j, g }).expect("a hoop");
    let speed = 8.0_f64;
    let rest = (g / (a * speed * speed)).acos();
    let accel = |theta: f64| {
        let [c, s] = s1::exp(theta);
        let accel = system.accel(&[1.0, 0.0, c, s], &[speed, 0.0], &[0.0]);
        accel.expect("M is regular")
    };
    let [hoop, bead] = accel(rest);
    assert_near("hoop", hoop, 0.0, 1e-12);
    assert_near("bead", bead, 0.0, 1e-12);
    // It is stable: θ̈ ≈ −W² sin²θ δ.
    for side in [-1e-5, 1e-5] {
        let stiffness = -accel(rest + side)[1] / side;
        assert_near(
            "stiffness",
            stiffness / (speed * rest.sin()).powi(2),
            1.0,
            1e-4,
        );
    }
    let [c, s] = s1::exp(rest);
    let state = end(&system, [1.0, 0.0, c, s], [speed, 0.0], 1.0);
    assert_near("θ", state.x[3].atan2(state.x[2]), rest, METHOD_TOLERANCE);
    let [c, s] = s1::exp(speed);
    assert_near("cos ψ", state.x[0], c, METHOD_TOLERANCE);
    assert_near("sin ψ", state.x[1], s, METHOD_TOLERANCE);
}

/// (28): f is the power of the applied loads per unit velocity.
#[test]
fn applied_loads_are_generalised_forces() {
    let plate: PlanarBody<f64> = PlanarBody::default();
    let [c, s] = s1::exp(0.7);
    let wrench = [1.5, -2.0, 0.6];
    let x = [0.3, 0.4, c, s];
    assert_eq!(
        plate.generalized_force(&x, &[1.0, 2.0, 3.0], &wrench),
        wrench
    );

    let damped = Pendulum::new(PendulumParameters {
        m: 1.0,
        l: 0.8,
        g: 9.81,
        d: 0.25,
    })
    .expect("a pendulum");
    let [force] = damped.generalized_force(&s1::exp(0.4), &[2.0], &[]);
    assert_near("damping", force, -0.5, 1e-15);
    let circle = CirclePendulum::new(CirclePendulumParameters {
        m: 1.0,
        l: 0.8,
        g: 9.81,
        d: 0.25,
    })
    .expect("a pendulum");
    let [force] = circle.generalized_force(&s1::exp(0.4), &[2.0], &[]);
    assert_near("damping", force, -0.5, 1e-15);

    // A wrench in body axes at the origin of the frame is dual to (v, ω) there, wherever the centre of mass is.
    let body: FreeBody<f64> = FreeBody::default();
    let mut state = State::start(&body);
    let turned = so3::exp([0.4, -1.0, 0.3]);
    state.x[3..].copy_from_slice(&turned);
    let wrench = [1.0, -2.0, 3.0, 0.4, -0.5, 0.6];
    assert_eq!(body.generalized_force(&state.x, &state.xi, &wrench), wrench);
}
