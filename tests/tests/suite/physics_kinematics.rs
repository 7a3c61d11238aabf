//! A from definitions of velocities and from constraints, [A Ψ] = [Y; Φ]⁻¹: the motions equal those of descriptions
//! with a given A, linkages follow their trigonometry, and a locked one is a typed error.

use hamel::methods::{Rk4, Rkmk4};
use hamel::{Monitor, Singular, State, StepError, System, integrate, s3, so3};
use hamel_tests::four_bar::{FourBar, FourBarParameters};
use hamel_tests::free_body::FreeBody;
use hamel_tests::free_body_both::FreeBodyBoth;
use hamel_tests::free_body_rows::FreeBodyRows;
use hamel_tests::heavy_top::HeavyTop;
use hamel_tests::heavy_top_columns::ColumnTop;
use hamel_tests::pendulum_circle::CirclePendulum;
use hamel_tests::pendulum_rows::PendulumRows;
use hamel_tests::reference::run;
use hamel_tests::rod_particles::RodParticles;
use hamel_tests::rod_particles_rows::RodParticlesRows;
use hamel_tests::slider_crank::SliderCrank;

/// Rounding of several hundred operations, relative.
const TOLERANCE: f64 = 1e-12;

#[track_caller]
fn assert_close(what: &str, a: &[f64], b: &[f64], bound: f64) {
    assert_eq!(a.len(), b.len(), "{what}");
    for (a, b) in a.iter().zip(b) {
        let scale = a.abs().max(b.abs()).max(1.0);
        assert!((a - b).abs() <= bound * scale, "{what}: {a:e} and {b:e}");
    }
}

/// Y alone gives the same functions as A alone, for the same x, ξ and u.
#[test]
fn definitions_give_the_same_functions_as_rates() {
    let (rows, rates) = (FreeBodyRows::<f64>::default(), FreeBody::<f64>::default());
    let mut x = System::start(&rates).0;
    let turned = so3::exp([0.3, -1.1, 0.7]);
    x[..3].copy_from_slice(&[0.4, -0.3, 0.8]);
    x[3..].copy_from_slice(&turned);
    let (xi, u) = (
        [0.3, -0.2, 0.5, 1.0, -2.0, 0.7],
        [1.0, 2.0, 3.0, 0.1, 0.2, 0.3],
    );
    let accel = (rows.accel(&x, &xi, &u), rates.accel(&x, &xi, &u));
    let (Ok(a), Ok(b)) = accel else {
        panic!("{accel:?}")
    };
    assert_close("free body", &a, &b, TOLERANCE);
    assert_close(
        "free body",
        &rows.rate(&x, &xi),
        &rates.rate(&x, &xi),
        TOLERANCE,
    );

    let (rows, rates) = (
        RodParticlesRows::<f64>::default(),
        RodParticles::<f64>::default(),
    );
    let (x, _) = System::start(&rates);
    let xi = [1.0, -2.0, 0.5];
    let accel = (rows.accel(&x, &xi, &[]), rates.accel(&x, &xi, &[]));
    let (Ok(a), Ok(b)) = accel else {
        panic!("{accel:?}")
    };
    assert_close("rods", &a, &b, TOLERANCE);
    assert_close("rods", &rows.rate(&x, &xi), &rates.rate(&x, &xi), TOLERANCE);
}

/// Nine reals with RᵀR = I and det R = 1 written out are equivalent to a rotation matrix: A = R ω̂.
#[test]
fn columns_of_reals_turn_as_a_rotation_does() {
    let columns = ColumnTop::<f64>::default();
    let mut top = HeavyTop::<f64>::default();
    top.set_m(columns.m()).expect("a mass");
    top.set_theta(columns.theta()).expect("an inertia");
    top.set_s(columns.s()).expect("a centre of mass");
    let r = so3::exp([0.3, -1.1, 0.7]);
    let transposed: [f64; 9] = std::array::from_fn(|i| r[3 * (i % 3) + i / 3]);
    let xi = [0.3, -0.2, 9.0];
    let (a, b) = (
        columns.accel(&transposed, &xi, &[]),
        top.accel(&r, &xi, &[]),
    );
    assert_close("ξ̇", &a.expect("regular"), &b.expect("regular"), TOLERANCE);
    let (a, b) = (columns.rate(&transposed, &xi), top.rate(&r, &xi));
    let b: [f64; 9] = std::array::from_fn(|i| b[3 * (i % 3) + i / 3]);
    assert_close("ẋ", &a, &b, TOLERANCE);
    assert_eq!(
        columns.constraint(&transposed).len(),
        10,
        "all rows stay in φ"
    );
}

/// With both given, the body of a quaternion moves as that of a rotation matrix; one has the world velocity of its
/// origin, the other the body velocity.
#[test]
fn a_body_with_both_moves_as_one_with_rates() {
    let (both, rates) = (FreeBodyBoth::<f64>::default(), FreeBody::<f64>::default());
    let start = State::start(&both);
    let end = run(&both, Rkmk4, start, 1.0, 2000).expect("a run");
    let other = run(&rates, Rkmk4, State::start(&rates), 1.0, 2000).expect("a run");
    let q: [f64; 4] = std::array::from_fn(|i| end.x[3 + i]);
    assert_close("r", &end.x[..3], &other.x[..3], 1e-10);
    assert_close("R", &s3::to_matrix(q), &other.x[3..], 1e-10);
}

/// l θ̈ = −g sin θ from x, y, one constraint and one definition.
#[test]
fn a_pendulum_of_points_swings_as_one_of_angles() {
    let points = PendulumRows::<f64>::default();
    let mut angles = CirclePendulum::<f64>::default();
    angles.set_d(0.0).expect("a damping");
    // x = l sin θ, y = −l cos θ.
    let (l, theta) = (0.8, 1.1_f64);
    let x = [l * theta.sin(), -l * theta.cos()];
    let a = points.accel(&x, &[0.4], &[]).expect("regular");
    let b = angles
        .accel(&[theta.cos(), theta.sin()], &[0.4], &[])
        .expect("regular");
    assert_close("θ̈", &a, &b, TOLERANCE);
    assert_close("θ̈", &a, &[-9.81 / l * theta.sin()], TOLERANCE);
}

/// Returns the other angles of the four-bar for a crank angle, in the assembly of the start.
fn assembly(a: f64) -> [f64; 6] {
    let (l1, l2, l3, d) = (1.0_f64, 2.5, 2.0, 3.0);
    let (px, py) = (l1 * a.cos() - d, l1 * a.sin());
    let distance = px.hypot(py);
    // Law of cosines at the base of the rocker.
    let inner = ((l3 * l3 + distance * distance - l2 * l2) / (2.0 * l3 * distance)).acos();
    let c = py.atan2(px) - inner;
    let (bx, by) = (d + l3 * c.cos() - l1 * a.cos(), l3 * c.sin() - l1 * a.sin());
    [a.cos(), a.sin(), bx / l2, by / l2, c.cos(), c.sin()]
}

#[test]
fn a_four_bar_moves_as_its_trigonometry_says() {
    let system = FourBar::<f64>::default();
    let start = State::start(&system);
    assert_close("start", &assembly(0.0), &start.x, 1e-15);
    for k in 0..40 {
        let (a, h) = (0.3 * f64::from(k), 1e-4);
        let rate = system.rate(&assembly(a), &[1.0]);
        let (plus, minus) = (assembly(a + h), assembly(a - h));
        let (wide, narrow) = (assembly(a + 2.0 * h), assembly(a - 2.0 * h));
        let slope: Vec<f64> = (0..6)
            .map(|i| (8.0 * (plus[i] - minus[i]) - (wide[i] - narrow[i])) / (12.0 * h))
            .collect();
        assert_close("dx/da", &rate, &slope, 1e-10);
    }
}

/// The crank makes full turns; energy is conserved, and x satisfies the trigonometry.
#[test]
fn a_four_bar_keeps_its_energy() {
    let system = FourBar::<f64>::default();
    let mut state = State::start(&system);
    state.xi = [9.0];
    let mut monitor = Monitor::new(&system, &state);
    let (mut turns, mut before) = (0, state.x[1]);
    let inputs = |_, _: &_, _: &_| [0.0];
    let observe = |state: &State<FourBar<f64>>| {
        monitor.observe(&system, state);
        turns += i32::from(before < 0.0 && state.x[1] >= 0.0);
        before = state.x[1];
    };
    integrate(&system, Rkmk4, &mut state, 2e-4, 10.0, inputs, observe).expect("a run");
    println!(
        "{turns} {:e} {:e}",
        monitor.relative_energy_deviation(),
        monitor.constraint()
    );
    assert!(turns >= 5, "{turns}");
    assert!(monitor.relative_energy_deviation() < 1e-8);
    let angle = state.x[1].atan2(state.x[0]);
    assert_close("x", &state.x, &assembly(angle), 1e-8);
}

/// With l1 = 2, l2 = l3 = 1, d = 3, the crank cannot turn beyond cos a = 3/4, where coupler and rocker are aligned.
#[test]
fn a_locked_four_bar_is_a_typed_error() {
    let (m, g, j) = ([1.0, 2.0, 1.5], 0.0, [0.1, 1.1, 0.5]);
    let system = FourBar::<f64>::new(FourBarParameters {
        l1: 2.0,
        l2: 1.0,
        l3: 1.0,
        d: 3.0,
        m1: m[0],
        m2: m[1],
        m3: m[2],
        g,
        j1: j[0],
        j2: j[1],
        j3: j[2],
    });
    let system = system.expect("lengths and masses");
    let half = 0.75_f64.sqrt();
    let start = [1.0, 0.0, 0.5, half, -0.5, half];
    assert!(system.accel(&start, &[1.0], &[0.0]).is_ok());
    let (c, s) = (0.75, (1.0_f64 - 0.5625).sqrt());
    // From (2 c, 2 s) to (3, 0) is twice the rod's unit vector; the rocker points in the opposite direction.
    let (ex, ey) = ((3.0 - 2.0 * c) / 2.0, -s);
    let locked = [c, s, ex, ey, -ex, -ey];
    let error = system.accel(&locked, &[1.0], &[0.0]).expect_err("locked");
    assert_eq!(error, Singular::Kinematics { pivot: 0 });
    // The mirrored assembly, in which the pivot has the other sign.
    let mirrored = [1.0, 0.0, 0.5, -half, -0.5, -half];
    let error = system
        .accel(&mirrored, &[1.0], &[0.0])
        .expect_err("mirrored");
    assert_eq!(error, Singular::Kinematics { pivot: 0 });
    let mut state = State {
        t: 0.0,
        x: start,
        xi: [3.0],
    };
    let inputs = |_, _: &_, _: &_| [0.0];
    let outcome = integrate(&system, Rkmk4, &mut state, 1e-3, 10.0, inputs, |_| {});
    match outcome {
        Err(StepError::Singular { cause, .. }) => {
            assert_eq!(cause, Singular::Kinematics { pivot: 0 })
        }
        other => panic!("{other:?}"),
    }
    assert!(
        state
            .x
            .iter()
            .chain(&state.xi)
            .all(|number| number.is_finite())
    );
    assert!(
        state.x[0] < 0.8,
        "close to the dead position: {}",
        state.x[0]
    );
}

/// x = l1 cos a + √(l2² − l1² sin² a), and the energy over a whole run.
#[test]
fn a_slider_crank_moves_as_its_trigonometry_says() {
    let system = SliderCrank::<f64>::default();
    let mut state = State::start(&system);
    state.xi = [15.0];
    let mut monitor = Monitor::new(&system, &state);
    let inputs = |_, _: &_, _: &_| [0.0];
    let observe = |state: &_| monitor.observe(&system, state);
    integrate(&system, Rkmk4, &mut state, 1e-4, 3.0, inputs, observe).expect("a run");
    println!("{:e}", monitor.relative_energy_deviation());
    assert!(monitor.relative_energy_deviation() < 1e-8);
    let [c, s, ..] = state.x;
    let x = 0.3 * c + (0.64 - 0.09 * s * s).sqrt();
    assert_close("x", &state.x[4..], &[x], 1e-8);
}

/// (8): φ decays like exp(−λ t) with the Ψ of the description, for every row of a redundant φ. The start is at rest: Φ
/// A = 0 holds only on X, so that a motion off X adds terms of order ξ φ.
#[test]
fn disturbed_linkages_decay_exponentially() {
    const LAMBDA: f64 = 10.0;
    const UNTIL: f64 = 0.5;
    /// Terms of φ² at a disturbance of 1e-7, and (λ h)⁵ of the method, with margin.
    const DECAY_TOLERANCE: f64 = 2e-3;
    fn decay<Sys>(system: &Sys, phi: impl Fn(&Sys::Coordinates) -> Vec<f64>)
    where
        Sys: System<Scalar = f64>,
    {
        let mut state = State::start(system);
        state.xi.as_mut().fill(0.0);
        for (k, x) in state.x.as_mut().iter_mut().enumerate() {
            *x += 1e-7 * [1.0, -2.0, 1.5, 0.7, -1.2, 2.3, 0.9, -0.4, 1.7][k];
        }
        let before = phi(&state.x);
        let method = Rk4 { lambda: LAMBDA };
        let end = run(system, method, state, UNTIL, 2000).expect("a run");
        for (before, after) in before.iter().zip(phi(&end.x)) {
            println!("{before:e} {after:e}");
            let expected = before * (-LAMBDA * UNTIL).exp();
            assert!(
                (after - expected).abs() < DECAY_TOLERANCE * 1e-7,
                "{after:e} {expected:e}"
            );
        }
    }
    let mut four_bar = FourBar::<f64>::default();
    four_bar.set_g(0.0).expect("no weight");
    decay(&four_bar, |x| four_bar.constraint(x).to_vec());
    let mut slider = SliderCrank::<f64>::default();
    slider.set_g(0.0).expect("no weight");
    decay(&slider, |x| slider.constraint(x).to_vec());
    let mut columns = ColumnTop::<f64>::default();
    columns.set_g(0.0).expect("no weight");
    decay(&columns, |x| columns.constraint(x).to_vec());
}

/// A zero value is refused for a parameter that is a divisor in a definition.
#[test]
fn a_lever_without_length_is_refused() {
    let mut system = FourBar::<f64>::default();
    let kept = system.l2();
    let before = system.accel(&System::start(&system).0, &[3.0], &[0.0]);
    let outcome = system.set_l2(0.0);
    // l2 is a factor of the pivot l2 l3 sin(b − c), which is checked when ξ̇ is computed.
    if outcome.is_ok() {
        let error = system.accel(&System::start(&system).0, &[3.0], &[0.0]);
        assert_eq!(error, Err(Singular::Kinematics { pivot: 0 }));
        system.set_l2(kept).expect("a length");
    }
    assert_eq!(
        system.accel(&System::start(&system).0, &[3.0], &[0.0]),
        before
    );
}
