//! Compares the method that is chosen by the structure of a system with the fastest one.

use crate::data::{Case, Kind, MethodRun, MethodRuns, Report};
use crate::work::{Work, work};
use std::fmt::Write;

/// The error at which methods are compared.
pub const TARGET_ERROR: f64 = 1e-9;

/// Returns the name of the comparison's entry for the method that `auto` takes: with error control where the method has
/// it.
pub fn entry(method: &str) -> String {
    match method {
        "rkmk54" | "rkmk8" => format!("{method} adaptive"),
        other => other.to_string(),
    }
}

/// Returns the wall time in µs in which a method reaches the [`TARGET_ERROR`].
pub fn micros(method: &MethodRuns) -> Work {
    work(&method.runs, TARGET_ERROR, |run: &MethodRun| {
        run.seconds.map(|seconds| 1e6 * seconds)
    })
}

/// Returns the fastest method that is neither a baseline nor of another program.
pub fn fastest(case: &Case) -> Option<(&MethodRuns, Work)> {
    let ours = case
        .methods
        .iter()
        .filter(|method| method.kind == Kind::Method);
    ours.filter_map(|method| Some((method, micros(method), micros(method).value()?)))
        .min_by(|a, b| a.2.total_cmp(&b.2))
        .map(|(method, work, _)| (method, work))
}

/// Returns the time of the chosen method relative to the fastest; `None` if one of them does not reach the target.
pub fn ratio(case: &Case) -> Option<f64> {
    let choice = case.auto.as_ref()?;
    let chosen = case
        .methods
        .iter()
        .find(|method| method.method == choice.method)?;
    let (_, best) = fastest(case)?;
    Some(micros(chosen).value()? / best.value()?)
}

/// Largest accepted time of the chosen method, relative to the fastest.
pub const MAX_TIME_RATIO: f64 = 2.0;

/// Summarises the choices over all cases in words: choices beyond the [`MAX_TIME_RATIO`], and choices that cannot be
/// judged. `None` if nothing was chosen.
pub fn verdict(report: &Report) -> Option<String> {
    let chosen: Vec<&Case> = report
        .cases
        .iter()
        .filter(|case| case.auto.is_some())
        .collect();
    if chosen.is_empty() {
        return None;
    }
    let judged: Vec<(&Case, f64)> = chosen
        .iter()
        .filter_map(|case| Some((*case, ratio(case)?)))
        .collect();
    let mut text = match judged.iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((worst, most)) => format!(
            "To reach an error of {TARGET_ERROR:.0e}, the method that `auto` takes needs at most {most:.1} times the time of the \
             fastest method measured, over {} of {} cases; the maximum is that of {}.",
            judged.len(),
            chosen.len(),
            worst.name
        ),
        None => {
            format!(
                "In no case did the method that `auto` takes reach an error of {TARGET_ERROR:.0e}."
            )
        }
    };
    let beyond = judged.iter().filter(|(_, ratio)| *ratio > MAX_TIME_RATIO);
    let beyond: Vec<&str> = beyond.map(|(case, _)| case.name.as_str()).collect();
    let _ = match beyond[..] {
        [] if judged.is_empty() => Ok(()),
        [] => write!(
            text,
            " It is never more than {MAX_TIME_RATIO} times slower."
        ),
        _ => write!(
            text,
            " It is more than {MAX_TIME_RATIO} times slower in: {}.",
            beyond.join(", ")
        ),
    };
    for case in chosen.iter().filter(|case| ratio(case).is_none()) {
        let why = match fastest(case) {
            None => "no method",
            Some(_) => "other methods, but not that of `auto`,",
        };
        let _ = write!(
            text,
            " {}: {why} reached {TARGET_ERROR:.0e} where times were measured.",
            case.name
        );
    }
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::{fastest, ratio, verdict};
    use crate::data::{Case, Choice, Kind, MethodRun, MethodRuns, Report};

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

    /// Returns a slow method, which is chosen, and a fast one.
    fn case(name: &str, slow: f64) -> Case {
        Case {
            name: name.into(),
            auto: Some(Choice {
                method: "slow".into(),
                reason: String::new(),
            }),
            methods: vec![
                method("baseline", Kind::Baseline, 1e-7),
                method("fast", Kind::Method, 1e-6),
                method("slow", Kind::Method, slow),
            ],
            ..Case::default()
        }
    }

    #[test]
    fn a_baseline_is_not_the_fastest_and_the_ratio_is_of_times() {
        let case = case("top", 3e-6);
        assert_eq!(
            fastest(&case).map(|(method, _)| &*method.method),
            Some("fast")
        );
        let ratio = ratio(&case).expect("both got there");
        assert!((ratio - 3.0).abs() < 1e-12, "{ratio}");
    }

    #[test]
    fn the_verdict_names_what_is_too_slow_and_what_cannot_be_judged() {
        let of = |cases: Vec<Case>| {
            verdict(&Report {
                cases,
                ..Report::default()
            })
        };
        assert_eq!(of(vec![Case::default()]), None);
        let good = of(vec![case("a", 1.5e-6), case("b", 1e-6)]).expect("a verdict");
        assert!(good.contains("at most 1.5 times"), "{good}");
        assert!(
            good.contains("2 of 2 cases; the maximum is that of a."),
            "{good}"
        );
        assert!(good.contains("never more than 2 times"), "{good}");
        let mut far = case("far", 1e-6);
        for method in &mut far.methods {
            method.runs.truncate(1);
        }
        let mut lame = case("lame", 1e-6);
        lame.methods[2].runs.truncate(1);
        let bad = of(vec![case("a", 1.5e-6), case("slow", 3e-6), far, lame]).expect("a verdict");
        for part in [
            "at most 3.0 times",
            "2 of 4 cases",
            "more than 2 times slower in: slow.",
            "far: no method reached",
            "lame: other methods, but not that of `auto`, reached",
        ] {
            assert!(bad.contains(part), "{part}: {bad}");
        }
    }

    #[test]
    fn what_was_not_chosen_or_not_measured_has_no_ratio() {
        assert_eq!(ratio(&Case::default()), None);
    }
}
