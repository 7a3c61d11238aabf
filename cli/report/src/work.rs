//! The work to reach an error, interpolated between the measured runs.

use crate::data::MethodRun;

/// The errors for which tables show the work.
pub const TARGET_ERRORS: [f64; 3] = [1e-3, 1e-6, 1e-9];

/// The work that a method needs to reach an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Work {
    /// Interpolated between two runs, linearly in the logarithms: exact if error = C hᵖ.
    Reached(f64),
    /// The work of the run with the longest steps, which already reaches the error.
    AtMost(f64),
    /// Not reached by any run.
    NotReached,
}

/// Returns the least `work` (evaluations, time) of `runs`, ordered by decreasing step length, for an error of at most
/// `target`.
pub fn work(runs: &[MethodRun], target: f64, work: impl Fn(&MethodRun) -> Option<f64>) -> Work {
    let reaches = |run: &MethodRun| run.error.is_some_and(|error| error <= target);
    let Some(index) = runs.iter().position(reaches) else {
        return Work::NotReached;
    };
    let Some(here) = runs.get(index).and_then(&work) else {
        return Work::NotReached;
    };
    let Some(before) = index.checked_sub(1).and_then(|before| runs.get(before)) else {
        return Work::AtMost(here);
    };
    let point = |run: &MethodRun| Some((run.error?.ln(), work(run)?.ln()));
    match (point(before), runs.get(index).and_then(point)) {
        (Some((e0, w0)), Some((e1, w1))) if e0 > e1 && e1.is_finite() => {
            let part = (e0 - target.ln()) / (e0 - e1);
            Work::Reached((w0 + part * (w1 - w0)).exp())
        }
        // The run before failed, or this one has no error.
        _ => Work::AtMost(here),
    }
}

impl Work {
    /// Returns the value, if there is one.
    pub fn value(self) -> Option<f64> {
        match self {
            Work::Reached(value) | Work::AtMost(value) => Some(value),
            Work::NotReached => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Work, work};
    use crate::data::MethodRun;

    /// Returns the runs of a method with error = C hᵖ, h = 1/n, and s evaluations a step.
    fn runs(c: f64, p: i32, s: u64) -> Vec<MethodRun> {
        let run = |steps: u64| MethodRun {
            steps,
            evaluations: Some(s * steps),
            error: Some(c / (steps as f64).powi(p)),
            ..MethodRun::default()
        };
        [10, 20, 40, 80, 160].map(run).to_vec()
    }

    fn evaluations(run: &MethodRun) -> Option<f64> {
        run.evaluations.map(|count| count as f64)
    }

    #[test]
    fn a_power_law_gives_the_exact_work() {
        for (p, s, steps) in [(2, 1, 33.0), (4, 4, 57.0), (8, 12, 150.0)] {
            let c = 3.7;
            let target = c / f64::powi(steps, p);
            match work(&runs(c, p, s), target, evaluations) {
                Work::Reached(found) => {
                    let exact = s as f64 * steps;
                    // The interpolation is exact up to the rounding of logarithms.
                    assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
                }
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn ends_of_the_range() {
        let runs = runs(1.0, 4, 4);
        assert_eq!(work(&runs, 1.0, evaluations), Work::AtMost(40.0));
        assert_eq!(work(&runs, 1e-30, evaluations), Work::NotReached);
        assert_eq!(work(&[], 1.0, evaluations), Work::NotReached);
        assert_eq!(work(&runs, 1e-5, |_| None), Work::NotReached);
    }

    #[test]
    fn a_failed_run_is_no_end_of_an_interval() {
        let mut runs = runs(1.0, 4, 4);
        runs[1].error = None;
        assert_eq!(work(&runs, 1e-6, evaluations), Work::AtMost(160.0));
    }
}
