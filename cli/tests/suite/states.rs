//! Given states: completed like a start, or refused with the reason.

use crate::common::{hamel, text};
use serde_json::{Value, json};

fn model(name: &str) -> String {
    format!("{}/../tests/models/{name}.eom", env!("CARGO_MANIFEST_DIR"))
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter()
        .map(|entry| entry.as_f64().expect("a number"))
        .collect()
}

/// The residuals of the loops of `four_bar_loop`, and their rates.
fn four_bar(x: &[f64], w: &[f64]) -> [f64; 4] {
    let (l1, l2, l3, d) = (0.4, 1.0, 0.8, 1.0);
    let parts = [(l1, x[0], w[0]), (l2, x[1], w[1]), (-l3, x[2], w[2])];
    let mut open = [-d, 0.0, 0.0, 0.0];
    for (l, q, w) in parts {
        open[0] += l * q.cos();
        open[1] += l * q.sin();
        open[2] -= l * q.sin() * w;
        open[3] += l * q.cos() * w;
    }
    open
}

fn refused(name: &str, state: &str) -> String {
    let output = hamel(&["eval", &model(name), "--at", "-"], state);
    assert_eq!(
        output.status.code(),
        Some(2),
        "{state}: {}",
        text(&output.stdout)
    );
    assert!(
        output.stdout.is_empty(),
        "nothing is printed of a state that is refused"
    );
    text(&output.stderr)
}

#[test]
fn a_coordinate_of_a_closed_loop_moves_the_others() {
    let output = hamel(
        &["eval", &model("four_bar_loop"), "--at", "-"],
        r#"{"coord": {"q1": 1.5}, "velocity": {"w1": -3}}"#,
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let (x, xi) = (numbers(&found["x"]), numbers(&found["xi"]));
    assert_eq!((x[0], xi[0]), (1.5, -3.0));
    let open = four_bar(&x, &xi);
    assert!(open.iter().all(|size| size.abs() < 1e-12), "{open:?}");
}

#[test]
fn what_contradicts_a_loop_is_refused_with_the_residual() {
    let message = refused(
        "four_bar_loop",
        r#"{"coord": {"q1": 1.5, "q2": 0, "q3": 0}}"#,
    );
    assert!(message.contains("open by 7.72e-1"), "{message}");
    assert!(
        message.contains("l1 * cos(q1) + l2 * cos(q2) = d + l3 * cos(q3)"),
        "{message}"
    );
    let velocities = r#"{"velocity": {"w1": 1, "w2": 5, "w3": 5}}"#;
    let message = refused("four_bar_loop", velocities);
    assert!(message.contains("velocity: violates `l1 *"), "{message}");
    let longer = r#"{"param": {"d": 10}}"#;
    assert!(refused("four_bar_loop", longer).contains("open by"));
}

#[test]
fn a_run_from_a_completed_state_keeps_its_energy() {
    let output = hamel(
        &[
            "simulate",
            &model("four_bar_loop"),
            "--until",
            "0.5",
            "--at",
            "-",
        ],
        r#"{"coord": {"q1": 1.5}, "velocity": {"w1": 4}}"#,
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let out = text(&output.stdout);
    let line = out
        .lines()
        .find(|line| line.trim_start().starts_with("energy"));
    let word = line.expect("the energy").split_whitespace().rev().nth(1);
    let drift: f64 = word.expect("a number").parse().expect("a number");
    assert!(drift < 1e-6, "{out}");
}

#[test]
fn what_is_no_state_is_refused() {
    for (state, message) in [
        (
            r#"{"coord": {"q1": 1, "q1": 2}}"#,
            "`q1` occurs twice in one object at line 1 column 24",
        ),
        (
            r#"{"coord": {"q1": 1}, "coord": {}}"#,
            "`coord` occurs twice",
        ),
        (r#"{"coord": {"q1": NaN}}"#, "not valid JSON"),
        (
            r#"{"coord": {"q1": 1e999}}"#,
            "not valid JSON: number out of range",
        ),
        (r#"{"coord": {"q4": 1}}"#, "coord.q4: unknown name"),
        (
            r#"{"coord": {"q1": [1, 2]}}"#,
            "coord.q1: expected a number, found a list",
        ),
        (r#"{"positions": {}}"#, "positions: unknown name"),
    ] {
        let found = refused("four_bar_loop", state);
        assert!(found.contains(message), "{state}: {found}");
    }
}

#[test]
fn a_rotation_off_by_the_rounding_of_its_text_is_cleared_of_it() {
    let state = json!({"coord": {"R": [[0.6, -0.8, 0.0], [0.8000001, 0.6, 0.0], [0.0, 0.0, 1.0]]}});
    let output = hamel(
        &["eval", &model("heavy_top"), "--at", "-"],
        &state.to_string(),
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let off = numbers(&found["constraint"]);
    assert!(off.iter().all(|size| size.abs() < 1e-15), "{off:?}");
    let further = json!({"coord": {"R": [[0.6, -0.8, 0.0], [0.801, 0.6, 0.0], [0.0, 0.0, 1.0]]}});
    assert!(refused("heavy_top", &further.to_string()).contains("the difference is"));
}

/// Full size with `HAMEL_ATTACK=full`.
#[test]
fn any_state_closes_its_loops_or_is_refused() {
    let full = std::env::var("HAMEL_ATTACK").is_ok_and(|size| size == "full");
    let mut state = 9u64;
    let mut number = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1u64 << 31) as f64
    };
    let mut kept = 0;
    let rounds = if full { 1_000 } else { 16 };
    for _ in 0..rounds {
        let (mut coord, mut velocity) = (json!({}), json!({}));
        for i in 1..=3 {
            if number() < 0.3 {
                coord[format!("q{i}")] = json!(4.0 * number() - 2.0);
            }
            if number() < 0.3 {
                velocity[format!("w{i}")] = json!(20.0 * number() - 10.0);
            }
        }
        let text = json!({"coord": coord, "velocity": velocity}).to_string();
        let output = hamel(&["eval", &model("four_bar_loop"), "--at", "-"], &text);
        match output.status.code() {
            Some(0) => {}
            Some(2) => continue,
            code => panic!("{text}: {code:?} {}", crate::common::text(&output.stderr)),
        }
        kept += 1;
        let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let (x, xi) = (numbers(&found["x"]), numbers(&found["xi"]));
        let size = xi.iter().fold(1.0, |size: f64, w| size.max(w.abs()));
        let open = four_bar(&x, &xi);
        assert!(
            open.iter().all(|open| open.abs() < 1e-11 * size),
            "{text}: {open:?}"
        );
        for i in 0..3 {
            let given = |part: &Value, name: String, value: f64| {
                let given = part.get(&name).and_then(Value::as_f64);
                assert!(
                    given.is_none_or(|given| given == value),
                    "{text}: {name} is {value}"
                );
            };
            given(&coord, format!("q{}", i + 1), x[i]);
            given(&velocity, format!("w{}", i + 1), xi[i]);
        }
    }
    assert!(kept * 3 > rounds, "{kept} of {rounds}");
}

/// A wheel on a slider, with a free base.
const FLYING: &str = "system Flying {
    joint base: free moves hull;
    joint wheel: continuous [0, 0, 1] on hull at pose(rotz(0), [0.3, 0, 0]) moves disk;
    joint slide: prismatic [0, 1, 0] on hull moves block { force u; }
    input u;
    body on hull { mass 2; inertia diag(1, 2, 3) about com; }
    body on disk { mass 1; com [0.1, 0, 0]; inertia diag(0.1, 0.1, 0.2) about com; }
    body on block { mass 1; inertia diag(0.1, 0.1, 0.1) about com; }
    start slide = 0.1;
}";
const BY_JOINTS: &str = r#"{"configuration": {"wheel": 0.3, "base": {"position": [1, 2, 3], "rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]}},
    "velocity": {"slide": 0.4, "base": {"linear": [0.1, 0, 0], "angular": [0, 0.2, 0]}}}"#;
const BY_COORDINATES: &str = r#"{"coord": {"wheel": 0.3, "base_r": [1, 2, 3], "base_R": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]},
    "velocity": {"slide_dot": 0.4, "base_v": [0.1, 0, 0], "base_w": [0, 0.2, 0]}}"#;

fn flying(name: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, FLYING).expect("scratch");
    path.display().to_string()
}

#[test]
fn every_command_takes_a_state_by_coordinates_or_by_joints() {
    let file = flying("flying.eom");
    let run = |arguments: &[&str], state: &str| {
        let output = hamel(&[arguments, &["--at", "-"]].concat(), state);
        assert!(
            output.status.success(),
            "{arguments:?}: {}",
            text(&output.stderr)
        );
        text(&output.stdout)
    };
    for arguments in [
        &["simulate", &file, "--until", "0.1"][..],
        &["linearize", &file, "--format", "json"],
    ] {
        let found = run(arguments, BY_JOINTS);
        assert_eq!(found, run(arguments, BY_COORDINATES));
        assert_ne!(found, run(arguments, "{}"));
    }
    let compare = [
        "compare",
        &file,
        "--until",
        "0.1",
        "--steps",
        "4",
        "--methods",
        "rkmk4",
        "--format",
        "json",
    ];
    let error = |state: &str| {
        let report: Value = serde_json::from_str(&run(&compare, state)).expect("JSON");
        let error = &report["cases"][0]["methods"][0]["runs"][0]["error"];
        error.as_f64().expect("an error")
    };
    assert_eq!(error(BY_JOINTS), error(BY_COORDINATES));
    assert_ne!(error(BY_JOINTS), error("{}"));
    let x = |state: &str| {
        let all: Value = serde_json::from_str(&run(&["eval", &file], state)).expect("JSON");
        (numbers(&all["x"]), numbers(&all["xi"]))
    };
    assert_eq!(x(BY_JOINTS), x(BY_COORDINATES));
}

#[test]
fn a_force_and_a_list_of_states_are_for_eval_alone() {
    let file = flying("forced.eom");
    for (state, message) in [
        (
            r#"{"configuration": {}, "force": {"slide": 1}}"#,
            "force: only `hamel eval` takes a force",
        ),
        (
            r#"{"samples": [{"configuration": {}}]}"#,
            "samples: only `hamel eval` takes several states",
        ),
    ] {
        assert!(hamel(&["eval", &file, "--at", "-"], state).status.success());
        for arguments in [
            &["simulate", &file, "--until", "0.1", "--at", "-"][..],
            &["linearize", &file, "--at", "-"],
            &["compare", &file, "--until", "0.1", "--at", "-"],
        ] {
            let output = hamel(arguments, state);
            let errors = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
            assert!(errors.contains(message), "{arguments:?}: {errors}");
        }
    }
    let wrong = r#"{"configuration": {"wheels": 1}}"#;
    let output = hamel(&["linearize", &file, "--at", "-"], wrong);
    let errors = text(&output.stderr);
    assert!(
        errors.contains("configuration.wheels: unknown name; did you mean `wheel`?"),
        "{errors}"
    );
    for command in [
        &["eval"][..],
        &["linearize"],
        &["simulate", "--until", "1"],
        &["compare"],
    ] {
        let output = hamel(&[command, &["-", "--at", "-"]].concat(), FLYING);
        let errors = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{command:?}: {errors}");
        assert!(
            errors.contains("cannot both be read from standard input"),
            "{command:?}: {errors}"
        );
    }
}

/// di/dt = (V − R i − n k w)/L of the motor, at a given current.
#[test]
fn states_of_first_order_are_read_and_shown() {
    let state = r#"{"state": {"i": 2}, "velocity": {"w": 1}, "input": {"V": 3}}"#;
    let json = |arguments: &[&str]| -> Value {
        let output = hamel(arguments, state);
        assert!(output.status.success(), "{}", text(&output.stderr));
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let motor = model("dc_pendulum");
    let found = json(&["eval", &motor, "--at", "-"]);
    assert_eq!(numbers(&found["xi"]), [1.0, 2.0]);
    assert_eq!(found["states"], json!(["i"]));
    assert_eq!(found["velocities"], json!(["w"]));
    let current = numbers(&found["accel"])[1];
    assert!((current - (3.0 - 1.2 * 2.0 - 20.0 * 0.03) / 1e-3).abs() < 1e-9);
    let linear = json(&["linearize", &motor, "--at", "-", "--format", "json"]);
    assert_eq!(linear["states"], json!(["h(w)", "d(w)", "d(i)"]));
    assert_eq!(linear["A"][2], json!([0.0, -600.0, -1200.0]));
    for (wrong, said) in [
        (r#"{"state": {"j": 2}}"#, "state.j"),
        (r#"{"state": {"i": [2]}}"#, "state.i: expected a number"),
        (r#"{"velocity": {"i": 2}}"#, "velocity.i"),
    ] {
        let errors = refused("dc_pendulum", wrong);
        assert!(errors.contains(said), "{wrong}: {errors}");
    }
    // Only a coil: i = exp(−R t/L) i₀ while the motor is at rest.
    let run = [
        "simulate", &motor, "--at", "-", "--until", "0.001", "--method", "rkmk8",
    ];
    let output = hamel(&run, r#"{"param": {"n": 0}, "state": {"i": 2}}"#);
    let report = text(&output.stdout);
    let row = report
        .lines()
        .find_map(|line| line.trim().strip_prefix("i "));
    let end: f64 = row
        .and_then(|end| end.trim().parse().ok())
        .expect("the current at the end");
    assert!((end - 2.0 * (-1.2_f64).exp()).abs() < 1e-5, "{report}");
}
