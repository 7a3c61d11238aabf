//! What a description declares and does not use is said on standard error, and changes nothing else.

use crate::common::{hamel, text};

const UNUSED: &str = "system A { param k = 2; coord q; velocity w; rate q = w; kinetic w^2 / 2; }";

#[test]
fn warnings_are_shown_once_and_end_nothing() {
    for command in ["check", "ops", "tables", "emit", "eval", "linearize"] {
        let output = hamel(&[command, "-"], UNUSED);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{command}: {said}");
        assert_eq!(said.matches("warning:").count(), 1, "{command}: {said}");
        for part in [
            "warning: the parameter `k` is never used",
            "<stdin>:1:18",
            "help: remove it, or call it `_k`",
        ] {
            assert!(said.contains(part), "{command}: {said}");
        }
        assert!(!text(&output.stdout).contains("warning"), "{command}");
    }
}

/// Each of them once, however many velocities a joint has.
#[test]
fn negative_masses_and_damping_are_warned_of() {
    let negative = "system N {
        joint b: spherical moves f { damping -0.1; }
        body on f { mass 1; inertia identity(3); com [0, 0, 0]; }
        particle mass -1/10 at [0, 0, 1] on f;
    }";
    let output = hamel(&["check", "-"], negative);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    for part in [
        "the mass of this particle is negative: -0.1",
        "this coefficient of damping is negative: -0.1",
    ] {
        assert_eq!(said.matches(part).count(), 1, "{said}");
    }
}

#[test]
fn the_advice_is_heeded() {
    let output = hamel(&["emit", "-"], &UNUSED.replace("param k", "param _k"));
    assert_eq!(text(&output.stderr), "");
    assert!(text(&output.stdout).contains("pub fn set_k("));
}

#[test]
fn errors_come_without_warnings() {
    let output = hamel(&["check", "-"], &UNUSED.replace("w^2", "z^2"));
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(!said.contains("warning"), "{said}");
}
