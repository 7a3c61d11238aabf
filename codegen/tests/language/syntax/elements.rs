//! Refused springs, dampers and forces between frames.

use super::refused::line;

#[test]
fn springs_dampers_and_reactions() {
    let cases = [
        "spring k from f to g;",
        "spring stiffness k;",
        "spring stiffness k from f;",
        "spring stiffness k from [1, 0, 0] to g;",
        "spring stiffness k length from f to g;",
        "damper c on w;",
        "damper coefficient c to g;",
        "dissipation;",
        "force F from f;",
        "torque t on f from in body;",
    ];
    insta::assert_snapshot!(cases.map(line).join("\n"), @r#"
    2:8 expected `stiffness`, found `k` <k>
      a spring is written `spring stiffness k length l from p on f to q on g;` or `spring stiffness k on q2 - q1;`
    2:19 expected `from` and two points, or `on` and a scalar, found `;` <;>
      a spring is written `spring stiffness k length l from p on f to q on g;` or `spring stiffness k on q2 - q1;`
    2:26 expected `to`, found `;` <;>
      a spring is written `spring stiffness k length l from p on f to q on g;` or `spring stiffness k on q2 - q1;`
    2:35 expected `on` and the frame of this point, found `to` <to>
      a spring is written `spring stiffness k length l from p on f to q on g;` or `spring stiffness k on q2 - q1;`
    2:32 expected `from` and two points, or `on` and a scalar, found `f` <f>
      a spring is written `spring stiffness k length l from p on f to q on g;` or `spring stiffness k on q2 - q1;`
    2:8 expected `coefficient`, found `c` <c>
      a damper is written `damper coefficient c from p on f to q on g;` or `damper coefficient c on w2 - w1;`
    2:22 expected `from` and two points, or `on` and a scalar, found `to` <to>
      a damper is written `damper coefficient c from p on f to q on g;` or `damper coefficient c on w2 - w1;`
    2:12 expected an expression, found `;` <;>
      a dissipation is written `dissipation d * w^2 / 2;`
    2:15 expected `to`, found `;` <;>
      a force is written `force F at p on f in body;`, `in world;` or `in g;`, or along a line `force F from p on f to q on g;`
    2:20 expected the name of a frame, found `in` <in>
      `in` is a word of the language and cannot be a name
    "#);
}
