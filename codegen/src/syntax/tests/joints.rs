//! Joints: accepted in all their forms, refused with the form that is missing.

use super::refused::line;
use super::{statement, told};

#[test]
fn all_forms_are_read() {
    let cases = [
        "joint elbow: revolute [0, 1, 0] on upper at pose(rotx(pi / 2), [0, 0, l]) moves fore;",
        "joint j: prismatic a moves g { limit -1 to 2 * k; max_speed 3; max_force 10; };",
        "joint j: spherical S3 on f moves g;",
        "joint j: spherical SO3 on f moves g;",
        "joint j: universal [1, 0, 0], [0, 1, 0] at P moves g;",
        "joint j: free moves g;",
        "joint j: continuous [0, 0, 1] moves g follows 2 * q - 1 { rest q0; stiffness k; }",
        "joint j: revolute n moves g { /// friction\n damping d; armature J; force u; }",
    ];
    let told: Vec<String> = cases.map(|case| told(&statement(case))).into();
    insta::assert_snapshot!(told.join("\n"), @"");
}

#[test]
fn what_is_missing_is_said() {
    let cases = [
        "joint revolute [0, 0, 1] moves g;",
        "joint j: revolut [0, 0, 1] moves g;",
        "joint j: bushing moves g;",
        "joint j: revolute on f moves g;",
        "joint j: revolute;",
        "joint j: revolute [0, 0, 1] on f at P;",
        "joint j: fixed [0, 0, 1] moves g;",
        "joint j: free S3 moves g;",
        "joint j: universal [1, 0, 0] moves g;",
        "joint j: revolute [0, 0, 1], [0, 1, 0] moves g;",
        "joint j: fixed moves g follows;",
        "joint j: revolute a moves g { friction d; limit 1; damping 1; damping 2; dampin 3; 4; }",
        "joint j: revolute a moves g { limit 1 to; }",
        "joint j: revolute a moves g { damping d }",
    ];
    insta::assert_snapshot!(cases.map(line).join("\n"), @"");
}
