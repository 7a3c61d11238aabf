//! Elements of URDF dialects that plain URDF does not have, against closed forms and against trees of the same
//! mechanism; every output reports the elements read and left out.

use crate::common::{hamel, text};
use serde_json::{Value, json};
use std::path::Path;

/// Rounding error of results of some hundred operations.
const ROUNDING: f64 = 1e-12;

type Matrix = [[f64; 3]; 3];

fn scratch(name: &str, content: impl AsRef<[u8]>) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, content).expect("writable");
    path.display().to_string()
}

fn eval(robot: &str, state: &Value) -> Value {
    let output = hamel(&["eval", robot, "--at", "-"], &state.to_string());
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_str(&text(&output.stdout)).expect("JSON")
}

fn near(value: &Value, expected: f64) {
    let value = value.as_f64().expect("a number");
    let close = ROUNDING * expected.abs().max(1.0);
    assert!((value - expected).abs() < close, "{value} {expected}");
}

/// A robot with the namespace declarations of the dialects.
fn robot(inside: &str) -> String {
    format!(
        "<robot name=\"r\" xmlns:drake=\"http://drake.mit.edu\">\n<link name=\"base\"/>\n{inside}\n</robot>"
    )
}

fn link(name: &str, com: [f64; 3], mass: f64) -> String {
    let [x, y, z] = com;
    format!(
        "<link name=\"{name}\"><inertial><origin xyz=\"{x} {y} {z}\" rpy=\"0.2 0 0.1\"/><mass value=\"{mass}\"/>\
         <inertia ixx=\"0.02\" ixy=\"0.001\" ixz=\"0\" iyy=\"0.03\" iyz=\"0.002\" izz=\"0.025\"/></inertial></link>\n"
    )
}

/// A pendulum of 1.5 kg at 0.3 m below a hinge about y, with 0.02 kg m² about its centre of mass.
fn pendulum(joint: &str, beside: &str) -> String {
    robot(&format!(
        "<link name=\"arm\"><inertial><origin xyz=\"0 0 -0.3\"/><mass value=\"1.5\"/>\
         <inertia ixx=\"0.02\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.01\"/></inertial></link>\n\
         <joint name=\"hinge\" type=\"revolute\"><parent link=\"base\"/><child link=\"arm\"/><axis xyz=\"0 1 0\"/>{joint}</joint>\n{beside}"
    ))
}

/// M = I + m l² + N² J and M q̈ = −m g l sin q − d q̇ − k (q − q₀), for all notations of rotors, damping and springs.
#[test]
fn rotors_dampers_and_springs_of_joints() {
    let transmission = |drive: &str| {
        format!(
            "<transmission name=\"t\"><type>transmission_interface/SimpleTransmission</type><joint name=\"hinge\"/>\
             <actuator name=\"m\">{drive}</actuator></transmission>"
        )
    };
    let drake = "<drake:rotor_inertia value=\"0.0001\"/>";
    let ratio = "<drake:gear_ratio value=\"-100\"/>";
    let both = transmission(&format!("{drake}{ratio}"));
    let own = "<rotorInertia>0.0001</rotorInertia><mechanicalReduction>50</mechanicalReduction>";
    let spring = "<gazebo reference=\"hinge\"><springStiffness>3</springStiffness>\
                  <springReference>0.2</springReference></gazebo>";
    let damped = "<joint_properties damping=\"0.4\"/>";
    for (joint, beside, armature, damping, stiffness) in [
        ("", both.clone(), 1.0, 0.0, 0.0),
        ("", transmission(drake), 0.0001, 0.0, 0.0),
        ("", transmission(own), 0.25, 0.0, 0.0),
        (
            "",
            both.clone() + &both.replace("\"t\"", "\"u\""),
            2.0,
            0.0,
            0.0,
        ),
        (
            "<dynamics armature=\"0.3\" damping=\"0.1\"/>",
            both.clone(),
            1.3,
            0.1,
            0.0,
        ),
        (damped, String::new(), 0.0, 0.4, 0.0),
        (damped, spring.to_string(), 0.0, 0.4, 3.0),
        (
            "",
            format!("<ros2_control name=\"c\" type=\"system\">{both}</ros2_control>"),
            1.0,
            0.0,
            0.0,
        ),
    ] {
        let file = scratch("pendulum-of-dialects.urdf", pendulum(joint, &beside));
        let (q, rate) = (0.7_f64, 1.3);
        let found = eval(
            &file,
            &json!({"configuration": {"hinge": q}, "velocity": {"hinge": rate}}),
        );
        let inertia = 0.02 + 1.5 * 0.09 + armature;
        near(&found["M"][0][0], inertia);
        let force = -1.5 * 9.81 * 0.3 * q.sin() - damping * rate - stiffness * (q - 0.2);
        near(&found["accel"][0], force / inertia);
    }
}

/// A rotor on a joint that follows another one with factor r adds r² N² J to the inertia of that joint.
#[test]
fn rotors_of_joints_that_follow() {
    let rotor = "<transmission name=\"t\"><joint name=\"second\"/><actuator name=\"m\">\
                 <drake:rotor_inertia value=\"0.001\"/><drake:gear_ratio value=\"20\"/></actuator></transmission>";
    let follower = |rotor: &str| {
        let inside = link("arm", [0.0, 0.0, -0.3], 1.5) + &link("fore", [0.1, 0.0, 0.0], 1.0);
        let inside = inside
            + "<joint name=\"first\" type=\"revolute\"><parent link=\"base\"/><child link=\"arm\"/><axis xyz=\"0 1 0\"/></joint>\n\
               <joint name=\"second\" type=\"revolute\"><parent link=\"arm\"/><child link=\"fore\"/><axis xyz=\"0 0 1\"/>\
               <mimic joint=\"first\" multiplier=\"-3\" offset=\"0.1\"/></joint>\n";
        robot(&(inside + rotor))
    };
    let state = json!({"configuration": {"first": 0.4}});
    let without = eval(&scratch("followed.urdf", follower("")), &state);
    let with = eval(&scratch("followed-rotor.urdf", follower(rotor)), &state);
    let plain = without["M"][0][0].as_f64().expect("a number");
    near(&with["M"][0][0], plain + 9.0 * 400.0 * 0.001);
}

/// ½ k (ℓ − l)² between a world point and a point of the pendulum, by its derivative.
#[test]
fn springs_between_points() {
    let part = |name: &str, value: &str| format!("<drake:linear_spring_damper_{name} {value}/>");
    let spring = [
        part("body_A", "name=\"base\""),
        part("p_AP", "value=\"0.1 0 0.2\""),
        part("body_B", "name=\"arm\""),
        part("p_BQ", "value=\"0 0 -0.5\""),
        part("free_length", "value=\"0.3\""),
        part("stiffness", "value=\"7\""),
        part("damping", "value=\"0.5\""),
    ];
    let spring = format!(
        "<drake:linear_spring_damper>{}</drake:linear_spring_damper>",
        spring.concat()
    );
    let file = scratch("point-spring.urdf", pendulum("", &spring));
    let (q, rate) = (0.7_f64, 1.3);
    let found = eval(
        &file,
        &json!({"configuration": {"hinge": q}, "velocity": {"hinge": rate}}),
    );
    let (x, z) = (-0.5 * q.sin() - 0.1, -0.5 * q.cos() - 0.2);
    let length = (x * x + z * z).sqrt();
    let slope = (x * -0.5 * q.cos() + z * 0.5 * q.sin()) / length;
    let force =
        -1.5 * 9.81 * 0.3 * q.sin() - 7.0 * (length - 0.3) * slope - 0.5 * slope * slope * rate;
    near(&found["accel"][0], force / (0.02 + 1.5 * 0.09));
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn times(a: Matrix, v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|k| a[i][k] * v[k]).sum())
}

fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// Rotation matrix by Rodrigues' formula.
fn turn(axis: [f64; 3], angle: f64) -> Matrix {
    let norm = axis.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|entry| entry / norm);
    let (c, s) = (angle.cos(), angle.sin());
    let hat = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let n = [x, y, z];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let same = if i == j { c } else { 0.0 };
            same + (1.0 - c) * n[i] * n[j] + s * hat[i][j]
        })
    })
}

/// A hand connected to an arm by a tree joint moves like a free hand that a closing joint connects to the arm.
#[test]
fn closing_joints_are_the_joints_of_a_tree() {
    let (axis, written) = ([1.0, 2.0, -1.0], "<axis xyz=\"1 2 -1\"/>");
    let place = "xyz=\"0.1 0.2 0.4\" rpy=\"0.3 -0.2 0.5\"";
    let arm = link("arm", [0.1, 0.0, -0.3], 1.5)
        + &link("hand", [0.05, -0.1, 0.2], 0.8)
        + "<joint name=\"shoulder\" type=\"revolute\"><parent link=\"base\"/><child link=\"arm\"/><axis xyz=\"0 1 0\"/></joint>\n";
    let rotation = product(
        turn([0.0, 0.0, 1.0], 0.5),
        product(turn([0.0, 1.0, 0.0], -0.2), turn([1.0, 0.0, 0.0], 0.3)),
    );
    let free = "<joint name=\"hand_joint\" type=\"floating\"><parent link=\"base\"/><child link=\"hand\"/></joint>\n";
    let ball = "<drake:ball_constraint><drake:ball_constraint_body_A name=\"arm\"/><drake:ball_constraint_p_AP value=\"0.1 0.2 0.4\"/>\
                <drake:ball_constraint_body_B name=\"hand\"/><drake:ball_constraint_p_BQ value=\"0 0 0\"/></drake:ball_constraint>";
    let oblique = turn([0.3, -0.5, 0.2], 0.9);
    let unit = axis.map(|entry| entry / 6.0_f64.sqrt());
    let identity = turn(axis, 0.0);
    for (kind, state, moved, shift) in [
        ("revolute", json!(0.6), turn(axis, 0.6), [0.0; 3]),
        (
            "prismatic",
            json!(0.2),
            identity,
            unit.map(|entry| 0.2 * entry),
        ),
        ("spherical", json!(oblique), oblique, [0.0; 3]),
        ("ball", json!(oblique), oblique, [0.0; 3]),
        ("fixed", Value::Null, identity, [0.0; 3]),
    ] {
        let tree = format!(
            "{arm}<joint name=\"wrist\" type=\"{kind}\"><origin {place}/><parent link=\"arm\"/><child link=\"hand\"/>{written}</joint>"
        );
        let closing = match kind {
            "ball" => ball.to_string(),
            _ => format!(
                "<loop_joint name=\"pin\" type=\"{kind}\">{written}<link1 link=\"arm\" {place}/><link2 link=\"hand\"/></loop_joint>"
            ),
        };
        let mut configuration = json!({"shoulder": 0.3});
        if !state.is_null() {
            configuration["wrist"] = state;
        }
        let tree = eval(
            &scratch(&format!("tree-{kind}.urdf"), robot(&tree)),
            &json!({ "configuration": configuration }),
        );
        let upper = turn([0.0, 1.0, 0.0], 0.3);
        let hand = product(upper, product(rotation, moved));
        let origin = times(upper, sum([0.1, 0.2, 0.4], times(rotation, shift)));
        let pose = json!({"position": origin, "rotation": hand});
        let tied = eval(
            &scratch(
                &format!("tied-{kind}.urdf"),
                robot(&(arm.clone() + free + &closing)),
            ),
            &json!({"configuration": {"shoulder": 0.3, "hand_joint": pose}}),
        );
        let order = |found: &Value| {
            let names = found["velocities"].as_array().expect("names");
            names.iter().position(|name| {
                name.as_str()
                    .is_some_and(|name| name.starts_with("shoulder"))
            })
        };
        let place = |found: &Value| order(found).expect("a shoulder");
        let expected = tree["accel"][place(&tree)].as_f64().expect("a number");
        assert!(expected.abs() > 0.1, "{kind}: {expected}");
        near(&tied["accel"][place(&tied)], expected);
    }
}

/// Drake's universal joint is a hinge about x followed by a hinge about y.
#[test]
fn universal_joints_are_two_hinges() {
    let damping = "<dynamics damping=\"0.3\"/>";
    let universal = link("arm", [0.1, 0.05, -0.3], 1.5)
        + &format!(
            "<drake:joint name=\"hook\" type=\"universal\"><parent link=\"base\"/><child link=\"arm\"/>{damping}</drake:joint>"
        );
    let hinges = link("arm", [0.1, 0.05, -0.3], 1.5)
        + &format!(
            "<link name=\"cross\"/><joint name=\"hook_1\" type=\"revolute\"><parent link=\"base\"/><child link=\"cross\"/><axis xyz=\"1 0 0\"/>{damping}</joint>\n\
             <joint name=\"hook_2\" type=\"revolute\"><parent link=\"cross\"/><child link=\"arm\"/><axis xyz=\"0 1 0\"/>{damping}</joint>"
        );
    let state = json!({"configuration": {"hook_1": 0.4, "hook_2": -0.7}, "velocity": {"hook_1": 1.1, "hook_2": 0.6}});
    let one = eval(&scratch("universal.urdf", robot(&universal)), &state);
    let two = eval(&scratch("hinges.urdf", robot(&hinges)), &state);
    for i in 0..2 {
        near(
            &one["accel"][i],
            two["accel"][i].as_f64().expect("a number"),
        );
    }
}

/// Every command prints on standard error the warnings that `import` also writes to the description.
#[test]
fn warnings_are_everywhere() {
    let inside = pendulum(
        "<joint_properties damping=\"0.4\"/><flexibility value=\"3\"/>",
        "<tendon name=\"t\"/>\n<gazebo reference=\"arm\"><turnGravityOff>true</turnGravityOff></gazebo>",
    );
    let file = scratch("warned.urdf", inside);
    let messages = [
        "`damping` of `<joint_properties>` is not part of URDF; it is read as that of `<dynamics>`",
        "`<flexibility>` is not an element of `<joint>` in URDF and is left out",
        "`<tendon>` is not an element of `<robot>` in URDF and is left out",
        "`<turnGravityOff>` changes the motion but is left out",
    ];
    let (out, picture) = (scratch("warned.rs", ""), scratch("warned.svg", ""));
    for arguments in [
        vec!["import", &file],
        vec!["ops", &file],
        vec!["check", &file],
        vec!["eval", &file],
        vec!["emit", &file, "-o", &out],
        vec!["simulate", &file, "--until", "0.01"],
        vec!["draw", &file, "--out", &picture],
        vec!["regressor", &file],
        vec!["linearize", &file],
        vec!["tables", &file],
    ] {
        let output = hamel(&arguments, "");
        let said = text(&output.stderr);
        for message in messages {
            let times = said.matches(&format!("warning: {message}\n")).count();
            assert_eq!(times, 1, "{arguments:?}: {message}\n{said}");
        }
    }
    let written = text(&hamel(&["import", &file], "").stdout);
    for (message, line) in messages.iter().zip([4, 4, 5, 6]) {
        assert!(
            written.contains(&format!("// - {line}: {message}\n")),
            "{written}"
        );
    }
}

/// UTF-16 from PowerShell and declared encodings are read as the same robot.
#[test]
fn encodings_of_robots() {
    let plain = pendulum("", "");
    let expected = text(&hamel(&["import", &scratch("encoded.urdf", &plain)], "").stdout);
    assert!(expected.contains("joint hinge"));
    let units = || "\u{feff}".encode_utf16().chain(plain.encode_utf16());
    let head = "\u{feff}<?xml version=\"1.0\" encoding=\"UTF-16\"?>";
    let declared = head.encode_utf16().chain(plain.encode_utf16());
    let wide: Vec<u8> = declared.flat_map(u16::to_le_bytes).collect();
    let little: Vec<u8> = units().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = units().flat_map(u16::to_be_bytes).collect();
    let marked = format!("\u{feff}{plain}").into_bytes();
    let declared = format!("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>{plain}").into_bytes();
    for bytes in [little, big, wide, marked, declared] {
        let output = hamel(&["import", &scratch("encoded.urdf", bytes)], "");
        assert_eq!(text(&output.stdout), expected, "{}", text(&output.stderr));
    }
    let unknown = "<?xml version=\"1.0\" encoding=\"Shift_JIS\"?><robot name=\"r\"/>";
    let output = hamel(&["import", &scratch("encoded.urdf", unknown)], "");
    let said = text(&output.stderr);
    assert!(
        said.contains("the encoding `shift_jis` is not read; save it as UTF-8"),
        "{said}"
    );
}
