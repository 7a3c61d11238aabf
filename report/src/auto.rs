//! How good the method is that the structure of a system chooses.

use crate::data::{Case, Kind, MethodRun, MethodRuns};
use crate::work::{Work, work};

/// The error at which methods are compared.
pub const TARGET: f64 = 1e-9;

/// The wall time in µs in which a method reaches the [`TARGET`].
pub fn micros(method: &MethodRuns) -> Work {
    work(&method.runs, TARGET, |run: &MethodRun| {
        run.seconds.map(|seconds| 1e6 * seconds)
    })
}

/// The method, no baseline and of no other program, that takes the least time.
pub fn fastest(case: &Case) -> Option<(&MethodRuns, Work)> {
    let ours = case
        .methods
        .iter()
        .filter(|method| method.kind == Kind::Method);
    ours.filter_map(|method| Some((method, micros(method), micros(method).value()?)))
        .min_by(|a, b| a.2.total_cmp(&b.2))
        .map(|(method, work, _)| (method, work))
}

/// The time of the chosen method over that of the fastest; `None` where one of them did not get there.
pub fn ratio(case: &Case) -> Option<f64> {
    let choice = case.auto.as_ref()?;
    let chosen = case
        .methods
        .iter()
        .find(|method| method.method == choice.method)?;
    let (_, best) = fastest(case)?;
    Some(micros(chosen).value()? / best.value()?)
}

#[cfg(test)]
mod tests {
    use super::{fastest, ratio};
    use crate::data::{Case, Choice, Kind, MethodRun, MethodRuns};

    fn method(name: &str, kind: Kind, seconds: f64) -> MethodRuns {
        let run = |steps: u64, error: f64| MethodRun {
            steps,
            error: Some(error),
            seconds: Some(seconds * steps as f64),
            ..MethodRun::default()
        };
        MethodRuns {
            method: name.into(),
            kind,
            order: Some(1),
            runs: vec![run(10, 1e-3), run(20, 1e-9)],
        }
    }

    #[test]
    fn a_baseline_is_not_the_fastest_and_the_ratio_is_of_times() {
        let case = Case {
            auto: Some(Choice {
                method: "slow".into(),
                reason: String::new(),
            }),
            methods: vec![
                method("baseline", Kind::Baseline, 1e-7),
                method("fast", Kind::Method, 1e-6),
                method("slow", Kind::Method, 3e-6),
            ],
            ..Case::default()
        };
        assert_eq!(
            fastest(&case).map(|(method, _)| &*method.method),
            Some("fast")
        );
        let ratio = ratio(&case).expect("both got there");
        assert!((ratio - 3.0).abs() < 1e-12, "{ratio}");
    }

    #[test]
    fn what_was_not_chosen_or_not_measured_has_no_ratio() {
        assert_eq!(ratio(&Case::default()), None);
    }
}
