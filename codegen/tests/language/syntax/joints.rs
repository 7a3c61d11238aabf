//! Joints: accepted in all forms, refused with a message about the missing form.

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
    insta::assert_snapshot!(told.join("\n"), @r#"
    joint elbow: Revolute [[0, 1, 0]] on Some("upper") at pose(rotx((pi / 2)), [0, 0, l]) moves fore follows none {}
    joint j: Prismatic [a] on None at none moves g follows none {Limit (-1), (2 * k); MaxSpeed 3; MaxForce 10}
    joint j: SphericalS3 [] on Some("f") at none moves g follows none {}
    joint j: Spherical [] on Some("f") at none moves g follows none {}
    joint j: Universal [[1, 0, 0], [0, 1, 0]] on None at P moves g follows none {}
    joint j: Free [] on None at none moves g follows none {}
    joint j: Continuous [[0, 0, 1]] on None at none moves g follows ((2 * q) - 1) {Rest q0; Stiffness k}
    joint j: Revolute [n] on None at none moves g follows none {Damping d; Armature J; Force u}
    "#);
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
    insta::assert_snapshot!(cases.map(line).join("\n"), @r#"
    2:16 expected one index or two <[0, 0, 1]>
      components are written `v[i]` and `M[i, j]`, numbered from 1
    2:10 unknown kind of joint `revolut` <revolut>
      did you mean `revolute`?
    2:10 unknown kind of joint `bushing` <bushing>
      the kinds are `revolute`, `continuous`, `prismatic`, `spherical`, `free`, `planar`, `universal`, `cylindrical`, `fixed`
    2:10 a revolute joint has an axis, found `on` <revolute>
      write `revolute [0, 0, 1]`
    2:10 a revolute joint has an axis, found `;` <revolute>
      write `revolute [0, 0, 1]`
    2:38 expected `moves` and the frame that the joint carries, found `;` <;>
      write `moves g` after the place of the joint; `g` is a new frame, on which bodies stand: `joint j: … moves g;`
    2:16 expected `on`, `at` or `moves`, found `[` <[>
      a fixed joint has no axis: write `fixed`
    2:15 expected `on`, `at` or `moves`, found `S3` <S3>
      a free joint has no axis: write `free`
    2:30 expected `,`, found `moves` <moves>
      a universal joint has two axes: `universal [1, 0, 0], [0, 1, 0]`
    2:28 expected `on`, `at` or `moves`, found `,` <,>
      a joint is written `joint j: revolute [0, 0, 1] on f at pose(R, p) moves g;`, or with `{ damping d; }` before its `;`
    2:31 expected an expression, found `;` <;>
      a joint is written `joint j: revolute [0, 0, 1] on f at pose(R, p) moves g;`, or with `{ damping d; }` before its `;`
    2:31 a joint has no `friction` <friction>
      a joint can have `damping`, `armature`, `stiffness`, `rest`, `force`, `limit`, `max_speed`, `max_force`
    2:50 expected `to`, found `;` <;>
      limits are written `limit -pi to pi;`
    2:63 `damping` is given twice for one joint <damping>
      remove one of them, or write their sum
    2:74 a joint has no `dampin` <dampin>
      did you mean `damping`?
    2:84 expected a property of the joint, found `4` <4>
      a joint can have `damping`, `armature`, `stiffness`, `rest`, `force`, `limit`, `max_speed`, `max_force`
    2:41 expected an expression, found `;` <;>
      limits are written `limit -pi to pi;`
    2:39 expected `;` after `d` <d>
      end the statement with `;`
    "#);
}
