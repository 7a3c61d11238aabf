//! Eight real robots, read from their URDF files, against values of Pinocchio.
//!
//! The files are those of the wheel `example-robot-data`, which `tests/robots/install.sh` installs
//! below the target folder. Without them these tests print this and end.

use crate::common::{hamel, text};
use crate::installed::installed;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Largest difference in the Euclidean norm, relative to the reference: twelve digits of π/2 in a
/// URDF are read as π/2, each of which rotates the links after the joint by about 1e-12 rad.
const AGREEMENT: f64 = 1e-9;
/// Rounding error of sums of a few masses.
const ROUNDING: f64 = 1e-14;

/// A robot with its reference values.
struct Robot {
    name: String,
    urdf: String,
    reference: PathBuf,
    values: Value,
}

impl Robot {
    /// `None`, with a message, if the URDF files are absent.
    fn open(name: &str) -> Option<Robot> {
        let Some(folder) = installed() else {
            eprintln!(
                "{name} is not tested: its URDF is absent; tests/robots/install.sh installs it"
            );
            return None;
        };
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/reference/robots");
        let reference = root.join(format!("{name}.json"));
        let json = std::fs::read_to_string(&reference).expect("reference values");
        let values: Value = serde_json::from_str(&json).expect("JSON");
        let urdf = folder.join(values["urdf"].as_str().expect("a path"));
        Some(Robot {
            name: name.to_string(),
            urdf: urdf.display().to_string(),
            reference,
            values,
        })
    }

    /// Standard output of a command with the robot's file.
    fn run(&self, command: &str, further: &[&str]) -> String {
        let mut arguments = vec![command, self.urdf.as_str()];
        if self.values["floating_base"] == true {
            arguments.push("--floating");
        }
        arguments.extend(further);
        let output = hamel(&arguments, "");
        let errors = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{}: {errors}", self.name);
        text(&output.stdout)
    }
}

impl Robot {
    /// A description of the robot with the rates of some joints as inputs.
    fn driven(&self, name: &str, joints: &[&str]) -> String {
        let text = self.run("import", &[]);
        let end = text.rfind('}').expect("a description");
        let drives = joints.iter().map(|joint| {
            format!("    input {joint}_rate;\n    prescribe rate({joint}_dot) = {joint}_rate;\n")
        });
        let description = format!("{}{}}}\n", &text[..end], drives.collect::<String>());
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("driven");
        std::fs::create_dir_all(&folder).expect("a folder");
        let file = folder.join(format!("{}_{name}.eom", self.name));
        std::fs::write(&file, description).expect("a file");
        file.display().to_string()
    }
}

/// All numbers of a value, row by row.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(numbers).collect(),
        Value::Number(number) => vec![number.as_f64().expect("a double")],
        other => panic!("no number: {other}"),
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Compares all samples of a robot, and its mass.
fn agrees(name: &str) {
    let Some(robot) = Robot::open(name) else {
        return;
    };
    let printed = robot.run("eval", &["--at", &robot.reference.display().to_string()]);
    let printed: Value = serde_json::from_str(&printed).expect("JSON");
    let samples = robot.values["samples"].as_array().expect("samples");
    let evaluated = printed["samples"].as_array().expect("samples");
    assert_eq!((evaluated.len(), samples.len()), (5, 5));
    for (ours, theirs) in evaluated.iter().zip(samples) {
        assert_eq!(ours["velocities"], robot.values["velocity_order"]);
        for (our, their) in [
            ("M", "mass_matrix"),
            ("bias", "bias"),
            ("potential_force", "gravity_force"),
            ("accel", "acceleration"),
            ("kinetic_energy", "kinetic_energy"),
            ("potential_energy", "potential_energy"),
        ] {
            let (found, expected) = (numbers(&ours[our]), numbers(&theirs[their]));
            assert_eq!(found.len(), expected.len(), "{name}: {our}");
            let difference: Vec<f64> = found.iter().zip(&expected).map(|(a, b)| a - b).collect();
            let error = norm(&difference) / norm(&expected);
            assert!(error <= AGREEMENT, "{name}: {our} differs by {error:.1e}");
        }
    }
    let imported = robot.run("import", &[]);
    let masses = imported.split("mass ").skip(1).filter_map(|rest| {
        let number = rest.split(';').next()?;
        number.parse::<f64>().ok()
    });
    let mass: f64 = masses.sum();
    let expected = robot.values["total_mass"].as_f64().expect("a mass");
    assert!(
        (mass - expected).abs() <= ROUNDING * expected,
        "{name}: {mass} kg"
    );
}

/// The imported description generates byte for byte the same code as the robot.
fn generates_the_same(name: &str) {
    let Some(robot) = Robot::open(name) else {
        return;
    };
    let description = Path::new(&robot.urdf).with_extension("eom");
    let description = description.file_name().expect("a file");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("a folder");
    let description = folder.join(description).display().to_string();
    robot.run("import", &["-o", &description]);
    let output = hamel(&["emit", &description], "");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(robot.run("emit", &[]), text(&output.stdout));
}

/// Two joints of UR5 with their rates as inputs: prescribing Pinocchio's accelerations yields its torques and the
/// accelerations of the other joints.
#[test]
fn prescribed_accelerations_need_the_torques_of_pinocchio() {
    let Some(robot) = Robot::open("ur5") else {
        return;
    };
    let driven = ["shoulder_lift_joint", "wrist_2_joint"];
    let file = robot.driven("torques", &driven);
    let order = robot.values["velocity_order"].as_array().expect("names");
    let joints: Vec<&str> = order
        .iter()
        .map(|name| name.as_str().expect("a name"))
        .collect();
    for sample in robot.values["samples"].as_array().expect("samples") {
        let [force, acceleration] = ["force", "acceleration"].map(|name| numbers(&sample[name]));
        let mut inputs = serde_json::Map::new();
        for (joint, (torque, rate)) in joints.iter().zip(force.iter().zip(&acceleration)) {
            match driven.contains(joint) {
                true => inputs.insert(format!("{joint}_rate"), (*rate).into()),
                false => inputs.insert(format!("{joint}_tau"), (*torque).into()),
            };
        }
        let state = serde_json::json!({
            "coord": sample["configuration"], "velocity": sample["velocity"], "input": inputs,
        });
        let output = hamel(&["eval", &file, "--at", "-"], &state.to_string());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let printed: Value = serde_json::from_str(&text(&output.stdout)).expect("JSON");
        let apart = |found: &[f64], expected: &[f64]| {
            let difference: Vec<f64> = found.iter().zip(expected).map(|(a, b)| a - b).collect();
            norm(&difference) / norm(expected)
        };
        let accel = apart(&numbers(&printed["accel"]), &acceleration);
        assert!(accel <= AGREEMENT, "accelerations differ by {accel:.1e}");
        let torques: Vec<f64> = (joints.iter().zip(&force))
            .filter(|(joint, _)| driven.contains(joint))
            .map(|(_, torque)| *torque)
            .collect();
        let torque = apart(&numbers(&printed["constraint_force"]), &torques);
        assert!(torque <= AGREEMENT, "torques differ by {torque:.1e}");
    }
}

/// ξ̇ of UR5 with two driven joints takes no more operations than that of the arm with these joints locked plus 60 % of
/// inverse dynamics.
#[test]
fn drives_cost_no_more_than_what_they_replace() {
    let Some(robot) = Robot::open("ur5") else {
        return;
    };
    let flops = |printed: &str, function: &str| {
        let counts: Value = serde_json::from_str(printed).expect("JSON");
        counts["functions"][function]["shared"]["flops"]
            .as_u64()
            .expect("a count")
    };
    let inverse = flops(&robot.run("ops", &["--format", "json"]), "inverse_dynamics");
    for (name, driven, expected) in [
        ("base", ["shoulder_pan_joint", "shoulder_lift_joint"], 206),
        ("middle", ["shoulder_lift_joint", "elbow_joint"], 240),
        ("wrist", ["wrist_2_joint", "wrist_3_joint"], 298),
    ] {
        let file = robot.driven(name, &driven);
        let output = hamel(&["ops", &file, "--format", "json"], "");
        assert!(output.status.success(), "{}", text(&output.stderr));
        let accel = flops(&text(&output.stdout), "accel");
        let [one, other] = driven.map(|joint| format!("{joint}=0.4"));
        let locked = robot.run(
            "ops",
            &["--format", "json", "--lock", &one, "--lock", &other],
        );
        let most = flops(&locked, "accel") as f64 + 0.6 * inverse as f64;
        assert_eq!(accel, expected, "{name}");
        assert!(accel as f64 <= most, "{name}: {accel}, at most {most}");
    }
}

macro_rules! robots {
    ($($name:ident)*) => {$(
        mod $name {
            #[test]
            fn agrees_with_pinocchio() {
                super::agrees(stringify!($name));
            }

            #[test]
            fn generates_the_same_from_its_description() {
                super::generates_the_same(stringify!($name));
            }
        }
    )*};
}

robots! { double_pendulum iris finger_edu so100 ur5 z1 solo12 a1 }
