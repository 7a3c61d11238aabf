//! Reports as Markdown tables.

use crate::data::{Case, Kind, MethodRun, MethodRuns, Report};
use crate::number::{digits, error, group_thousands, short};
use crate::work::{TARGET_ERRORS, Work, work};
use crate::{auto, tolerance_table};
use std::fmt::Write;

/// Renders a whole report; `picture` returns the file of a case's picture, if there is one.
pub fn write(report: &Report, picture: impl Fn(&Case) -> Option<String>) -> String {
    let mut text = format!("# {}\n\n{}\n", cell(&report.title), how(report));
    if !report.peers.is_empty() {
        text.push_str("\n## Other programs\n\n| program | measured | |\n|---|---|---|\n");
        for peer in &report.peers {
            let measured = if peer.available {
                "yes"
            } else {
                "not available"
            };
            line(&mut text, &[&peer.name, measured, &peer.note]);
        }
        text.push_str("\nTo include all of them in the report:\n\n```sh\n");
        for peer in &report.peers {
            let _ = writeln!(text, "# {}\n{}", peer.name, peer.start);
        }
        text.push_str("```\n");
    }
    if let Some(verdict) = auto::verdict(report) {
        let _ = write!(text, "\n## What `auto` takes\n\n{verdict}\n");
    }
    for entry in &report.cases {
        let _ = write!(text, "\n## {}\n\n", cell(&entry.title));
        if let Some(file) = picture(entry) {
            let _ = write!(text, "![error against work]({file})\n\n");
        }
        text.push_str(&case(entry));
    }
    if !report.drifts.is_empty() {
        text.push_str("\n## Long runs\n\n");
        text.push_str(&drifts(report));
    }
    text
}

/// Describes the measurements in plain words.
pub fn how(report: &Report) -> String {
    let machine = &report.machine;
    let mut text = String::new();
    if machine.repeats > 0 {
        let _ = write!(
            text,
            "Times are medians of {} interleaved repeats on one core ({}; {}); the equations are {}. Compare ratios: \
             times of other machines differ.\n\n",
            machine.repeats, machine.processor, machine.system, machine.code
        );
    }
    let _ = write!(
        text,
        "Work to reach an error is interpolated between runs with doubled numbers of steps; `≤` marks a first run that \
         is already better than required, `-` an error that no run reached. Drifts are the largest of a run, relative; the \
         defect is max |φ(x)|.\n\nTo reproduce this: `{}`",
        report.command
    );
    text
}

/// Renders the tables of one case.
pub fn case(case: &Case) -> String {
    let mut text = format!(
        "t = {}. Error: {}, against {}{}.\n\n",
        short(case.until),
        case.error,
        case.reference,
        case.reference_error.map_or(String::new(), |error| format!(
            " (itself off by {error:.0e})"
        ))
    );
    if let Some(choice) = &case.auto {
        let _ = write!(text, "`auto` takes `{}`: {}", choice.method, choice.reason);
        match auto::ratio(case) {
            Some(ratio) => {
                let _ = write!(
                    text,
                    "; to {:.0e} it needs {ratio:.1} times the time of the fastest method.\n\n",
                    auto::TARGET_ERROR
                );
            }
            None => text.push_str(".\n\n"),
        }
    }
    let timed = case
        .methods
        .iter()
        .flat_map(|method| &method.runs)
        .any(|run| run.seconds.is_some());
    let mut head = vec!["method".to_string(), "order".into()];
    head.extend(
        TARGET_ERRORS
            .iter()
            .map(|target| format!("evaluations to {target:.0e}")),
    );
    if timed {
        head.extend(
            TARGET_ERRORS
                .iter()
                .map(|target| format!("µs to {target:.0e}")),
        );
    }
    table(&mut text, &head);
    for method in &case.methods {
        let mut cells = vec![
            name(method),
            method.order.map_or("-".into(), |p| p.to_string()),
        ];
        let evaluations = |run: &MethodRun| run.evaluations.map(|count| count as f64);
        cells.extend(
            TARGET_ERRORS.map(|target| format_work(work(&method.runs, target, evaluations))),
        );
        if timed {
            let micros = |run: &MethodRun| run.seconds.map(|seconds| 1e6 * seconds);
            cells.extend(
                TARGET_ERRORS.map(|target| format_work(work(&method.runs, target, micros))),
            );
        }
        row(&mut text, &cells);
    }
    text.push('\n');
    let mut head: Vec<String> = [
        "most exact run of",
        "steps",
        "error",
        "energy",
        "momentum",
        "defect",
    ]
    .map(String::from)
    .to_vec();
    if timed {
        head.extend(["ns a step".to_string(), "µs a unit of time".into()]);
    }
    table(&mut text, &head);
    for method in &case.methods {
        row(&mut text, &best(method, case.until, timed));
    }
    if let Some((head, rows)) = tolerance_table::table(case) {
        text.push('\n');
        table(&mut text, &head);
        for cells in rows {
            row(&mut text, &cells);
        }
    }
    for missing in &case.missing {
        let _ = write!(
            text,
            "\n`{}` was not run: {}.",
            missing.method,
            cell(&missing.why)
        );
    }
    if !case.missing.is_empty() {
        text.push('\n');
    }
    text
}

/// Returns the run with the least error, or the reason for its absence.
fn best(method: &MethodRuns, until: f64, timed: bool) -> Vec<String> {
    let with = |run: &&MethodRun| run.error.is_some();
    let order = |a: &&MethodRun, b: &&MethodRun| {
        let value = |run: &MethodRun| run.error.unwrap_or(f64::INFINITY);
        value(a).total_cmp(&value(b))
    };
    let Some(run) = method.runs.iter().filter(with).min_by(order) else {
        let failure = method.runs.iter().find_map(|run| run.failure.clone());
        return vec![
            name(method),
            "-".into(),
            failure.unwrap_or_else(|| "-".into()),
        ];
    };
    let value = |value: Option<f64>| value.map_or("-".into(), error);
    let mut cells = vec![
        name(method),
        group_thousands(run.steps),
        value(run.error),
        value(run.energy),
        value(run.momentum),
        value(run.defect),
    ];
    if timed {
        let step = run.seconds_per_step();
        cells.push(step.map_or("-".into(), |seconds| digits(1e9 * seconds, 3)));
        let unit = run.seconds.map(|seconds| 1e6 * seconds / until);
        cells.push(unit.map_or("-".into(), |micros| digits(micros, 3)));
    }
    cells
}

/// Renders long runs, with the growth of their energy error.
fn drifts(report: &Report) -> String {
    let mut text = "Largest deviation of the energy in the last quarter over that in the first: 1 means no drift.\n\n".to_string();
    let head = [
        "case",
        "method",
        "step",
        "steps",
        "energy",
        "last/first quarter",
        "momentum",
        "defect",
    ];
    table(&mut text, &head.map(String::from));
    for drift in &report.drifts {
        let value = |value: Option<f64>| value.map_or("-".into(), error);
        let energy = drift.energy.iter().copied().fold(0.0, f64::max);
        let ended = drift.failure.as_ref().map(|why| format!("ended: {why}"));
        let growth = drift.growth().map(|growth| digits(growth, 3));
        row(
            &mut text,
            &[
                drift.case.clone(),
                drift.method.clone(),
                short(drift.step),
                group_thousands(drift.steps),
                error(energy),
                ended.or(growth).unwrap_or_else(|| "-".into()),
                value(drift.momentum),
                value(drift.defect),
            ],
        );
    }
    text
}

/// Returns the name of a method with its role.
pub fn name(method: &MethodRuns) -> String {
    match method.kind {
        Kind::Method => method.method.clone(),
        Kind::Baseline => format!("{} (baseline)", method.method),
        Kind::Peer => format!("{} (peer)", method.method),
    }
}

/// Formats work with three digits.
pub fn format_work(work: Work) -> String {
    let three = |value: f64| digits(value, 3);
    match work {
        Work::Reached(value) => three(value),
        Work::AtMost(value) => format!("≤ {}", three(value)),
        Work::NotReached => "-".into(),
    }
}

fn table(text: &mut String, head: &[String]) {
    row(text, head);
    let rule: Vec<&str> = head
        .iter()
        .enumerate()
        .map(|(index, _)| if index == 0 { "---" } else { "---:" })
        .collect();
    let _ = writeln!(text, "|{}|", rule.join("|"));
}

fn row(text: &mut String, cells: &[String]) {
    let cells: Vec<&str> = cells.iter().map(String::as_str).collect();
    line(text, &cells);
}

fn line(text: &mut String, cells: &[&str]) {
    let cells: Vec<String> = cells.iter().map(|text| cell(text)).collect();
    let _ = writeln!(text, "| {} |", cells.join(" | "));
}

/// Escapes a text for a cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
        .replace('\n', " ")
        .replace('<', "&lt;")
}
