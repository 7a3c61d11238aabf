//! The binary as users run it: results that satisfy physical laws, exit statuses, messages.

use crate::common::text;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Output;

/// Rounding error of exact laws, relative to the largest term.
const ROUNDING: f64 = 1e-12;

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models")
}

fn model(name: &str) -> String {
    models().join(name).display().to_string()
}

/// The names of all descriptions among the fixtures.
fn fixtures() -> Vec<String> {
    let entries = std::fs::read_dir(models()).expect("tests/models");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut names: Vec<String> = paths
        .filter(|path| path.extension().is_some_and(|extension| extension == "eom"))
        .map(|path| path.display().to_string())
        .collect();
    names.sort();
    assert!(names.len() > 10);
    names
}

/// A quarter of a list, and all of it with `HAMEL_ATTACK`: other tests cover every model without a process for each.
fn some(all: Vec<String>) -> impl Iterator<Item = String> {
    let apart = if std::env::var_os("HAMEL_ATTACK").is_some() {
        1
    } else {
        4
    };
    all.into_iter().step_by(apart)
}

/// A path for a temporary file of one test.
fn scratch(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

fn hamel(arguments: &[&str]) -> Output {
    crate::common::hamel(arguments, "")
}

/// Standard output of a command that succeeds and writes nothing to standard error.
fn stdout(arguments: &[&str]) -> String {
    let output = hamel(arguments);
    let errors = text(&output.stderr);
    assert_eq!(
        (output.status.code(), errors.as_str()),
        (Some(0), ""),
        "{arguments:?}"
    );
    text(&output.stdout)
}

/// Standard error of a command that fails with this status.
fn stderr(arguments: &[&str], input: &str, status: i32) -> String {
    let output = crate::common::hamel(arguments, input);
    let errors = text(&output.stderr);
    assert_eq!(
        output.status.code(),
        Some(status),
        "{arguments:?}: {errors}"
    );
    assert!(!errors.contains('\x1b'), "colours in a pipe: {errors}");
    errors
}

fn vector(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter()
        .map(|number| number.as_f64().expect("a number"))
        .collect()
}

fn matrix(value: &Value) -> Vec<Vec<f64>> {
    value.as_array().expect("rows").iter().map(vector).collect()
}

fn apply(rows: &[Vec<f64>], v: &[f64]) -> Vec<f64> {
    rows.iter()
        .map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
        .collect()
}

/// Asserts that sums of terms vanish, entry by entry.
fn assert_balance(what: &str, terms: &[Vec<f64>]) {
    for index in 0..terms[0].len() {
        let sum: f64 = terms.iter().map(|term| term[index]).sum();
        let scale = terms
            .iter()
            .map(|term| term[index].abs())
            .fold(1.0, f64::max);
        assert!(
            sum.abs() <= ROUNDING * scale,
            "{what}, entry {index}: {sum:e} of {scale:e}"
        );
    }
}

fn minus(v: &[f64]) -> Vec<f64> {
    v.iter().map(|x| -x).collect()
}

#[test]
fn every_fixture_is_proved() {
    for file in some(fixtures()) {
        let report = stdout(&["check", &file]);
        assert!(
            report.contains("Y A = I") && report.contains("power"),
            "{file}: {report}"
        );
        assert!(!report.contains("FAILED"), "{file}: {report}");
    }
}

#[test]
fn several_files_have_headings_and_one_bad_one_fails_all() {
    let (top, bad) = (model("heavy_top.eom"), scratch("bad.eom"));
    std::fs::write(&bad, "system Bad { coord q; velocity w; rate q = W; }").expect("scratch");
    let bad = bad.display().to_string();
    let output = hamel(&["check", &top, &bad, &model("pendulum.eom")]);
    let report = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1));
    assert!(report.contains("heavy_top.eom\n") && report.contains("pendulum.eom\n"));
    assert!(
        text(&output.stderr).contains("bad.eom:1:"),
        "{}",
        text(&output.stderr)
    );
}

/// The text under a heading in a report of two columns.
fn under<'a>(report: &'a str, heading: &str) -> &'a str {
    let line = report.lines().find(|line| line.contains(heading));
    let line = line.unwrap_or_else(|| panic!("no `{heading}` in {report}"));
    let place = line.find(heading).expect("found above") + heading.len();
    line[place..].trim()
}

#[test]
fn integrable_velocities_are_named() {
    let report = stdout(&["check", &model("free_body_world_velocity.eom")]);
    for i in 1..=3 {
        let line = format!("v[{i}] = d/dt (r[{i}])");
        assert!(report.contains(&line), "{report}");
    }
    let others = under(&report, "not integrable (quasi-velocities)");
    assert_eq!(others, "w[1], w[2], w[3]");
}

#[test]
fn lie_algebras_are_named_with_their_side() {
    for (name, algebra, block) in [
        ("free_body", "se(3)", "se(3), left-invariant (body)"),
        ("heavy_top_world", "so(3)", "so(3), right-invariant (world)"),
        ("planar_body", "se(2)", "se(2), left-invariant (body)"),
        (
            "two_bodies",
            "so(3) ⊕ so(3)",
            "so(3), left-invariant (body)",
        ),
    ] {
        let report = stdout(&["tables", &model(&format!("{name}.eom")), "--of", "geometry"]);
        let found = under(&report, "Lie algebra of the ∂ᵢ");
        assert_eq!(found, format!("{algebra}: γ is constant"), "{name}");
        assert!(report.contains(block), "{name}: {report}");
    }
    let json = stdout(&[
        "tables",
        &model("heavy_top_world.eom"),
        "--of",
        "geometry",
        "--format",
        "json",
    ]);
    let json: Value = serde_json::from_str(&json).expect("JSON");
    let geometry = &json["geometry"];
    assert_eq!(geometry["algebra"], "so(3)");
    assert_eq!(geometry["constant_mass"], false);
    let conserved: Vec<&Value> = geometry["velocities"]
        .as_array()
        .expect("velocities")
        .iter()
        .map(|velocity| &velocity["conserved_momentum"])
        .collect();
    assert_eq!(conserved, [false, false, true]);
}

#[test]
fn evaluation_obeys_the_laws() {
    for file in some(fixtures()) {
        let all: Value = serde_json::from_str(&stdout(&["eval", &file])).expect("JSON");
        // With constraints on velocities, M and Γ refer to the full frame, and the forces include multipliers.
        if all.get("constraint_force").is_some() {
            continue;
        }
        let (a, m) = (matrix(&all["A"]), matrix(&all["M"]));
        // With time, the tables refer to the extended frame: ξ⁰ = 1, and its row is not an equation of motion.
        let names = |of: &str| -> Vec<String> {
            let list = all[of].as_array().expect("names").iter();
            list.map(|name| name.as_str().expect("a name").to_owned())
                .collect()
        };
        let (frame, free) = (names("frame"), names("velocities"));
        let place = |name: &String| free.iter().position(|other| other == name);
        let extended = |values: &[f64], of_time: f64| -> Vec<f64> {
            let entries = frame
                .iter()
                .map(|name| place(name).map_or(of_time, |i| values[i]));
            entries.collect()
        };
        let of_free = |values: Vec<f64>| -> Vec<f64> {
            let entries = frame.iter().zip(values);
            entries
                .filter(|(name, _)| place(name).is_some())
                .map(|(_, value)| value)
                .collect()
        };
        let (mut velocities, mut accel) = (vector(&all["xi"]), vector(&all["accel"]));
        // They are followed by states of first order.
        let states = all.get("states").map_or(0, |_| names("states").len());
        assert_eq!(velocities.len(), free.len() + states);
        velocities.truncate(free.len());
        accel.truncate(free.len());
        let xi = extended(&velocities, 1.0);
        assert_balance(&file, &[vector(&all["rate"]), minus(&apply(&a, &xi))]);
        let [bias, slope, force] =
            ["bias", "potential_force", "generalized_force"].map(|name| vector(&all[name]));
        let inertial = of_free(apply(&m, &extended(&accel, 0.0)));
        assert_balance(&file, &[inertial, bias.clone(), slope, minus(&force)]);
        let kinetic = all["kinetic_energy"].as_f64().expect("a number");
        let half: f64 = apply(&m, &xi)
            .iter()
            .zip(&xi)
            .map(|(p, v)| 0.5 * p * v)
            .sum();
        assert_balance(&file, &[vec![kinetic], vec![-half]]);
        // The bias is Γ contracted with ξ twice.
        let table = all["Gamma"].as_array().expect("Γ").iter().map(matrix);
        let contracted: Vec<f64> = table
            .map(|rows| apply(&rows, &xi).iter().zip(&xi).map(|(c, v)| c * v).sum())
            .collect();
        assert_balance(&file, &[bias, minus(&of_free(contracted))]);
        for entry in vector(&all["constraint"]) {
            assert!(entry.abs() < 1e-9, "{file}: φ = {entry}");
        }
        assert_eq!(a.len(), all["coordinates"].as_array().map_or(0, Vec::len));
    }
}

#[test]
fn a_state_changes_the_numbers() {
    let state = r#"{"param": {"m": 2}, "velocity": {"w": [0, 0, 0]}}"#;
    let output = crate::common::hamel(&["eval", &model("heavy_top.eom"), "--at", "-"], state);
    let all: Value = serde_json::from_str(&text(&output.stdout)).expect("JSON");
    assert_eq!(all["kinetic_energy"], 0.0);
    assert!((all["potential_energy"].as_f64().expect("V") - 2.0 * 9.81 * 0.3).abs() < 1e-12);
}

#[test]
fn mistakes_in_a_state_are_named_at_once() {
    let state =
        r#"{"coord": {"R": [[1, 0], 2, 3]}, "velocity": {"omega": 1}, "param": {"g": "9"}}"#;
    let errors = stderr(&["eval", &model("heavy_top.eom"), "--at", "-"], state, 2);
    for expected in [
        "coord.R[0]: ",
        "coord.R[1]: ",
        "velocity.omega: ",
        "param.g: ",
        "5 errors",
    ] {
        assert!(errors.contains(expected), "{expected} in {errors}");
    }
    let off = r#"{"coord": {"R": [[1, 0, 0], [0, 1, 0], [0, 0, 1.001]]}}"#;
    let errors = stderr(&["eval", &model("heavy_top.eom"), "--at", "-"], off, 2);
    assert!(errors.contains("coord.R: violates"), "{errors}");
    let errors = stderr(&["eval", &model("heavy_top.eom"), "--at", "-"], "{", 2);
    assert!(
        errors.contains("not valid JSON") && errors.contains("line 1"),
        "{errors}"
    );
}

#[test]
fn a_singular_mass_matrix_is_an_error_and_no_nan() {
    for (file, state) in [
        ("principal_axes.eom", r#"{"param": {"J2": 0}}"#),
        ("pendulum.eom", r#"{"param": {"m": 0}}"#),
        ("cart_pole.eom", r#"{"param": {"mp": 0}}"#),
    ] {
        let output = crate::common::hamel(&["eval", &model(file), "--at", "-"], state);
        let all: Value = serde_json::from_str(&text(&output.stdout)).expect("JSON");
        assert_eq!(
            (output.status.code(), &all["accel"]),
            (Some(1), &Value::Null),
            "{file}"
        );
        assert!(
            text(&output.stderr).contains("not positive definite"),
            "{file}"
        );
        let arguments = ["simulate", &model(file), "--until", "1", "--at", "-"];
        let errors = stderr(&arguments, state, 1);
        assert!(errors.contains("not positive definite"), "{file}: {errors}");
    }
}

#[test]
fn the_heavy_top_keeps_its_energy() {
    for method in ["rkmk4", "rk4", "rk4-projected"] {
        let (csv, svg) = (
            scratch(&format!("{method}.csv")),
            scratch(&format!("{method}.svg")),
        );
        let (out, plot) = (csv.display().to_string(), svg.display().to_string());
        let file = model("heavy_top.eom");
        let summary = stdout(&[
            "simulate", &file, "--until", "5", "--step", "0.002", "--method", method, "--out",
            &out, "--plot", &plot, "--every", "25",
        ]);
        assert!(summary.contains("2 500 steps of 0.002") && summary.contains("10 000 evaluations"));
        let line = summary
            .lines()
            .find(|line| line.contains("relative"))
            .expect("energy");
        let change: f64 = line
            .split_whitespace()
            .rev()
            .nth(1)
            .and_then(|v| v.parse().ok())
            .expect("a number");
        assert!(change < 1e-8, "{method}: {line}");
        let table = std::fs::read_to_string(&csv).expect("the samples");
        assert!(table.starts_with("t,\"R[1,1]\",\"R[1,2]\","), "{table:.60}");
        assert_eq!(table.lines().count(), 1 + 101);
        assert!(
            table
                .lines()
                .last()
                .is_some_and(|line| line.starts_with("5.0,"))
        );
        let drawing = std::fs::read_to_string(&svg).expect("the plot");
        assert!(drawing.starts_with("<svg") && drawing.contains("body axis 3"));
        // P| of this top varies far more than that of a nearly free body.
        assert!(!drawing.contains("Poinsot"));
    }
}

#[test]
fn a_free_body_is_drawn_with_poinsots_construction() {
    let plot = scratch("poinsot.svg").display().to_string();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/dzhanibekov.eom");
    let file = file.display().to_string();
    let said = stdout(&["simulate", &file, "--until", "10", "--plot", &plot]);
    // The closed form never evaluates a force.
    assert!(said.contains(" 0 evaluations of the forces"), "{said}");
    let drawing = std::fs::read_to_string(&plot).expect("the plot");
    assert!(drawing.contains("Poinsot") && drawing.contains("polhode"));
    let plot = scratch("lagrange.svg").display().to_string();
    let file = model("lagrange_top.eom");
    stdout(&["simulate", &file, "--until", "1", "--plot", &plot]);
    let drawing = std::fs::read_to_string(&plot).expect("the plot");
    assert!(drawing.contains("energy and invariants") && drawing.contains("spin_momentum"));
}

#[test]
fn samples_as_json_hold_outputs() {
    let path = scratch("dzhanibekov.json");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/dzhanibekov.eom");
    let (file, out) = (file.display().to_string(), path.display().to_string());
    stdout(&[
        "simulate", &file, "--until", "30", "--step", "0.01", "--out", &out,
    ]);
    let samples: Value =
        serde_json::from_str(&std::fs::read_to_string(path).expect("samples")).expect("JSON");
    let samples = samples.as_array().expect("a list");
    let (first, last) = (&samples[0], &samples[samples.len() - 1]);
    assert_eq!(
        (&first["t"], &last["t"]),
        (&Value::from(0.0), &Value::from(30.0))
    );
    // It has flipped, and its angular momentum is unchanged.
    assert!(last["w[2]"].as_f64().expect("w") < -0.99);
    let drift = last["angular_momentum[2]"].as_f64().expect("L") - 2.0;
    assert!(drift.abs() < 1e-9, "{drift:e}");
}

#[test]
fn a_run_that_fails_says_when() {
    let description = "system Fall { coord q; velocity w; rate q = w; kinetic w^2 / 2; potential -q^4; start q = 1; }";
    let errors = stderr(
        &["simulate", "-", "--until", "10", "--step", "0.01"],
        description,
        1,
    );
    assert!(errors.contains("the run ends at t = "), "{errors}");
}

#[test]
fn wrong_usage_has_status_two() {
    let top = model("heavy_top.eom");
    for (arguments, expected) in [
        (&["simulate", &top, "--until", "0"][..], "greater than zero"),
        (
            &["simulate", &top, "--until", "1", "--step", "0"],
            "greater than zero",
        ),
        (
            &["simulate", &top, "--until", "1", "--step", "-0.1"],
            "greater than zero",
        ),
        (&["simulate", &top, "--until", "NaN"], "greater than zero"),
        (
            &["simulate", &top, "--until", "1", "--step", "1e-300"],
            "a time of 1.0 cannot be covered by steps of 1e-300",
        ),
        (
            &["simulate", &top, "--until", "1", "--lambda", "3"],
            "--method rk4",
        ),
        (
            &["simulate", &top, "--until", "1", "--every", "0"],
            "--every",
        ),
        (
            &["simulate", &top, "--until", "1", "--out", "a.txt"],
            ".csv",
        ),
        (&["simulate", &top], "--until"),
        (&["tables", &top, "--of", "A,B"], "there is no table `B`"),
        (
            &["tables", "no-such-file.eom"],
            "cannot read no-such-file.eom",
        ),
        (&["emit", &top, "--check"], "--out"),
        (&["nonsense"], "nonsense"),
    ] {
        let errors = stderr(arguments, "", 2);
        assert!(errors.contains(expected), "{arguments:?}: {errors}");
    }
}

#[test]
fn errors_of_a_description_show_its_text() {
    let description = "system Bad {\n    coord q;\n    velocity w;\n    rate q = omega;\n}";
    for command in ["tables", "check", "ops", "emit", "eval"] {
        let errors = stderr(&[command, "-"], description, 1);
        assert!(
            errors.contains("<stdin>:4:14") && errors.contains("^^^^^"),
            "{errors}"
        );
    }
}

#[test]
fn emitted_code_is_checked_against_a_file() {
    let (file, path) = (model("pendulum.eom"), scratch("pendulum.rs"));
    let out = path.display().to_string();
    assert_eq!(stdout(&["emit", &file, "-o", &out]), "");
    assert_eq!(
        stdout(&["emit", &file]),
        std::fs::read_to_string(&path).expect("the code")
    );
    stdout(&["emit", &file, "-o", &out, "--check"]);
    std::fs::write(&path, "fn other() {}").expect("scratch");
    let errors = stderr(&["emit", &file, "-o", &out, "--check"], "", 1);
    assert!(errors.contains("is out of date"), "{errors}");
    assert_eq!(
        std::fs::read_to_string(&path).expect("untouched"),
        "fn other() {}"
    );
}

#[test]
fn tables_and_counts_come_in_every_format() {
    let file = model("heavy_top.eom");
    let table = stdout(&["tables", &file, "--of", "gamma"]);
    assert!(table.contains("123 231 312"), "{table}");
    for format in ["text", "markdown", "latex"] {
        assert!(!stdout(&["tables", &file, "--format", format, "--all"]).is_empty());
    }
    let tables: Result<Value, _> =
        serde_json::from_str(&stdout(&["tables", &file, "--format", "json"]));
    assert!(tables.is_ok());
    assert!(stdout(&["ops", &file]).contains("accel"));
    let counts: Value =
        serde_json::from_str(&stdout(&["ops", &file, "--format", "json"])).expect("JSON");
    let accel = &counts["functions"]["accel"];
    assert!(
        accel["shared"]["flops"].as_u64() < accel["unshared"]["flops"].as_u64(),
        "{accel}"
    );
    assert!(counts["parameters"]["kept"].as_u64() > Some(0));
}

#[test]
fn check_prints_what_rounding_takes() {
    let lines = |name: &str| -> Vec<String> {
        let printed = stdout(&["check", &model(name)]);
        let lines = printed.lines().filter(|line| line.contains("rounding"));
        lines.map(|line| line.trim().to_string()).collect()
    };
    assert_eq!(
        lines("heavy_top.eom"),
        ["rounding       no function loses a digit"]
    );
    // Lost digits are reported if there are any.
    let some = lines("bricard.eom");
    let digits = |line: &String| -> Option<f64> {
        let digits = line.split("loses ").nth(1)?.split(' ').next()?;
        digits.trim_end_matches('.').parse().ok()
    };
    let (rest, listed) = some.split_last().expect("lines");
    assert!(
        listed.iter().any(|line| line.contains(" accel ")),
        "{some:?}"
    );
    assert!(
        listed.iter().all(|line| digits(line) >= Some(1.0)),
        "{some:?}"
    );
    assert!(
        rest.ends_with("functions lose less than a digit"),
        "{some:?}"
    );
}
