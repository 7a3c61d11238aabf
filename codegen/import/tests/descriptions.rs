//! The description written for a robot, as people read it.

use hamel_import::{Idle, Imported, Mimic, Options, import, import_without};
use hamel_language::syntax::ast::ItemKind;
use hamel_language::syntax::{parse_text, print};
use std::collections::{BTreeMap, BTreeSet};

const EVERY_JOINT: &str = include_str!("files/every_joint.urdf");

fn imported(options: &Options) -> Imported {
    import(EVERY_JOINT, options).expect("a sound robot")
}

fn options() -> Options {
    Options {
        file: "every_joint.urdf".into(),
        ..Options::default()
    }
}

#[test]
fn every_joint_on_a_fixed_base() {
    let imported = imported(&options());
    insta::assert_snapshot!("fixed_base", imported.text());
    let warnings: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
    insta::assert_snapshot!("warnings", warnings.join("\n"));
}

#[test]
fn every_option() {
    let imported = imported(&Options {
        name: Some("gantry".into()),
        floating: true,
        locks: vec![
            ("arm".into(), "0.5".into()),
            ("slide".into(), ".1".into()),
            ("2nd joint".into(), "0".into()),
            ("finger_l_joint".into(), "0.04".into()),
        ],
        params: true,
        ..options()
    });
    insta::assert_snapshot!("every_option", imported.text());
}

#[test]
fn joints_that_mimic_may_be_free() {
    let free = imported(&Options {
        mimic: Mimic::Free,
        ..options()
    });
    let names: Vec<&str> = free.joints.iter().map(|(name, _)| name.as_str()).collect();
    assert!(names.contains(&"finger_r_joint"));
    assert!(
        free.text()
            .contains("// In the URDF it follows 0.5 * finger_l_joint - 0.01.")
    );
}

/// With a tolerance of zero, every digit is kept.
#[test]
fn a_tolerance_of_zero_changes_nothing() {
    let exact = imported(&Options {
        tolerance: 0.0,
        ..options()
    });
    assert!(exact.cleaned.is_empty(), "{:?}", exact.cleaned);
    assert!(
        exact
            .text()
            .contains("rpy(3.14159265359, -1.57079632679, 0)")
    );
    assert!(exact.text().contains("1e-20"));
}

/// Directions and inertias are compared with their largest entry only; lengths have an absolute tolerance.
#[test]
fn small_is_what_is_small_beside_the_largest() {
    let robot = |origin: &str, axis: &str, inertia: &str| {
        let entries =
            format!("ixx='{inertia}' ixy='0' ixz='0' iyy='{inertia}' iyz='0' izz='{inertia}'");
        let link = format!(
            "<link name='b'><inertial><mass value='1e-9'/><inertia {entries}/></inertial></link>"
        );
        let hinge = format!(
            "<joint name='j' type='revolute'><parent link='a'/><child link='b'/><origin xyz='{origin}'/><axis xyz='{axis}'/></joint>"
        );
        let text = format!("<robot name='r'><link name='a'/>{link}{hinge}</robot>");
        import(&text, &options()).expect("a sound robot")
    };
    let light = robot("0 0 1e-16", "1e-16 0 1e-26", "4e-16");
    assert!(light.warnings.is_empty(), "{:?}", light.warnings);
    assert_eq!(
        light.cleaned,
        ["1e-16 is read as 0 (line 1)", "1e-26 is read as 0 (line 1)"]
    );
    assert!(
        light.text().contains("diag(4e-16, 4e-16, 4e-16)"),
        "{}",
        light.text()
    );
    assert!(
        light
            .text()
            .contains("joint j: revolute [1e-16, 0, 0] moves b")
    );
}

/// Quaternions are equivalent to the corresponding angles.
#[test]
fn quaternions() {
    let angles = EVERY_JOINT.replace(
        "rpy=\"0 0 -1.57079632679\"",
        "rpy=\"0 0 -1.5707963267948966\"",
    );
    let quaternion = angles.replace("rpy=\"0 0 -1.5707963267948966\"", "quat_xyzw=\"0 0 2 -2\"");
    assert_ne!(angles, quaternion);
    let text = |urdf: &str| {
        let imported = import(urdf, &options()).expect("a sound robot");
        let text = imported.text();
        let lines = text.lines().filter(|line| !line.starts_with("//"));
        lines.map(str::to_string).collect::<Vec<String>>()
    };
    assert_eq!(text(&angles), text(&quaternion));
}

/// Names are quoted in comments, and cannot end the line.
#[test]
fn names_with_line_breaks_stay_in_comments() {
    let broken = EVERY_JOINT
        .replace("finger_l_joint", "x&#10;param injected = 1; //")
        .replace("base plate", "b&#13;&#10;param grounded = 1; //");
    assert_ne!(broken, EVERY_JOINT);
    let free = Options {
        mimic: Mimic::Free,
        ..options()
    };
    let text = import(&broken, &free).expect("a sound robot").text();
    for line in text.lines().filter(|line| line.contains(" = 1;")) {
        assert!(line.trim_start().starts_with("//"), "{line}");
    }
    assert!(
        text.contains("In the URDF it follows 0.5 * x param injected"),
        "{text}"
    );
    assert!(
        text.contains("// `b  param grounded = 1; //` is fixed in the world."),
        "{text}"
    );
}

/// Every link that is a frame, or is fixed to the world, is listed with its name in the description.
#[test]
fn links_are_known_by_both_names() {
    let fixed = imported(&options());
    let floating = imported(&Options {
        floating: true,
        ..options()
    });
    let base = fixed.ground.clone().expect("a base that stands");
    assert_eq!(floating.ground, None);
    assert_eq!(floating.links[0], base);
    assert_eq!(floating.links[1..], fixed.links);
    for (_, name) in &fixed.links {
        assert!(fixed.text().contains(&format!("moves {name}")), "{name}");
    }
    assert!(!fixed.text().contains(&format!("moves {}", base.1)));
}

/// The printed description reads back as the same statements.
#[test]
fn the_text_says_what_was_built() {
    let every_level = include_str!("files/every_level.urdf");
    for urdf in [EVERY_JOINT, every_level] {
        for (params, mimic) in [(false, Mimic::Follow), (true, Mimic::Free)] {
            let options = Options {
                params,
                mimic,
                ..options()
            };
            let imported = import(urdf, &options).expect("a sound robot");
            let text = imported.text();
            let mut read = parse_text(&text).expect("a description");
            read.starts_anywhere = true;
            assert_eq!(read, imported.system, "{text}");
        }
    }
}

/// Every statement has places of its own, which lead to the element that it is made from.
#[test]
fn statements_know_their_origin() {
    let Imported { system, .. } = imported(&options());
    let mut places = BTreeSet::new();
    for item in &system.items {
        let place = item.span.range().expect("a place");
        assert!(places.insert(place.start), "{item:?}");
        let origin = system.origins.source(item.span).range();
        let source = &EVERY_JOINT[origin.expect("an origin")];
        // A joint's name, as written, or the element of an inertia.
        match &item.kind {
            ItemKind::Body(_) => assert_eq!(source, "<inertial"),
            ItemKind::Joint(joint) if joint.name.name == "roll" => assert_eq!(source, "roll"),
            ItemKind::Gravity(_) => assert_eq!(source, "every-joint"),
            _ => {}
        }
    }
}

#[test]
fn the_same_file_gives_the_same_text() {
    assert_eq!(imported(&options()).text(), imported(&options()).text());
}

/// Equations of closing joints that are said to be idle are comments with the reason, and a closing joint without any has
/// no frames.
#[test]
fn idle_equations_are_comments() {
    let urdf = include_str!("files/every_level.urdf");
    let equations = |imported: &Imported| {
        let places = imported.equations.iter();
        let items = places.map(|&place| print::statement(&imported.system.items[place]));
        items.collect::<Vec<String>>()
    };
    let all = import(urdf, &options()).expect("a sound robot");
    let before = equations(&all);
    // A hinge has five, a ball three.
    assert_eq!(before.len(), 8, "{before:?}");
    assert!(before.iter().all(|equation| equation.starts_with("loop ")));
    assert!(!all.text().contains("Left out of"), "{}", all.text());
    let ball = (5..8).map(|place| (place, Idle::Holds));
    let idle: BTreeMap<usize, Idle> = ball.chain([(1, Idle::Follows)]).collect();
    let fewer = import_without(urdf, &options(), &idle).expect("a sound robot");
    let expected = [0, 2, 3, 4].map(|place| before[place].clone());
    assert_eq!(equations(&fewer), expected);
    let text = fewer.text();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines.contains(&"    // - along [0, 1, 0] of the world: `position(pin_1)[2] = position(pin_2)[2]` follows from the others"));
    assert!(lines.contains(
        &"    // Left out of `ball_constraint`, since it adds nothing for any position of the tree:"
    ));
    assert!(!text.contains("frame ball_constraint"));
}
