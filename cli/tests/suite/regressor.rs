//! Base parameters: their number for real robots, the columns against those of Pinocchio, Y β against inverse dynamics,
//! exact factors, and refused systems.

use crate::common::{hamel, text};
use crate::installed::installed;
use crate::pinocchio::{control, coordinates, joint, list, velocities};
use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::algebra::residue_pair::Random;
use hamel_codegen::derive::regressor::{Regressor, regressor};
use hamel_codegen::generate::from_text;
use hamel_codegen::lower::build;
use hamel_codegen::model::Model;
use hamel_codegen::model::joints::Joint;
use hamel_codegen::model::layout::Block;
use hamel_codegen::program::count::count;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::proof::regressor::check_base_parameters;
use hamel_codegen::syntax::parse_text;
use hamel_codegen::urdf::{Options, import};
use serde_json::Value;
use std::path::Path;

/// Lengths and a mount angle that are run-time parameters, a ball joint, a body on a separate frame, and a massless
/// link before the last one.
const ARM: &str = "system Arm {
    param l = 0.4, tilt = 0.3, g = 9.81;
    joint q1: revolute [0, 1, 0] moves upper { stiffness 3; rest 0.1; armature 0.02; }
    joint q2: revolute [1, 2, 2] on upper at pose(rotz(tilt) * rotx(pi/4), [0, 0, l]) moves fore { damping 0.1; }
    joint q3: spherical on fore at translation([0.1, l, 0.2]) moves hand;
    joint q4: prismatic [0, 3, 4] on hand moves slide;
    joint q5: continuous [0, 0, 1] on slide at pose(roty(pi/6), [0.2, 0, 0]) moves last;
    frame tool on last = pose(rotx(0.7), [0.1, 0, 0.05]);
    body on upper { mass 2; com [0, 0, 0.2]; inertia diag(0.03, 0.03, 0.004) about com; }
    body on fore { mass 1; com [0.2, 0, 0]; inertia diag(0.002, 0.02, 0.02) about com; }
    body on hand { mass 1.5; com [0.1, 0.02, 0]; inertia diag(0.01, 0.02, 0.02) about com; }
    body on tool { mass 0.7; com [0.2, 0.1, 0]; inertia diag(0.002, 0.02, 0.02) about com; }
    gravity [0, 0, -g];
";

/// An upright axis: the first link can only turn, and its drive turns with it.
const UPRIGHT: &str = "system Upright {
    param l = 0.3;
    joint a: revolute [0, 0, 1] moves f { armature 0.02; damping 0.1; }
    joint b: revolute [0, 0, 1] on f at translation([l, 0, 0]) moves g;
    body on f { mass 2; com [0.1, 0, 0]; inertia diag(0.03, 0.03, 0.04) about com; }
    body on g { mass 1; com [0.2, 0.1, 0]; inertia diag(0.02, 0.03, 0.04) about com; }
    gravity [0, 0, -9.81];
";

/// A hand at an angle that is not a simple fraction of a turn, with two fingers moved against each other by one drive.
const HAND: &str = "system Hand {
    joint q1: revolute [0, 1, 0] moves upper { damping 0.1; };
    joint q2: revolute [1, 0, 0] on upper at translation([0, 0, 0.3]) moves fore;
    frame hand on fore = pose(rotz(-0.7853981633974483), [0, 0, 0.107]);
    joint left: prismatic [0, 1, 0] on hand at translation([0, 0, 0.0584]) moves one;
    joint right: prismatic [0, -1, 0] on hand at translation([0, 0, 0.0584]) moves two follows left;
    body on upper { mass 2; com [0.1, 0, 0.2]; inertia diag(0.03, 0.03, 0.04) about com; }
    body on fore { mass 1; com [0.2, 0.1, 0]; inertia diag(0.02, 0.03, 0.04) about com; }
    body on one { mass 0.1; com [0.01, 0.02, 0.03]; inertia diag(0.002, 0.003, 0.004) about com; }
    body on two { mass 0.2; com [0.02, 0.01, 0.05]; inertia diag(0.003, 0.003, 0.004) about com; }
    gravity [0, 0, -9.81];
";

fn found(text: &str) -> Regressor {
    let model = build(&parse_text(text).expect("a text")).expect("a model");
    let found = regressor(&model).expect("base parameters");
    check_base_parameters(&model, &found).expect("a proof");
    found
}

fn numbers(model: &Model, x: &[f64], xi: &[f64], xi_dot: &[f64]) -> Vec<f64> {
    let u = vec![0.0; model.u.len()];
    model.numbers(&model.defaults, x, xi, &u, xi_dot)
}

/// A random number in ±1.
fn number(random: &mut Random) -> f64 {
    random.bits() as f64 / u64::MAX as f64 * 2.0 - 1.0
}

fn many(random: &mut Random, count: usize) -> Vec<f64> {
    (0..count).map(|_| number(random)).collect()
}

/// Random coordinates of a model.
fn anywhere(model: &Model, random: &mut Random) -> Vec<f64> {
    let mut x = Vec::new();
    for block in &model.blocks {
        match block {
            Block::Flat(n) => x.extend(many(random, *n)),
            Block::Circle => {
                let (sin, cos) = number(random).sin_cos();
                x.extend([cos, sin]);
            }
            Block::Quaternion | Block::Rotation => {
                let q = many(random, 4);
                let norm = q.iter().map(|a| a * a).sum::<f64>().sqrt();
                let [w, a, b, c] = std::array::from_fn(|k| q[k] / norm);
                match block {
                    Block::Quaternion => x.extend([w, a, b, c]),
                    _ => x.extend(hamel_codegen::model::layout::rotation([w, a, b, c], 2.0)),
                }
            }
        }
    }
    x
}

/// β for the values of the description.
fn beta(found: &Regressor, numbers: &[f64]) -> Vec<f64> {
    let graph = &found.model.graph;
    let values: Vec<Edge> = found.standard.iter().map(|one| one.value).collect();
    let values = evaluate(graph, &values, numbers);
    let of = |base: &hamel_codegen::derive::regressor::BaseParameter| {
        let terms = base.terms.iter();
        terms
            .map(|&(k, factor)| evaluate(graph, &[factor], numbers)[0] * values[k])
            .sum()
    };
    found.base.iter().map(of).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

/// Asserts that Y β is the force of inverse dynamics and dampers, to rounding.
fn is_force(description: &str, count: usize) {
    let text = format!("{description} generate inverse_dynamics, dissipation, regressor; }}");
    let plain = found(&text);
    assert_eq!(plain.base.len(), count, "{}", plain.model.name);
    let generated = from_text(&text).expect("a program");
    let defaults = &generated.model.defaults;
    let function = |name: &str| {
        let function = generated.program.function(name).expect("a function");
        Interpreter::new(&generated.program, function, defaults)
    };
    let (inverse, dissipation) = (function("inverse_dynamics"), function("dissipation"));
    let (emitted, emitted_beta) = (function("regressor"), function("base_parameters"));
    let random = &mut Random::new(7);
    let model = &plain.model;
    for _ in 0..5 {
        let x = anywhere(model, random);
        let (xi, xi_dot) = (many(random, model.n()), many(random, model.n()));
        let numbers = numbers(model, &x, &xi, &xi_dot);
        let beta = beta(&plain, &numbers);
        let mut force = inverse.call(&x, &xi, &[], &xi_dot).expect("a force");
        // D is quadratic: its derivative is D(ξ + e) − D(ξ) − D(e), and 2 D(e) at ξ = 0.
        let d = |xi: &[f64]| dissipation.call(&x, xi, &[], &[]).expect("D")[0];
        for (i, force) in force.iter_mut().enumerate() {
            let mut unit = vec![0.0; xi.len()];
            unit[i] = 1.0;
            let moved: Vec<f64> = xi.iter().zip(&unit).map(|(a, b)| a + b).collect();
            *force += d(&moved) - d(&xi) - d(&unit);
        }
        let mut sum = vec![0.0; force.len()];
        for (base, beta) in plain.base.iter().zip(&beta) {
            let column = evaluate(&model.graph, &base.column, &numbers);
            sum.iter_mut()
                .zip(column)
                .for_each(|(sum, entry)| *sum += entry * beta);
        }
        // The emitted functions.
        let rows = emitted.call(&x, &xi, &[], &xi_dot).expect("Y");
        let beta = emitted_beta.call(&[], &[], &[], &[]).expect("β");
        let product = rows.chunks(count).map(|row| {
            let terms = row.iter().zip(&beta).map(|(y, beta)| y * beta);
            terms.sum::<f64>()
        });
        for sum in [sum, product.collect()] {
            let difference: Vec<f64> = sum.iter().zip(&force).map(|(a, b)| a - b).collect();
            let error = largest(&difference) / largest(&force);
            assert!(error < 1e-12, "{}: {error:.1e}", model.name);
        }
    }
}

#[test]
fn y_beta_is_the_force_that_a_motion_needs() {
    // 3 + 7 + 9, and 7 for the last link with its mass and the part of its first moment along its axis, for which a
    // mass on the slider could stand; a spring and a damper. The drive of the first joint acts like Θ_yy.
    is_force(ARM, 30);
    // Both turn about upright axes: Θ_zz of each, h of the second, and the damper.
    is_force(UPRIGHT, 5);
    // 3 + 7; for the fingers, which move against each other, differences of h, and both masses; the damper.
    is_force(HAND, 16);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models");
    for (name, count) in [("free_body", 10), ("two_bodies", 18), ("planar_body", 4)] {
        let text = std::fs::read_to_string(root.join(format!("{name}.eom"))).expect("a model");
        let end = text.rfind('}').expect("a description");
        is_force(&text[..end], count);
    }
}

/// Lengths that are parameters appear in the factors; numbers are exact.
#[test]
fn factors_are_exact() {
    let output = hamel(&["regressor", "-"], &format!("{UPRIGHT} }}"));
    let said = text(&output.stdout);
    for row in [
        "beta[1] = f.Theta_zz + l^2*g.m + a_dot.armature",
        "beta[2] = g.Theta_zz",
        "beta[3] = g.h_x",
        "beta[4] = g.h_y",
        "beta[5] = a_dot.damping",
    ] {
        assert!(said.contains(row), "{row} is not in\n{said}");
    }
    assert!(said.contains("Without effect: f.Theta_xx"), "{said}");
    for (format, wanted) in [
        (
            "latex",
            r"\Theta_{zz}^{\text{f}} + l^{2}\,m^{\text{g}} + J^{\text{a\_dot}}",
        ),
        (
            "markdown",
            "| β1 | `f.Theta_zz + l^2*g.m + a_dot.armature` |",
        ),
        ("json", "\"kept\": \"f.Theta_zz\""),
    ] {
        let output = hamel(
            &["regressor", "-", "--format", format],
            &format!("{UPRIGHT} }}"),
        );
        let said = text(&output.stdout);
        assert!(said.contains(wanted), "{wanted} is not in\n{said}");
    }
}

/// Axes given by arbitrary numbers: three hinges in a chain have 3 + 7 + 7 base parameters if the first one is not
/// upright (Mayeda, Yoshida and Osuka 1990). A tilt of 1e-7 leads to no factors of 1e14, with which f = Y β would lose
/// all digits.
#[test]
fn axes_of_many_digits_are_as_good_as_others() {
    let body = "mass 1; com [0.1, -0.2, 0.3]; inertia [[1.1, 0.1, 0.2], [0.1, 1.2, 0.3], [0.2, 0.3, 1]] about com;";
    for axes in [
        [
            "[0.361147, -0.482309, 0.798101]",
            "[sqrt(2), 1.41421, -0.333333]",
            "[0.577350, 0.577351, 0.577349]",
        ],
        ["[1, 2e-7, 1e-7]", "[0, 1e-7, 1]", "[1e-7, 1, -1e-7]"],
        ["[0.001, 0.001, 1]", "[1, 1e-4, 0]", "[1e-5, 0, 1]"],
    ] {
        let [a, b, c] = axes;
        is_force(
            &format!(
                "system Arm {{
                    gravity [0, 0, -9.81];
                    joint a: revolute {a} at pose(roty(pi / 4), [0, 0, 0]) moves f;
                    joint b: revolute {b} on f at pose(rpy(0.1234, 0.5, -1.2345), [0.17, 0.23, -0.41]) moves g;
                    joint c: revolute {c} on g at pose(rotx(0.7), [0.3, 0.1, 0.2]) moves h;
                    body on f {{ {body} }}
                    body on g {{ {body} }}
                    body on h {{ {body} }}"
            ),
            17,
        );
    }
}

/// Sliders on a link that turns about a fixed axis: no force depends on a first moment along that axis, for any
/// mounting.
#[test]
fn sliders_may_be_mounted_in_any_way() {
    let body = "mass 1; com [0.1, -0.2, 0.3]; inertia [[1.1, 0.1, 0.2], [0.1, 1.2, 0.3], [0.2, 0.3, 1]] about com;";
    is_force(
        &format!(
            "system Sliders {{
                gravity [0.3, -1.1, -9.81];
                joint a: revolute [1, 1, 0] at pose(roty(-pi / 2), [0, -0.01, 0]) moves f;
                joint b: prismatic [0, 0, 1] on f at pose(rpy(-1.217, 0.4, 1.1), [0, 0, 0.38]) moves g;
                joint c: prismatic [-0.697, -0.2, 0.949] on g at pose(roty(pi / 6), [0.1, 0, 0]) moves h;
                body on f {{ {body} }}
                body on g {{ {body} }}
                body on h {{ {body} }}"
        ),
        9,
    );
}

/// A body with an impossible centre of mass, and systems that are not trees of bodies.
#[test]
fn what_has_no_regressor_says_why() {
    let slim = UPRIGHT.replacen("diag(0.03, 0.03, 0.04)", "diag(0.01, 0.01, 0.04)", 1);
    let output = hamel(&["regressor", "-"], &format!("{slim} }}"));
    let said = text(&output.stdout);
    assert!(
        said.contains("the values of the description are not, for f"),
        "{said}"
    );
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models");
    for (name, why) in [
        ("torque_curve", "it has no bodies"),
        ("four_bar_loop", "constraints act on its velocities"),
        ("rolling_disk", "constraints act on its velocities"),
        ("kapitza", "depends on the time"),
        ("pendulum", "its coordinates are tied by constraints"),
        (
            "cart_pole",
            "describe it by `body` statements, without `kinetic` and `particle`",
        ),
    ] {
        let file = root.join(format!("{name}.eom"));
        let output = hamel(&["regressor", &file.display().to_string()], "");
        assert_eq!(output.status.code(), Some(1), "{name}");
        let said = text(&output.stderr);
        assert!(
            said.contains("has no regressor") && said.contains(why),
            "{name}: {said}"
        );
    }
}

/// The number of inertial base parameters equals the number of nonzero singular values of Pinocchio's regressor; for
/// `so100`, whose file has right angles with six digits, both as written and corrected. Y costs no more than its limit.
#[test]
fn real_robots_have_as_many_as_their_regressors_rank() {
    let Some(folder) = installed() else {
        eprintln!("not tested: the URDF files are absent; tests/robots/install.sh installs them");
        return;
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/reference/robots");
    let panda = ["panda_finger_joint1=0", "panda_finger_joint2=0"]
        .map(|joint| ["--lock", joint])
        .concat();
    for (name, options, count, most) in [
        ("a1", &[][..], 94, 1594),
        ("double_pendulum", &[], 6, 26),
        ("finger_edu", &[], 17, 113),
        ("iris", &[], 10, 36),
        ("panda", &panda, 43, 968),
        ("so100", &["--rounding", "0"], 38, 664),
        ("so100", &["--rounding", "1e-4"], 36, 664),
        ("solo12", &[], 94, 1594),
        ("ur5", &[], 36, 502),
        ("z1", &[], 43, 727),
    ] {
        // The Panda has no reference; seven joints in a chain have 1 + 6 · 7.
        let json = std::fs::read_to_string(root.join(format!("{name}.json")));
        let reference: Value = json.map_or(Value::Null, |json| {
            serde_json::from_str(&json).expect("JSON")
        });
        let urdf = reference["urdf"].as_str();
        let urdf = folder.join(urdf.unwrap_or("panda_description/urdf/panda.urdf"));
        let urdf = urdf.display().to_string();
        let mut arguments = vec!["regressor", &urdf, "--format", "json"];
        if reference["floating_base"] == true {
            arguments.push("--floating");
        }
        arguments.extend(options);
        let output = hamel(&arguments, "");
        assert!(output.status.success(), "{name}: {}", text(&output.stderr));
        let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(value["inertial"], count, "{name}");
        let operations = value["operations"].as_u64().expect("a count");
        assert!(operations <= most, "{name}: {operations} operations");
    }
}

/// The ten columns of each link in the frame of its joint, against Pinocchio's.
#[test]
fn columns_agree_with_pinocchio() {
    let Some(folder) = installed() else {
        eprintln!("not tested: the URDF files are absent; tests/robots/install.sh installs them");
        return;
    };
    for robot in control() {
        agrees(&folder, &robot);
    }
}

fn agrees(folder: &Path, reference: &Value) {
    let name = reference["robot"].as_str().expect("a name");
    let urdf = folder.join(reference["urdf"].as_str().expect("a path"));
    let urdf = std::fs::read_to_string(urdf).expect("a URDF");
    let options = Options {
        floating: reference["floating_base"] == true,
        ..Options::default()
    };
    let imported = import(&urdf, &options).expect("a robot");
    let found = found(&imported.text());
    let model = &found.model;
    let joints = &imported.joints;
    let (mut worst, mut size) = (0.0_f64, 0.0_f64);
    for sample in reference["samples"].as_array().expect("samples") {
        let x = coordinates(model, sample, joints);
        let xi = velocities(model, sample, joints);
        let xi_dot = list(&sample["regressor"]["acceleration"]);
        let numbers = numbers(model, &x, &xi, &xi_dot);
        let rows = sample["regressor"]["matrix"].as_array().expect("rows");
        let order: Vec<&str> = reference["velocity_order"]
            .as_array()
            .expect("names")
            .iter()
            .map(|name| name.as_str().expect("a name"))
            .collect();
        let ours: Vec<String> = model
            .velocities
            .iter()
            .flat_map(|group| vec![joint(joints, &group.name); group.len])
            .collect();
        assert_eq!(ours, order, "{name}");
        for (body, one) in reference["bodies"]
            .as_array()
            .expect("bodies")
            .iter()
            .enumerate()
        {
            let moved = |of: &&Joint| one["joint"] == joint(joints, &of.name).as_str();
            let frame = &model.joints.iter().find(moved).expect("a joint").frame;
            let own: Vec<usize> = (0..found.standard.len())
                .filter(|&k| found.standard[k].of == *frame)
                .collect();
            assert_eq!(own.len(), 10, "{name}: {frame}");
            // Θ, h, m here are m, h, Θ there, with yy before xz.
            let theirs = [4, 5, 7, 6, 8, 9, 1, 2, 3, 0];
            for (&k, place) in own.iter().zip(theirs) {
                let column = evaluate(&model.graph, &found.columns[k], &numbers);
                for (row, entry) in rows.iter().zip(column) {
                    let wanted = row[10 * body + place].as_f64().expect("a number");
                    worst = worst.max((entry - wanted).abs());
                    size = size.max(wanted.abs());
                }
            }
        }
    }
    let kept: Vec<Edge> = found
        .base
        .iter()
        .flat_map(|base| base.column.clone())
        .collect();
    println!(
        "{name}: columns differ by {:.1e}; {} operations for those of {} base parameters",
        worst / size,
        count(&model.graph, &kept).flops(),
        found.base.len()
    );
    assert!(worst <= 1e-9 * size, "{name}: {:.1e}", worst / size);
}
