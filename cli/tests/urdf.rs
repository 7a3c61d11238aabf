//! Robots in URDF through the commands that take descriptions, and states by the names of joints.

mod common;

use common::{hamel, text};
use serde_json::Value;
use std::path::Path;

/// Small results of a few roundings.
const ROUNDING: f64 = 1e-14;

/// A pendulum on a slider: 1 kg that slides along x, 2 kg at 0.5 m below a hinge about y.
const CART: &str = r#"<robot name="cart">
  <link name="rail"/>
  <joint name="slide-x" type="prismatic">
    <parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/><dynamics damping="3"/>
  </joint>
  <link name="cart"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="hinge" type="continuous">
    <parent link="cart"/><child link="rod"/><axis xyz="0 1 0"/>
  </joint>
  <link name="rod">
    <inertial><origin xyz="0 0 -0.5"/><mass value="2"/><inertia ixx="1e-1" ixy="0" ixz="0" iyy="1e-1" iyz="0" izz="1e-1"/></inertial>
  </link>
</robot>"#;

fn scratch(name: &str, content: &str) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, content).expect("writable");
    path.display().to_string()
}

fn eval(arguments: &[&str], state: &str) -> Value {
    let mut all = vec!["eval"];
    all.extend(arguments);
    all.extend(["--at", "-"]);
    let output = hamel(&all, state);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_str(&text(&output.stdout)).expect("JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// M and forces of the cart with the pendulum at an angle, by hand.
#[test]
fn states_by_joint() {
    let robot = scratch("cart.urdf", CART);
    let state = r#"{"configuration": {"slide-x": 0.3, "hinge": 0.4}, "velocity": {"slide-x": 2, "hinge": 0.7},
        "force": {"hinge": 0.2}}"#;
    let found = eval(&[&robot], state);
    assert_eq!(found["velocities"], serde_json::json!(["slide-x", "hinge"]));
    let (c, s) = (0.4_f64.cos(), 0.4_f64.sin());
    let (mass, coupling, inertia) = (3.0, -2.0 * 0.5 * c, 0.1 + 2.0 * 0.25);
    let bias = [2.0 * 0.5 * s * 0.49, 2.0 * 0.5 * 9.81 * s];
    let near = |value: &Value, expected: f64| {
        let value = number(value);
        assert!(
            (value - expected).abs() < ROUNDING * expected.abs().max(1.0),
            "{value} {expected}"
        );
    };
    near(&found["M"][0][0], mass);
    near(&found["M"][0][1], coupling);
    near(&found["M"][1][1], inertia);
    near(&found["bias"][0], bias[0]);
    near(&found["bias"][1], bias[1]);
    // The force is the whole one: the damping of the slider is not added to it.
    let rest = [0.0 - bias[0], 0.2 - bias[1]];
    let determinant = mass * inertia - coupling * coupling;
    near(
        &found["accel"][0],
        (inertia * rest[0] - coupling * rest[1]) / determinant,
    );
    near(
        &found["accel"][1],
        (mass * rest[1] - coupling * rest[0]) / determinant,
    );
    // Without a force it is what acts.
    let free = eval(
        &[&robot],
        r#"{"configuration": {}, "velocity": {"slide-x": 2}}"#,
    );
    near(&free["generalized_force"][0], -6.0);
}

/// Joints go by the names that they have in the robot's file, for every command.
#[test]
fn a_run_starts_at_a_state_by_joint() {
    let robot = scratch("started.urdf", CART);
    let out = scratch("started.csv", "");
    let state = r#"{"configuration": {"slide-x": 0.3}, "velocity": {"slide-x": 2}}"#;
    let arguments = [
        "simulate", &robot, "--until", "0.1", "--at", "-", "--out", &out,
    ];
    let output = hamel(&arguments, state);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let samples = std::fs::read_to_string(&out).expect("the samples");
    let lines: Vec<&str> = samples.lines().collect();
    assert_eq!(lines[0], "t,slide_x,hinge.c,hinge.s,slide_x_dot,hinge_dot");
    assert_eq!(lines[1], "0.0,0.3,1.0,0.0,2.0,0.0");
}

/// Lists of forces in another order, and several states at once.
#[test]
fn several_states_in_an_order_of_their_own() {
    let robot = scratch("ordered.urdf", CART);
    let state = |force: &str| format!(r#"{{"configuration": {{"hinge": 1}}, "force": {force}}}"#);
    let one = eval(&[&robot], &state("[5, 7]"));
    let list = format!(
        r#"{{"velocity_order": ["hinge", "slide-x"], "samples": [{}, {}]}}"#,
        state("[7, 5]"),
        state("[1, 2]")
    );
    let all = eval(&[&robot], &list);
    assert_eq!(all["samples"][0], one);
    assert_ne!(all["samples"][1], one);
}

#[test]
fn wrong_states_by_joint() {
    let robot = scratch("wrong.urdf", CART);
    let state = r#"{"configuration": {"hinge": [1, 0], "slider-x": 1}, "speed": 1, "force": [1],
        "velocity": {"hinge": "fast"}}"#;
    let output = hamel(&["eval", &robot, "--at", "-"], state);
    assert_eq!(output.status.code(), Some(2));
    let errors = text(&output.stderr);
    for line in [
        "speed: unknown name",
        "configuration.slider-x: unknown name; did you mean `slide-x`?",
        "configuration.hinge: a number expected, a list found",
        "velocity.hinge: a number expected, a text found",
        "force: a list of 2 numbers expected, a list of 1 found",
        "5 errors",
    ] {
        assert!(errors.contains(line), "{line} is not in {errors}");
    }
}

/// Every command takes the robot as it takes its description.
#[test]
fn commands_take_robots() {
    let robot = scratch("door.urdf", CART);
    let description = scratch("door.eom", "");
    let output = hamel(
        &["import", &robot, "--lock", "hinge=0.5", "-o", &description],
        "",
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    for command in ["ops", "tables", "emit", "check"] {
        let ours = hamel(&[command, &robot, "--lock", "hinge=0.5"], "");
        let theirs = hamel(&[command, &description], "");
        assert!(ours.status.success(), "{command}: {}", text(&ours.stderr));
        assert_eq!(text(&ours.stdout), text(&theirs.stdout), "{command}");
    }
    let piped = hamel(&["ops", "-", "--lock", "hinge=0.5"], CART);
    assert!(piped.status.success(), "{}", text(&piped.stderr));
    let misplaced = hamel(&["ops", &description, "--floating"], "");
    assert_eq!(misplaced.status.code(), Some(2));
    assert!(text(&misplaced.stderr).contains("is a description"));
}

/// Inertias that are parameters give the numbers of those that are constants.
#[test]
fn parameters_change_no_number() {
    // A base that moves by itself needs inertia.
    let rail = r#"<link name="rail"><inertial><mass value="4"/><inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="1.5"/></inertial></link>"#;
    let robot = scratch("params.urdf", &CART.replace(r#"<link name="rail"/>"#, rail));
    let state = r#"{"configuration": {"root_joint": {"position": [1, 2, 3]}, "hinge": 0.4},
        "velocity": {"root_joint": {"linear": [1, 0, 2], "angular": [0.1, 0.2, 0.3]}, "slide-x": 2},
        "force": [1, 2, 3, 4, 5, 6, 7, 8]}"#;
    let constants = eval(&[&robot, "--floating"], state);
    let params = eval(&[&robot, "--floating", "--params"], state);
    assert_eq!(constants["velocities"][5], "root_joint");
    for (name, scale) in [("accel", 1e2), ("bias", 1e2)] {
        for index in 0..8 {
            let (a, b) = (
                number(&constants[name][index]),
                number(&params[name][index]),
            );
            assert!((a - b).abs() < ROUNDING * scale, "{name}[{index}]: {a} {b}");
        }
    }
}

/// The damping of a joint that follows at three times the rate is felt nine times by its leader.
#[test]
fn dampers_of_joints_that_follow() {
    let mimic = r#"<dynamics damping="0.2"/><mimic joint="slide-x" multiplier="-3" offset="1"/><parent link="cart"/><child link="rod"/>"#;
    let both = r#"<parent link="cart"/><child link="rod"/>"#;
    let robot = scratch(
        "mimic.urdf",
        &CART.replace(both, mimic).replace("continuous", "revolute"),
    );
    let found = eval(
        &[&robot],
        r#"{"configuration": {}, "velocity": {"slide-x": 2}}"#,
    );
    let force = number(&found["generalized_force"][0]);
    assert!(
        (force + (3.0 + 9.0 * 0.2) * 2.0).abs() < ROUNDING * 10.0,
        "{force}"
    );
}

/// Mistakes are underlined in the URDF, all at once.
#[test]
fn mistakes_are_shown_in_the_urdf() {
    let wrong = CART
        .replace("axis xyz=\"1 0 0\"", "axis xyz=\"0 0 0\"")
        .replace("value=\"2\"", "value=\"-2\"");
    let robot = scratch("mistakes.urdf", &wrong);
    let output = hamel(&["ops", &robot], "");
    assert_eq!(output.status.code(), Some(1));
    let errors = text(&output.stderr);
    assert!(
        errors.contains("mistakes.urdf:4:") && errors.contains("mistakes.urdf:11:"),
        "{errors}"
    );
    assert!(errors.contains("2 errors"), "{errors}");
}
