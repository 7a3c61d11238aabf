//! If M is singular because the motion of a joint has no inertia, the message names the joint, and its help is valid.

use hamel_codegen::generate::from_text;

/// Returns message and help for a refused description.
fn refusal(text: &str) -> [String; 2] {
    let errors = from_text(text).expect_err("M is singular");
    let [error] = errors.as_slice() else {
        panic!("{} errors", errors.len());
    };
    [
        error.message.clone(),
        error.help.clone().unwrap_or_default(),
    ]
}

/// A slender rod between ball joints connects a crank and a rocker, along an axis of its frame: the spin about itself
/// has no inertia. With the proposed joint the mechanism can be derived.
#[test]
fn the_spin_of_a_slender_rod_is_named() {
    for (axis, shown) in [
        ([0.0, 0.0, 1.0], "[0, 0, 1]"),
        ([0.6, 0.8, 0.0], "[0.6, 0.8, 0]"),
        ([-0.36, 0.48, -0.8], "[0.36, -0.48, 0.8]"),
    ] {
        let [x, y, z] = axis;
        let row = |a: f64| format!("[{a} * {x}, {a} * {y}, {a} * {z}]");
        let square = axis.map(row).join(", ");
        let text = format!(
            "system Rods {{
                const a = 0.2, b = 0.5, l = 0.9, n = [{x}, {y}, {z}];
                joint crank: revolute [0, 0, 1] moves c;
                joint rocker: revolute [1, 0, 0] at translation([0.5, 0.6, 0]) moves r;
                joint ball: spherical on c at translation([a, 0, 0]) moves rod;
                body on c {{ mass 1; com [a / 2, 0, 0]; inertia diag(0.001, 0.004, 0.004) about com; }}
                body on r {{ mass 2; com [0, 0, b / 2]; inertia diag(0.05, 0.05, 0.001) about com; }}
                body on rod {{ mass 0.1; com l / 2 * n; inertia 0.1 * l^2 / 12 * (identity(3) - [{square}]) about com; }}
                loop position(rod, l * n) = position(r, [0, 0, b]);
                gravity [0, 0, -9.81];
                start crank = 0.3, crank_dot = 4, rocker ~ -0.3;
            }}"
        );
        let [message, help] = refusal(&text);
        assert!(message.contains("not positive definite"), "{message}");
        let expected = format!("nothing resists the spin of `rod` about its axis {shown}");
        assert!(help.starts_with(&expected), "{help}");
        let joint = help
            .split('`')
            .find(|part| part.starts_with("joint ball: "));
        let joint = joint.expect("a joint is proposed");
        let heeded = text.replace("joint ball: spherical", joint);
        assert!(from_text(&heeded).is_ok(), "{heeded}");
        // A small inertia also suffices.
        assert!(from_text(&text.replace("identity(3) - [", "identity(3) - 0.99 * [")).is_ok());
    }
}

#[test]
fn a_joint_that_moves_nothing_is_named() {
    let [_, help] = refusal(
        "system Arm {
            joint a: revolute [0, 0, 1] moves A;
            joint b: revolute [0, 0, 1] on A at [1, 0, 0] moves B;
            joint c: prismatic [1, 0, 0] on B moves _C;
            body on B { mass 1; com [0.5, 0, 0]; inertia diag(1, 1, 1) / 10 about com; }
        }",
    );
    assert!(
        help.starts_with("nothing resists the motion of the joint `c`"),
        "{help}"
    );
    // A combined motion of several joints has no name.
    let [_, help] = refusal(
        "system Arm {
            joint a: revolute [0, 0, 1] moves A;
            joint b: revolute [0, 0, 1] on A moves B;
            body on B { mass 1; com [0.5, 0, 0]; inertia diag(1, 1, 1) / 10 about com; }
        }",
    );
    assert!(help.starts_with("every velocity needs inertia"), "{help}");
}
