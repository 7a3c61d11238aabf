//! The output of the writers for a small case: structure, escaping, numbers.

use hamel_report::data::{
    Case, Choice, Drift, Kind, Machine, MethodRun, MethodRuns, Missing, Peer, Report,
};
use hamel_report::plot::precision;
use hamel_report::summary::summary;
use hamel_report::{book_excerpt, json, markdown, page};

/// A report with error = 1/n⁴, 4 n evaluations and 1 µs a step, so that 1e-6 takes 10^1.5 steps and 1e-9 takes 10^2.25.
fn report() -> Report {
    let run = |steps: u64| MethodRun {
        steps,
        evaluations: Some(4 * steps),
        error: Some((steps as f64).powi(-4)),
        energy: Some(2.5e-7),
        momentum: None,
        defect: Some(0.0),
        seconds: Some(1e-6 * steps as f64),
        ..MethodRun::default()
    };
    let failed = MethodRun {
        steps: 10,
        failure: Some("state <not finite>".into()),
        ..MethodRun::default()
    };
    let method = |name: &str, kind: Kind, runs: Vec<MethodRun>| MethodRuns {
        method: name.into(),
        kind,
        order: Some(4),
        runs,
    };
    Report {
        title: "Speed & error".into(),
        command: "make <it>".into(),
        machine: Machine {
            processor: "a processor".into(),
            system: "linux".into(),
            code: "compiled".into(),
            repeats: 3,
        },
        cases: vec![Case {
            name: "top".into(),
            title: "A top | <heavy>".into(),
            until: 2.0,
            error: "‖R − R*‖".into(),
            reference: "a solution".into(),
            reference_error: Some(1e-30),
            auto: None,
            methods: vec![
                method("rkmk4", Kind::Method, [10, 100, 1000].map(run).to_vec()),
                method("engine", Kind::Peer, vec![failed]),
            ],
            missing: vec![Missing {
                method: "free".into(),
                why: "a torque acts".into(),
            }],
        }],
        drifts: vec![Drift {
            case: "top".into(),
            method: "rkmk4".into(),
            step: 0.5,
            steps: 4000,
            energy: vec![1e-8, 2e-8, 3e-8, 5e-8],
            momentum: Some(1e-12),
            defect: None,
            failure: None,
        }],
        peers: vec![Peer {
            name: "engine".into(),
            available: false,
            note: "no wheel".into(),
            start: "install engine".into(),
        }],
    }
}

#[test]
fn json_reads_back_with_one_line_a_run() {
    let report = report();
    let text = json::write(&report).expect("JSON");
    assert_eq!(json::read(&text).expect("a report"), report);
    let runs = text
        .lines()
        .filter(|line| line.trim_start().starts_with("{\"steps\""))
        .count();
    assert_eq!(runs, 4, "{text}");
    assert!(
        text.contains("\"energy\": [1e-8, 2e-8, 3e-8, 5e-8]"),
        "{text}"
    );
    assert!(!text.contains("null"), "{text}");
    assert!(json::read("{").is_err());
}

#[test]
fn markdown_has_the_work_between_runs() {
    let text = markdown::write(&report(), |case| Some(format!("{}.svg", case.name)));
    // 4 · 10^1.5 = 126.5 and 4 · 10^2.25 = 711 evaluations; 10^1.5 and 10^2.25 µs.
    let row = "| rkmk4 | 4 | ≤ 40 | 126 | 711 | ≤ 10 | 31.6 | 178 |";
    assert!(text.contains(row), "{text}");
    assert!(
        text.contains("| rkmk4 | 1 000 | 1.0e-12 | 2.5e-7 | - | 0 | 1000 | 500 |"),
        "{text}"
    );
    assert!(
        text.contains("| engine (peer) | - | state &lt;not finite> |"),
        "{text}"
    );
    for part in [
        "## A top \\| &lt;heavy>",
        "![error against work](top.svg)",
        "(itself off by 1e-30)",
        "`free` was not run: a torque acts.",
        "| engine | not available | no wheel |",
        "install engine",
        "| top | rkmk4 | 0.5 | 4 000 | 5.0e-8 | 5 | 1.0e-12 | - |",
        "medians of 3 interleaved repeats",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
}

#[test]
fn the_page_needs_nothing_else() {
    let report = report();
    let figure = precision(&report.cases[0]).expect("a picture");
    let text = page::write(&report, &[Some(figure)], &[]);
    assert!(text.starts_with("<!DOCTYPE html>") && text.trim_end().ends_with("</html>"));
    for part in [
        "<html lang=\"en\">",
        "Speed &amp; error",
        "A top | &lt;heavy&gt;",
        "<td>711</td>",
        "role=\"img\" aria-label=",
        "prefers-color-scheme:dark",
        "not available",
        "make &lt;it&gt;",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    // The page loads nothing: the only addresses are the name of a namespace and anchors of the page.
    let addresses = text.matches("http").count();
    assert_eq!(
        addresses,
        text.matches("xmlns=\"http://www.w3.org/2000/svg\"").count()
    );
    for word in ["<script", "<link", "src=", "url(", "@import"] {
        assert!(!text.contains(word), "{word}");
    }
    assert_eq!(text.matches("<svg").count(), text.matches("</svg>").count());
}

/// A report with marks in every text that a writer may put between backticks.
fn marked() -> Report {
    let mut report = report();
    report.title = "Speed of `a < b`".into();
    report.peers[0].note = "needs the feature `ode`".into();
    let case = &mut report.cases[0];
    case.title = "A top: see `top & co`".into();
    case.error = "the norm of `R`".into();
    case.reference = "`rkmk8` with 3200 steps".into();
    case.missing[0].why = "it is for `Split` systems".into();
    case.auto = Some(Choice {
        method: "rkmk4".into(),
        reason: "it fits".into(),
    });
    case.methods.push(MethodRuns {
        method: "rkmk8 adaptive".into(),
        kind: Kind::Method,
        order: Some(8),
        runs: vec![MethodRun {
            tolerance: Some(1e-5),
            failure: Some("take `hamel::adapter`".into()),
            ..MethodRun::default()
        }],
    });
    report
}

#[test]
fn the_page_sets_code_apart() {
    let report = marked();
    let figure = precision(&report.cases[0]).expect("a picture");
    let further = page::Picture {
        title: "The motion of `top`".into(),
        figure: figure.clone(),
    };
    let text = page::write(&report, &[Some(figure)], &[further]);
    let literal = text.lines().find(|line| line.contains('`'));
    assert_eq!(literal, None);
    for part in [
        "<title>Speed of a &lt; b</title>",
        "<h1>Speed of <code>a &lt; b</code></h1>",
        "<h2>A top: see <code>top &amp; co</code></h2>",
        "<code>≤</code> marks",
        "the method that <code>auto</code> takes",
        "<code>rkmk8</code> with 3200 steps",
        "take <code>hamel::adapter</code>",
        "The motion of <code>top</code>",
        "A top: see top &amp; co",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let text = markdown::write(&report, |_| None);
    assert!(text.contains("take `hamel::adapter`") && text.contains("against `rkmk8` with"));
}

#[test]
fn the_summary_says_what_the_book_says() {
    let whole = report();
    let small = summary(&whole);
    assert_eq!(book_excerpt::block(&small), book_excerpt::block(&whole));
    assert_eq!(summary(&small), small);
    let [rkmk4] = &small.cases[0].methods[..] else {
        panic!("one method is in the block: {small:?}");
    };
    let steps: Vec<u64> = rkmk4.runs.iter().map(|run| run.steps).collect();
    assert_eq!(steps, [100, 1000]);
}

#[test]
fn the_book_names_the_fastest_method() {
    let block = book_excerpt::block(&report());
    let row = "| A top | <heavy> | `rkmk4` | 711 | 178 µs | 178 µs | - | - |";
    assert!(
        block.lines().last() == Some(&row.replace(" | <heavy>", " \\| <heavy>")),
        "{block}"
    );
    let text = format!(
        "a\n{}\nold\n{}\nb\n",
        book_excerpt::BEGIN_MARKER,
        book_excerpt::END_MARKER
    );
    let new = book_excerpt::replace_block(&text, &block).expect("a block");
    assert_eq!(book_excerpt::present(&new), Some(block.as_str()));
    assert!(new.starts_with("a\n") && new.ends_with("\nb\n") && !new.contains("old"));
    assert_eq!(book_excerpt::replace_block("nothing", &block), None);
}
