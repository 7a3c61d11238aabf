//! `hamel compare`: known errors, complete files, reported mistakes.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn file(path: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests");
    root.join(path).display().to_string()
}

fn scratch(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

fn compare(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hamel"))
        .arg("compare")
        .args(arguments)
        .output()
        .expect("the binary runs")
}

fn stdout(arguments: &[&str]) -> String {
    let output = compare(arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{errors}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn runs<'a>(report: &'a Value, method: &str) -> &'a [Value] {
    let methods = report["cases"][0]["methods"].as_array().expect("methods");
    let found = methods.iter().find(|entry| entry["method"] == method);
    found.expect(method)["runs"].as_array().expect("runs")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Largest deviation of an order measured between runs with doubled steps.
const ORDER: f64 = 0.1;

#[test]
fn errors_against_a_reference_have_the_order_of_the_method() {
    // The model has the parameters of the benchmark.
    let text = stdout(&[
        &file("models/heavy_top_axis.eom"),
        "--reference",
        &file("reference/heavy-top-benchmark-150.json"),
        "--until",
        "1",
        "--methods",
        "rkmk4,rk4-projected",
        "--steps",
        "8000,4000",
        "--format",
        "json",
    ]);
    let report: Value = serde_json::from_str(&text).expect("JSON");
    for method in ["rkmk4", "rk4-projected"] {
        let [coarse, fine] = runs(&report, method) else {
            panic!("two runs of {method}");
        };
        assert_eq!(
            (&coarse["steps"], &fine["steps"]),
            (&4000.into(), &8000.into())
        );
        assert_eq!(coarse["evaluations"], 16000);
        let order = (number(&coarse["error"]) / number(&fine["error"])).log2();
        assert!((order - 4.0).abs() < ORDER, "{method}: {order}");
        // x lies on its manifold after every step, to rounding.
        assert!(number(&fine["defect"]) < 1e-14, "{method}");
    }
    assert_eq!(
        report["machine"]["code"],
        "compiled to machine code at once"
    );
}

#[test]
fn without_a_reference_a_finer_run_serves_and_says_its_error() {
    let folder = scratch("comparison");
    let out = folder.display().to_string();
    let text = stdout(&[
        &file("models/lagrange_top.eom"),
        "--until",
        "1",
        "--methods",
        "rkmk4",
        "--steps",
        "200,400",
        "--out",
        &out,
    ]);
    assert!(
        text.contains("against rkmk4 with 1600 steps (itself off by "),
        "{text}"
    );
    assert!(
        text.contains("| rkmk4 | 4 |") && text.contains("compiled to machine code at once"),
        "{text}"
    );
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect(name);
    assert_eq!(read("report.md"), text);
    let report: Value = serde_json::from_str(&read("report.json")).expect("JSON");
    let [coarse, fine] = runs(&report, "rkmk4") else {
        panic!("two runs");
    };
    let own = number(&report["cases"][0]["reference_error"]);
    let (coarse, end) = (number(&coarse["error"]), number(&fine["error"]));
    assert!(own < end && end < coarse, "{own} {end} {coarse}");
    // The description claims invariants, whose drift is reported.
    assert!(number(&fine["momentum"]) < 1e-6);
    assert!(read("lagrangetop.svg").starts_with("<svg"));
    let page = read("index.html");
    assert!(page.contains("<svg") && page.contains("LagrangeTop"));
}

#[test]
fn mistakes_are_named() {
    let top = file("models/heavy_top_axis.eom");
    let benchmark = file("reference/heavy-top-benchmark-150.json");
    for (arguments, words) in [
        (
            vec![top.as_str(), "--methods", "euler9"],
            "no method is called `euler9`; there are auto, rkmk4",
        ),
        (
            vec![&top, "--reference", &benchmark, "--until", "0.123"],
            "no state at t = 0.123; it has",
        ),
        (vec![&top, "--reference", &top], "not valid JSON"),
        (vec![&top, "--steps", "0"], "a whole number from 1"),
        (vec!["missing.eom"], "cannot read missing.eom"),
    ] {
        let output = compare(&arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{errors}");
        assert!(errors.contains(words), "{errors}");
    }
    let sleigh = file("reference/chaplygin-sleigh.json");
    let output = compare(&[&top, "--reference", &sleigh]);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(
        errors.contains("is a coordinate or velocity of AxisTop (R, w)"),
        "{errors}"
    );
}
