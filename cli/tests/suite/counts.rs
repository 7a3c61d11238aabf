//! Operation counts of robots and of spatial chains, as `hamel ops` prints them: exact, and below
//! their limits.
//!
//! The robots are those of the wheel `example-robot-data`, which `tests/robots/install.sh` installs;
//! without them the test prints this and ends.

use crate::common::{hamel, text};
use crate::installed::installed;
use serde_json::Value;
use std::fmt::Write;

const FUNCTIONS: [&str; 4] = ["inverse_dynamics", "mass_matrix", "accel", "linearize"];

/// A robot with the largest numbers of operations of `FUNCTIONS`, and of divisions of `accel`.
struct Bars {
    name: &'static str,
    urdf: &'static str,
    options: &'static [&'static str],
    flops: [Option<u64>; 4],
    divisions: u64,
}

/// Multiplications, additions and divisions with the numbers of the URDF folded. The best of the other
/// generators measured needs 468, 286, 1,024 and 6,547 for UR5, 810, 1,049 and 1,826 for
/// Panda, 2,051, 1,133, 4,441 and 37,411 for Solo12 and 5,057 for the motion of ANYmal B.
const ROBOTS: [Bars; 4] = [
    Bars {
        name: "UR5",
        urdf: "ur_description/urdf/ur5_robot.urdf",
        options: &[],
        flops: [Some(270), Some(131), Some(465), Some(2264)],
        divisions: 6,
    },
    Bars {
        name: "Panda",
        urdf: "panda_description/urdf/panda.urdf",
        options: &[
            "--lock",
            "panda_finger_joint1=0",
            "--lock",
            "panda_finger_joint2=0",
        ],
        flops: [Some(576), Some(317), Some(1119), Some(5184)],
        divisions: 7,
    },
    Bars {
        name: "Solo12",
        urdf: "solo_description/robots/solo12.urdf",
        options: &["--floating"],
        flops: [Some(1108), Some(516), Some(2419), Some(14000)],
        divisions: 18,
    },
    Bars {
        name: "ANYmal B",
        urdf: "anymal_b_simple_description/robots/anymal.urdf",
        options: &["--floating"],
        flops: [None, None, Some(3400), None],
        divisions: 18,
    },
];

/// Numbers of links of the chains.
const LENGTHS: [usize; 5] = [2, 4, 8, 16, 32];
/// Largest number of operations that each link adds to the inverse dynamics and to the motion.
const GROWTH: [(&str, u64); 2] = [("inverse_dynamics", 195), ("accel", 470)];

/// The counts that `hamel ops` prints for every function.
fn counts(file: &str, options: &[&str], text_of: &str) -> Value {
    let mut arguments = vec!["ops", file, "--format", "json"];
    arguments.extend(options);
    let output = hamel(&arguments, text_of);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let mut all: Value = serde_json::from_str(&text(&output.stdout)).expect("JSON");
    all["functions"].take()
}

fn number(counts: &Value, function: &str, kind: &str) -> u64 {
    let count = &counts[function]["shared"][kind];
    count
        .as_u64()
        .unwrap_or_else(|| panic!("{function} has no {kind}"))
}

/// ξ = M⁻¹ p costs as much as ξ̇ without bias and gravity; p = M ξ is an outward and an inward recursion like inverse
/// dynamics, and ṗ two of them.
fn momenta_cost_no_more_than_motions(name: &str, counts: &Value) {
    let flops = |function: &str| number(counts, function, "flops");
    let inverse = flops("inverse_dynamics");
    for (function, most) in [
        ("velocity_from_momentum", flops("accel")),
        ("momentum_rate", inverse * 22 / 10),
        ("momentum", inverse),
    ] {
        let flops = flops(function);
        assert!(
            flops <= most,
            "{name}: {function} has {flops} operations, the bar is {most}"
        );
    }
}

fn row(counts: &Value, function: &str) -> String {
    let of = |kind: &str| number(counts, function, kind);
    format!(
        "{function:17}{:6} flops = {:5} mul {:5} add {:3} div, {} sincos\n",
        of("flops"),
        of("mul"),
        of("add"),
        of("div"),
        of("sincos")
    )
}

#[test]
fn robots_cost_no_more_than_their_bars() {
    let Some(folder) = installed() else {
        eprintln!(
            "the counts of robots are not tested: their URDF is absent; tests/robots/install.sh installs it"
        );
        return;
    };
    let mut table = String::new();
    for robot in ROBOTS {
        let path = folder.join(robot.urdf).display().to_string();
        let counts = counts(&path, robot.options, "");
        let _ = writeln!(table, "{}", robot.name);
        momenta_cost_no_more_than_motions(robot.name, &counts);
        for (function, bar) in FUNCTIONS.into_iter().zip(robot.flops) {
            let flops = number(&counts, function, "flops");
            assert!(
                bar.is_none_or(|bar| flops <= bar),
                "{}: {function} has {flops} operations, the bar is {bar:?}",
                robot.name
            );
            table += &row(&counts, function);
        }
        let divisions = number(&counts, "accel", "div");
        assert!(
            divisions <= robot.divisions,
            "{}: {divisions} divisions",
            robot.name
        );
        table.push('\n');
    }
    insta::assert_snapshot!(table);
}

/// A chain of hinges at random places with random axes, whose numbers are neither zero nor equal except by chance.
fn chain(links: usize) -> String {
    let mut seed = 0x5eed_u64;
    let mut number = |most: f64| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let share = 0.1 + 0.9 * (seed >> 33) as f64 / (1_u64 << 31) as f64;
        let sign = if seed >> 32 & 1 == 0 { 1.0 } else { -1.0 };
        (1000.0 * sign * share * most).round() / 1000.0
    };
    let mut text = String::from("system Chain {\n");
    for i in 1..=links {
        let on = match i {
            1 => String::new(),
            _ => format!("on f{} ", i - 1),
        };
        let [a, b, c] = [1.5; 3].map(&mut number);
        let [x, y, z] = [0.5; 3].map(&mut number);
        let [p, q, r] = [0.2; 3].map(&mut number);
        let [yz, xz, xy] = [0.02; 3].map(&mut number);
        let mass = 2.0 + number(1.0);
        let _ = writeln!(
            text,
            "joint q{i}: revolute [0, 0, 1] {on}at pose(rpy({a}, {b}, {c}), [{x}, {y}, {z}]) moves f{i};\n\
             body on f{i} {{ mass {mass}; com [{p}, {q}, {r}]; inertia [[0.21, {xy}, {xz}], [{xy}, 0.32, {yz}], [{xz}, {yz}, 0.27]] about com; }}"
        );
    }
    text + "gravity [0.5, -0.25, -9.81];\ngenerate inverse_dynamics, mass_matrix, accel;\n}\n"
}

/// Multibody systems of the literature, with all parameters set at run time.
#[test]
fn fixtures() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/models/multibody/");
    let mut table = String::new();
    for name in [
        "furuta",
        "double_spherical_pendulum",
        "quadrotor_load",
        "satellite_arm",
        "tricopter",
    ] {
        let counts = counts(&format!("{folder}{name}.eom"), &[], "");
        let _ = writeln!(table, "{name}");
        momenta_cost_no_more_than_motions(name, &counts);
        for function in FUNCTIONS {
            table += &row(&counts, function);
        }
        table.push('\n');
    }
    insta::assert_snapshot!(table);
}

/// Joints with two freedoms each, whose M is long when written out.
#[test]
fn a_chain_of_universal_joints() {
    let mut text = String::from("system Chain {\n");
    for i in 0..12 {
        let on = match i {
            0 => String::new(),
            _ => format!("on f{} at pose(identity(3), [0.3, 0, 0]) ", i - 1),
        };
        let _ = writeln!(
            text,
            "joint j{i}: universal [0, 0, 1], [0, 1, 0] {on}moves f{i};\n\
             body on f{i} {{ mass 1; com [0.1, 0.2, 0.05]; inertia diag(1, 2, 2.5) about com; }}"
        );
    }
    text += "gravity [0, 0, -9.81];\ngenerate all;\n}\n";
    momenta_cost_no_more_than_motions("chain", &counts("-", &[], &text));
}

/// A cart with n pendulums in a row, with point masses at the ends of rods.
fn cart(rods: usize) -> String {
    let mut text = String::from(
        "system Cart {\nparam g = 9.81, m0 = 2;\ninput u;\njoint cart: prismatic [1, 0, 0] moves f0 { force u; };\nbody on f0 { mass m0; }\n",
    );
    for i in 1..=rods {
        let (before, length) = (i - 1, 0.75 + 0.125 * i as f64);
        let place = match before {
            0 => "0".to_string(),
            _ => format!("-l{before}"),
        };
        let _ = writeln!(
            text,
            "param m{i} = 1, l{i} = {length};\n\
             joint q{i}: revolute [0, -1, 0] on f{before} at pose(identity(3), [0, 0, {place}]) moves f{i};\n\
             particle mass m{i} at [0, 0, -l{i}] on f{i};"
        );
    }
    text + "gravity [0, 0, -g];\ngenerate inverse_dynamics, mass_matrix, accel;\n}\n"
}

#[test]
fn carts_with_pendulums() {
    let mut table = String::new();
    for rods in 1..=10 {
        let counts = counts("-", &[], &cart(rods));
        let _ = writeln!(table, "{rods} rods");
        for function in &FUNCTIONS[..3] {
            table += &row(&counts, function);
        }
        table.push('\n');
    }
    insta::assert_snapshot!(table);
}

#[test]
fn chains_grow_by_the_link() {
    let mut table = String::new();
    let mut before: Option<(usize, Value)> = None;
    for links in LENGTHS {
        let counts = counts("-", &[], &chain(links));
        let _ = writeln!(table, "{links} links");
        for function in &FUNCTIONS[..3] {
            table += &row(&counts, function);
        }
        table.push('\n');
        for (function, most) in GROWTH {
            let now = number(&counts, function, "flops");
            assert!(now <= most * links as u64, "{function} of {links} links");
            if let Some((fewer, smaller)) = &before {
                let added = now - number(smaller, function, "flops");
                let bar = most * (links - fewer) as u64;
                assert!(added <= bar, "{function}: {added} from {fewer} to {links}");
            }
        }
        before = Some((links, counts));
    }
    insta::assert_snapshot!(table);
}
