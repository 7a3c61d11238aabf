//! Systems with velocity constraints, compared with reference solutions, published states and conservation laws.

use hamel::methods::Rkmk4;
use hamel::{Energies, Singular, State, StepError, System, integrate};
use hamel_tests::bicycle::Bicycle;
use hamel_tests::bricard::Bricard;
use hamel_tests::double_four_bar::DoubleFourBar;
use hamel_tests::four_bar_loop::FourBarLoop;
use hamel_tests::reference::{Reference, relative, run, slopes};
use hamel_tests::rolling_ball::RollingBall;
use hamel_tests::sleigh::{Sleigh, SleighParameters};
use hamel_tests::snakeboard::Snakeboard;
use hamel_tests::spherical_pendulum_frame::SphericalPendulum;
use hamel_tests::squeezer::Squeezer;

fn energy<Sys: Energies<Scalar = f64>>(system: &Sys, state: &State<Sys>) -> f64 {
    system.kinetic_energy(&state.x, &state.xi) + system.potential_energy(&state.x)
}

/// Returns the largest relative change of energy, the largest |φ|, and the last state.
fn drift<Sys: Energies<Scalar = f64>>(
    system: &Sys,
    until: f64,
    step: f64,
) -> Result<(f64, f64, State<Sys>), StepError> {
    let mut state = State::start(system);
    let first = energy(system, &state);
    let (mut change, mut open) = (0.0_f64, 0.0_f64);
    let none = |_, _: &_, _: &_| system.zero_inputs();
    integrate(system, Rkmk4, &mut state, step, until, none, |state| {
        change = change.max(((energy(system, state) - first) / first).abs());
        open = open.max(system.constraint_norm(&state.x));
    })?;
    Ok((change, open, state))
}

/// The coordinates have no poles: the path of R e₃ passes through both.
#[test]
fn spherical_pendulum_passes_both_poles() {
    let reference = Reference::read("spherical-pendulum-through-poles");
    let system = SphericalPendulum::default();
    let x: [f64; 3] = reference.initial("x");
    let v: [f64; 3] = reference.initial("xdot");
    let cross = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            a[j] * b[k] - a[k] * b[j]
        })
    };
    // Columns: any two orthogonal directions, then the rod.
    let spin = cross(x, v);
    let length = spin.iter().map(|s| s * s).sum::<f64>().sqrt();
    let first = spin.map(|s| s / length);
    let second = cross(x, first);
    let rotation: [f64; 9] = std::array::from_fn(|k| [first, second, x][k % 3][k / 3]);
    let xi = [length, 0.0];
    let start = State {
        t: 0.0,
        x: rotation,
        xi,
    };
    let end = run(&system, Rkmk4, start, 10.0, 8000).expect("a run");
    let rod = [end.x[2], end.x[5], end.x[8]];
    let error = relative(&rod, &reference.sample::<3>(10.0, "x"));
    assert!(error < 1e-9, "{error:e}");
}

/// The state published by the IVP test set for t = 0.03.
#[test]
fn squeezer_reaches_the_published_state() {
    let published: [f64; 7] = [
        15.81077119629904,
        -15.75637105984298,
        0.04082224013073101,
        -0.5347301163226948,
        0.5244099658805304,
        0.5347301163226948,
        1.048080741042263,
    ];
    let system = Squeezer::<f64>::default();
    let end = run(&system, Rkmk4, State::start(&system), 0.03, 3000).expect("a run");
    for (found, expected) in end.x.iter().zip(published) {
        assert!((found - expected).abs() < 1e-8, "{found} {expected}");
    }
    assert!(system.constraint_norm(&end.x) < 1e-14);
}

/// With all rods horizontal the position is singular, and the motion passes it eight times in ten seconds.
#[test]
fn double_four_bar_passes_its_singular_position() {
    let system = DoubleFourBar::default();
    let (change, open, end) = drift(&system, 10.0, 2e-3).expect("a run");
    assert!(change < 1e-9, "{change:e}");
    assert!(open < 1e-13, "{open:e}");
    // The motion stays on its branch, with level couplers, through more than four turns.
    assert!(end.x[0] < -25.0 && end.x[3].abs() < 1e-9, "{:?}", end.x);
}

/// Exactly there, the rows of the loops are linearly dependent.
#[test]
fn singular_position_is_a_typed_error() {
    let system = DoubleFourBar::default();
    let level = [0.0; 5];
    let found = system.accel(&level, &[-1.0, -1.0, -1.0, 0.0, 0.0], &[]);
    assert!(
        matches!(found, Err(Singular::Constraints { .. })),
        "{found:?}"
    );
}

/// Five rods with one degree of freedom, and one row of the loops redundant everywhere.
#[test]
fn bricard_keeps_its_energy() {
    let system = Bricard::default();
    let (change, open, end) = drift(&system, 10.0, 5e-4).expect("a run");
    println!("energy {change:e}, loops {open:e}");
    assert!(change < 1e-8, "{change:e}");
    assert!(open < 1e-12, "{open:e}");
    assert!(end.xi[0].abs() > 0.1, "it moves: {:?}", end.xi);
}

#[test]
fn four_bar_keeps_its_energy_and_its_loop() {
    let system = FourBarLoop::default();
    let mut changes = Vec::new();
    for step in [4e-3, 2e-3, 1e-3] {
        let (change, open, _) = drift(&system, 5.0, step).expect("a run");
        assert!(open < 1e-12, "{open:e}");
        changes.push(change);
    }
    // Energy is conserved to the order of the method.
    assert!(
        slopes(&changes).iter().all(|order| *order > 3.7),
        "{changes:?}"
    );
}

/// Without slip, the ball's contact point is at rest, and ideal constraints do no work.
#[test]
fn ball_with_general_inertia_keeps_its_energy() {
    let (change, _, end) = drift(&RollingBall::default(), 5.0, 1e-3).expect("a run");
    assert!(change < 1e-9, "{change:e}");
    assert!(
        (end.x[2] - 0.3).abs() < 1e-12,
        "it leaves the plane: {}",
        end.x[2]
    );
}

/// The multipliers are constraint forces: the force on a wheel's contact is the mass times its acceleration, less the
/// weight; here compared with the closed form m (v̇ + u ω) for the sleigh's blade.
#[test]
fn sleigh_blade_bears_the_centrifugal_force() {
    let (m, inertia, a) = (2.0, 0.6, 0.5_f64);
    let system = Sleigh::new(SleighParameters { m, j: inertia, a }).expect("a body");
    let (u, w) = (1.3, 0.7);
    let x = [0.0, 0.0, 1.0, 0.0];
    let [lambda]: [f64; 1] = system.constraint_force(&x, &[u, w], &[]).expect("regular");
    let w_dot = -m * a * u * w / (inertia + m * a * a);
    let expected = m * (u * w + a * w_dot);
    assert!((lambda - expected).abs() < 1e-14, "{lambda} {expected}");
}

#[test]
fn snakeboard_moves_by_turning_its_rotor() {
    let system = Snakeboard::default();
    let mut state = State::start(&system);
    let twist = |t: f64, _: &_, _: &_| [0.3 * (3.0 * t).sin(), 0.02 * (3.0 * t).cos()];
    integrate(&system, Rkmk4, &mut state, 1e-3, 4.0, twist, |_| {}).expect("a run");
    assert!(state.x[0].hypot(state.x[1]) > 0.05, "{:?}", state.x);
}

/// Between 4.3 and 6.0 m/s the riderless bicycle is stable.
#[test]
fn bicycle_is_stable_at_five_metres_a_second() {
    let lean = |speed: f64| {
        let system = Bicycle::default();
        let mut state = State::start(&system);
        let (rr, rf) = (0.3, 0.35);
        let mut xi = state.xi;
        // Active velocities: the rear frame's angular velocity, steer, rear wheel, front wheel.
        xi = [0.05, xi[1], xi[2], xi[3], -speed / rr, -speed / rf];
        state.xi = system.project_velocity(&state.x, &xi).expect("regular");
        let none = |_, _: &_, _: &_| system.zero_inputs();
        integrate(&system, Rkmk4, &mut state, 2e-3, 6.0, none, |_| {}).map(|()| {
            // The sine of the lean angle: the vertical component of the frame's y axis.
            state.x[3 + 7].abs()
        })
    };
    let stable = lean(5.0).expect("a run");
    assert!(stable < 5e-3, "{stable:e}");
    // At a low speed it falls.
    assert!(lean(2.0).is_err() || lean(2.0).is_ok_and(|fallen| fallen > 0.3));
}
