//! Closing joints of robots: only equations that are not redundant are written. Their number is counted by hand; that
//! the others are redundant is shown by adding them again.

use crate::common::{difference, generated, value};
use hamel_codegen::derive::reduction::reduce;
use hamel_codegen::generate::Generated;
use hamel_codegen::lower::build;
use hamel_codegen::syntax::{parse_text, print};
use hamel_codegen::urdf::{Imported, Options, import};

/// Returns a link with mass.
fn link(name: &str) -> String {
    format!(
        "<link name='{name}'><inertial><origin xyz='0.2 0.03 0'/><mass value='1.5'/>\
         <inertia ixx='0.02' ixy='0' ixz='0' iyy='0.03' iyz='0' izz='0.04'/></inertial></link>"
    )
}

/// Returns a hinge about an axis.
fn hinge(name: &str, [parent, child]: [&str; 2], origin: &str, axis: &str) -> String {
    format!(
        "<joint name='{name}' type='revolute'><parent link='{parent}'/><child link='{child}'/>\
         <origin {origin}/><axis xyz='{axis}'/></joint>"
    )
}

/// Returns bars on a tilted base, two of them in series and the third one parallel to them, and the joint that closes
/// them.
fn bars(tilt: &str, lengths: [&str; 3], more: &str) -> String {
    let [crank, turned, base] = lengths;
    let z = "0 0 1";
    [
        "<robot name='bars'><link name='world'/><link name='base'/>".to_string(),
        format!(
            "<joint name='mount' type='fixed'><parent link='world'/><child link='base'/><origin rpy='{tilt}' xyz='0.1 0.2 0.3'/></joint>"
        ),
        ["A", "B", "C"].map(link).concat(),
        hinge("a", ["base", "A"], &format!("rpy='0 0 {turned}'"), z),
        hinge("b", ["A", "B"], &format!("xyz='{crank} 0 0' rpy='0 0 -{turned}'"), z),
        hinge(
            "c",
            ["base", "C"],
            &format!("xyz='{base} 0 0' rpy='0 0 {turned}'"),
            z,
        ),
        format!("{more}</robot>"),
    ]
    .concat()
}

/// Returns a `<loop_joint>` between ends of two bars.
fn closing(kind: &str, axis: &str, ends: [&str; 4]) -> String {
    let [first, at, second, to] = ends;
    format!(
        "<loop_joint name='pin' type='{kind}'><axis xyz='{axis}'/><link1 link='{first}' {at}/><link2 link='{second}' {to}/></loop_joint>"
    )
}

fn imported(urdf: &str) -> Imported {
    import(urdf, &Options::default()).expect("a robot")
}

/// Returns the equations that are comments.
fn comments(text: &str) -> Vec<&str> {
    let parts = text.lines().filter(|line| {
        line.ends_with("` always holds") || line.ends_with("` follows from the others")
    });
    // The equation follows the direction.
    parts
        .map(|line| line.split(": `").nth(1).expect("an equation"))
        .map(|rest| rest.split('`').next().expect("its end"))
        .collect()
}

/// Returns the description with the equations that are comments.
fn with_all(text: &str) -> String {
    let mut all = text.trim_end().trim_end_matches('}').to_string();
    for equation in comments(text) {
        all += &format!("loop {equation};\n");
    }
    all + "}\n"
}

/// Returns the number of warnings about redundant rows.
fn warnings(text: &str) -> usize {
    let model = build(&parse_text(text).expect("a description")).expect("a model");
    let reduction = reduce(&model).expect("it moves").expect("it has loops");
    model.warnings.len() + reduction.dropped.len()
}

fn accel(of: &Generated) -> Vec<f64> {
    let model = &of.active;
    let inputs: Vec<f64> = (0..model.u.len()).map(|i| 1.0 + (i * i) as f64).collect();
    value(of, "accel", [&model.start_x, &model.start_xi, &inputs, &[]])
}

const LENGTHS: [&str; 3] = ["0.4", "0.9", "0.7"];

/// In any plane, a pin needs two equations, a weld three and a slider two, however many equations the closing joint has
/// in space. Adding the others gives warnings and does not change the motion.
#[test]
fn closing_joints_in_a_plane_have_as_many_equations_as_the_plane() {
    let tip = "xyz='0.4 0 0'";
    let end = "xyz='0.7 0 0'";
    let free = [link("D"), hinge("d", ["C", "D"], tip, "0 0 1")].concat();
    for tilt in ["0 0 0", "1.5707963267948966 0 0", "0.3 -0.4 0.2"] {
        for (kind, axis, least, all) in [
            ("revolute", "0 0 1", 2, 5),
            ("spherical", "0 0 1", 2, 3),
            ("fixed", "0 0 1", 3, 6),
            ("prismatic", "1 0 0", 2, 5),
            ("prismatic", "0.6 0.8 0", 2, 5),
        ] {
            let on_c = closing(kind, axis, ["B", end, "C", tip]);
            let more = match kind {
                "fixed" => free.clone() + &closing(kind, axis, ["B", end, "D", "xyz='0 0 0'"]),
                _ => on_c,
            };
            let robot = imported(&bars(tilt, LENGTHS, &more));
            let text = &robot.text();
            assert_eq!(robot.equations.len(), least, "{text}");
            assert_eq!(comments(text).len(), all - least, "{text}");
            assert_eq!(warnings(text), 0, "{text}");
            let full = with_all(text);
            assert!(warnings(&full) >= all - least, "{full}");
            let (fewer, full) = (generated(text), generated(&full));
            let starts = [&fewer, &full].map(|of| of.active.start_x.clone());
            assert!(difference(&starts[0], &starts[1]) < 1e-9, "{text}");
            let both = [&fewer, &full].map(accel);
            assert!(both[0].iter().any(|rate| rate.abs() > 0.1), "{both:?}");
            assert!(difference(&both[0], &both[1]) < 1e-8, "{both:?}\n{text}");
        }
    }
}

/// If all bars are aligned, the equation along them has slope zero; but it is not redundant at neighbouring points, and
/// remains.
#[test]
fn what_vanishes_at_the_start_alone_is_written() {
    let pin = closing(
        "revolute",
        "0 0 1",
        ["B", "xyz='0.7 0 0'", "C", "xyz='0.4 0 0'"],
    );
    let robot = imported(&bars("0 0 0", ["0.4", "0", "0.7"], &pin));
    assert_eq!(robot.equations.len(), 2, "{}", robot.text());
    assert_eq!(warnings(&robot.text()), 0, "{}", robot.text());
    for axis in [1, 2] {
        let row = format!("position(pin_1)[{axis}] = position(pin_2)[{axis}]");
        let mut equations = robot.equations.iter();
        let is_row = |&place: &usize| print::statement(&robot.system.items[place]).contains(&row);
        assert!(equations.any(is_row), "{}", robot.text());
    }
}

/// A ball joint at the ends of bars with axes that are not parallel needs three equations.
#[test]
fn in_space_all_equations_are_written() {
    let skew = [
        link("D"),
        hinge("d", ["C", "D"], "xyz='0.4 0 0'", "0 1 1"),
        closing(
            "spherical",
            "0 0 1",
            ["B", "xyz='0.7 0 0'", "D", "xyz='0.1 0 0'"],
        ),
    ]
    .concat();
    let tilted = LENGTHS.map(str::to_string);
    let urdf = bars("0 0 0", [&tilted[0], &tilted[1], "0.8"], &skew);
    let robot = imported(&urdf);
    assert_eq!(robot.equations.len(), 3, "{}", robot.text());
    assert_eq!(warnings(&robot.text()), 0, "{}", robot.text());
    assert_eq!(comments(&robot.text()), [""; 0]);
}

/// Ends that no motion brings together do not count as ends that always coincide.
#[test]
fn what_cannot_be_closed_is_refused_as_before() {
    for (tilt, reason) in [
        ("0 0 0", "this loop contains nothing that moves"),
        ("0.3 -0.4 0.2", "closes this loop"),
    ] {
        let pin = closing(
            "spherical",
            "0 0 1",
            ["B", "xyz='0.7 0 0.01'", "C", "xyz='0.4 0 0'"],
        );
        let robot = imported(&bars(tilt, LENGTHS, &pin));
        assert_eq!(robot.equations.len(), 3, "{}", robot.text());
        let errors = build(&robot.system)
            .map(|_| ())
            .expect_err("it cannot be closed");
        let all: Vec<&str> = errors.iter().map(|error| error.message.as_str()).collect();
        assert!(all.join("; ").contains(reason), "{all:?}");
    }
}

/// A redundant closing joint is a comment, without its frames.
#[test]
fn a_second_pin_at_the_same_place_is_a_comment() {
    let ends = ["B", "xyz='0.7 0 0'", "C", "xyz='0.4 0 0'"];
    let pin = closing("revolute", "0 0 1", ends);
    let two = pin.clone() + &pin.replace("'pin'", "'other'");
    let robot = imported(&bars("0 0 0", LENGTHS, &two));
    assert_eq!(robot.equations.len(), 2, "{}", robot.text());
    let frames = robot.text().matches("    frame ").count();
    assert_eq!(frames, 2, "{}", robot.text());
    assert_eq!(warnings(&robot.text()), 0);
}
