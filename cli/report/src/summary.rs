//! The few runs of a report from which its part of the book is made, small enough to be stored.

use crate::auto::{TARGET_ERROR, fastest};
use crate::data::{Case, MethodRun, MethodRuns, Report};

/// Reduces a report to the runs that [`crate::book_excerpt::block`] reads: of every case the fastest method, the one of
/// `auto` and rkmk4, and of these the two runs between which the error falls to 1e-9.
pub fn summary(report: &Report) -> Report {
    Report {
        cases: report.cases.iter().map(case).collect(),
        drifts: Vec::new(),
        ..report.clone()
    }
}

fn case(case: &Case) -> Case {
    let fastest = fastest(case).map(|(method, _)| method.method.as_str());
    let chosen = case.auto.as_ref().map(|choice| choice.method.as_str());
    let read = [fastest, chosen, Some("rkmk4")];
    let methods = case.methods.iter();
    let methods = methods.filter(|method| read.contains(&Some(method.method.as_str())));
    Case {
        methods: methods.map(runs_around).collect(),
        missing: Vec::new(),
        ..case.clone()
    }
}

/// Keeps the first run that reaches the error and the one before it, or the last run if none does.
fn runs_around(method: &MethodRuns) -> MethodRuns {
    let reaches = |run: &MethodRun| run.error.is_some_and(|error| error <= TARGET_ERROR);
    let last = method.runs.len().saturating_sub(1);
    let range = match method.runs.iter().position(reaches) {
        Some(index) => index.saturating_sub(1)..=index,
        None => last..=last,
    };
    let bare = |run: &MethodRun| MethodRun {
        energy: None,
        momentum: None,
        defect: None,
        ..run.clone()
    };
    let runs = method.runs.get(range).unwrap_or_default();
    MethodRuns {
        runs: runs.iter().map(bare).collect(),
        ..method.clone()
    }
}
