//! Reports as one self-contained HTML page: pictures inline, light and dark.

use crate::code_markup::{mark_up, plain};
use crate::data::{Case, MethodRun, Report};
use crate::markdown::{format_work, how, name};
use crate::number::short;
use crate::plot::{Figure, sheet};
use crate::work::{TARGET_ERRORS, work};
use crate::{auto, tolerance_table};
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// A picture with a heading.
pub struct Picture {
    /// Heading.
    pub title: String,
    /// The drawing.
    pub figure: Figure,
}

const STYLE: &str = "\
:root{color-scheme:light dark;--ink:#1c2128;--soft:#59636e;--rule:#e3e7ec;--ground:#fff}\
@media(prefers-color-scheme:dark){:root{--ink:#e8edf3;--soft:#9aa5b1;--rule:#2a323c;--ground:#11161d}}\
body{font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--ground);max-width:62rem;margin:2rem auto;padding:0 1rem}\
h2{margin-top:2.5rem;border-top:1px solid var(--rule);padding-top:1rem}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:1rem 0;display:block;overflow-x:auto}\
th,td{padding:.2rem .7rem;border-bottom:1px solid var(--rule);text-align:right;white-space:nowrap}\
th:first-child,td:first-child{text-align:left}caption{text-align:left;color:var(--soft)}\
.words td{text-align:left;white-space:normal}svg{max-width:100%;height:auto}p.soft{color:var(--soft)}\
code{font-size:.9em}summary{cursor:pointer}";

/// Renders the page. `figures` contains the picture of every case in turn, `further` those at the end.
pub fn write(report: &Report, figures: &[Option<Figure>], further: &[Picture]) -> String {
    let figure = |index: usize| figures.get(index).and_then(Option::as_ref);
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (plain(&report.title)) }
                style { (PreEscaped(STYLE)) (PreEscaped(sheet())) }
            }
            body {
                main {
                    h1 { (mark_up(&report.title)) }
                    @for paragraph in how(report).split("\n\n") {
                        p.soft { (mark_up(paragraph)) }
                    }
                    nav aria-label="cases" {
                        ul {
                            @for case in &report.cases {
                                li { a href=(format!("#{}", case.name)) { (mark_up(&case.title)) } }
                            }
                        }
                    }
                    (peers(report))
                    @if let Some(verdict) = auto::verdict(report) {
                        h2 { (mark_up("What `auto` takes")) }
                        p { (mark_up(&verdict)) }
                    }
                    @for (index, case) in report.cases.iter().enumerate() {
                        (section(case, figure(index)))
                    }
                    @for picture in further {
                        section {
                            h2 { (mark_up(&picture.title)) }
                            (PreEscaped(picture.figure.inline()))
                        }
                    }
                }
            }
        }
    };
    page.into_string()
}

fn peers(report: &Report) -> Markup {
    html! {
        @if !report.peers.is_empty() {
            h2 { "Other programs" }
            table.words {
                thead { tr { th scope="col" { "program" } th scope="col" { "measured" } th scope="col" { "what" } th scope="col" { "to include it here" } } }
                tbody {
                    @for peer in &report.peers {
                        tr {
                            td { (mark_up(&peer.name)) }
                            td { @if peer.available { "yes" } @else { "not available" } }
                            td { (mark_up(&peer.note)) }
                            td { code { (peer.start) } }
                        }
                    }
                }
            }
        }
    }
}

fn section(case: &Case, figure: Option<&Figure>) -> Markup {
    html! {
        section id=(case.name) {
            h2 { (mark_up(&case.title)) }
            p.soft {
                "t = " (short(case.until)) "; error: " (mark_up(&case.error)) ", against " (mark_up(&case.reference))
                @if let Some(error) = case.reference_error { " (itself off by " (format!("{error:.0e}")) ")" }
            }
            @if let Some(figure) = figure { (PreEscaped(figure.inline())) }
            (summary(case))
            (tolerances(case))
            @for missing in &case.missing {
                p.soft { code { (missing.method) } " was not run: " (mark_up(&missing.why)) "." }
            }
        }
    }
}

/// Renders the work to reach errors.
fn summary(case: &Case) -> Markup {
    let evaluations = |run: &MethodRun| run.evaluations.map(|count| count as f64);
    let micros = |run: &MethodRun| run.seconds.map(|seconds| 1e6 * seconds);
    html! {
        table {
            caption { "evaluations of forces, and µs, to reach an error" }
            thead {
                tr {
                    th scope="col" { "method" }
                    @for target in TARGET_ERRORS { th scope="col" { (format!("{target:.0e}")) } }
                    @for target in TARGET_ERRORS { th scope="col" { (format!("µs, {target:.0e}")) } }
                }
            }
            tbody {
                @for method in &case.methods {
                    tr {
                        td { (name(method)) }
                        @for target in TARGET_ERRORS { td { (format_work(work(&method.runs, target, evaluations))) } }
                        @for target in TARGET_ERRORS { td { (format_work(work(&method.runs, target, micros))) } }
                    }
                }
            }
        }
    }
}

/// Renders the results at each tolerance, for methods with error control.
fn tolerances(case: &Case) -> Markup {
    html! {
        @if let Some((head, rows)) = tolerance_table::table(case) {
            table {
                caption { "steps chosen by their error" }
                thead { tr { @for cell in &head { th scope="col" { (cell) } } } }
                tbody {
                    @for row in &rows { tr { @for cell in row { td { (mark_up(cell)) } } } }
                }
            }
        }
    }
}
