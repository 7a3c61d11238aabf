//! Texts do not extend beyond their pictures, for names of any length.

use hamel_report::data::{Case, Drift, Kind, MethodRun, MethodRuns};
use hamel_report::plot::{Figure, Panel, Path, Picture, drifts, precision, run, width};

const LONG: &str = "moment_about_the_moving_point_of_contact[2,3]";

/// Returns the value of an attribute in a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = tag.split_once(&format!(" {name}=\""))?;
    Some(rest.split_once('"')?.0)
}

fn number(tag: &str, name: &str) -> f64 {
    let value = attribute(tag, name).unwrap_or_else(|| panic!("no {name} in {tag}"));
    value.parse().unwrap_or_else(|_| panic!("{name} in {tag}"))
}

/// Returns all texts with their left and right ends, and the width of the view box.
fn texts(figure: &Figure) -> (Vec<(String, f64, f64)>, f64) {
    let svg = figure.standalone();
    let view = attribute(&svg, "viewBox").expect("a view box");
    let across = view.split(' ').nth(2).and_then(|width| width.parse().ok());
    let texts = svg.split("<text").skip(1).map(|rest| {
        let (tag, rest) = rest.split_once('>').expect("a tag");
        let (text, _) = rest.split_once("</text>").expect("its end");
        let text = text.trim().replace("&lt;", "<").replace("&amp;", "&");
        let bold = attribute(tag, "font-weight") == Some("bold");
        let size = number(tag, "font-size");
        let (x, length) = (number(tag, "x"), width(&text, size, bold));
        let left = match attribute(tag, "text-anchor") {
            None | Some("start") => x,
            Some("middle") => x - 0.5 * length,
            _ => x - length,
        };
        (text, left, left + length)
    });
    (texts.collect(), across.expect("a width"))
}

fn assert_within(figure: &Figure, shown: &str) {
    let (texts, across) = texts(figure);
    assert!(texts.iter().any(|(text, ..)| text == shown), "{texts:?}");
    for (text, left, right) in &texts {
        assert!(
            *left >= 0.0 && *right <= across,
            "{text}: {left} to {right} of {across}"
        );
    }
}

fn picture(spheres: bool) -> Picture {
    let time: Vec<f64> = (0..=50).map(|i| f64::from(i) * 1e4).collect();
    let mut panel = Panel::new(&format!(
        "output {LONG} and what belongs to it, all in one panel"
    ));
    for index in 0..30 {
        let values = time.iter().map(|t| t.sin() + f64::from(index)).collect();
        panel.lines.push((LONG.to_string(), values));
    }
    let mut last = Panel::new("energy, relative change");
    last.lines.push(("E".into(), vec![0.0; time.len()]));
    let points = time.iter().map(|t| [t.cos(), t.sin(), 0.0]).collect();
    Picture {
        title: "A mechanism of many links whose name is as long as its description is".into(),
        subtitle: "A sentence that goes on and on, past the end of the picture. ".repeat(4),
        time,
        panels: vec![panel, last],
        path: spheres.then(|| Path {
            title: "body axis 1 in the world".into(),
            points,
        }),
        poinsot: None,
    }
}

#[test]
fn names_of_lines_end_within_the_picture() {
    for spheres in [false, true] {
        assert_within(&run(&picture(spheres)).expect("a drawing"), LONG);
    }
}

#[test]
fn names_of_many_lines_stand_apart() {
    let svg = run(&picture(false)).expect("a drawing").standalone();
    let tags = svg
        .split("<text")
        .skip(1)
        .filter(|rest| rest.contains(LONG));
    // The name of the panel is cut before its end.
    let names = tags.filter(|rest| !rest.contains("output"));
    let mut heights: Vec<f64> = names.map(|tag| number(tag, "y")).collect();
    heights.sort_by(f64::total_cmp);
    assert_eq!(heights.len(), 30);
    assert!(
        heights.windows(2).all(|pair| pair[1] - pair[0] >= 149.0),
        "{heights:?}"
    );
}

#[test]
fn names_of_methods_end_within_the_picture() {
    let runs = |kind, method: &str| MethodRuns {
        method: method.into(),
        kind,
        order: Some(4),
        runs: vec![MethodRun {
            steps: 10,
            evaluations: Some(40),
            error: Some(1e-4),
            seconds: Some(1e-5),
            ..MethodRun::default()
        }],
    };
    let names = [
        "semi-implicit-euler",
        "rk4-projected",
        "rkmk54 adaptive in equal parts",
    ];
    for kind in [Kind::Method, Kind::Baseline, Kind::Peer] {
        let case = Case {
            title: "A top that is heavy, and turns about a point that does not move, ".repeat(3),
            until: 1.0,
            error: "largest difference of the state, each field over max(1, its largest entry)"
                .into(),
            methods: names.map(|name| runs(kind, name)).to_vec(),
            ..Case::default()
        };
        assert_within(&precision(&case).expect("a drawing"), names[0]);
    }
    let drift = Drift {
        method: names[2].into(),
        steps: 1_000_000,
        energy: vec![1e-8, 2e-8],
        case: "top".into(),
        step: 0.5,
        momentum: None,
        defect: None,
        failure: None,
    };
    let figure = drifts("Drift of the energy", &"a case, ".repeat(40), &[&drift]);
    assert_within(&figure.expect("a drawing"), names[2]);
}
