//! Long runs: drift of conserved quantities, decay of disturbances, orders, and work.

use hamel::methods::{General, Rk4, Rkmk4};
use hamel::{Monitor, State, System, integrate, so3};
use hamel_tests::heavy_top::HeavyTop;
use hamel_tests::hoop_bead::HoopBead;
use hamel_tests::planar_body::PlanarBody;
use hamel_tests::reference::{distance, run, slopes};
use hamel_tests::rod_particles::RodParticles;
use hamel_tests::two_bodies::TwoBodies;

/// An invariant drifts like h⁴ if step errors accumulate, like h⁵ if they average out.
const DRIFT_ORDER: f64 = 3.9;
/// Tolerance between a slope and the order of a convergent run.
const ORDER_TOLERANCE: f64 = 0.1;

#[test]
fn heavy_top_keeps_energy_vertical_momentum_and_rotation() {
    let system: HeavyTop<f64> = HeavyTop::default();
    let theta = system.theta().concat();
    let theta: [f64; 9] = theta.try_into().expect("nine entries");
    let vertical =
        |state: &State<HeavyTop<f64>>| so3::apply(state.x, so3::apply(theta, state.xi))[2];
    let mut energies = Vec::new();
    for step in [0.02, 0.01, 0.005] {
        let mut state = State::start(&system);
        let momentum = vertical(&state);
        let mut monitor = Monitor::new(&system, &state);
        let mut drift = 0.0_f64;
        let inputs = |_, _: &_, _: &_| [];
        integrate(&system, Rkmk4, &mut state, step, 50.0, inputs, |state| {
            monitor.observe(&system, state);
            drift = drift.max((vertical(state) - momentum).abs());
        })
        .expect("a run");
        println!(
            "{step}: {:e} {drift:e}",
            monitor.relative_energy_deviation()
        );
        // |R_T R − I| of every state: a few roundings.
        assert!(monitor.constraint() < 2e-15, "{}", monitor.constraint());
        // h |ω| is at most 0.1: 5.8e-3 · 250 rad · 1e-4 bounds the errors at the coarsest step.
        assert!(drift < 1e-3 * (step / 0.02_f64).powi(4), "{drift}");
        energies.push(monitor.relative_energy_deviation());
    }
    assert!(energies[0] < 1e-3, "{energies:?}");
    for slope in slopes(&energies) {
        assert!(slope > DRIFT_ORDER, "{energies:?}");
    }
}

#[test]
fn two_bodies_keep_energy_and_vertical_momentum() {
    let system: TwoBodies<f64> = TwoBodies::default();
    let mut energies = Vec::new();
    for step in [4e-3, 2e-3, 1e-3] {
        let mut state = State::start(&system);
        let mut monitor = Monitor::new(&system, &state);
        let inputs = |_, _: &_, _: &_| [];
        let observe = |state: &_| monitor.observe(&system, state);
        integrate(&system, Rkmk4, &mut state, step, 10.0, inputs, observe).expect("a run");
        assert!(monitor.constraint() < 2e-15, "{}", monitor.constraint());
        energies.push(monitor.relative_energy_deviation());
    }
    println!("{energies:?}");
    for slope in slopes(&energies) {
        assert!(slope > DRIFT_ORDER, "{energies:?}");
    }
}

/// Disturbs x, runs to t = 0.5 with λ = 10 by RK4, and compares φ with exp(−λ t), entry by entry.
fn assert_decay<Sys, F>(system: &Sys, phi: F, disturb: impl Fn(usize) -> f64)
where
    Sys: System<Scalar = f64>,
    F: Fn(&Sys::Coordinates) -> Vec<f64>,
{
    /// λ, of the order that the integrators document.
    const LAMBDA: f64 = 10.0;
    /// Time over which exp(−λ t) = 1/148.
    const UNTIL: f64 = 0.5;
    /// Terms of φ² at a disturbance of 1e-5, and (λ h)⁵ of the method, with margin.
    const DECAY_TOLERANCE: f64 = 1e-3;
    let mut state = State::start(system);
    for (k, x) in state.x.as_mut().iter_mut().enumerate() {
        *x += disturb(k);
    }
    let before = phi(&state.x);
    let method = Rk4 { lambda: LAMBDA };
    let end = run(system, method, state, UNTIL, 500).expect("a run");
    let expected = (-LAMBDA * UNTIL).exp();
    for (before, after) in before.iter().zip(phi(&end.x)) {
        println!("{before:e} {after:e} {}", after / before / expected);
        assert!(before.abs() > 1e-6, "not disturbed");
        assert!((after / before / expected - 1.0).abs() < DECAY_TOLERANCE);
    }
}

#[test]
fn disturbed_constraints_decay_exponentially() {
    let disturb = |k: usize| 1e-5 * [1.0, -2.0, 1.5, 0.7, -1.2, 2.3][k];
    let rods: RodParticles<f64> = RodParticles::default();
    assert_decay(&rods, |x| rods.constraint(x).to_vec(), disturb);
    let plate: PlanarBody<f64> = PlanarBody::default();
    assert_decay(&plate, |x| plate.constraint(x).to_vec(), disturb);
}

#[test]
fn rods_are_integrated_with_order_four() {
    let system: RodParticles<f64> = RodParticles::default();
    let methods = [
        General::Rkmk4,
        General::Rk4 { lambda: 0.0 },
        General::Rk4 { lambda: 10.0 },
    ];
    for method in methods {
        let ends = [1000, 2000, 4000, 8000].map(|n| {
            let end = run(&system, method, State::start(&system), 1.0, n).expect("a run");
            [&end.x[..], &end.xi].concat()
        });
        let differences: Vec<f64> = ends.windows(2).map(|e| distance(&e[0], &e[1])).collect();
        println!("{method:?}: {differences:?} {:?}", slopes(&differences));
        for slope in slopes(&differences) {
            assert!(
                (slope - 4.0).abs() < ORDER_TOLERANCE,
                "{method:?}: {differences:?}"
            );
        }
    }
}

/// E(t) − E(0) = ∫ τ W dt, and the vertical momentum is the impulse: p_W(t) − p_W(0) = ∫ τ dt.
#[test]
fn hoop_takes_up_the_work_of_its_torque() {
    /// Steps of 1 ms: the errors of Simpson's rule and RKMK4 are 1e-11, with margin for rounding.
    const WORK_TOLERANCE: f64 = 1e-9;
    let system: HoopBead<f64> = HoopBead::default();
    let torque = |t: f64| 0.3 * (3.0 * t).cos() + 0.1;
    let impulse = |t: f64| 0.1 * (3.0 * t).sin() + 0.1 * t;
    let mut state = State::start(&system);
    let start = state.clone();
    let until = 10.0;
    let mut powers = Vec::new();
    let inputs = |t, _: &_, _: &_| [torque(t)];
    integrate(&system, Rkmk4, &mut state, 1e-3, until, inputs, |state| {
        powers.push(torque(state.t) * state.xi[0]);
    })
    .expect("a run");

    let intervals = powers.len() - 1;
    assert_eq!(intervals, 10_000);
    let simpson: f64 = powers
        .iter()
        .enumerate()
        .map(|(k, power)| match k {
            0 => *power,
            _ if k == intervals => *power,
            _ if k % 2 == 1 => 4.0 * power,
            _ => 2.0 * power,
        })
        .sum();
    let work = simpson * until / intervals as f64 / 3.0;
    let energy = system.energy(&state.x, &state.xi) - system.energy(&start.x, &start.xi);
    println!("work {work}, energy {energy}");
    assert!(work.abs() > 0.1, "no work to speak of");
    assert!(
        (energy - work).abs() < WORK_TOLERANCE,
        "{energy} against {work}"
    );
    let momentum =
        system.momentum(&state.x, &state.xi)[0] - system.momentum(&start.x, &start.xi)[0];
    assert!(
        (momentum - impulse(until)).abs() < WORK_TOLERANCE,
        "{momentum}"
    );
}
