//! The hard cases by methods for bodies in potentials: closed forms, few evaluations, no drift of the tilt.

use hamel::methods::{Rkmk8, Scheme, free};
use hamel::so3;
use hamel_cases::models::lagrange_top::LagrangeTop;
use hamel_cases::models::principal_axes::{PrincipalAxes, PrincipalAxesParameters};
use hamel_cases::{Case, bodies};

/// Bound of ω of the closed form, relative to max(1, |ω|): about ten roundings, through Jacobi's functions near modulus
/// one.
const SPIN_TOLERANCE: f64 = 1e-13;
/// Bound of R of the closed form: the angle about the momentum grows with time, and its rounding too.
const ATTITUDE_TOLERANCE: f64 = 1e-11;

/// Checks all listed times of all free bodies, each in one evaluation from the start.
#[test]
fn free_bodies_have_a_closed_form() {
    for case in [
        bodies::dzhanibekov(),
        bodies::dzhanibekov_near(),
        bodies::nearly_symmetric(),
        bodies::elongated(),
        bodies::fast_spin(),
    ] {
        for t in case.reference.times() {
            let state = free::at(&case.system, &case.start, t).expect(case.name);
            for (field, error) in case.deviations(t, &state) {
                let bound = if field == "R" {
                    ATTITUDE_TOLERANCE
                } else {
                    SPIN_TOLERANCE
                };
                assert!(
                    error <= bound,
                    "{} at t = {t}: {field} is off by {error:e}",
                    case.name
                );
            }
        }
    }
}

/// Consecutive flips are half the period of the elliptic functions apart.
#[test]
fn flips_are_spaced_by_the_half_period() {
    for case in [bodies::dzhanibekov(), bodies::dzhanibekov_near()] {
        let half = case.reference.extra("half_period_between_flips");
        let middle = |t: f64| free::at(&case.system, &case.start, t).expect("free").xi[1];
        // ω₂ has a zero in the middle of each flip, found by bisection down to the rounding of t.
        let flip = |mut a: f64, mut b: f64| {
            let rising = middle(b) > middle(a);
            while b - a > 4.0 * f64::EPSILON * b {
                let m = 0.5 * (a + b);
                if (middle(m) > 0.0) == rising {
                    b = m;
                } else {
                    a = m;
                }
            }
            0.5 * (a + b)
        };
        let first = flip(0.25 * half, 0.75 * half);
        let second = flip(first + 0.5 * half, first + 1.5 * half);
        let off = (second - first) / half - 1.0;
        assert!(off.abs() <= 1e-13, "{}: {off:e}", case.name);
    }
}

/// For inertias with equal moments, and spins about principal axes, the closed form takes its limit: uniform rotation.
#[test]
fn symmetric_bodies_and_principal_axes_are_limits() {
    for (moments, spin) in [
        ([2.0, 2.0, 2.0], [0.3, -0.4, 1.2]),
        ([1.0, 1.0, 1.7], [0.0, 0.0, 5.0]),
        ([1.0, 2.0, 3.0], [2.0, 0.0, 0.0]),
        ([1.0, 2.0, 3.0], [0.0, 2.0, 0.0]),
        ([1.0, 2.0, 3.0], [0.0, 0.0, -2.0]),
        ([1.0, 2.0, 3.0], [0.0; 3]),
        ([1.0, 2.0, 3.0], [0.0, f64::MIN_POSITIVE / 8.0, 0.0]),
    ] {
        let [j1, j2, j3] = moments;
        let system = PrincipalAxes::new(PrincipalAxesParameters { j1, j2, j3 }).expect("a body");
        let start = hamel::State {
            t: 0.0,
            x: so3::identity(),
            xi: spin,
        };
        let end = free::at(&system, &start, 7.0).expect("free");
        let expected = so3::exp(spin.map(|w| 7.0 * w));
        for (a, b) in end.x.iter().zip(expected) {
            assert!((a - b).abs() <= 1e-13, "{moments:?} {spin:?}: {a} and {b}");
        }
        for (a, b) in end.xi.iter().zip(spin) {
            assert!((a - b).abs() <= 1e-14, "{moments:?} {spin:?}: {a} and {b}");
        }
    }
}

/// Returns the smallest number of evaluations for which the error of R is at most 1e-9.
fn evaluations(runs: impl Iterator<Item = (f64, u64)>) -> u64 {
    let good = runs.filter(|(error, _)| *error <= 1e-9);
    good.map(|(_, count)| count).min().unwrap_or(u64::MAX)
}

#[test]
fn the_benchmark_needs_few_evaluations() {
    let case = bodies::benchmark_top();
    let split = evaluations((20..=60).map(|n| {
        let run = case.split(Scheme::Nystrom4, case.until, n).expect("a run");
        (case.error(&run.0), run.1)
    }));
    assert!(split <= 250, "splitting: {split}");
    let explicit = evaluations([430, 440, 450].into_iter().map(|n| {
        let run = case.counted(Rkmk8, case.until, n).expect("a run");
        (case.error(&run.0), run.1)
    }));
    assert!(explicit <= 5_400, "rkmk8: {explicit}");
}

#[test]
fn other_tops_need_few_evaluations() {
    let fast = bodies::fast_top();
    let split = evaluations((400..=450).step_by(10).map(|n| {
        let run = fast.split(Scheme::Nystrom4, fast.until, n).expect("a run");
        (fast.error(&run.0), run.1)
    }));
    assert!(split <= 2_700, "fast top: {split}");
    let top = bodies::kovalevskaya();
    let explicit = evaluations([100, 105, 110, 116].into_iter().map(|n| {
        let run = top.counted(Rkmk8, top.until, n).expect("a run");
        (top.error(&run.0), run.1)
    }));
    assert!(explicit <= 1_400, "Kovalevskaya's top: {explicit}");
}

/// A sleeping top is stable by 1 % of its spin: its tilt stays near 10⁻⁶, with steps of 1.2 rad.
#[test]
fn the_sleeping_top_stays_asleep() {
    const STEP: f64 = 0.04;
    let case: Case<LagrangeTop<f64>> = bodies::sleeping_top();
    let method = hamel::methods::Splitting::new(&case.system, Scheme::Nystrom4);
    let mut state = case.start.clone();
    let mut tilt = 0.0_f64;
    let none = |_, _: &_, _: &_| [];
    let watch = |state: &hamel::State<LagrangeTop<f64>>| {
        tilt = tilt.max(state.x[2].hypot(state.x[5]));
    };
    hamel::integrate(
        &case.system,
        method,
        &mut state,
        STEP,
        case.until,
        none,
        watch,
    )
    .expect("a run");
    assert!(tilt <= 7.2e-6, "{tilt:e}");
    let error = case.error_at(case.until, &state);
    assert!(error <= 1e-10, "{error:e}");
}

#[test]
fn the_vertical_top_passes_upright() {
    let case = bodies::vertical_top();
    let (end, _) = case
        .split(Scheme::Nystrom4, case.until, 1000)
        .expect("a run");
    assert!(case.error(&end) <= 1e-9, "{:e}", case.error(&end));
    let end = case.run(Rkmk8, case.until, 1000).expect("a run");
    assert!(case.error(&end) <= 1e-12, "{:e}", case.error(&end));
}

/// Forces that depend on positions, time and constant inputs can be split, too.
#[test]
fn loads_that_are_no_potentials_are_kicks() {
    let satellite = bodies::gravity_gradient();
    let (end, _) = satellite
        .split(Scheme::Nystrom6, satellite.until, 400)
        .expect("a run");
    assert!(satellite.error(&end) <= 1e-9, "{:e}", satellite.error(&end));
    for case in [bodies::offset_body(), bodies::constant_wrench()] {
        let (end, _) = case
            .split(Scheme::Nystrom6, case.until, 400)
            .expect("a run");
        assert!(case.error(&end) <= 1e-9, "{:e}", case.error(&end));
    }
    let pendulum = bodies::spherical_pendulum();
    let (end, _) = pendulum
        .split(Scheme::Nystrom6, pendulum.until, 600)
        .expect("a run");
    assert!(pendulum.error(&end) <= 1e-9, "{:e}", pendulum.error(&end));
}
