//! Printed counts and failures: separated columns, correct numbers, names instead of indices.

use crate::common::{hamel, text};
use serde_json::Value;
use std::fmt::Write;

fn model(name: &str) -> String {
    format!("{}/../tests/models/{name}.eom", env!("CARGO_MANIFEST_DIR"))
}

/// An output that uses every value twice, `times` times: written out it has more than 2ⁿ operations.
fn doubled(times: usize) -> String {
    let mut description =
        "system Deep { coord q; velocity w; rate q = w; kinetic w^2 / 2; let a0 = sin(q) + 2;"
            .to_string();
    for level in 1..=times {
        let before = level - 1;
        write!(description, " let a{level} = a{before} * sin(a{before});").expect("text");
    }
    description + &format!(" output deep = a{times}; }}")
}

/// The row of a function, cell by cell.
fn row<'a>(table: &'a str, function: &str) -> Vec<&'a str> {
    let line = table.lines().find(|line| line.starts_with(function));
    let cells = line.expect(function).split("  ").map(str::trim);
    cells.filter(|cell| !cell.is_empty()).collect()
}

#[test]
fn a_count_beyond_all_bounds_is_no_number() {
    let counts = |times: usize| {
        let description = doubled(times);
        let output = hamel(&["ops", "-"], &description);
        let last = row(&text(&output.stdout), "deep")
            .last()
            .map(|cell| cell.to_string());
        let output = hamel(&["ops", "-", "--format", "json"], &description);
        let all: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        (
            last.expect("a cell"),
            all["functions"]["deep"]["unshared"].clone(),
        )
    };
    // One addition for each of 2²⁰ uses of a0, one multiplication for each level above.
    let (cell, json) = counts(20);
    assert_eq!(
        (cell.as_str(), &json["flops"]),
        ("2097151", &Value::from(2_097_151))
    );
    let (cell, json) = counts(140);
    assert_eq!((cell.as_str(), &json["flops"]), ("> 3.4e38", &Value::Null));
    assert_eq!(
        (&json["div"], &json["add"]),
        (&Value::from(0), &Value::Null)
    );
}

/// A particle in polar coordinates: at r = 0 its angular velocity has no inertia.
const POLAR: &str = "system Polar {
    coord r, a; velocity v, w; rate r = v; rate a = w;
    kinetic (v^2 + r^2 * w^2) / 2;
    start r = 1; start v = -1;
}";

#[test]
fn a_velocity_without_inertia_is_named() {
    let scratch = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let file = scratch.join("polar.eom").display().to_string();
    std::fs::write(&file, POLAR).expect("scratch");
    let named = "the mass matrix is not positive definite at pivot 2 (`w`, line 2)";
    let there = r#"{"coord": {"r": 0}}"#;
    for command in ["eval", "linearize"] {
        let output = hamel(&[command, &file, "--at", "-"], there);
        let errors = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{command}: {errors}");
        assert!(errors.contains(named), "{command}: {errors}");
    }
    let arguments = [
        "simulate", &file, "--until", "2", "--step", "0.25", "--method", "rkmk4",
    ];
    let errors = text(&hamel(&arguments, "").stderr);
    assert!(
        errors.contains(named) && errors.contains("ends at t = "),
        "{errors}"
    );
    let arguments = ["compare", &file, "--until", "2", "--steps", "8"];
    let report = text(&hamel(&arguments, "").stdout);
    assert!(
        report.contains(&format!("| {named}, in the step from t = 0.75 |")),
        "{report}"
    );
    // The reference run has steps of 1/16.
    let errors = text(&hamel(&[&arguments[..], &["--methods", "rkmk4"]].concat(), "").stderr);
    assert!(errors.contains(named), "{errors}");
}

/// A velocity determined by a constraint with division by a parameter.
const ROLLING: &str = "system Rolling {
    param L2 = 0.5;
    coord x, p; velocity u, w; rate x = u; rate p = w;
    kinetic u^2 / 2 + w^2 / 2;
    nonholonomic L2 * w = u * sin(x);
    start x = 1, u = 1;
}";

#[test]
fn constraints_that_are_divided_by_0_are_named() {
    let scratch = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let file = scratch.join("rolling.eom").display().to_string();
    std::fs::write(&file, ROLLING).expect("scratch");
    let named = "the constraint on line 5, `L2 * w = u * sin(x)`, gives `w` by others, but its factor `L2` is 0";
    for arguments in [
        &["eval", &file, "--at", "-"][..],
        &["linearize", &file, "--at", "-"],
        &["simulate", &file, "--until", "1", "--at", "-"],
        &["compare", &file, "--until", "1", "--at", "-"],
    ] {
        let output = hamel(arguments, r#"{"param": {"L2": 0}}"#);
        let errors = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {errors}");
        assert!(errors.contains(named), "{arguments:?}: {errors}");
    }
    let output = hamel(&["simulate", &file, "--until", "1"], "");
    assert!(output.status.success());
}

#[test]
fn parameters_that_leave_no_inertia_name_the_velocity() {
    let state = r#"{"param": {"J2": 0}}"#;
    let file = model("principal_axes");
    for arguments in [
        &["eval", &file, "--at", "-"][..],
        &["linearize", &file, "--at", "-"],
        &["simulate", &file, "--until", "1", "--at", "-"],
        &["compare", &file, "--until", "1", "--at", "-"],
    ] {
        let errors = text(&hamel(arguments, state).stderr);
        assert!(
            errors.contains("pivot 2 (`w[2]`, line "),
            "{arguments:?}: {errors}"
        );
    }
}

/// The names of the lines of a plot, and its headings.
fn labels(description: &str, name: &str) -> Vec<String> {
    let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let plot = file.display().to_string();
    let arguments = ["simulate", "-", "--until", "0.5", "--plot", &plot];
    let output = hamel(&arguments, description);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let drawing = std::fs::read_to_string(&file).expect("the plot");
    let texts = drawing.split("<text").skip(1).map(|rest| {
        let (_, rest) = rest.split_once('>').expect("a tag");
        rest.split("</text>")
            .next()
            .expect("a text")
            .trim()
            .to_string()
    });
    texts.collect()
}

#[test]
fn coordinates_of_joints_and_outputs_are_plotted() {
    let arm = "system Arm {
        joint shoulder: continuous [0, 0, 1] moves upper;
        joint elbow: revolute [0, 1, 0] on upper at pose(rotx(pi/2), [0, 0, 0.4]) moves fore;
        joint slide: planar [0, 0, 1] moves cart;
        joint left: spherical on cart moves one;
        joint right: spherical on cart moves two;
        body on upper { mass 2; com [0, 0, 0.2]; inertia diag(0.03, 0.03, 0.004) about com; }
        body on fore { mass 1; com [0.2, 0, 0]; inertia diag(0.002, 0.02, 0.02) about com; }
        body on cart { mass 1; inertia diag(1, 1, 1) about com; }
        body on one { mass 1; inertia diag(1, 1, 1) about com; }
        body on two { mass 1; inertia diag(1, 1, 1) about com; }
        output reach = sin(elbow);
        output pair = [sin(elbow), cos(elbow)];
        gravity [0, 0, -9.81];
        start elbow = 0.5; start shoulder_dot = 20;
    }";
    let labels = labels(arm, "arm.svg");
    for expected in [
        "coordinates",
        "shoulder",
        "elbow",
        "coordinate slide_r",
        "slide_r[2]",
        "slide",
        "angles of rotation",
        "left",
        "right",
        "velocities",
        "shoulder_dot",
        "velocity left_dot",
        "outputs",
        "reach",
        "output pair",
        "pair[2]",
    ] {
        assert!(
            labels.iter().any(|label| label == expected),
            "{expected}: {labels:?}"
        );
    }
}

#[test]
fn the_only_attitude_is_on_the_sphere_alone() {
    let body = "system Body {
        joint base: free moves hull;
        body on hull { mass 1; inertia diag(1, 2, 3) about com; }
        output speed = norm(base_v);
        start base_w = [0, 1, 0]; start base_v = [1, 0, 0];
    }";
    let labels = labels(body, "body.svg");
    for expected in ["coordinate base_r", "base_r[3]", "velocity base_w", "speed"] {
        assert!(
            labels.iter().any(|label| label == expected),
            "{expected}: {labels:?}"
        );
    }
    assert!(labels.iter().any(|label| label.starts_with("body axis")));
    assert!(
        !labels.iter().any(|label| label.contains("angles")),
        "{labels:?}"
    );
}

/// An output may be undefined where the motion continues: a root, or a table with `extrapolate error`.
#[test]
fn outputs_without_a_value_are_counted() {
    let described =
        "system Ending { coord q; velocity w; rate q = w; kinetic w^2 / 2; start q = 0.5, w = 1;
        output side = sqrt(1 - q^2); output twice = 2 * q; }";
    let output = hamel(
        &["simulate", "-", "--until", "1", "--step", "0.125"],
        described,
    );
    let said = text(&output.stdout);
    assert!(
        said.contains("side has no finite value at 4 of 9 samples, first at t = 0.625\n"),
        "{said}"
    );
    assert!(!said.contains("twice has"), "{said}");
}

/// A massless tip, in a system that is too large to be written out, with a loop.
#[test]
fn a_joint_without_inertia_is_named_beside_loops() {
    let described = "system Cranks {
        for i in 1..7 { joint c[i]: revolute [0, 1, 0] at [i, 0, 0] moves f[i]; body on f[i] { mass 1; inertia diag(1, 1, 1) about com; } }
        joint p: revolute [0, 1, 0] on f[1] at [0, 0, 1] moves g;
        body on g { mass 1; inertia diag(1, 1, 1) about com; }
        joint tip: revolute [0, 0, 1] on f[3] moves nothing;
        loop position(g, [1, 0, 0]) = position(f[2], [0, 0, 1]);
    }";
    let output = hamel(&["check", "-"], described);
    let said = text(&output.stderr);
    assert!(
        said.contains("(`tip_dot`) is not positive") && said.contains("5:15"),
        "{said}"
    );
}
