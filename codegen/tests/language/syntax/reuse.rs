//! The parsed form of repetition, components, parts, and names with indices.

use super::{statement, told};
use hamel_language::syntax::path::{plain, spelling};

fn says(text: &str) -> String {
    told(&statement(text))
}

#[test]
fn repetition() {
    assert_eq!(
        says("for i in 1..n - 1 { param m[i] = i; start q[i]_dot = 2 * i; }"),
        "for i from 1 to (n - 1): param m[i]: Scalar = i | start q[i]_dot = (2 * i)"
    );
    // A dot between numbers does not end a number.
    assert_eq!(says("for i in 1..2 { }"), "for i from 1 to 2: ");
    assert_eq!(says("for i in a.b..2.5 { };"), "for i from a.b to 5/2: ");
}

#[test]
fn components_and_parts() {
    assert_eq!(
        says("component Leg(mount: frame, side = -1, l) { frame f on mount = P; }"),
        "component Leg(mount: frame = none; side = (-1); l = none): frame f on Some(\"mount\") = P"
    );
    assert_eq!(says("component Foot { }"), "component Foot(): ");
    assert_eq!(
        says("part leg[i in 2 * 1..6] = Leg(mount[i], side = -1);"),
        "part leg Some(\"i from (2 * 1) to 6\") of Leg: None mount[i]; Some(\"side\") (-1)"
    );
    assert_eq!(
        says("part leg[i+1] = Leg();"),
        "part leg[i+1] None of Leg: "
    );
    assert_eq!(says("include \"a/b.eom\";"), "include a/b.eom");
}

#[test]
fn names_with_indices() {
    assert_eq!(
        says("torque t on leg[i - 1].shin [2].foot in arm . hand;"),
        "torque t on leg[i-1].shin[2].foot in arm.hand"
    );
    assert_eq!(
        says("output y = a[1]_dot[2] + b.c[i, 2]_r.p;"),
        "output y = (a[1]_dot[2] + b.c[i,2]_r.p)"
    );
    // Brackets are indices of a name only directly after it.
    assert_eq!(spelling("link[ (i - 1) * 2 ].x"), "link[(i-1)*2].x");
    assert_eq!(plain("leg[3].node[1, 2]_dot"), "leg_3_node_1_2_dot");
}
