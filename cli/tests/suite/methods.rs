//! Selection of a method on the command line: suitable methods run, others are refused with the reason
//! before the run begins.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// Energy drift of a top over 200 steps of order 4 or more: the truncation error of rkmk4 is 4e-7.
const CONSERVED: f64 = 1e-5;
/// Difference between the ends of two methods of order 6 and 8 at these steps.
const SAME: f64 = 1e-8;

fn model(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models");
    folder.join(format!("{name}.eom")).display().to_string()
}

fn hamel(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hamel"))
        .args(arguments)
        .output()
        .expect("the binary runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

fn simulate(name: &str, arguments: &[&str]) -> Output {
    let file = model(name);
    let mut all = vec!["simulate", &file, "--until", "1"];
    all.extend(arguments);
    hamel(&all)
}

/// The last line of the samples of a run.
fn end(name: &str, tag: &str, arguments: &[&str]) -> Vec<f64> {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{tag}.csv"));
    let out = path.display().to_string();
    let mut all = arguments.to_vec();
    all.extend(["--out", &out]);
    let output = simulate(name, &all);
    assert!(output.status.success(), "{name}: {}", text(&output.stderr));
    let written = std::fs::read_to_string(&path).expect("samples");
    let last = written.lines().last().expect("a line");
    let numbers = last
        .split(',')
        .map(|entry| entry.parse().expect("a number"));
    numbers.collect()
}

/// The relative deviation of the energy in the summary.
fn deviation(output: &Output) -> f64 {
    let out = text(&output.stdout);
    let line = out
        .lines()
        .find(|line| line.trim_start().starts_with("energy"));
    let line = line.expect("the energy");
    let word = line.split_whitespace().rev().nth(1).expect("a number");
    word.parse().expect("a number")
}

#[test]
fn auto_takes_what_fits_and_says_why() {
    for (name, method, reason) in [
        ("principal_axes", "free", "no force acts"),
        ("benchmark_top", "splitting6", "symmetric rotor"),
        // The parameters make it symmetric, which is detected once they are known.
        ("heavy_top_axis", "splitting6", "symmetric rotor"),
        ("heavy_top", "rkmk8", "without symmetry"),
        ("free_body", "splitting6", "closed form"),
        ("two_bodies", "rkmk8", "depends on the configuration"),
        ("gyrostat", "rkmk8", "exchange momentum"),
        ("suspended_body", "rkmk54", "depend on velocities"),
        ("rolling_disk", "rkmk8", "velocities are constrained"),
        ("four_bar_loop", "rkmk8", "multipliers"),
    ] {
        let file = model(name);
        let output = hamel(&["simulate", &file, "--until", "0.1", "--method", "auto"]);
        let out = text(&output.stdout);
        assert!(output.status.success(), "{name}: {}", text(&output.stderr));
        let said = format!("{method} was chosen: ");
        assert!(out.contains(&said), "{name}: {out}");
        assert!(out.contains(reason), "{name}: {out}");
    }
}

#[test]
fn check_tells_the_structure_and_the_method() {
    for (name, lines) in [
        (
            "benchmark_top",
            &[
                "splits into free motion and kicks",
                "rotor `R`: inertia symmetric about body axis 2",
                "mass matrix constant",
                "method splitting6: ",
            ][..],
        ),
        (
            "cart_pole",
            &[
                "does not split: the mass matrix in the rates of the coordinates depends on `th`",
                "mass matrix depends on `th`",
                "method rkmk8: ",
            ],
        ),
    ] {
        let file = model(name);
        let out = text(&hamel(&["check", &file]).stdout);
        for line in lines {
            assert!(out.contains(line), "{name}: {line}: {out}");
        }
    }
}

#[test]
fn methods_that_do_not_fit_are_refused_with_the_reason() {
    for (name, method, reasons) in [
        ("cart_pole", "splitting", &["depends on `th`"][..]),
        ("gyrostat", "lgvi", &["`a`", "`b`", "`c`", "3 errors"]),
        ("suspended_body", "splitting6", &["damper", "`dissipation`"]),
        ("heavy_top", "free", &["forces act"]),
        ("sleigh", "gauss4", &["inactive velocity"]),
        ("sleigh", "buss2", &["inactive velocity"]),
        ("pendulum_rows", "kahan-li", &["tied to one another"]),
    ] {
        let output = simulate(name, &["--method", method]);
        assert_eq!(output.status.code(), Some(2), "{name} by {method}");
        assert!(output.stdout.is_empty(), "{name}: nothing runs");
        let error = text(&output.stderr);
        assert!(
            error.contains(&format!("--method {method} does not fit")),
            "{error}"
        );
        for reason in reasons {
            assert!(
                error.contains(reason),
                "{name} by {method}: {reason}: {error}"
            );
        }
    }
}

#[test]
fn an_unknown_method_lists_the_names() {
    let output = simulate("heavy_top", &["--method", "runge"]);
    assert_eq!(output.status.code(), Some(2));
    let error = text(&output.stderr);
    for name in [
        "auto",
        "rkmk4",
        "splitting6",
        "gauss6",
        "buss-augmented2",
        "slide",
    ] {
        assert!(error.contains(name), "{name}: {error}");
    }
}

#[test]
fn tolerances_are_for_methods_that_choose_their_steps() {
    let output = simulate("heavy_top", &["--method", "rkmk8", "--tol", "1e-10"]);
    assert!(output.status.success());
    assert!(text(&output.stdout).contains("by tolerance"));
    assert!(deviation(&output) < 1e-9);
    for arguments in [
        &["--method", "rkmk4", "--tol", "1e-9"][..],
        &["--method", "splitting", "--tol", "1e-9"],
        &["--method", "rkmk8", "--tol", "1e-9", "--step", "0.1"],
        &["--method", "rkmk8", "--tol", "0"],
    ] {
        assert_eq!(
            simulate("heavy_top", arguments).status.code(),
            Some(2),
            "{arguments:?}"
        );
    }
}

/// Every method of order 4 or more reaches the same end as rkmk8.
#[test]
fn every_method_runs_and_the_good_ones_agree() {
    let expected = end(
        "lagrange_top",
        "rkmk8",
        &["--method", "rkmk8", "--step", "0.002"],
    );
    for method in ["splitting6", "kahan-li", "gauss6", "rkmk54"] {
        let found = end(
            "lagrange_top",
            method,
            &["--method", method, "--step", "0.002"],
        );
        for (a, b) in found.iter().zip(&expected) {
            assert!(
                (a - b).abs() <= SAME * b.abs().max(1.0),
                "{method}: {a} {b}"
            );
        }
    }
    for method in ["rkmk4", "cf4", "splitting", "suzuki", "gauss4"] {
        let output = simulate("lagrange_top", &["--method", method, "--step", "0.005"]);
        assert!(deviation(&output) < CONSERVED, "{method}");
    }
    for method in [
        "splitting2",
        "lgvi",
        "euler",
        "backward-euler",
        "semi-implicit-euler",
        "rk4",
        "rk4-projected",
        "slide",
        "buss1",
        "buss2",
        "buss-augmented2",
        "buss4",
    ] {
        let output = simulate("lagrange_top", &["--method", method, "--step", "0.001"]);
        assert!(
            output.status.success(),
            "{method}: {}",
            text(&output.stderr)
        );
    }
}

/// The closed form is evaluated from the start: one step ends where a thousand steps do.
#[test]
fn closed_forms_do_not_depend_on_steps() {
    let one = end(
        "principal_axes",
        "one",
        &["--method", "free", "--step", "1"],
    );
    let many = end(
        "principal_axes",
        "many",
        &["--method", "free", "--step", "0.001"],
    );
    for (a, b) in one.iter().zip(&many) {
        assert!((a - b).abs() <= 1e-14 * b.abs().max(1.0), "{a} {b}");
    }
}

/// Samples as JSON contain the same numbers.
#[test]
fn samples_are_written_whatever_the_method() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("splitting.json");
    let out = path.display().to_string();
    let output = simulate("free_body", &["--method", "splitting6", "--out", &out]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let written = std::fs::read_to_string(&path).expect("samples");
    assert!(serde_json::from_str::<Value>(&written).is_ok());
}

/// Three stiff joints of an arm, one of them mounted at 45 degrees, that begin a third of a radian from rest: after a
/// second in steps of 1/20 s they have come to rest, deflected by gravity by about 1e-7 rad.
#[test]
fn stiff_arms_come_to_rest_by_implicit_steps() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let (file, out) = (folder.join("stiff_arm.eom"), folder.join("stiff_arm.csv"));
    let text_of = "system StiffArm {
        gravity [0, 0, -9.81];
        param k = 1e8;
        joint a: revolute [0, 1, 0] moves upper { force -k * (a - 0.3 + 30 * (a - 0.3)^3); }
        body on upper { mass 2; com [0.2, 0.02, 0.01]; inertia diag(0.02, 0.1, 0.1) about com; }
        joint b: revolute [0, 1, 0] on upper at pose(rotx(pi / 4), [0.5, 0, 0]) moves lower { force -k * (b + 0.2); }
        body on lower { mass 1; com [0.2, 0.02, 0.01]; inertia diag(0.02, 0.1, 0.1) about com; }
        joint c: continuous [1, 0, 0] on lower at [0.4, 0, 0] moves hand { force -k * c.s; }
        body on hand { mass 0.5; com [0.05, 0.1, 0.1]; inertia diag(0.01, 0.02, 0.02) about com; }
        start a = 0, b = 0.1;
    }";
    std::fs::write(&file, text_of).expect("a file");
    let [file, out] = [&file, &out].map(|path| path.display().to_string());
    let output = hamel(&[
        "simulate",
        &file,
        "--until",
        "1",
        "--step",
        "0.05",
        "--method",
        "backward-euler",
        "--out",
        &out,
    ]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let written = std::fs::read_to_string(&out).expect("samples");
    let mut lines = written.lines();
    let names = lines.next().expect("names").split(',');
    let last = lines.last().expect("a line").split(',');
    let end: std::collections::BTreeMap<&str, f64> = names
        .zip(last.map(|entry| entry.parse().expect("a number")))
        .collect();
    for (name, rest) in [("a", 0.3), ("b", -0.2), ("c.s", 0.0)] {
        let apart = (end[name] - rest).abs();
        assert!(apart < 1e-6 && apart > 0.0, "{name}: {apart:e}");
    }
    for name in ["a_dot", "b_dot", "c_dot"] {
        assert!(end[name].abs() < 1e-8, "{name}: {}", end[name]);
    }
}
