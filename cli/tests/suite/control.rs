//! Quantities for controllers, for real robots against Pinocchio: poses, Jacobians and bias accelerations of frames,
//! centre of mass, momenta, centroidal map, and the derivatives of ξ̇ and of inverse dynamics.
//!
//! `HAMEL_CONTROL_REFERENCE` names a folder with more robots.

use crate::installed::installed;
use crate::pinocchio::{control, coordinates, list, velocities};
use crate::undamped::undamped;
use hamel_codegen::functions::FunctionId;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::program::count::count;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::urdf::{Options, import};
use serde_json::Value;
use std::path::Path;

/// Relative to the largest entry of an array.
const TOLERANCE: f64 = 1e-10;

#[test]
fn quantities_for_control_agree_with_pinocchio() {
    let Some(folder) = installed() else {
        eprintln!("not tested: the URDF files are absent; tests/robots/install.sh installs them");
        return;
    };
    for robot in control() {
        agrees(&folder, &robot);
    }
}

/// A robot without damping, and the compared quantities.
fn described(folder: &Path, reference: &Value) -> (Generated, Vec<(String, String)>, String) {
    let (text, joints) = undamped(folder, reference);
    let frames = reference["samples"][0]["frames"]
        .as_object()
        .expect("frames");
    let frames: Vec<String> = frames
        .keys()
        .map(|link| word(link, &text))
        .map(|frame| format!("jacobian {frame} in world, jacobian {frame} in {frame}"))
        .collect();
    let text = format!(
        "{text} generate linearize, inverse_dynamics_slopes, centre_of_mass, centroidal_map, {}; }}",
        frames.join(", ")
    );
    (from_text(&text).expect("a program"), joints, text)
}

fn agrees(folder: &Path, reference: &Value) {
    let name = reference["robot"].as_str().expect("a name");
    let (generated, joints, text) = described(folder, reference);
    let model = &generated.active;
    let call = |function: &str, x: &[f64], xi: &[f64], u: &[f64]| -> Vec<f64> {
        let found = generated.program.function(function);
        let found = found.unwrap_or_else(|| panic!("{name}: no {function}"));
        let interpreter = Interpreter::new(&generated.program, found, &model.defaults);
        interpreter.call(x, xi, u, &[]).expect("a value")
    };
    let same = |what: &str, found: &[f64], wanted: &[f64]| {
        assert_eq!(found.len(), wanted.len(), "{name}: {what}");
        let size = wanted.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let pairs = found.iter().zip(wanted);
        let worst = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        let error = if size > 0.0 { worst / size } else { worst };
        assert!(error < TOLERANCE, "{name}: {what} differs by {error:.1e}");
    };
    for sample in reference["samples"].as_array().expect("samples") {
        let x = coordinates(model, sample, &joints);
        let xi = velocities(model, sample, &joints);
        let force = list(&sample["force"]);
        // The wrench on a floating base, force before torque, then the motors.
        let u = force;
        for (link, wanted) in sample["frames"].as_object().expect("frames") {
            let frame = word(link, &text);
            let pose = call(&format!("{frame}_pose"), &x, &xi, &u);
            let position: Vec<f64> = pose.chunks(4).map(|row| row[3]).collect();
            let rotation: Vec<f64> = pose.chunks(4).flat_map(|row| row[..3].to_vec()).collect();
            same("a position", &position, &list(&wanted["position"]));
            same("a rotation", &rotation, &list(&wanted["rotation"]));
            for (axes, body) in [("local_world_aligned", ""), ("local", "body_")] {
                let rows = &wanted[format!("jacobian_{axes}")];
                let found = call(&format!("{frame}_{body}jacobian"), &x, &xi, &u);
                same("a Jacobian", &found, &both(rows));
                let twist = call(&format!("{frame}_{body}twist"), &x, &xi, &u);
                same("a twist", &product(&both(rows), &xi), &twist);
                let bias = call(&format!("{frame}_{body}bias_acceleration"), &x, &xi, &u);
                let wanted = &wanted[format!("jdot_v_{axes}")];
                same("a bias acceleration", &bias, &both(wanted));
            }
        }
        let centroidal = &sample["centroidal"];
        let centre = call("centre_of_mass", &x, &xi, &u);
        same(
            "the centre of mass",
            &centre,
            &list(&centroidal["com_position"]),
        );
        let momentum = call("centroidal_momentum", &x, &xi, &u);
        let wanted = ["linear_momentum", "angular_momentum"].map(|part| list(&centroidal[part]));
        same("the linear momentum", &momentum[..3], &wanted[0]);
        same("the angular momentum", &momentum[3..], &wanted[1]);
        let map = call("centroidal_map", &x, &xi, &u);
        same("the map", &product(&map, &xi), &momentum);
        if centroidal["momentum_matrix"].is_object() {
            same("the map", &map, &both(&centroidal["momentum_matrix"]));
        }
        let forward = &sample["forward_dynamics"];
        let linear = call("linearize", &x, &xi, &u);
        let n = model.n();
        let columns = 2 * n + u.len();
        let part = |from: usize| -> Vec<f64> {
            let rows = linear[n * columns..].chunks(columns);
            rows.flat_map(|row| row[from..from + n].to_vec()).collect()
        };
        let slopes = |by: &str| list(&forward[format!("d_acceleration_d_{by}")]);
        same("∂ξ̇/∂h", &part(0), &slopes("displacement"));
        same("∂ξ̇/∂ξ", &part(n), &slopes("velocity"));
        same("∂ξ̇/∂f", &part(2 * n), &slopes("force"));
        let inverse = &sample["inverse_dynamics"];
        let xi_dot = list(&inverse["acceleration"]);
        let function = generated.program.function("inverse_dynamics_slopes");
        let function = function.expect("slopes of inverse dynamics");
        let interpreter = Interpreter::new(&generated.program, function, &model.defaults);
        let found = interpreter.call(&x, &xi, &[], &xi_dot).expect("a value");
        let rows = found.chunks(2 * n);
        let (left, right): (Vec<&[f64]>, Vec<&[f64]>) = rows.map(|row| row.split_at(n)).unzip();
        let wanted = |by: &str| list(&inverse[format!("d_force_d_{by}")]);
        same("∂f/∂h", &left.concat(), &wanted("displacement"));
        same("∂f/∂ξ", &right.concat(), &wanted("velocity"));
    }
    let operations = |function: &str| {
        let found = generated.program.function(function).expect("a function");
        count(&generated.program.graph, &found.outputs).flops()
    };
    println!(
        "{name}: {} operations for the slopes, {} for those of inverse dynamics, {} for the centroidal map",
        operations(FunctionId::Linearize.name()),
        operations("inverse_dynamics_slopes"),
        operations("centroidal_map")
    );
}

/// The name of a link in a description, with a suffix if a joint has this name.
fn word(link: &str, text: &str) -> String {
    let word = link.replace(|letter: char| !letter.is_ascii_alphanumeric(), "_");
    match text.contains(&format!("joint {word}:")) {
        true => word + "_link",
        false => word,
    }
}

/// A matrix by rows times a vector.
fn product(rows: &[f64], vector: &[f64]) -> Vec<f64> {
    let entry = |row: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum();
    rows.chunks(vector.len()).map(entry).collect()
}

/// The linear rows, followed by the angular ones.
fn both(value: &Value) -> Vec<f64> {
    [list(&value["linear"]), list(&value["angular"])].concat()
}

/// The operations of the Jacobian of a last link, in world axes and in body axes.
#[test]
fn jacobians_cost_no_more_than_they_did() {
    let Some(folder) = installed() else {
        eprintln!("not tested: the URDF files are absent; tests/robots/install.sh installs them");
        return;
    };
    for (urdf, floating, link, world, own) in [
        (
            "ur_description/urdf/ur5_robot.urdf",
            false,
            "wrist_3_link",
            56,
            108,
        ),
        (
            "ur_description/urdf/ur5_robot.urdf",
            false,
            "tool0",
            76,
            116,
        ),
        (
            "panda_description/urdf/panda.urdf",
            false,
            "panda_link7",
            119,
            134,
        ),
        (
            "solo_description/robots/solo12.urdf",
            true,
            "FL_FOOT",
            97,
            45,
        ),
    ] {
        let text = std::fs::read_to_string(folder.join(urdf)).expect("a URDF");
        let options = Options {
            floating,
            ..Options::default()
        };
        let imported = import(&text, &options).expect("a robot");
        let text = imported.text();
        let (text, _) = text.rsplit_once('}').expect("a description");
        let asked = format!("generate jacobian {link}, jacobian {link} in {link};");
        let generated = from_text(&format!("{text} {asked} }}")).expect("a program");
        let program = &generated.program;
        // No other function of the robot is generated.
        assert_eq!(program.functions.len(), 7, "{link}");
        for (function, most) in [("jacobian", world), ("body_jacobian", own)] {
            let function = program.function(format!("{link}_{function}"));
            let outputs = &function.expect("a function").outputs;
            let operations = count(&program.graph, outputs).flops();
            println!("{link}: {operations} operations, at most {most}");
            assert!(
                operations <= most,
                "{link}: {operations} operations, {most} before"
            );
        }
    }
}
