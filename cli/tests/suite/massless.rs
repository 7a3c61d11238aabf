//! Robots and descriptions without masses: kinematics from every front end, and errors for everything that needs
//! masses.

use crate::common::{hamel, text};
use hamel_cli::reports;
use hamel_codegen::algebra::residue_pair::Random;
use hamel_engine::{OpenOptions, Quiet, Session, WarningTexts};
use serde_json::Value;
use std::sync::Arc;

/// Two hinges, about z at 0.3 m and about y 0.2 m above, and a tool 0.5 m along x.
const ARM: &str = r#"<robot name="arm"><link name="base"/><link name="l1"/><link name="l2"/><link name="tool"/>
<joint name="a" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/><origin xyz="0 0 0.3"/></joint>
<joint name="b" type="revolute"><parent link="l1"/><child link="l2"/><axis xyz="0 1 0"/><origin xyz="0 0 0.2"/></joint>
<joint name="f" type="fixed"><parent link="l2"/><child link="tool"/><origin xyz="0.5 0 0"/></joint></robot>"#;

/// Rounding error of a few products of lengths near 1.
const ROUNDING: f64 = 1e-14;
/// Error of central differences with steps of 1e-5: a third derivative times 1e-10, and rounding of 1e-16 / 1e-5.
const DIFFERENCE: f64 = 1e-8;

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().expect("a number")],
    }
}

fn assert_close(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (a, b) in found.iter().zip(expected) {
        assert!(
            (a - b).abs() <= tolerance,
            "{what}: {found:?}, {expected:?}"
        );
    }
}

/// Number of warnings on standard error.
fn warnings(said: &str) -> usize {
    said.lines()
        .filter(|line| line.starts_with("warning"))
        .count()
}

#[test]
fn the_jacobian_of_an_arm_without_masses_is_that_of_its_closed_form() {
    let (a, b) = (0.4_f64, -0.7_f64);
    let state =
        format!(r#"{{"coord": {{"a": {a}, "b": {b}}}, "velocity": {{"a": 1.5, "b": -2}}}}"#);
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("massless_state.json");
    std::fs::write(&folder, state).expect("a file");
    let at = folder.display().to_string();
    let output = hamel(&["eval", "-", "--frame", "tool", "--at", &at], ARM);
    let said = text(&output.stderr);
    assert!(output.status.success() && warnings(&said) == 1, "{said}");
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let ((s1, c1), (s2, c2)) = (a.sin_cos(), b.sin_cos());
    let (r, h) = (0.5 * c2, 0.5 - 0.5 * s2);
    let tool = &value["kinematics"]["tool"];
    // The origin of the tool is (r cos a, r sin a, h), and its axes are those of Rz(a) Ry(b).
    let pose = [
        [c1 * c2, -s1, c1 * s2, r * c1],
        [s1 * c2, c1, s1 * s2, r * s1],
        [-s2, 0.0, c2, h],
    ];
    let jacobian = [
        [-r * s1, -0.5 * s2 * c1],
        [r * c1, -0.5 * s2 * s1],
        [0.0, -0.5 * c2],
        [0.0, -s1],
        [0.0, c1],
        [1.0, 0.0],
    ];
    assert_close("pose", &numbers(&tool["pose"]), &pose.concat(), ROUNDING);
    let found = numbers(&tool["jacobian"]);
    assert_close("Jacobian", &found, &jacobian.concat(), ROUNDING);
    let twist: Vec<f64> = jacobian
        .iter()
        .map(|[one, two]| 1.5 * one - 2.0 * two)
        .collect();
    assert_close("twist", &numbers(&tool["twist"]), &twist, ROUNDING);
    assert_close("A", &numbers(&value["A"]), &[1.0, 0.0, 0.0, 1.0], 0.0);
    for absent in ["M", "Gamma", "bias", "accel", "kinetic_energy"] {
        assert_eq!(value[absent], Value::Null, "{absent}");
    }
}

#[test]
fn every_command_gives_kinematics_with_one_warning() {
    let shown: [(&[&str], &str); 7] = [
        (&["import", "-"], "joint b: revolute"),
        (&["draw", "-"], "<svg"),
        (&["eval", "-", "--frame", "l2"], "\"jacobian\""),
        (&["tables", "-", "--of", "A"], "kinematic map"),
        (&["check", "-"], "Y A = I"),
        (&["ops", "-"], "rate"),
        (&["emit", "-"], "fn rate"),
    ];
    for (words, part) in shown {
        let output = hamel(words, ARM);
        let said = text(&output.stderr);
        assert!(output.status.success(), "{words:?}: {said}");
        assert_eq!(warnings(&said), 1, "{words:?}: {said}");
        assert!(said.contains("no moving link of the robot has mass"));
        let out = text(&output.stdout);
        assert!(out.contains(part), "{words:?}: {out}");
        assert!(
            !out.contains("mass_matrix") && !out.contains("fn accel"),
            "{out}"
        );
    }
}

/// Without equations of motion nothing is proved about them.
#[test]
fn check_says_nothing_of_equations_of_motion() {
    let out = text(&hamel(&["check", "-"], ARM).stdout);
    for absent in ["(20)", "(30", "M ", "mass", "method", "T "] {
        assert!(!out.contains(absent), "{absent}: {out}");
    }
}

#[test]
fn what_needs_masses_is_refused_by_its_name() {
    let refused: [(&[&str], &str); 6] = [
        (&["tables", "-", "--of", "A,M"], "`M`"),
        (&["simulate", "-", "--until", "1"], "`accel`"),
        (&["compare", "-", "--until", "1"], "`accel`"),
        (&["draw", "-", "--motion", "1"], "`accel`"),
        (&["linearize", "-"], "`linearize`"),
        (&["regressor", "-"], "no regressor"),
    ];
    for (words, name) in refused {
        let output = hamel(words, ARM);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{words:?}: {said}");
        let error = said.split("error").nth(1).expect("an error");
        assert!(error.contains(name), "{words:?}: {said}");
        let (inertia, bodies) = ("the system has no inertia", "it has no bodies");
        assert!(error.contains(inertia) || error.contains(bodies), "{said}");
    }
    let output = hamel(&["simulate", "-", "--until", "1"], ARM);
    let said = text(&output.stderr);
    assert!(said.contains("give the links an `<inertial>`"), "{said}");
}

/// The description that an import writes is treated like the robot; functions that it does not request are not missing.
#[test]
fn descriptions_without_masses_have_kinematics() {
    let imported = text(&hamel(&["import", "-"], ARM).stdout);
    let output = hamel(&["eval", "-", "--frame", "tool"], &imported);
    let said = text(&output.stderr);
    assert!(output.status.success() && warnings(&said) == 1, "{said}");
    let output = hamel(&["emit", "-"], &imported);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        said.contains("`accel`") && said.contains("generate rate"),
        "{said}"
    );
    // A bar that slides on a wall and on the floor, with a claim and no requested functions; a sled, whose blade is a
    // constraint without a constant factor.
    let loops = "system Bar { joint s: prismatic [1, 0, 0] moves f; joint h: revolute [0, 0, 1] on f moves g;
         joint v: prismatic [0, 1, 0] moves w; let tip = g.p + 2 * g.R * [1, 0, 0];
         loop tip[1] = 0, tip[2] = w.p[2]; start h = 2; GENERATE }";
    let sled = "system Sled { coord x, y, th; velocity u, v, w; rate x = u, y = v, th = w;
         nonholonomic sin(th) * u = cos(th) * v; frame g = pose(rotz(th), [x, y, 0]); GENERATE }";
    for described in [
        loops,
        sled,
        &imported.replace("gravity", "GENERATE gravity"),
    ] {
        let frame = if described.contains("l2") { "l2" } else { "g" };
        let asked = described.replace("GENERATE", &format!("generate rate, jacobian {frame};"));
        let output = hamel(&["emit", "-"], &asked);
        let said = text(&output.stderr);
        assert!(output.status.success() && said.is_empty(), "{said}");
        let code = text(&output.stdout);
        assert!(code.contains(&format!("fn {frame}_jacobian")), "{code}");
        for named in ["mass_matrix", "constraint_force", "momentum", "regressor"] {
            let more = asked.replace("generate rate", &format!("generate {named}, rate"));
            let output = hamel(&["emit", "-"], &more);
            let said = text(&output.stderr);
            assert_eq!(output.status.code(), Some(1), "{named}");
            let wanted = format!("the system has no inertia, which `{named}` needs");
            assert!(said.contains(&wanted), "{said}");
        }
        let claimed = described.replace("GENERATE", "invariant energy;");
        let output = hamel(&["check", "-"], &claimed);
        let said = text(&output.stderr);
        assert!(output.status.success(), "{said}");
        assert!(said.contains("no claim is proved: `energy`"), "{said}");
        assert!(!text(&output.stdout).contains("energy"));
    }
}

/// An armature is inertia: T = ½ J ȧ².
#[test]
fn armatures_alone_are_inertia() {
    let described = "system Drive { joint a: revolute [0, 0, 1] moves _f { armature 2; }; }";
    let output = hamel(&["eval", "-"], described);
    let said = text(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{said}");
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(numbers(&value["M"]), [2.0]);
}

fn number(random: &mut Random) -> f64 {
    (random.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// A tree of links with random joints.
fn robot(random: &mut Random, with_masses: bool) -> String {
    let count = 1 + random.bits() % 3;
    let mut text = "<robot name=\"r\">\n<link name=\"l0\"/>\n".to_string();
    for link in 1..=count {
        let parent = random.bits() % link;
        let kind = ["revolute", "prismatic", "continuous"][(random.bits() % 3) as usize];
        let [axis, place, turn, com] = [(); 4].map(|()| {
            let entries: Vec<String> = (0..3).map(|_| format!("{:.3}", number(random))).collect();
            entries.join(" ")
        });
        let limit = match kind {
            "continuous" => "",
            _ => "<limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"1\"/>",
        };
        let inertial = match with_masses {
            true => format!(
                "<inertial><origin xyz=\"{com}\"/><mass value=\"1.5\"/><inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\" iyz=\"0\" izz=\"0.1\"/></inertial>"
            ),
            false => String::new(),
        };
        text += &format!(
            "<link name=\"l{link}\">{inertial}</link>\n<joint name=\"j{link}\" type=\"{kind}\"><parent link=\"l{parent}\"/><child link=\"l{link}\"/><axis xyz=\"{axis}\"/><origin xyz=\"{place}\" rpy=\"{turn}\"/>{limit}</joint>\n"
        );
    }
    text + "</robot>"
}

/// A function at x and ξ.
fn value(session: &Session, name: &str, [x, xi]: [&[f64]; 2]) -> Vec<f64> {
    let function = session.function(name);
    let function = function.unwrap_or_else(|error| panic!("{error}"));
    let constants = function.constants(&[]).expect("constants");
    let mut out = vec![f64::NAN; function.shape.entries()];
    let u = vec![0.0; session.inputs().entries.len()];
    let called = function.call(&constants, [x, xi, &u, &[], &[]], &mut out);
    called.expect("a value");
    out
}

/// Robots have the same kinematics with masses and without; Jacobians are derivatives of poses.
#[test]
fn masses_take_no_part_in_kinematics() {
    let cases = match std::env::var("HAMEL_ATTACK").as_deref() {
        Ok("full") => 200,
        Ok(_) => 40,
        Err(_) => 4,
    };
    for seed in 0..cases {
        let mut random = Random::new(0x3a55 + seed);
        let mut again = Random::new(0x3a55 + seed);
        let floating = seed % 4 == 3;
        let [heavy, light] = [(true, &mut random), (false, &mut again)].map(|(masses, random)| {
            let options = OpenOptions {
                floating,
                ..OpenOptions::default()
            };
            let mut text = robot(random, masses);
            if floating && masses {
                let base = "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>";
                text = text.replace("\"l0\"/>\n", &format!("\"l0\">{base}</link>\n"));
            }
            let texts = Arc::new(WarningTexts::default());
            let read = Session::read(text, "r.urdf", &options, texts.clone());
            let session = read.unwrap_or_else(|error| panic!("{error}"));
            let said = texts.take();
            assert_eq!(warnings(&said), usize::from(!masses), "{seed}: {said}");
            session
        });
        let start = light.start();
        let joints = light
            .joints()
            .into_iter()
            .filter(|(_, _, count)| *count == 1);
        let coords: Vec<String> = joints
            .map(|(name, ..)| format!("\"{name}\": {}", number(&mut random)))
            .collect();
        let state = format!("{{\"coord\": {{{}}}}}", coords.join(", "));
        let state = light.state(&start.params, &state, "state.json");
        let x = state.unwrap_or_else(|error| panic!("{error}")).x;
        let xi: Vec<f64> = start.xi.iter().map(|_| number(&mut random)).collect();
        let names = light.functions();
        let last = light.frames().pop().expect("a link");
        let of_last = format!("{last}_");
        let kinematic = |name: &&String| name.starts_with(&of_last) || name.as_str() == "rate";
        let names: Vec<&String> = names.iter().filter(kinematic).collect();
        assert_eq!(names.len(), 8, "{names:?}");
        for name in &names {
            let (with, without) = (
                value(&heavy, name, [&x, &xi]),
                value(&light, name, [&x, &xi]),
            );
            assert_close(name, &without, &with, 100.0 * ROUNDING);
        }
        let tables = |session: &Session| {
            reports::tables(
                session,
                &["A".into(), "gamma".into()],
                hamel_cli::Format::Json,
                true,
            )
        };
        let [with, without] = [&heavy, &light].map(|session| tables(session).expect("tables"));
        assert_eq!(with, without, "{seed}");
        if floating || x.len() != xi.len() {
            continue;
        }
        // For joints with limits on a fixed base x is q, and ξ is its rate.
        let jacobian = value(&light, &format!("{last}_jacobian"), [&x, &xi]);
        let pose = |x: &[f64]| value(&light, &format!("{last}_pose"), [x, &xi]);
        for column in 0..x.len() {
            let [ahead, behind] = [1e-5, -1e-5].map(|step| {
                let mut x = x.clone();
                x[column] += step;
                pose(&x)
            });
            for row in 0..3 {
                let slope = (ahead[4 * row + 3] - behind[4 * row + 3]) / 2e-5;
                let entry = jacobian[row * x.len() + column];
                assert!(
                    (slope - entry).abs() < DIFFERENCE,
                    "{seed}: {slope}, {entry}"
                );
            }
        }
    }
}

/// A session reports missing masses like the commands.
#[test]
fn sessions_refuse_what_needs_masses() {
    let read = Session::read(
        ARM.into(),
        "arm.urdf",
        &OpenOptions::default(),
        Arc::new(Quiet),
    );
    let light = read.unwrap_or_else(|error| panic!("{error}"));
    let start = light.start();
    for refused in ["accel", "mass_matrix", "momentum", "linearize"] {
        let error = light.function(refused).expect_err("no masses").to_string();
        assert!(error.contains(&format!("`{refused}` need")), "{error}");
    }
    let linear = light.linearize(&start, false).map(drop);
    let error = linear.expect_err("no masses").to_string();
    assert!(error.contains("`linearize`"), "{error}");
    let stepped = light.single_stepper(&start, "auto").map(drop);
    let error = stepped.expect_err("no masses").to_string();
    assert!(error.contains("`accel`"), "{error}");
    let evaluated = light.evaluate(&start);
    let evaluated = evaluated.unwrap_or_else(|error| panic!("{error}"));
    assert!(evaluated.mass.is_none(), "{evaluated:?}");
}
