//! What is written for a robot, as it is read by people.

use hamel_urdf::{Imported, Mimic, Options, import};

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
    insta::assert_snapshot!("fixed_base", imported.text);
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
    insta::assert_snapshot!("every_option", imported.text);
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
        free.text
            .contains("// In the URDF it follows 0.5 * finger_l_joint - 0.01.")
    );
}

/// Every digit is kept where nothing is a rounding.
#[test]
fn a_tolerance_of_zero_changes_nothing() {
    let exact = imported(&Options {
        tolerance: 0.0,
        ..options()
    });
    assert!(exact.cleaned.is_empty(), "{:?}", exact.cleaned);
    assert!(exact.text.contains("rpy(3.14159265359, -1.57079632679, 0)"));
    assert!(exact.text.contains("1e-20"));
}

/// Every line that is made from an element knows where it stands.
#[test]
fn lines_know_their_origin() {
    let imported = imported(&options());
    assert_eq!(imported.text.lines().count(), imported.origins.len());
    for (line, origin) in imported.text.lines().zip(&imported.origins) {
        let Some(origin) = origin else { continue };
        let source = &EVERY_JOINT[origin.clone()];
        // A joint's name, as written, or the element of an inertia.
        if line.trim_start().starts_with("body ") {
            assert_eq!(source, "<inertial", "{line}");
        }
        if line.trim_start().starts_with("joint roll:") {
            assert_eq!(source, "roll");
        }
    }
}

#[test]
fn the_same_file_gives_the_same_text() {
    assert_eq!(imported(&options()).text, imported(&options()).text);
}
