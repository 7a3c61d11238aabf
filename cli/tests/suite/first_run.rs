//! Common situations of first runs: states of closed loops, constraints that determine coordinates, and dependent
//! velocities.

use crate::common::{hamel, text};
use serde_json::Value;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The numbers of a member in the output of `eval` for a description at a state.
fn evaluated(description: &str, state: &str, member: &str) -> Vec<f64> {
    // Tests of one process run concurrently.
    static STATES: AtomicUsize = AtomicUsize::new(0);
    let number = STATES.fetch_add(1, Ordering::Relaxed);
    let path = format!("{}/first-run-{number}.json", env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(&path, state).expect("written");
    let output = hamel(&["eval", "-", "--at", &path], description);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let list = value[member].as_array().expect("a list");
    list.iter().filter_map(Value::as_f64).collect()
}

const FIVE_BAR: &str = include_str!("../../../tests/models/five_bar.eom");

/// The two rods meet in the assembly of the start, with the given cranks kept.
#[test]
fn states_on_loops_are_closed_in_the_assembly_of_the_start() {
    let state = r#"{"coord": {"q1": 1.9, "q2": 1.1}, "velocity": {"w1": 1, "w2": -0.5}}"#;
    let x = evaluated(FIVE_BAR, state, "x");
    assert_eq!(x[..2], [1.9, 1.1]);
    let (a, b, d) = (0.3, 0.5, 0.25);
    let tip = |q: f64, p: f64, at: f64| {
        [
            at + a * q.cos() + b * (q + p).cos(),
            a * q.sin() + b * (q + p).sin(),
        ]
    };
    let (left, right) = (tip(x[0], x[2], 0.0), tip(x[1], x[3], d));
    assert!(
        (0..2).all(|k| (left[k] - right[k]).abs() < 1e-11),
        "{left:?} {right:?}"
    );
    // Above the cranks, not below them.
    assert!(left[1] > 0.5, "{left:?}");
    let xi = evaluated(FIVE_BAR, state, "xi");
    let speed = |q: f64, p: f64, w: f64, u: f64| {
        [
            -a * q.sin() * w - b * (q + p).sin() * (w + u),
            a * q.cos() * w + b * (q + p).cos() * (w + u),
        ]
    };
    let (left, right) = (
        speed(x[0], x[2], xi[0], xi[2]),
        speed(x[1], x[3], xi[1], xi[3]),
    );
    assert!(
        (0..2).all(|k| (left[k] - right[k]).abs() < 1e-10),
        "{left:?} {right:?}"
    );
}

/// A bead on an ellipse: for a given x, y follows, on the side of the start.
#[test]
fn coordinates_that_constraints_give_are_solved_for() {
    let bead = "system Bead {
        coord x, y; velocity u;
        constraint x^2 / 4 + y^2 = 1;
        rate x = -2 * y * u, y = x * u / 2;
        particle mass 1 at [x, y, 0];
        start x = 0, y = -1;
    }";
    let x = evaluated(bead, r#"{"coord": {"x": 1.2}}"#, "x");
    assert!((x[1] + 0.8).abs() < 1e-12, "{x:?}");
    let output = hamel(&["eval", "-", "--at", "/dev/null"], bead);
    assert!(!output.status.success());
}

/// `check` shows the origin of a dependent velocity.
#[test]
fn velocities_that_follow_are_shown_with_their_line() {
    let sleigh = include_str!("../../../tests/models/sleigh_choice.eom");
    let output = hamel(&["check", "-"], sleigh);
    let said = text(&output.stdout);
    assert!(output.status.success(), "{said}");
    for line in [
        "velocity u  stays in the state",
        "velocity v  stays in the state",
        "velocity w  follows from the constraint on line 10, `v = -a * w`",
    ] {
        assert!(said.contains(line), "{said}");
    }
}

/// A robot with a massless finger: functions that do not need M⁻¹ are emitted, with a warning.
#[test]
fn robots_without_an_inverse_of_m_are_emitted_and_counted() {
    let robot = r#"<robot name="hand">
  <link name="base"/>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <link name="rod"><inertial><mass value="1"/><inertia ixx="0.2" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.01"/></inertial></link>
  <joint name="finger" type="revolute"><parent link="rod"/><child link="tip"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <link name="tip"/>
</robot>"#;
    let output = hamel(&["emit", "-"], robot);
    let (code, said) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{said}");
    assert!(said.contains("functions that need its inverse"), "{said}");
    assert!(
        code.contains("fn inverse_dynamics") && !code.contains("fn accel"),
        "{code}"
    );
    let output = hamel(&["ops", "-"], robot);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let counts = text(&output.stdout);
    assert!(
        counts.contains("mass_matrix") && !counts.contains("accel"),
        "{counts}"
    );
    // The motion is undefined.
    let output = hamel(&["simulate", "-", "--until", "1"], robot);
    assert!(!output.status.success());
}

/// A table in a file is found by every command.
#[test]
fn tables_in_files_are_read_by_all_commands() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../tests/models/tabled/wing.eom"
    );
    for command in ["check", "ops", "eval", "tables"] {
        let output = hamel(&[command, path], "");
        assert!(
            output.status.success(),
            "{command}: {}",
            text(&output.stderr)
        );
    }
}

/// Poses and Jacobians of frames by their names, for states by coordinates and by joints.
#[test]
fn frames_are_evaluated_by_their_names() {
    let arm = "system Arm {
        joint a: revolute [0, 0, 1] moves f;
        joint b: revolute [0, 0, 1] on f at pose(identity(3), [1, 0, 0]) moves g;
        frame tip on g = pose(identity(3), [0.5, 0, 0]);
        body on g { mass 1; inertia diag(1, 1, 1) about com; }
        start a = 0.3, b = 0.5, a_dot = 2, b_dot = -1;
    }";
    let state = r#"{"configuration": {"a": 0.3, "b": 0.5}, "velocity": {"a": 2, "b": -1}}"#;
    let file = format!("{}/frames-by-joints.json", env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(&file, state).expect("written");
    for at in [&[][..], &["--at", &file]] {
        let output = hamel(&[&["eval", "-", "--frame", "tip"], at].concat(), arm);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let tip = &value["kinematics"]["tip"];
        let number = |value: &Value| value.as_f64().expect("a number");
        let (elbow, angle) = (0.3_f64, 0.8_f64);
        // The tip rotates at 2 about the base, and at −1 about the elbow.
        let x = elbow.cos() + 0.5 * angle.cos();
        let speed = 2.0 * x - 0.5 * angle.cos();
        let close =
            |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-14, "{found} {wanted}");
        close(number(&tip["pose"][0][3]), x);
        close(number(&tip["jacobian"][1][0]), x);
        close(number(&tip["twist"][1]), speed);
        close(number(&tip["body_twist"][5]), 1.0);
        assert!(tip["bias_acceleration"][0].is_number() && tip["body_jacobian"][5][1] == 1.0);
    }
    let output = hamel(&["eval", "-", "--frame", "top"], arm);
    assert_eq!(output.status.code(), Some(1));
    let said = text(&output.stderr);
    assert!(
        said.contains("no frame is called `top`") && said.contains("the frames are f, g, tip"),
        "{said}"
    );
}

#[test]
fn checks_count_dimensions_where_units_are_written() {
    let sled = "system Sled { param m: [kg] = 2, k = 3; coord x: [m]; velocity v; rate x = v;
        kinetic m * v^2 / 2; spring stiffness k on x; start x = 20 [cm]; }";
    let said = |description: &str| text(&hamel(&["check", "-"], description).stdout);
    let line = "  dimensions     consistent: 2 declared, 2 inferred\n";
    assert!(said(sled).contains(line), "{}", said(sled));
    let plain = sled
        .replace(": [kg]", "")
        .replace(": [m]", "")
        .replace("20 [cm]", "0.2");
    assert_eq!(said(sled).replace(line, ""), said(&plain));
}
