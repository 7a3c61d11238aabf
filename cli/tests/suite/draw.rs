//! `hamel draw`: pictures are reproducible SVG whose parts are placed like those of the mechanism, within the picture.

use crate::common::text;
use std::path::Path;

fn model(name: &str) -> String {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models");
    models.join(name).display().to_string()
}

/// The picture that a command prints.
fn drawn(arguments: &[&str], input: &str) -> String {
    let output = crate::common::hamel(&[&["draw"], arguments].concat(), input);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {said}");
    text(&output.stdout)
}

fn refused(arguments: &[&str], input: &str) -> String {
    let output = crate::common::hamel(&[&["draw"], arguments].concat(), input);
    assert_ne!(output.status.code(), Some(0), "{arguments:?}");
    assert!(output.stdout.is_empty());
    text(&output.stderr)
}

/// Attributes of elements with this name, as numbers.
fn elements<const N: usize>(picture: &str, name: &str, attributes: [&str; N]) -> Vec<[f64; N]> {
    let document = roxmltree::Document::parse(picture).expect("well-formed XML");
    let found = document
        .descendants()
        .filter(|node| node.has_tag_name(name));
    found
        .filter(|node| node.has_attribute(attributes[0]))
        .map(|node| attributes.map(|name| node.attribute(name).expect(name).parse().expect(name)))
        .collect()
}

/// Asserts that every ellipse is within the view box, and counts the ellipses.
fn within(picture: &str) -> usize {
    let document = roxmltree::Document::parse(picture).expect("well-formed XML");
    let size = document
        .root_element()
        .attribute("viewBox")
        .expect("a view box");
    let size: Vec<f64> = size
        .split(' ')
        .map(|word| word.parse().expect("a number"))
        .collect();
    let ellipses = document
        .descendants()
        .filter(|node| node.has_tag_name("ellipse"));
    let mut count = 0;
    for ellipse in ellipses {
        let number = |name| {
            ellipse
                .attribute(name)
                .expect("it")
                .parse::<f64>()
                .expect("a number")
        };
        let turn = ellipse.attribute("transform").map_or(0.0, |turn| {
            let angle = turn.trim_start_matches("rotate(").split(' ').next();
            angle.expect("an angle").parse::<f64>().expect("a number")
        });
        let (s, c) = turn.to_radians().sin_cos();
        let (a, b) = (number("rx"), number("ry"));
        let (wide, high) = ((a * c).hypot(b * s), (a * s).hypot(b * c));
        for (middle, reach, size) in [("cx", wide, size[2]), ("cy", high, size[3])] {
            let place = number(middle);
            assert!(
                place - reach >= 0.0 && place + reach <= size,
                "{place} {reach} {size}"
            );
        }
        count += 1;
    }
    assert!(!picture.contains("NaN") && !picture.contains("inf"));
    count
}

#[test]
fn points_are_where_the_isometric_projection_has_them() {
    let particles = "pub system Points {
        coord q;
        velocity w;
        rate q = w;
        frame rail = pose(identity(3), [q, 0, 0]);
        particle mass 2 at rail.p;
        particle mass 1 at rail.p + [0.3, 0, 0];
        particle mass 1 at rail.p + [0, 0.3, 0];
        particle mass 1 at rail.p + [0, 0, 0.3];
    }";
    let picture = drawn(&["-"], particles);
    let balls = elements(&picture, "circle", ["cx", "cy", "r"]);
    // The heaviest one is at the origin; coordinates are tenths of a pixel.
    let heaviest = |ball: &&[f64; 3]| ball[2] == 70.0;
    let middle = balls.iter().find(heaviest).expect("the heaviest");
    let mut others: Vec<(f64, f64)> = balls
        .iter()
        .filter(|ball| !heaviest(ball))
        .map(|ball| (ball[0] - middle[0], ball[1] - middle[1]))
        .collect();
    others.sort_by(|a, b| a.1.total_cmp(&b.1));
    assert_eq!(others.len(), 3);
    // z points straight up, the other two to the right, one up and one down by half.
    let length = -others[0].1;
    assert!(others[0].0.abs() <= 1.0 && length > 100.0, "{others:?}");
    let side = length * 0.75_f64.sqrt();
    for (x, y) in &others[1..] {
        assert!(
            (x - side).abs() <= 2.0 && (y.abs() - length / 2.0).abs() <= 2.0,
            "{others:?}"
        );
    }
}

#[test]
fn pictures_are_well_formed_and_the_same_every_time() {
    for name in [
        "free_body.eom",
        "bricard.eom",
        "ship_arm_joints.eom",
        "bicycle.eom",
    ] {
        let file = model(name);
        let picture = drawn(&[&file, "--view", "-70,20"], "");
        assert_eq!(picture, drawn(&[&file, "--view", "-70,20"], ""), "{name}");
        assert!(within(&picture) > 0, "{name}");
        assert!(picture.contains("prefers-color-scheme:dark"), "{name}");
        assert_ne!(picture, drawn(&[&file], ""), "{name}");
    }
}

#[test]
fn a_motion_has_faint_poses_and_paths() {
    let file = model("multibody/furuta.eom");
    let file = file.as_str();
    let still = drawn(&[file], "");
    let later = drawn(&[file, "--time", "0.5"], "");
    assert!(still.contains("at the start") && later.contains("at t = 0.5"));
    assert_ne!(still, later);
    let moving = drawn(
        &[file, "--motion", "0.5", "--poses", "3", "--trace", "rod"],
        "",
    );
    assert_eq!(
        moving.matches("<g opacity").count(),
        3 + 1,
        "poses and shadows"
    );
    let lines = |picture: &str| picture.matches("class=\"line\"").count();
    assert!(lines(&moving) > lines(&later) + 30);
    within(&moving);
    // The pose drawn in full is the last one: without the others the picture equals that at its time.
    let last = drawn(&[file, "--motion", "0.5", "--poses", "0"], "");
    let parts = |picture: &str| elements(picture, "ellipse", ["rx", "ry"]);
    assert_eq!(parts(&last), parts(&later));
    let shifted = drawn(
        &[file, "--time", "0.2", "--motion", "0.3", "--poses", "0"],
        "",
    );
    assert_eq!(parts(&shifted).len(), parts(&later).len());
    let driven = drawn(&[file, "--time", "0.5", "--input", "tau = 0.02"], "");
    assert_ne!(driven, later);
}

#[test]
fn a_state_that_is_given_is_drawn() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("draw");
    std::fs::create_dir_all(&folder).expect("a folder");
    let state = folder.join("state.json");
    std::fs::write(&state, r#"{"coord": {"arm": 1.2, "swing": 2}}"#).expect("a file");
    let (file, out) = (model("multibody/furuta.eom"), folder.join("furuta.svg"));
    let (state, out) = (state.display().to_string(), out.display().to_string());
    let printed = drawn(&[&file, "--at", &state], "");
    assert!(printed.contains("at the state given"));
    assert_ne!(printed, drawn(&[&file], ""));
    let said = drawn(&[&file, "--at", &state, "--out", &out], "");
    assert_eq!(said, format!("wrote {out}\n"));
    assert_eq!(std::fs::read_to_string(&out).expect("a picture"), printed);
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let energies = "pub system Abstract {
        coord q;
        velocity w;
        rate q = w;
        kinetic w^2 / 2;
        potential q^2 / 2;
    }";
    let said = refused(&["-"], energies);
    assert!(
        said.contains("nothing of Abstract can be drawn") && said.contains("frame f = pose"),
        "{said}"
    );
    assert!(said.contains("`kinetic` has no place"), "{said}");
    // Parts that a picture leaves out are reported; a frame shown in the picture counts as used.
    let partly = energies.replace(
        "kinetic",
        "frame mark = pose(identity(3), [q, 0, 0]); kinetic",
    );
    let output = crate::common::hamel(&["draw", "-"], &partly);
    assert_eq!(output.status.code(), Some(0));
    let said = text(&output.stderr);
    assert!(
        said.contains("not drawn: the inertia in `kinetic`"),
        "{said}"
    );
    assert!(!said.contains("never used"), "{said}");
    let output = crate::common::hamel(&["check", "-"], &partly);
    let said = text(&output.stderr);
    assert!(said.contains("the frame `mark` is never used"), "{said}");
    let output = crate::common::hamel(&["eval", "-", "--frame", "mark"], &partly);
    let said = text(&output.stderr);
    assert!(!said.contains("never used"), "{said}");
    let file = model("multibody/furuta.eom");
    let said = refused(
        &[&file, "--motion", "1", "--trace", "bob", "--trace", "rod"],
        "",
    );
    assert!(
        said.contains("no frame is called bob; the frames are beam, rod"),
        "{said}"
    );
    let said = refused(&[&file, "--view", "40"], "");
    assert!(said.contains("two angles in degrees"), "{said}");
    let said = refused(&[&file, "--trace", "rod"], "");
    assert!(said.contains("--motion"), "{said}");
    let said = refused(&[&file, "--motion", "-1"], "");
    assert!(said.contains("greater than zero"), "{said}");
}

#[test]
fn elements_have_shapes() {
    let sprung = "pub system Sprung {
        joint a: revolute [0, 1, 0] moves upper;
        joint b: spherical on upper at [0, 0, -0.7] moves lower;
        body on upper { mass 1; com [0, 0, -0.3]; inertia diag(0.1, 0.1, 0.01) about com; }
        body on lower { mass 2; }
        frame hook = pose(identity(3), [0.8, 0.1, 0]);
        spring stiffness 70 length 0.4 from hook to [0.2, 0, -0.5] on lower;
        damper coefficient 2 from [0.1, 0, 0] on upper to [0.5, 1, 0] on world;
        gravity [0, 0, -9.81];
    }";
    let picture = drawn(&["-"], sprung);
    let document = roxmltree::Document::parse(&picture).expect("XML");
    let paths = document
        .descendants()
        .filter_map(|node| node.attribute("d"));
    let lines = paths.flat_map(|path| path.split('M').map(|line| line.matches('L').count()));
    let longest = lines.max();
    // A spring has 14 corners, its ends and two straight leads.
    assert_eq!(longest, Some(17));
    assert!(picture.contains("grid 0.2"), "a floor");
    let floating = sprung.replace("gravity [0, 0, -9.81];", "");
    assert!(!drawn(&["-"], &floating).contains("grid"));
}
