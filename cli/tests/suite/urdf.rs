//! Robots in URDF with the commands that take descriptions, and states by the names of joints.

use crate::common::{hamel, text};
use hamel_codegen::urdf::Options;
use hamel_codegen::{lower, vocabulary};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

/// Rounding error of small results.
const ROUNDING: f64 = 1e-14;

/// A pendulum on a slider: 1 kg sliding along x, 2 kg at 0.5 m below a hinge about y.
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

/// M and forces of the cart with the pendulum at an angle, computed by hand.
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
    // The force is the total: the damping of the slider is not added to it.
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
    // Without a given force the loads of the robot act.
    let free = eval(
        &[&robot],
        r#"{"configuration": {}, "velocity": {"slide-x": 2}}"#,
    );
    near(&free["generalized_force"][0], -6.0);
}

/// Every command accepts the joint names of the robot's file.
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

/// Lists of forces in a given order, and several states at once.
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
        "configuration.hinge: expected a number, found a list",
        "velocity.hinge: expected a number, found a text",
        "force: expected a list of 2 numbers, found a list of 1",
        "5 errors",
    ] {
        assert!(errors.contains(line), "{line} is not in {errors}");
    }
}

/// Every command treats the robot like its description.
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

/// Inertias that are parameters give the same numbers as constant ones.
#[test]
fn parameters_change_no_number() {
    // A free base needs inertia.
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

/// The damping of a joint that follows at three times the rate acts nine times on its leader.
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

/// Errors are underlined in the URDF, all at once.
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

const BODY: &str = r#"<inertial><origin xyz="0.1 0.2 0.3"/><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>"#;

/// A joint between two links.
fn joint(name: &str, kind: &str, parent: &str, child: &str) -> String {
    format!(
        r#"<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><axis xyz="0 0 1"/></joint>"#
    )
}

/// A link with mass.
fn link(name: &str) -> String {
    format!(r#"<link name="{name}">{BODY}</link>"#)
}

/// A massless fingertip at the end of a chain of twelve links: the joint that turns it is underlined.
#[test]
fn a_joint_without_inertia_is_shown_in_the_urdf() {
    let mut robot = String::from("<robot name=\"chain\">\n<link name=\"l0\"/>\n");
    for k in 1..=12 {
        let (before, after) = (format!("l{}", k - 1), format!("l{k}"));
        let kind = if k % 2 == 0 { "revolute" } else { "prismatic" };
        robot += &joint(&format!("j{k}"), kind, &before, &after);
        robot += &match k {
            12 => "\n<link name=\"l12\"/>\n".to_string(),
            _ => link(&after) + "\n",
        };
    }
    let robot = scratch("fingertip.urdf", &(robot + "</robot>"));
    let output = hamel(&["simulate", &robot, "--until", "1"], "");
    assert_eq!(output.status.code(), Some(1));
    let said = text(&output.stderr);
    assert!(
        said.contains("`j12_dot`) is not positive") && said.contains("fingertip.urdf:14:14"),
        "{said}"
    );
}

/// Joints and links may have names that are words of the language: the description renames them.
#[test]
fn words_of_the_language_are_names_of_robots() {
    let words: BTreeSet<String> = vocabulary::statements()
        .map(|(word, _)| word.to_string())
        .chain(vocabulary::kinds_of_joints().map(String::from))
        .chain(vocabulary::fields_of_joints().map(|(word, _)| word.into()))
        .chain(vocabulary::fields_of_bodies().map(|(word, _)| word.into()))
        .chain(vocabulary::functions().map(|(word, _)| word.into()))
        .collect();
    assert!(words.len() > 100);
    let mut refused = Vec::new();
    for word in &words {
        let robot = |joint_name: &str, link_name: &str| {
            let (base, link) = (r#"<link name="base"/>"#, link(link_name));
            let joint = joint(joint_name, "revolute", "base", link_name);
            let text = format!(r#"<robot name="{word}">{base}{link}{joint}</robot>"#);
            let imported = hamel_codegen::urdf::import(&text, &Options::default());
            imported.expect("a sound robot")
        };
        for imported in [robot(word, "rod"), robot("hinge", word)] {
            let built = lower::build(&imported.system);
            if let Err(errors) = built {
                refused.push(format!("{word}: {}", errors[0].message));
            }
        }
        if word == "max" {
            assert_eq!(robot(word, "rod").joints[0].1, "max_joint");
            assert_eq!(robot("hinge", word).links[0].1, "max_link");
        }
    }
    assert!(refused.is_empty(), "{refused:#?}");
}

/// Frames are links by their names in the file, which descriptions change; the fixed base is one of them.
#[test]
fn frames_are_links() {
    let described = format!(
        r#"<robot name="r"><link name="base link"/>{}<link name="tool-0"/><link name="tool_0"/>{}{}
        <joint name="s" type="fixed"><parent link="arm"/><child link="tool_0"/><origin xyz="0 0 2"/></joint></robot>"#,
        link("arm"),
        joint("arm", "revolute", "base link", "arm"),
        joint("t", "fixed", "arm", "tool-0").replace("<axis", r#"<origin xyz="0 3 0"/><axis"#),
    );
    let robot = scratch("frames.urdf", &described);
    let names = ["tool-0", "tool_0", "arm", "arm_link", "base link"];
    let mut arguments = vec![robot.as_str()];
    arguments.extend(names.iter().flat_map(|name| ["--frame", name]));
    let by_joints = eval(&arguments, r#"{"configuration": {}}"#);
    for found in [eval(&arguments, "{}"), by_joints] {
        let frames = found["kinematics"].as_object().expect("frames");
        assert_eq!(frames.len(), names.len());
        let position = |name: &str, place: usize| number(&frames[name]["pose"][place][3]);
        assert_eq!(position("tool-0", 1), 3.0);
        // The name of a link in the file takes precedence over that of another link in the description.
        assert_eq!(position("tool_0", 2), 2.0);
        assert_eq!(frames["arm"], frames["arm_link"]);
        let base = &frames["base link"];
        for (row, column) in (0..3).flat_map(|row| (0..4).map(move |column| (row, column))) {
            let expected = f64::from(u8::from(row == column));
            assert_eq!(number(&base["pose"][row][column]), expected);
        }
        let rows = base["jacobian"].as_array().expect("a Jacobian");
        assert!(rows.iter().all(|row| number(&row[0]) == 0.0), "{base}");
    }
    let output = hamel(&["eval", &robot, "--frame", "tool-1", "--frame", "x"], "");
    assert_eq!(output.status.code(), Some(1));
    let said = text(&output.stderr);
    for part in [
        "frames.urdf: no link is called `tool-1`; did you mean `tool-0`?",
        "no link is called `x`; the links are arm, tool_0, tool-0, base link",
    ] {
        assert!(said.contains(part), "{part} is not in {said}");
    }
}

/// Velocities by joints alone, in either form, and together with inputs.
#[test]
fn velocities_alone_are_known_by_joints() {
    let described = format!(
        r#"<robot name="r">{}{}{}</robot>"#,
        link("base"),
        link("leg"),
        joint("hip 1", "revolute", "base", "leg")
    );
    let robot = scratch("velocities.urdf", &described);
    let given = r#""velocity": {"hip 1": 2, "root_joint": {"linear": [1, 2, 3]}}"#;
    let other = r#""velocity": {"hip_1": 2, "root_joint_v": [1, 2, 3]}"#;
    for state in [
        format!("{{{given}}}"),
        format!(r#"{{"configuration": {{}}, {given}}}"#),
        format!(r#"{{"input": {{"hip_1_tau": 1}}, {given}}}"#),
        format!("{{{other}}}"),
    ] {
        let found = eval(&[&robot, "--floating"], &state);
        let xi: Vec<f64> = found["xi"]
            .as_array()
            .expect("ξ")
            .iter()
            .map(number)
            .collect();
        assert_eq!(xi, [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 2.0], "{state}");
    }
    let twice =
        r#"{"velocity": {"hip 1": 2, "hip_1": 2, "root_joint": {"linear": [1], "angle": 0}}}"#;
    let output = hamel(&["eval", &robot, "--floating", "--at", "-"], twice);
    let said = text(&output.stderr);
    for part in [
        "velocity.hip_1: given twice, also by another of its names",
        "velocity.root_joint.linear: expected a list of 3 numbers, found a list of 1",
        "velocity.root_joint.angle: unknown name",
    ] {
        assert!(said.contains(part), "{part} is not in {said}");
    }
}

/// A planar joint is one joint, whatever other joints are called.
#[test]
fn planar_joints_are_one_joint() {
    let described = format!(
        r#"<robot name="r"><link name="base"/>{}{}{}{}</robot>"#,
        link("a"),
        link("b"),
        joint("glide 1", "planar", "base", "a"),
        joint("glide_1_r", "revolute", "a", "b")
    );
    let robot = scratch("planar.urdf", &described);
    let state = r#"{"configuration": {"glide_1_r": 0.3, "glide 1": {"position": [1, 2], "angle": 0.5}},
        "velocity": {"glide_1_r": 4, "glide 1": {"linear": [1, 2], "angular": 3}},
        "force": {"glide 1": [5, 6, 7]}}"#;
    let found = eval(&[&robot], state);
    let names = ["glide 1", "glide 1", "glide 1", "glide_1_r"];
    assert_eq!(found["velocities"], serde_json::json!(names));
    assert_eq!(found["x"], serde_json::json!([1.0, 2.0, 0.5, 0.3]));
    assert_eq!(found["xi"], serde_json::json!([1.0, 2.0, 3.0, 4.0]));
    let force = serde_json::json!([5.0, 6.0, 7.0, 0.0]);
    assert_eq!(found["generalized_force"], force);
    let alone = eval(&[&robot], r#"{"velocity": {"glide 1": [1, 2, 3]}}"#);
    assert_eq!(alone["xi"], serde_json::json!([1.0, 2.0, 3.0, 0.0]));
}

/// Two links with a point mass at the end of the second one, which starts on the first axis, where M is singular: this
/// start was not chosen by the user, and other states have accelerations.
#[test]
fn a_start_at_zero_may_be_singular() {
    let hinge = |name: &str, parent: &str, child: &str, place: &str| {
        format!(
            r#"<joint name="{name}" type="KIND"><parent link="{parent}"/><child link="{child}"/>
            <origin xyz="{place}"/><axis xyz="0 1 0"/></joint>"#
        )
    };
    let described = format!(
        r#"<robot name="r"><link name="base"/><link name="a"/><link name="b"><inertial><origin xyz="0 0 1"/><mass value="1"/>
        <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>{}{}</robot>"#,
        hinge("j", "base", "a", "0 0 0"),
        hinge("k", "a", "b", "0 0 1")
    );
    for kind in ["revolute", "continuous"] {
        let robot = scratch(
            &format!("singular_{kind}.urdf"),
            &described.replace("KIND", kind),
        );
        let state = r#"{"configuration": {"k": 1.2}}"#;
        let found = eval(&[&robot], state);
        // Closed form: r = (sin a + sin(a + k), cos a + cos(a + k)) for a = 0, whose rates have to satisfy r̈ = −g e_z.
        let (s, c) = 1.2_f64.sin_cos();
        let rates: [f64; 2] = [0, 1].map(|place| number(&found["accel"][place]));
        let reached = [
            (1.0 + c) * rates[0] + c * rates[1],
            -s * (rates[0] + rates[1]),
        ];
        assert!(reached[0].abs() < 1e-12, "{reached:?}");
        assert!((reached[1] + 9.81).abs() < 1e-12, "{reached:?}");
        for command in [
            &["simulate", &robot, "--until", "0.01", "--at", "-"][..],
            &["linearize", &robot, "--at", "-"],
        ] {
            let output = hamel(command, state);
            assert!(output.status.success(), "{}", text(&output.stderr));
        }
        // At the start itself there is none, which is reported.
        let output = hamel(&["eval", &robot], "");
        assert_eq!(output.status.code(), Some(1));
        let said = text(&output.stderr);
        assert!(said.contains("`accel` has no value"), "{said}");
        let output = hamel(&["simulate", &robot, "--until", "0.01"], "");
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    }
    // A system that is singular everywhere still has no inverse: the point lies on an axis.
    let robot = scratch(
        "nowhere.urdf",
        &described
            .replace("KIND", "revolute")
            .replace(r#"<origin xyz="0 0 1"/><mass"#, "<mass"),
    );
    let output = hamel(
        &["eval", &robot, "--at", "-"],
        r#"{"configuration": {"k": 1.2}}"#,
    );
    let said = text(&output.stderr);
    assert!(said.contains("functions that need its inverse"), "{said}");
}
