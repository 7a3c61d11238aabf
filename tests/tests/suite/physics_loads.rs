//! Compares loads and sensors with closed forms, finite differences and the energy balance.

use hamel::methods::Rkmk4;
use hamel::{State, System, so3};
use hamel_tests::actuated_pendulum::ActuatedPendulum;
use hamel_tests::drone::Drone;
use hamel_tests::elastic_pendulum::ElasticPendulum;
use hamel_tests::reference::{relative, run};
use hamel_tests::spring_chain::SpringChain;
use hamel_tests::suspended_body::SuspendedBody;

/// Rounding of sums of a few dozen products of numbers of order 100, in another order.
const ROUNDING_TOLERANCE: f64 = 1e-12;
/// Step of central differences (s): errors of order h², rounding of order 1e-16/h².
const DIFFERENCE_STEP: f64 = 1e-4;
/// Errors of first and second central differences, with margin: a wrong term gives 1e-2 and more.
const DIFFERENCE_TOLERANCE: f64 = 1e-6;

#[track_caller]
fn assert_near(what: &str, a: &[f64], b: &[f64], bound: f64) {
    let difference = relative(a, b);
    println!("{what}: {difference:.1e}");
    assert!(difference <= bound, "{what}: {a:?} against {b:?}");
}

/// Newton's law for every cart, with the forces of springs and dampers by hand.
#[test]
fn chain_of_springs_and_dampers_obeys_newton() {
    let chain = SpringChain::<f64>::default();
    let (k, l, c) = (chain.k(), chain.l(), chain.c());
    let (x, v) = ([0.7, 1.4, 1.9], [0.3, -0.5, 1.1]);
    let wall = k * (x[0] - l);
    let first = k * (x[1] - x[0] - l) + c * (v[1] - v[0]);
    let second = 2.0 * k * (x[2] - x[1] - l) + 2.0 * c * (v[2] - v[1]);
    let expected = [
        (first - wall) / chain.m1(),
        (second - first) / chain.m2(),
        -second / chain.m3(),
    ];
    let accel = chain.accel(&x, &v, &[]).expect("masses");
    assert_near("v̇", &accel, &expected, ROUNDING_TOLERANCE);
    let dissipation = 0.5 * c * (v[1] - v[0]).powi(2) + c * (v[2] - v[1]).powi(2);
    assert_near(
        "D",
        &[chain.dissipation(&x, &v)],
        &[dissipation],
        ROUNDING_TOLERANCE,
    );
}

/// A body on springs and dampers loses energy at the rate 2 D, over a run and at each instant.
#[test]
fn energy_of_a_suspended_body_goes_into_its_dampers() {
    let body = SuspendedBody::<f64>::default();
    let mut state = State::start(&body);
    let before = body.energy(&state.x, &state.xi);
    let (steps, h) = (400, 2.5e-3);
    let mut lost = 0.0;
    for _ in 0..steps {
        // Simpson's rule over one step.
        let middle = run(&body, Rkmk4, state.clone(), state.t + h / 2.0, 4).expect("a run");
        let end = run(&body, Rkmk4, middle.clone(), state.t + h, 4).expect("a run");
        let power = |s: &State<_>| 2.0 * body.dissipation(&s.x, &s.xi);
        lost += h / 6.0 * (power(&state) + 4.0 * power(&middle) + power(&end));
        state = end;
    }
    let after = body.energy(&state.x, &state.xi);
    assert!(lost > 0.1 * before.abs(), "{lost} of {before}");
    // The errors of Simpson's rule and RKMK4 are h⁴ times derivatives of at most ω⁴, with ω h = 0.04.
    assert_near("energy", &[after + lost], &[before], 1e-7);
}

/// Springs pull along the lines between their points: force and torque by hand.
#[test]
fn springs_in_space_pull_along_their_lines() {
    let body = SuspendedBody::<f64>::default();
    let rotation = so3::exp([0.3, -0.5, 0.4]);
    let r = [0.1, -0.2, 0.4];
    let x: [f64; 12] = std::array::from_fn(|i| if i < 3 { r[i] } else { rotation[i - 3] });
    let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
    let mut pull = |at: [f64; 3], world: [f64; 3]| {
        let f = so3::apply_transpose(rotation, world);
        let lever = so3::cross(at, f);
        for i in 0..3 {
            force[i] += f[i];
            torque[i] += lever[i];
        }
    };
    let anchors = [
        ([0.6, 0.0, 1.5], [0.4, 0.0, 0.0], body.l()),
        ([-0.3, 0.5, 1.5], [-0.2, 0.3, 0.0], body.l()),
        ([-0.3, -0.5, 1.5], [-0.2, -0.3, 0.0], 0.0),
    ];
    for (anchor, at, rest) in anchors {
        let arm = so3::apply(rotation, at);
        let d: [f64; 3] = std::array::from_fn(|i| r[i] + arm[i] - anchor[i]);
        let length = so3::dot(d, d).sqrt();
        pull(at, d.map(|d| -body.k() * (length - rest) * d / length));
    }
    pull(body.s(), [0.0, 0.0, -body.m() * body.g()]);
    let slope = body.potential_force(&x).map(|slope| -slope);
    let expected: [f64; 6] = std::array::from_fn(|i| if i < 3 { force[i] } else { torque[i - 3] });
    assert_near("−∂V", &slope, &expected, ROUNDING_TOLERANCE);
}

/// In relative angles, a motor's torque acts on its joint only, and a force at a point of the lower link, with its
/// reaction on the upper one, has a moment about the joint.
#[test]
fn reactions_of_motors_act_on_the_other_link() {
    let arm = ActuatedPendulum::<f64>::default();
    let (a, b) = (0.4_f64, -1.1_f64);
    let x = [a.cos(), a.sin(), b.cos(), b.sin()];
    let xi = [0.7, -1.3];
    let force = arm.generalized_force(&x, &xi, &[3.0, 5.0, 7.0]);
    let expected = [
        3.0 - arm.d1() * xi[0],
        5.0 + 7.0 * arm.s2() - arm.d2() * xi[1],
    ];
    assert_near("f", &force, &expected, ROUNDING_TOLERANCE);
}

/// d/dt (T + V) = −2 D + fᵢ ξⁱ of the inputs, by central differences along the motion.
#[test]
fn energy_of_an_actuated_pendulum_balances() {
    let arm = ActuatedPendulum::<f64>::default();
    let u = [2.0, -1.5, 4.0];
    let start = State::start(&arm);
    let energy = |steps: f64| {
        let mut state = State {
            xi: [0.8, -2.0],
            ..start.clone()
        };
        hamel::integrate(
            &arm,
            Rkmk4,
            &mut state,
            DIFFERENCE_STEP * steps.signum(),
            DIFFERENCE_STEP * steps,
            |_, _: &_, _: &_| u,
            |_| {},
        )
        .expect("a run");
        arm.energy(&state.x, &state.xi)
    };
    let (later, now) = (energy(2.0), energy(1.0));
    let first = energy(0.0);
    let rate = (later - first) / (2.0 * DIFFERENCE_STEP);
    let mut state = State {
        xi: [0.8, -2.0],
        ..start.clone()
    };
    hamel::integrate(
        &arm,
        Rkmk4,
        &mut state,
        DIFFERENCE_STEP,
        DIFFERENCE_STEP,
        |_, _: &_, _: &_| u,
        |_| {},
    )
    .expect("a run");
    let loss = 2.0 * arm.dissipation(&state.x, &state.xi);
    let motors = [u[0], u[1] + u[2] * arm.s2()];
    let gain = motors[0] * state.xi[0] + motors[1] * state.xi[1];
    assert!((now - first).abs() > 1e-6, "the energy moves");
    assert_near("Ė", &[rate], &[gain - loss], DIFFERENCE_TOLERANCE);
}

/// Returns three states of a run, one step apart.
fn three<Sys>(system: &Sys, start: State<Sys>) -> [State<Sys>; 3]
where
    Sys: System<Scalar = f64>,
    State<Sys>: Clone,
{
    let next = |from: &State<Sys>| {
        run(system, Rkmk4, from.clone(), from.t + DIFFERENCE_STEP, 1).expect("a run")
    };
    let middle = next(&start);
    let last = next(&middle);
    [start, middle, last]
}

fn difference<const N: usize>(a: [f64; N], b: [f64; N], h: f64) -> [f64; N] {
    std::array::from_fn(|i| (a[i] - b[i]) / h)
}

/// The readings of a swinging mass's speed sensor and accelerometer equal differences of its position.
#[test]
fn sensors_of_a_pendulum_see_its_motion() {
    let bob = ElasticPendulum::<f64>::default();
    let mut start = State::start(&bob);
    start.xi = [0.4, -1.7];
    let states = three(&bob, start);
    let u = [0.0];
    let places = states.each_ref().map(|s| bob.place(&s.x));
    let State { x, xi, .. } = &states[1];
    let speed = bob.speed(x, xi);
    let measured = difference(places[2], places[0], 2.0 * DIFFERENCE_STEP);
    assert_near("speed", &speed, &measured, DIFFERENCE_TOLERANCE);

    let speeds = states.each_ref().map(|s| bob.speed(&s.x, &s.xi));
    let mut felt = difference(speeds[2], speeds[0], 2.0 * DIFFERENCE_STEP);
    felt[1] += bob.g();
    let (c, s) = (x[1], x[2]);
    let turned = [
        c * felt[0] + s * felt[1],
        c * felt[1] - s * felt[0],
        felt[2],
    ];
    let xi_dot = bob.accel(x, xi, &u).expect("a mass");
    assert_near(
        "felt",
        &bob.felt(x, xi, &xi_dot),
        &turned,
        DIFFERENCE_TOLERANCE,
    );
    assert_near("gyro", &[bob.gyro(xi)], &[xi[1]], ROUNDING_TOLERANCE);
    assert_near(
        "sliding",
        &bob.sliding(xi),
        &[xi[0], 0.0, 0.0],
        ROUNDING_TOLERANCE,
    );
}

/// At rest, an accelerometer measures g upwards, and the spring carries the weight.
#[test]
fn at_rest_an_accelerometer_shows_gravity() {
    let bob = ElasticPendulum::<f64>::default();
    let stretch = bob.m() * bob.g() / bob.k();
    let (x, xi, u) = ([bob.l() + stretch, 0.0, -1.0], [0.0; 2], [0.0]);
    let xi_dot = bob.accel(&x, &xi, &u).expect("a mass");
    assert_near("rest", &xi_dot, &[0.0, 0.0], ROUNDING_TOLERANCE);
    let felt = bob.felt(&x, &xi, &xi_dot);
    assert_near("felt", &felt, &[-bob.g(), 0.0, 0.0], ROUNDING_TOLERANCE);
}

/// The readings of a body's sensors in space equal differences of position and speed in its axes; the sensors are not
/// at the centre of mass, so that ω̇ and ω × (ω × p) matter.
#[test]
fn sensors_of_a_drone_see_its_motion() {
    let drone = Drone::<f64>::default();
    let mut start = State::start(&drone);
    start.xi = [1.0, 0.3, -0.5, 2.0, -1.0, 3.0];
    let u = [0.0; 4];
    let states = three(&drone, start);
    let places = states.each_ref().map(|s| drone.place(&s.x));
    let State { x, xi, .. } = &states[1];
    let sum: [f64; 3] = std::array::from_fn(|i| places[2][i] - 2.0 * places[1][i] + places[0][i]);
    let mut acceleration = sum.map(|sum| sum / (DIFFERENCE_STEP * DIFFERENCE_STEP));
    acceleration[2] += drone.g();
    let rotation: [f64; 9] = std::array::from_fn(|i| x[3 + i]);
    let expected = so3::apply_transpose(rotation, acceleration);
    let xi_dot = drone.accel(x, xi, &u).expect("a body");
    let felt = drone.accelerometer(x, xi, &xi_dot);
    assert_near("accelerometer", &felt, &expected, DIFFERENCE_TOLERANCE);
    let turning = drone.turning(&xi_dot);
    assert_near("ω̇", &turning, &xi_dot[3..], ROUNDING_TOLERANCE);
    // The speed of the centre of mass, on which the drag acts.
    let w = [xi[3], xi[4], xi[5]];
    let lever = so3::cross(w, drone.s());
    let local: [f64; 3] = std::array::from_fn(|i| xi[i] + lever[i]);
    let world = so3::apply(rotation, local);
    assert_near(
        "speed",
        &drone.ground_speed(x, xi),
        &world,
        ROUNDING_TOLERANCE,
    );
    let drag = drone.generalized_force(x, xi, &u);
    let pull = local.map(|v| -drone.d() * v);
    let twist = so3::cross(drone.s(), pull);
    let expected: [f64; 6] = std::array::from_fn(|i| if i < 3 { pull[i] } else { twist[i - 3] });
    assert_near("drag", &drag, &expected, ROUNDING_TOLERANCE);
}
