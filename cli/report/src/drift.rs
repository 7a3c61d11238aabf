//! Long runs, which show whether conserved quantities drift or only oscillate.

use crate::data::{Drift, round_to_three_digits};
use crate::entry::{Division, Entry, Worst};

/// Number of windows of a run.
pub const WINDOWS_PER_RUN: u64 = 100;

/// Runs `steps` steps of one length, and keeps the largest deviations of each window; `None` for a method with error
/// control.
pub fn drift(case: &str, entry: &Entry, step: f64, steps: u64) -> Option<Drift> {
    let length = (steps / WINDOWS_PER_RUN).max(1);
    let mut worst = Worst::default();
    let mut window = Worst::default();
    let mut energy = Vec::new();
    // The first state is the start.
    let mut count = 0_u64;
    let outcome = entry.run(
        Division::Steps(steps),
        step * steps as f64,
        &mut |deviation| {
            worst.take(deviation);
            window.take(deviation);
            if count > 0 && count.is_multiple_of(length) {
                energy.extend(round_to_three_digits(window.energy));
                window = Worst::default();
            }
            count += 1;
        },
    )?;
    Some(Drift {
        case: case.to_string(),
        method: entry.method.clone(),
        step,
        steps,
        energy,
        momentum: round_to_three_digits(worst.momentum),
        defect: round_to_three_digits(worst.defect),
        failure: outcome.failure,
    })
}

#[cfg(test)]
mod tests {
    use super::drift;
    use crate::data::Kind;
    use crate::entry::{Deviation, Entry, Outcome};

    #[test]
    fn windows_hold_their_largest_deviations() {
        let run = |steps: u64, until: f64, watch: &mut dyn FnMut(Deviation)| {
            assert_eq!(until, 20.0);
            for step in 0..=steps {
                watch(Deviation {
                    energy: step as f64,
                    momentum: 0.5,
                    defect: f64::NAN,
                });
            }
            Outcome {
                evaluations: None,
                error: 0.0,
                failure: None,
                statistics: None,
            }
        };
        let entry = Entry::new("m", Kind::Method, None, run, |_, _| None);
        let drift = drift("c", &entry, 0.1, 200).expect("equal steps");
        assert_eq!(drift.energy.len(), 100);
        assert_eq!(drift.energy[..2], [2.0, 4.0]);
        assert_eq!((drift.momentum, drift.defect), (Some(0.5), None));
        assert_eq!(drift.growth(), Some(4.0));
    }
}
