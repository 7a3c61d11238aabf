//! Every error has a place, a message and a help.

use hamel_import::{Options, import};

const BODY: &str = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";

/// Returns a robot of two links with a joint and an inertial element.
fn pendulum(joint: &str, inertial: &str) -> String {
    format!(
        "<robot name='r'>\n<link name='a'/>\n<link name='b'>{inertial}</link>\n{joint}\n</robot>"
    )
}

fn hinge(inside: &str) -> String {
    format!("<joint name='j' type='revolute'><parent link='a'/><child link='b'/>{inside}</joint>")
}

/// Returns the messages, one per line.
fn messages(text: &str, options: &Options) -> String {
    match import(text, options) {
        Ok(imported) => panic!("nothing is wrong: {}", imported.text()),
        Err(problems) => {
            let lines: Vec<String> = problems.iter().map(ToString::to_string).collect();
            lines.join("\n")
        }
    }
}

#[test]
fn wrong_files() {
    let cases = [
        ("no XML", "robot".to_string()),
        ("not closed", "<robot name='r'>\n  <link name='a'>\n</robot>".into()),
        ("cut off", format!("{}\n", pendulum(&hinge(""), BODY).replace("</robot>", ""))),
        ("cut off in a name", "<robot name='r'>\n  <link name='é".into()),
        ("a comment alone", "<!-- nothing -->\n".into()),
        ("no URDF", "<mujoco model='m'/>".into()),
        ("xacro", "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>\n<xacro:arm/></robot>".into()),
        ("xacro without its namespace", "<robot name='r'>\n<xacro:arm/></robot>".into()),
        ("property of xacro", pendulum(&hinge("<origin xyz='0 0 ${l}'/>"), BODY)),
        ("a blank line before the declaration", "\n<?xml version='1.0'?>\n<robot name='r'/>".into()),
        ("undeclared prefix", "<robot name='r'>\n<gazebo><sensor:ray name='x'/></gazebo></robot>".into()),
        ("undeclared prefix of Drake", "<robot name='r'>\n<drake:joint name='x'/></robot>".into()),
        ("ampersand", "<robot name='a & b'/>".into()),
        ("tiny numbers", pendulum(&hinge("<origin xyz='0 1e-400 1.6e-314'/>"), BODY)),
        ("huge numbers", pendulum(&hinge("<origin xyz='0 1e400 -1e301'/>"), BODY)),
        ("infinite", pendulum(&hinge("<origin xyz='0 inf 0'/>"), BODY)),
        ("three parts of a quaternion", pendulum(&hinge("<origin quat_xyzw='0 0 1'/>"), BODY)),
        ("quaternion zero", pendulum(&hinge("<origin quat_xyzw='0 0 0 0'/>"), BODY)),
        ("quaternion and angles", pendulum(&hinge("<origin quat_xyzw='0 0 0 1' rpy='0 0 0'/>"), BODY)),
        ("no name", "<robot><link name='a'/></robot>".into()),
        ("no links", "<robot name='r'/>".into()),
        ("unknown link", pendulum(&hinge("").replace("'a'", "'aa'"), BODY)),
        ("two links of one name", pendulum("", BODY).replace("'b'", "'a'")),
        ("two roots", pendulum("", BODY)),
        ("moved twice", pendulum(&format!("{}\n{}", hinge(""), hinge("").replace("'j'", "'k'")), BODY)),
        ("cycle", pendulum(&format!("{}\n<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint>", hinge("")), BODY)),
        ("cycle beside the tree", "<robot name='r'><link name='o'/><link name='a'/><link name='b'/>\n<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>\n<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>".into()),
        ("two roots beside two cycles", "<robot name='r'><link name='o'/><link name='p'/><link name='a'/><link name='b'/><link name='c'/><link name='d'/>\n<joint name='l' type='fixed'><parent link='b'/><child link='d'/></joint>\n<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>\n<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint>\n<joint name='m' type='fixed'><parent link='c'/><child link='c'/></joint></robot>".into()),
        ("unknown link beside a cycle", "<robot name='r'><link name='o'/><link name='a'/><link name='b'/><link name='c'/>\n<joint name='i' type='fixed'><parent link='oo'/><child link='c'/></joint>\n<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>\n<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>".into()),
        ("unknown type", pendulum(&hinge("").replace("revolute", "screw"), BODY)),
        ("unknown type, axis, pose and link", pendulum(&hinge("<origin xyz='0 0'/><axis xyz='0 0 0'/>").replace("revolute", "screw").replace("'b'", "'bb'"), BODY)),
        ("no parent", pendulum("<joint name='j' type='fixed'><child link='b'/></joint>", BODY)),
        ("zero axis", pendulum(&hinge("<axis xyz='0 0 0'/>"), BODY)),
        ("two numbers", pendulum(&hinge("<axis xyz='0 1'/>"), BODY)),
        ("no number", pendulum(&hinge("<origin xyz='0 0 nan' rpy='0 x 0'/>"), BODY)),
        ("negative damping", pendulum(&hinge("<dynamics damping='-1'/>"), BODY)),
        ("two axes", pendulum(&hinge("<axis xyz='1 0 0'/><axis xyz='0 1 0'/>"), BODY)),
        ("no mass", pendulum(&hinge(""), &BODY.replace("<mass value='1'/>", ""))),
        ("no inertia", pendulum(&hinge(""), "<inertial><mass value='1'/></inertial>")),
        ("incomplete inertia", pendulum(&hinge(""), &BODY.replace("iyz='0' ", ""))),
        ("negative mass", pendulum(&hinge(""), &BODY.replace("value='1'", "value='-1'"))),
        ("nothing that moves", pendulum(&hinge("").replace("revolute", "fixed"), BODY)),
        ("mimic of nothing", pendulum(&hinge("<mimic joint='k'/>"), BODY)),
        ("mimic of itself", pendulum(&hinge("<mimic joint='j'/>"), BODY)),
        ("several at once", pendulum(&hinge("<axis xyz='0 0 0'/>"), &BODY.replace("izz='1'", "izz='?'"))),
    ];
    let report: Vec<String> = cases
        .iter()
        .map(|(name, text)| format!("{name}\n{}", messages(text, &Options::default())))
        .collect();
    insta::assert_snapshot!(report.join("\n\n"));
}

#[test]
fn wrong_options() {
    let robot = pendulum(
        &format!(
            "{}\n<joint name='k' type='fixed'><parent link='b'/><child link='c'/></joint>\n<link name='c'/>",
            hinge("")
        ),
        BODY,
    );
    let locks = |list: &[(&str, &str)]| Options {
        locks: list
            .iter()
            .map(|(a, b)| (a.to_string(), b.to_string()))
            .collect(),
        ..Options::default()
    };
    let cases = [
        locks(&[("elbow", "0")]),
        locks(&[("j", "pi")]),
        locks(&[("j", "0"), ("j", "1")]),
        locks(&[("k", "0")]),
    ];
    let report: Vec<String> = cases
        .iter()
        .map(|options| messages(&robot, options))
        .collect();
    insta::assert_snapshot!(report.join("\n"));
}

/// Inertias that no body can have are kept, with a warning.
#[test]
fn inertias_of_no_body() {
    let warnings = |inertial: &str| {
        let text = pendulum(&hinge(""), inertial);
        let imported = import(&text, &Options::default()).expect("legal");
        let lines: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
        lines.join("\n")
    };
    let report = [
        warnings(&BODY.replace("ixy='0'", "ixy='2'")),
        warnings(&BODY.replace("izz='1'", "izz='2.5'")),
        warnings(&BODY.replace("value='1'", "value='0'")),
        warnings(
            &BODY
                .replace("='1'", "='0'")
                .replace("value='0'", "value='1'"),
        ),
    ];
    insta::assert_snapshot!(report.join("\n"));
    // A thin rod is the limit of possible inertias.
    assert_eq!(warnings(&BODY.replace("izz='1'", "izz='0'")), "");
}

/// Warnings for legal robots that are probably wrong: misspelt names, other units, forgotten links.
#[test]
fn robots_that_look_wrong() {
    let origin = |inside: &str| pendulum(&hinge(&format!("<origin {inside}/>")), BODY);
    let two = format!(
        "{}\n<link name='c'>{BODY}</link>\n<joint name='k' type='prismatic'><parent link='b'/><child link='c'/></joint>",
        hinge("")
    );
    let cases = [
        ("misspelt attribute", origin("xzy='0 0 1'")),
        (
            "misspelt element",
            pendulum(&hinge("<orgin xyz='0 0 1'/>"), BODY),
        ),
        ("misspelt inertial", pendulum(&two, "<Inertial/>")),
        (
            "misspelt joint",
            pendulum(&format!("{}\n<joints/>", hinge("")), BODY),
        ),
        (
            "unknown properties",
            pendulum(
                &two.replace("<child", "<dynamics damping='1' viscous='2'/><child"),
                BODY,
            ),
        ),
        ("a link without inertia", pendulum(&two, "")),
        (
            "a last link without mass",
            pendulum(&two.replace(BODY, ""), BODY),
        ),
        ("degrees", origin("rpy='90 0 0'")),
        ("millimetres", origin("xyz='0 0 350'")),
        (
            "inertia in kg mm²",
            pendulum(
                &hinge(""),
                &BODY
                    .replace("='1'", "='2000'")
                    .replace("value='2000'", "value='1'"),
            ),
        ),
    ];
    let bare = [
        ("nothing with mass", pendulum(&two.replace(BODY, ""), "")),
        (
            "nothing that moves has mass",
            pendulum(&hinge(""), "")
                .replace("<link name='a'/>", &format!("<link name='a'>{BODY}</link>")),
        ),
    ];
    let report = cases.iter().chain(&bare).map(|(name, text)| {
        let imported = import(text, &Options::default()).expect("legal");
        assert_eq!(
            imported.has_masses,
            imported.text().contains("body on"),
            "{name}"
        );
        let lines: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
        assert!(!lines.is_empty(), "{name}");
        format!("{name}\n{}", lines.join("\n"))
    });
    insta::assert_snapshot!(report.collect::<Vec<String>>().join("\n\n"));
    // Frames between two joints, and the world, need no mass.
    let fixed = two.replace("prismatic", "fixed");
    let imported = import(&pendulum(&fixed, ""), &Options::default()).expect("legal");
    assert_eq!(imported.warnings, []);
}

/// Limits are checked only for joints whose positions URDF limits.
#[test]
fn limits_of_joints_that_have_none() {
    let exchanged = pendulum(&hinge("<limit lower='0' upper='-1'/>"), BODY);
    for kind in ["continuous", "planar", "floating"] {
        let text = exchanged.replace("revolute", kind);
        import(&text, &Options::default()).expect("the limits say nothing");
    }
    let fixed = format!(
        "{}<link name='c'/>\n<joint name='k' type='fixed'><parent link='b'/><child link='c'/><limit lower='1' upper='0'/></joint>",
        hinge("")
    );
    import(&pendulum(&fixed, BODY), &Options::default()).expect("the limits say nothing");
    for kind in ["revolute", "prismatic"] {
        let text = exchanged.replace("revolute", kind);
        let imported =
            import(&text, &Options::default()).expect("limits do not enter the equations");
        let warnings: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
        assert!(
            warnings.iter().any(|w| w.contains("swap them")),
            "{warnings:?}"
        );
        assert!(
            !imported.text().contains("    limit "),
            "{}",
            imported.text()
        );
    }
}

/// Unreadable numbers outside of the equations are left out with a warning.
#[test]
fn bounds_and_names_may_be_wrong() {
    let bounds = "<limit lower='-inf' upper='Infinity' velocity='1e999' effort='?'/>";
    let imported = import(&pendulum(&hinge(bounds), BODY), &Options::default()).expect("legal");
    assert_eq!(imported.warnings.len(), 4, "{:?}", imported.warnings);
    assert!(
        imported.text().contains("force j_tau;\n    };"),
        "{}",
        imported.text()
    );
    for name in ["<robot>", "<robot name=''>", "<robot name=' '>"] {
        let text = pendulum(&hinge(""), BODY).replace("<robot name='r'>", name);
        assert!(import(&text, &Options::default()).is_err());
        let named = Options {
            name: Some("arm".into()),
            ..Options::default()
        };
        let imported = import(&text, &named).expect("it has another name");
        assert!(imported.text().contains("pub system Arm {"));
        let warnings: Vec<&str> = imported
            .warnings
            .iter()
            .map(|w| w.message.as_str())
            .collect();
        assert_eq!(warnings, ["the robot has no name"]);
    }
}

/// Truncated or damaged texts are refused or read, without a panic.
#[test]
fn damaged_files() {
    let text = include_str!("files/every_joint.urdf");
    for end in (0..text.len()).filter(|&end| text.is_char_boundary(end)) {
        assert!(import(&text[..end], &Options::default()).is_err() || end + 2 > text.len());
    }
    let mut seed: u64 = 0x9e37_79b9_7f4a_7c15;
    for _ in 0..500 {
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..3 {
            // An xorshift generator with a fixed seed, so that every run has the same damage.
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            let place = (seed % bytes.len() as u64) as usize;
            bytes[place] = b" \"<>/=0-.ea"[(seed >> 40) as usize % 11];
        }
        if let Ok(text) = String::from_utf8(bytes) {
            match import(&text, &Options::default()) {
                Ok(imported) => assert!(imported.text().ends_with("}\n")),
                Err(problems) => assert!(!problems.is_empty()),
            }
        }
    }
}
