//! The time of a description in the output of runs, and in inputs over time.

use crate::common::{hamel, text};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A mass of 1, pushed from time 0.9 on.
const PUSHED: &str = "system Pushed {
    time t;
    input F;
    joint q: prismatic [1, 0, 0] moves block { force F; }
    body on block { mass 1; }
    joint x: prismatic [1, 0, 0] moves other;
    body on other { mass 1; }
    prescribe x = sin(t);
    start t = 0.9;
}";

fn file(name: &str, content: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("clock");
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    std::fs::write(&path, content).expect("written");
    path
}

/// The output of a run of length 1.
fn run(name: &str, description: &str, options: &[&str]) -> String {
    let out = file(name, "").display().to_string();
    let fixed = ["simulate", "-", "--until", "1", "--out", &out];
    let output = hamel(&[&fixed[..], options].concat(), description);
    assert!(output.status.success(), "{}", text(&output.stderr));
    std::fs::read_to_string(&out).expect("a file")
}

fn last(csv: &str) -> Vec<f64> {
    let row = csv.lines().last().expect("a row").split(',');
    row.map(|n| n.parse().expect("a number")).collect()
}

#[test]
fn every_name_stands_once() {
    let header = |text: &str| text.lines().next().expect("a header").to_string();
    let csv = run("own.csv", PUSHED, &[]);
    assert_eq!(header(&csv), "t,q,x,q_dot");
    let first = csv.lines().nth(1).expect("a row");
    assert!(first.starts_with("0.9,0.0,"), "{first}");
    let end = last(&csv);
    assert!((end[0] - 1.9).abs() < 1e-12 && (end[2] - end[0].sin()).abs() < 1e-9);
    let json = run("own.json", PUSHED, &[]);
    assert_eq!(
        json.lines()
            .nth(1)
            .expect("a row")
            .matches("\"t\":")
            .count(),
        1
    );
    let rows: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(rows[0]["t"], 0.9);
    // A clock with another name appears in addition to the time of the run.
    let named = PUSHED
        .replace("time t", "time s")
        .replace("start t", "start s");
    let csv = run("named.csv", &named.replace("sin(t)", "sin(s)"), &[]);
    assert_eq!(header(&csv), "t,s,q,x,q_dot");
    let end = last(&csv);
    assert!(end[0] == 1.0 && (end[1] - 1.9).abs() < 1e-12, "{end:?}");
    // If another quantity has its name, the time of the run is renamed.
    let taken = "system Taken {
        joint t: prismatic [1, 0, 0] moves block;
        body on block { mass 1; }
        output t_run = 2 * t;
        start t = 3;
    }";
    let csv = run("taken.csv", taken, &[]);
    assert_eq!(header(&csv), "t_run_run,t,t_dot,t_run");
    assert_eq!(last(&csv), [1.0, 3.0, 0.0, 6.0]);
}

/// `t` labels the axis, and no line.
#[test]
fn plots_are_over_the_time_of_the_description() {
    let svg = run("own.svg", PUSHED, &[]);
    let labelled = |label: &str| svg.lines().filter(|line| *line == label).count();
    assert_eq!([labelled("t"), labelled("q"), labelled("x")], [1, 1, 1]);
    // Axis labels from 0.9 to 1.9.
    assert_eq!([labelled("1.8"), labelled("0.2")], [1, 0]);
}

/// F = t from 0.9 on: q̇ = (t² − 0.81)/2, however the input refers to the time.
#[test]
fn inputs_are_over_the_time_of_the_description() {
    let straight = file("straight.csv", "t,F\n0,0\n2,2\n");
    let straight = straight.to_str().expect("UTF-8");
    let wanted = (1.9 * 1.9 - 0.81) / 2.0;
    let named = PUSHED
        .replace("time t", "time s")
        .replace("start t", "start s");
    let named = named.replace("sin(t)", "sin(s)");
    for (name, description) in [("one.csv", PUSHED), ("two.csv", &named)] {
        for options in [["--inputs", straight], ["--input", "F = t"]] {
            let end = last(&run(name, description, &options));
            let speed = end[end.len() - 1];
            assert!(
                (speed - wanted).abs() < 1e-9,
                "{options:?}: {speed} {wanted}"
            );
        }
    }
    // 1 until 1.4, and then 3; no step of the run ends at 1.4.
    let steps = file("steps.csv", "t,F\n0,1\n1.4,3\n");
    let options = [
        "--inputs",
        steps.to_str().expect("UTF-8"),
        "--hold",
        "--step",
        "0.3",
    ];
    let end = last(&run("held.csv", PUSHED, &options));
    assert!((end[3] - (0.5 + 1.5)).abs() < 1e-12, "{end:?}");
    let short = file("short.csv", "t,F\n0,0\n1,1\n");
    let late = ["simulate", "-", "--until", "1", "--inputs"];
    let output = hamel(
        &[&late[..], &[short.to_str().expect("UTF-8")]].concat(),
        PUSHED,
    );
    let said = text(&output.stderr);
    assert!(
        said.contains("its times reach from 0 to 1, the run from 0.9 to 1.9"),
        "{said}"
    );
}

#[test]
fn samples_are_taken_at_times_of_the_description() {
    let times = file("times.csv", "t\n0.9\n1.25\n1.9\n");
    let csv = run(
        "timed.csv",
        PUSHED,
        &["--times", times.to_str().expect("UTF-8")],
    );
    let found: Vec<f64> = csv
        .lines()
        .skip(1)
        .map(|row| {
            let first = row.split(',').next().expect("a number");
            first.parse().expect("a number")
        })
        .collect();
    for (found, wanted) in found.iter().zip([0.9, 1.25, 1.9]) {
        assert!((found - wanted).abs() < 1e-12, "{csv}");
    }
    assert_eq!(found.len(), 3);
}

/// q̈ = cos(t − t₀) from rest at t₀, a time in seconds since 1970: q = 1 − cos(t − t₀).
const LATE: &str = "system Late {
    time t; param t0 = 1.7e9; coord q; velocity w; rate q = w; kinetic w^2/2;
    generalized force w = cos(t - t0); start t = 1.7e9;
}";

/// Spacing of floating-point numbers at such times.
const APART: f64 = 2.4e-7;

/// The columns t, q and w of all samples.
fn columns(csv: &str) -> Vec<Vec<f64>> {
    let number = |n: &str| n.parse().expect("a number");
    let rows = csv.lines().skip(1);
    rows.map(|row| row.split(',').map(number).collect())
        .collect()
}

/// The time of the description equals that of the run for all ways of stepping: many steps at once by machine code
/// (`rkmk4`), samples at multiples of a time, few steps by the method itself, a tolerance.
#[test]
fn the_time_of_the_description_does_not_drift() {
    let all: [&[&str]; 6] = [
        &["--method", "rkmk4", "--step", "1e-4"],
        &["--method", "rkmk4", "--step", "1e-4", "--every", "0.1s"],
        &["--method", "rk4", "--step", "1e-4", "--every", "7"],
        &["--method", "rkmk4", "--step", "1e-2"],
        &["--method", "rkmk8", "--tol", "1e-6"],
        &["--method", "rkmk54", "--tol", "1e-6", "--every", "0.1s"],
    ];
    for options in all {
        let samples = columns(&run("late.csv", LATE, options));
        for sample in &samples {
            let t = sample[0] - 1.7e9;
            assert!(
                (sample[1] - (1.0 - t.cos())).abs() < 1e-6,
                "{options:?} {sample:?}"
            );
            assert!((sample[2] - t.sin()).abs() < 1e-6, "{options:?} {sample:?}");
        }
        let last = samples.last().expect("a sample");
        assert_eq!(last[0], 1.7e9 + 1.0, "{options:?}");
    }
    // At the ends of steps of 0.001 from 0, and of samples at multiples of 1/8.
    let early = LATE.replace("1.7e9", "0");
    let fixed = ["simulate", "-", "--until", "3", "--method", "rkmk4"];
    for (every, at) in [("1", 1e-3), ("0.125s", 0.125)] {
        let out = file("early.csv", "").display().to_string();
        let options = [&fixed[..], &["--every", every, "--out", &out]].concat();
        let output = hamel(&options, &early);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let csv = std::fs::read_to_string(&out).expect("a file");
        for (index, sample) in columns(&csv).iter().enumerate() {
            let wanted = index as f64 * at;
            assert!(
                (sample[0] - wanted).abs() <= 2.0 * f64::EPSILON * wanted,
                "{sample:?}"
            );
        }
        assert_eq!(last(&csv)[0], 3.0);
    }
}

/// Steps of 1e-7 are below the spacing of numbers near 1.7e9: the clock still advances.
#[test]
fn the_time_of_the_description_does_not_stand_still() {
    let out = file("still.csv", "").display().to_string();
    let fixed = ["simulate", "-", "--until", "0.001", "--step", "1e-7"];
    let options = ["--method", "rkmk4", "--every", "100", "--out", &out];
    let output = hamel(&[&fixed[..], &options].concat(), LATE);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let samples = columns(&std::fs::read_to_string(&out).expect("a file"));
    assert_eq!(samples.len(), 101);
    for (index, sample) in samples.iter().enumerate() {
        let t = index as f64 * 1e-5;
        assert!((sample[0] - 1.7e9 - t).abs() <= APART, "{sample:?} {t}");
    }
}
