//! Tests of names in LaTeX.

use super::latex_name;

/// The rate of the velocity `q_dot` is named `q_dot_dot`, with the index of a joint before or after `_dot`.
#[test]
fn rates_of_rates_have_two_dots() {
    for (name, wanted) in [
        ("arm_dot", r"\dot{\mathrm{arm}}"),
        ("arm_dot_dot", r"\ddot{\mathrm{arm}}"),
        ("q_1_dot", r"\dot{q}_1"),
        ("q_1_dot_dot", r"\ddot{q}_1"),
        ("j_dot_dot[2]", r"\ddot{j}_{2}"),
        ("w_dot[2]", r"\dot{w}_{2}"),
    ] {
        assert_eq!(latex_name(name).replace("{1}", "1"), wanted, "{name}");
    }
}
