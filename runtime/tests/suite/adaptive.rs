//! Runs that choose their steps: errors against tolerances, costs, dense output, what fails.

use crate::common::points::Points;
use crate::common::{Body, FreeBody, Reference, Top, distance, run};
use hamel::adaptive::{Adaptive, Report, Statistics, Tolerance};
use hamel::methods::General;
use hamel::{Block, Energies, Monitor, Singular, State, StepError, System};

const CASES: [(&str, f64); 2] = [("heavy-top-benchmark-150", 1.0), ("kovalevskaya-top", 20.0)];

fn top(case: &str) -> Top<f64> {
    Top(Reference::read(case).body())
}

fn none<Sys: System<Inputs = [f64; 0]>>(
    _: f64,
    _: &Sys::Coordinates,
    _: &Sys::Velocities,
) -> [f64; 0] {
    []
}

/// Error of R at the end, and what the run cost.
fn outcome<const M: usize, const D: usize>(
    method: Adaptive<M, D>,
    case: &str,
    until: f64,
) -> (f64, Statistics) {
    let system = top(case);
    let mut state = State::start(&system);
    let statistics = method
        .run(&system, &mut state, until, none::<Top<f64>>)
        .expect(case);
    assert_eq!(state.t, until);
    let error = distance(state.x, Reference::read(case).sample(until, "R"));
    (error, statistics)
}

/// Bars of a run: error below 1000 tolerances; few refusals once the tolerance is 1e-6 or less.
fn assert_bars(what: &str, tolerance: f64, (error, statistics): (f64, Statistics)) {
    println!(
        "{what}: {:.1} tolerances, {statistics:?}",
        error / tolerance
    );
    assert!(error <= 1000.0 * tolerance, "{what}: error {error:e}");
    if tolerance <= 1e-6 {
        let attempts = statistics.accepted + statistics.rejected;
        assert!(
            50 * statistics.rejected <= attempts,
            "{what}: {statistics:?}"
        );
    }
}

/// Errors follow the tolerance: the exponent over the decades, and no two neighbours far from it.
fn assert_proportional(what: &str, runs: &[(f64, f64)]) {
    let (first, last) = (runs[0], runs[runs.len() - 1]);
    let exponent = (last.1 / first.1).log10() / (last.0 / first.0).log10();
    println!("{what}: exponent {exponent:.3}");
    assert!((exponent - 1.0).abs() < 0.2, "{what}: {runs:?}");
    for pair in runs.windows(2) {
        let ratio = pair[0].1 / pair[1].1;
        // A decade of tolerance is a decade of error, give or take where the errors cancel.
        assert!((2.0..50.0).contains(&ratio), "{what}: {runs:?}");
    }
}

#[test]
fn errors_of_order_5_are_proportional_to_the_tolerance() {
    for (case, until) in CASES {
        let runs: Vec<(f64, f64)> = (5..=11)
            .map(|digits| {
                let tolerance = 10_f64.powi(-digits);
                let run = outcome(Adaptive::rkmk54(tolerance), case, until);
                assert_bars(&format!("rkmk54, {case}, 1e-{digits}"), tolerance, run);
                (tolerance, run.0)
            })
            .collect();
        assert_proportional(case, &runs);
    }
}

#[test]
fn errors_of_order_8_are_proportional_to_the_tolerance() {
    for (case, until) in CASES {
        let runs: Vec<(f64, f64)> = (5..=11)
            .map(|digits| {
                let tolerance = 10_f64.powi(-digits);
                let run = outcome(Adaptive::rkmk8(tolerance), case, until);
                assert_bars(&format!("rkmk8, {case}, 1e-{digits}"), tolerance, run);
                (tolerance, run.0)
            })
            .collect();
        assert_proportional(case, &runs);
    }
}

/// The largest error at the ends of steps and within them, against a much finer run.
fn dense_errors<const M: usize, const D: usize>(
    method: Adaptive<M, D>,
    case: &str,
    until: f64,
) -> (f64, f64) {
    let system = top(case);
    let mut state = State::start(&system);
    let mut exact = State::start(&system);
    let fine = Adaptive::rkmk8(1e-13);
    let (mut at_ends, mut within) = (0.0_f64, 0.0_f64);
    let observe = |report: Report<'_, Top<f64>, D>| {
        let Report::Step(step) = report else { return };
        assert_eq!(step.at(step.start().t).x, step.start().x);
        assert_eq!(step.at(step.end().t).x, step.end().x);
        let (from, to) = (step.start().t, step.end().t);
        for k in 1..=8 {
            let t = if k == 8 {
                to
            } else {
                from + (to - from) * f64::from(k) / 8.0
            };
            fine.run(&system, &mut exact, t, none::<Top<f64>>)
                .expect("a fine run");
            let state = step.at(t);
            assert_eq!(state.t, t);
            assert!(system.constraint_norm(&state.x) < 1e-14);
            let error = distance(state.x, exact.x).max(distance(state.xi, exact.xi));
            let largest = if k == 8 { &mut at_ends } else { &mut within };
            *largest = largest.max(error);
        }
    };
    method
        .integrate(&system, &mut state, until, none::<Top<f64>>, &[], observe)
        .expect(case);
    (at_ends, within)
}

#[test]
fn dense_output_is_as_good_as_the_steps() {
    let case = "kovalevskaya-top";
    for tolerance in [1e-5, 1e-8] {
        let (ends, within) = dense_errors(Adaptive::rkmk54(tolerance), case, 4.0);
        println!("rkmk54: {ends:e} at the ends, {within:e} within");
        assert!(within <= 3.0 * ends);
        let (ends, within) = dense_errors(Adaptive::rkmk8(tolerance), case, 4.0);
        println!("rkmk8: {ends:e} at the ends, {within:e} within");
        assert!(within <= 3.0 * ends);
    }
}

#[test]
fn a_run_back_returns_to_the_start() {
    for (case, until) in CASES {
        let system = top(case);
        let start = State::start(&system);
        let mut state = start.clone();
        let method = Adaptive::rkmk8(1e-12);
        method
            .run(&system, &mut state, until, none::<Top<f64>>)
            .expect(case);
        method
            .run(&system, &mut state, 0.0, none::<Top<f64>>)
            .expect(case);
        assert_eq!(state.t, 0.0);
        let distance = distance(state.x, start.x);
        // The error of a run to and fro: 1000 tolerances each, see above.
        assert!(distance < 2e-9, "{case}: {distance:e}");
    }
}

#[test]
fn no_time_is_no_step() {
    let system = top("kovalevskaya-top");
    let mut state = State::start(&system);
    let start = state.clone();
    let statistics = Adaptive::rkmk54(1e-6).run(&system, &mut state, 0.0, none::<Top<f64>>);
    assert_eq!(statistics, Ok(Statistics::default()));
    assert_eq!((state.x, state.xi), (start.x, start.xi));
}

#[test]
fn steps_do_not_exceed_the_longest_and_start_with_the_first() {
    let system = top("kovalevskaya-top");
    let mut state = State::start(&system);
    let mut method = Adaptive::rkmk54(1e-2);
    method.longest = 0.05;
    method.first = Some(1e-3);
    let mut lengths = Vec::new();
    let observe = |report: Report<'_, _, 1>| {
        if let Report::Step(step) = report {
            lengths.push(step.end().t - step.start().t);
        }
    };
    method
        .integrate(&system, &mut state, 2.0, none::<Top<f64>>, &[], observe)
        .expect("a run");
    assert!((lengths[0] - 1e-3).abs() < 1e-15);
    // The last step may be stretched by a hundredth.
    assert!(lengths.iter().all(|length| *length <= 0.05 * 1.011));
    assert!(lengths[1] > 2e-3, "steps grow");
}

#[test]
fn a_body_at_rest_takes_few_steps() {
    let mut body = Reference::read("free-dzhanibekov-1e-3").body();
    for w0 in [[0.0; 3], [5e-324; 3]] {
        body.w0 = w0;
        let system = Top(body.clone());
        let mut state = State::start(&system);
        let statistics = Adaptive::rkmk54(1e-9)
            .run(&system, &mut state, 1e3, none::<Top<f64>>)
            .expect("a body at rest");
        assert!(
            statistics.accepted < 20 && statistics.rejected == 0,
            "{statistics:?}"
        );
        assert!(distance(state.x, body.r0) < 1e-15);
        assert_eq!(state.xi, w0);
    }
}

#[test]
fn a_fixed_wrench_moves_a_body_as_the_reference_says() {
    let case = "quadrotor-constant-wrench";
    let reference = Reference::read(case);
    let system: FreeBody = reference.free_body();
    let force: [f64; 3] = reference.parameter("F").expect("F");
    let torque: [f64; 3] = reference.parameter("tau").expect("tau");
    let wrench: [f64; 6] = std::array::from_fn(|k| if k < 3 { force[k] } else { torque[k - 3] });
    let mut state = State::start(&system);
    Adaptive::rkmk8(1e-11)
        .run(&system, &mut state, 10.0, |_, _, _| wrench)
        .expect(case);
    let r: [f64; 3] = std::array::from_fn(|k| state.x[k]);
    let expected: [f64; 3] = reference.sample(10.0, "r");
    let scale = expected.iter().fold(1.0_f64, |most, r| most.max(r.abs()));
    assert!(distance(r, expected) / scale < 1e-8);
}

/// ξ̇ = ξ²: infinite at t = 1.
const EXPLOSION: Points<1> = Points {
    start: ([0.0], [1.0]),
    accel: |_, xi| Ok([xi[0] * xi[0]]),
};

/// Uniform motion that has no acceleration from x = 1 on.
const WALL: Points<1> = Points {
    start: ([0.0], [1.0]),
    accel: |x, _| {
        if x[0] < 1.0 {
            Ok([0.0])
        } else {
            Err(Singular::Mass)
        }
    },
};

#[test]
fn a_singularity_ahead_is_a_typed_error() {
    let mut state = State::start(&EXPLOSION);
    let end = Adaptive::rkmk54(1e-9).run(&EXPLOSION, &mut state, 2.0, none::<Points<1>>);
    println!("{end:?} at {}", state.t);
    assert!(matches!(
        end,
        Err(StepError::StepTooSmall { .. } | StepError::NonFinite { .. })
    ));
    // ξ = 1/(1 − t) as long as it exists.
    assert!(state.t < 1.0 && state.t > 0.999 && state.is_finite());

    let mut state = State::start(&WALL);
    let end = Adaptive::rkmk54(1e-9).run(&WALL, &mut state, 2.0, none::<Points<1>>);
    assert!(matches!(end, Err(StepError::Singular { .. })), "{end:?}");
    assert!(
        (state.t - 1.0).abs() < 1e-9,
        "the last step ends at the wall: {}",
        state.t
    );
}

#[test]
fn a_first_step_far_too_long_is_shortened() {
    let system = top("heavy-top-benchmark-150");
    let mut method = Adaptive::rkmk54(1e-9);
    method.first = Some(1.0);
    let mut state = State::start(&system);
    let statistics = method
        .run(&system, &mut state, 1.0, none::<Top<f64>>)
        .expect("a run");
    assert!(statistics.rejected >= 3);
    let exact = Reference::read("heavy-top-benchmark-150").sample(1.0, "R");
    assert!(distance(state.x, exact) < 1e-6);
}

#[test]
fn what_cannot_be_asked_is_a_typed_error() {
    let system = top("kovalevskaya-top");
    let start = State::start(&system);
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut state = start.clone();
        let end = Adaptive::rkmk54(tolerance).run(&system, &mut state, 1.0, none::<Top<f64>>);
        assert_eq!(
            end,
            Err(StepError::InvalidTolerance {
                least: f64::EPSILON
            })
        );
    }
    let mut absolute = Adaptive::rkmk54(1e-6);
    absolute.tolerance = Tolerance {
        relative: 0.0,
        ..Tolerance::new(1e-6)
    };
    assert!(
        absolute
            .run(&system, &mut start.clone(), 1.0, none::<Top<f64>>)
            .is_ok()
    );
    for until in [f64::NAN, f64::INFINITY] {
        let end = Adaptive::rkmk54(1e-6).run(&system, &mut start.clone(), until, none::<Top<f64>>);
        assert!(matches!(end, Err(StepError::InvalidStep { .. })));
    }
    let mut still = Adaptive::rkmk54(1e-6);
    still.longest = 0.0;
    let end = still.run(&system, &mut start.clone(), 1.0, none::<Top<f64>>);
    assert!(matches!(end, Err(StepError::InvalidStep { .. })));
    let mut broken = start.clone();
    broken.xi[0] = f64::NAN;
    let end = Adaptive::rkmk54(1e-6).run(&system, &mut broken, 1.0, none::<Top<f64>>);
    assert_eq!(end, Err(StepError::NonFinite { time: 0.0 }));
}

#[test]
fn a_tolerance_below_rounding_is_a_typed_error() {
    let double = top("kovalevskaya-top");
    let end =
        Adaptive::rkmk8(1e-17).run(&double, &mut State::start(&double), 1.0, none::<Top<f64>>);
    assert_eq!(
        end,
        Err(StepError::InvalidTolerance {
            least: f64::EPSILON
        })
    );
    let single = single_precision(&double.0);
    let end = Adaptive::rkmk8(1e-9).run(&single, &mut State::start(&single), 1.0, |_, _, _| []);
    let least = f64::from(f32::EPSILON);
    assert_eq!(end, Err(StepError::InvalidTolerance { least }));
}

fn single_precision(double: &Body<f64>) -> Top<f32> {
    Top(Body {
        inertia: double.inertia.map(|v| v as f32),
        m: double.m as f32,
        s: double.s.map(|v| v as f32),
        g: double.g.map(|v| v as f32),
        r0: double.r0.map(|v| v as f32),
        w0: double.w0.map(|v| v as f32),
    })
}

#[test]
fn single_precision_reaches_its_own_rounding() {
    let case = "kovalevskaya-top";
    let system = single_precision(&top(case).0);
    let mut state = State::start(&system);
    let run = Adaptive::rkmk54(1e-6).run(&system, &mut state, 20.0, |_, _, _| []);
    let statistics = run.expect("a run of f32");
    let error = distance(
        state.x.map(f64::from),
        Reference::read(case).sample(20.0, "R"),
    );
    println!("f32: {error:e}, {statistics:?}");
    // A hundred steps of a few roundings of 6e-8 each, amplified by the motion.
    assert!(error < 2e-4);
}

/// A point on a ring, x² + y² = 1, kept there by a multiplier: ξ̇ = g − λ x, λ = |ξ|² + g·x.
struct Ring;

impl Ring {
    const G: [f64; 2] = [0.0, -9.81];
}

impl System for Ring {
    type Scalar = f64;
    type Coordinates = [f64; 2];
    type Velocities = [f64; 2];
    type Chart = [f64; 2];
    type Inputs = [f64; 0];
    fn blocks(&self) -> &[Block] {
        &[Block::Flat(2)]
    }
    fn start(&self) -> ([f64; 2], [f64; 2]) {
        ([1.0, 0.0], [0.0, 0.0])
    }
    fn chart_rate(&self, _: &[f64; 2], xi: &[f64; 2]) -> [f64; 2] {
        *xi
    }
    fn forward_dynamics(
        &self,
        x: &[f64; 2],
        xi: &[f64; 2],
        _: &[f64; 0],
    ) -> Result<[f64; 2], Singular> {
        let square = xi[0] * xi[0] + xi[1] * xi[1];
        let multiplier = square + Self::G[0] * x[0] + Self::G[1] * x[1];
        Ok([
            Self::G[0] - multiplier * x[0],
            Self::G[1] - multiplier * x[1],
        ])
    }
    fn project_position(&self, x: &[f64; 2]) -> Result<Option<[f64; 2]>, Singular> {
        let factor = -0.5 * self.constraint(x);
        Ok(Some(x.map(|x| factor * x)))
    }
    fn project_velocity(&self, x: &[f64; 2], xi: &[f64; 2]) -> Result<Option<[f64; 2]>, Singular> {
        let outwards = x[0] * xi[0] + x[1] * xi[1];
        Ok(Some([xi[0] - outwards * x[0], xi[1] - outwards * x[1]]))
    }
    fn constraint_norm(&self, x: &[f64; 2]) -> f64 {
        self.constraint(x).abs()
    }
}

impl Energies for Ring {
    fn kinetic_energy(&self, _: &[f64; 2], xi: &[f64; 2]) -> f64 {
        0.5 * (xi[0] * xi[0] + xi[1] * xi[1])
    }
    fn potential_energy(&self, x: &[f64; 2]) -> f64 {
        -Self::G[1] * x[1]
    }
}

impl Ring {
    fn constraint(&self, x: &[f64; 2]) -> f64 {
        x[0] * x[0] + x[1] * x[1] - 1.0
    }
}

#[test]
fn constraints_of_multipliers_hold_after_every_step() {
    let mut state = State::start(&Ring);
    let mut monitor = Monitor::new(&Ring, &state);
    let outcome = Adaptive::rkmk8(1e-10)
        .integrate(&Ring, &mut state, 20.0, none::<Ring>, &[], |report| {
            if let Report::Step(step) = report {
                monitor.observe(&Ring, step.end());
            }
        })
        .expect("a run");
    let Statistics {
        accepted,
        rejected,
        evaluations,
    } = outcome.statistics;
    // What a Newton step leaves of a defect of 1e-10; the projection keeps the energy's error small.
    assert!(monitor.constraint() < 1e-15);
    assert!(monitor.relative_energy_deviation() < 1e-8);
    // Fifteen stages, and one more where the projection has moved the state.
    assert_eq!(evaluations, 2 + 15 * (accepted + rejected) + accepted);
}

#[test]
fn the_adaptive_methods_are_the_fixed_ones() {
    // One accepted step of the same length is the same step.
    let system = top("kovalevskaya-top");
    let fixed = run(&system, General::Rkmk54, 0.01, 1).expect("a step");
    let mut method = Adaptive::rkmk54(1.0);
    method.first = Some(0.01);
    let mut state = State::start(&system);
    method
        .run(&system, &mut state, 0.01, none::<Top<f64>>)
        .expect("a step");
    assert_eq!((state.x, state.xi), (fixed.x, fixed.xi));
}
