//! The part of the book that is written from a report, between two comments.

use crate::auto::{self, TARGET_ERROR, fastest};
use crate::data::{MethodRun, Report};
use crate::markdown::format_work;
use crate::work::{Work, work};
use std::fmt::Write;

/// Marks the beginning of the block.
pub const BEGIN_MARKER: &str = "<!-- report: begin -->";
/// Marks its end.
pub const END_MARKER: &str = "<!-- report: end -->";

/// Renders a table of the fastest method of every case and its cost for an error of 1e-9, compared with rkmk4 and the
/// method that `auto` takes.
pub fn block(report: &Report) -> String {
    let mut text = String::from(
        "| motion | fastest method to 1e-9 | evaluations of forces | time | `rkmk4` to 1e-9 | `auto` takes | over the fastest |\n|---|---|---:|---:|---:|---|---:|\n",
    );
    for case in &report.cases {
        if let Some((method, time)) = fastest(case) {
            let evaluations = |run: &MethodRun| run.evaluations.map(|count| count as f64);
            let usual = case.methods.iter().find(|other| other.method == "rkmk4");
            let _ = writeln!(
                text,
                "| {} | `{}` | {} | {} | {} | {} | {} |",
                case.title.replace('|', "\\|"),
                method.method,
                format_work(work(&method.runs, TARGET_ERROR, evaluations)),
                micros(Some(time)),
                micros(usual.map(auto::micros)),
                case.auto
                    .as_ref()
                    .map_or("-".into(), |choice| format!("`{}`", choice.method)),
                auto::ratio(case).map_or("-".into(), |ratio| format!("{ratio:.1}")),
            );
        }
    }
    text
}

fn micros(time: Option<Work>) -> String {
    match time {
        Some(Work::Reached(value)) if value >= 1e4 => {
            format!("{} ms", format_work(Work::Reached(1e-3 * value)))
        }
        Some(time @ (Work::Reached(_) | Work::AtMost(_))) => format!("{} µs", format_work(time)),
        _ => "not reached".into(),
    }
}

/// Replaces the block of a text; `None` if the comments are missing.
pub fn replace_block(text: &str, block: &str) -> Option<String> {
    let (before, rest) = text.split_once(BEGIN_MARKER)?;
    let (_, after) = rest.split_once(END_MARKER)?;
    Some(format!(
        "{before}{BEGIN_MARKER}\n{block}{END_MARKER}{after}"
    ))
}

/// Returns the block of a text; `None` if the comments are missing.
pub fn present(text: &str) -> Option<&str> {
    let (_, rest) = text.split_once(BEGIN_MARKER)?;
    let (block, _) = rest.split_once(END_MARKER)?;
    Some(block.strip_prefix('\n').unwrap_or(block))
}
