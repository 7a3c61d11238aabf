//! Stiff motion under explicit pairs: it is noticed, and refused where it would never end.

use crate::oscillator::Oscillator;
use hamel::adaptive::{Adaptive, Report};
use hamel::{State, StepError};

/// q̈ = −q − d q̇.
fn damped(damping: f64) -> Oscillator {
    Oscillator {
        frequency: 1.0,
        damping,
    }
}

/// The end of a run to t = 1 and its steps.
fn run<const M: usize, const D: usize>(
    method: Adaptive<M, D>,
    damping: f64,
) -> (Result<f64, StepError>, u64) {
    let system = damped(damping);
    let mut state = State::start(&system);
    let mut steps = 0;
    let outcome = method.integrate(
        &system,
        &mut state,
        1.0,
        |_, _, _| [0.0],
        &[],
        |report| {
            steps += u64::from(matches!(report, Report::Step(_)));
        },
    );
    (outcome.map(|_| state.x[0]), steps)
}

fn assert_noticed<const M: usize, const D: usize>(method: Adaptive<M, D>, damping: f64) {
    let (end, steps) = run(method, damping);
    match end {
        Err(StepError::Stiff { rate, step, .. }) => {
            assert!(
                rate > 0.3 * damping && rate < 3.0 * damping,
                "{rate:e} for {damping:e}"
            );
            assert!(step * damping < 10.0, "{step:e} for {damping:e}");
            assert!(damping > 1e6, "{damping:e} is no reason to stop");
            // It was noticed early, not after the million.
            assert!(steps < 5_000, "{damping:e}: {steps} steps");
        }
        Ok(q) => {
            // Overdamped: q falls at the rate 1/d.
            let slow = (0.5 * (damping - (damping * damping - 4.0).sqrt())).min(2.0 / damping);
            assert!(
                (q - (-slow).exp()).abs() < 2.0 / (damping * damping) + 1e-5,
                "{damping:e}: {q}"
            );
            assert!(damping < 1e8, "{damping:e} went on for {steps} steps");
        }
        Err(error) => panic!("{damping:e}: {error}"),
    }
}

#[test]
fn a_damper_that_would_take_a_billion_steps_is_refused_with_its_rate() {
    assert_noticed(Adaptive::rkmk54(1e-9), 1e9);
    assert_noticed(Adaptive::rkmk8(1e-9), 1e9);
}

/// At full size with `HAMEL_ATTACK=full`.
#[test]
fn dampers_of_any_size_end_or_are_refused() {
    let full = std::env::var("HAMEL_ATTACK").is_ok_and(|size| size == "full");
    let mut state = 5u64;
    let mut number = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1u64 << 31) as f64
    };
    for _ in 0..if full { 2_000 } else { 30 } {
        // Such as end soon, and such as never would.
        let exponent = match number() < 0.5 {
            true => 1.0 + 3.5 * number(),
            false => 8.0 + 6.0 * number(),
        };
        let (damping, tolerance) = (10f64.powf(exponent), 10f64.powf(-10.0 + 5.0 * number()));
        assert_noticed(Adaptive::rkmk54(tolerance), damping);
        assert_noticed(Adaptive::rkmk8(tolerance), damping);
    }
}

#[test]
fn more_steps_are_taken_where_they_are_allowed() {
    let mut patient = Adaptive::rkmk54(1e-6);
    patient.stiff = 1e3;
    assert!(matches!(run(patient, 1e5).0, Err(StepError::Stiff { .. })));
    patient.stiff = f64::INFINITY;
    let (end, steps) = run(patient, 1e5);
    assert!(end.is_ok() && steps > 10_000, "{end:?} after {steps} steps");
}
