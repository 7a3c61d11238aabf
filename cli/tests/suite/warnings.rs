//! Unused declarations of a description cause warnings on standard error, and change nothing else.

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

/// Each is reported once, however many velocities a joint has.
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
        "this damping coefficient is negative: -0.1",
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

/// Rows that hold identically are found when a description is read, dependent rows when it is derived: every command
/// that derives it reports both once.
#[test]
fn rows_that_say_nothing_are_warned_of_once() {
    let weld = "system Weld {
        joint a: revolute [0, 0, 1] moves A; joint b: revolute [0, 0, 1] on A at [1, 0, 0] moves B;
        joint c: revolute [0, 0, 1] at [1.5, 0, 0] moves C; joint d: revolute [0, 0, 1] on C at [0, 1, 0] moves D;
        body on B { mass 1; com [0.5, 0, 0]; inertia diag(1, 1, 1) / 10 about com; }
        body on A { mass 1; com [0.5, 0, 0]; inertia diag(1, 1, 1) / 10 about com; }
        body on C { mass 1; com [0, 0.5, 0]; inertia diag(1, 1, 1) / 10 about com; }
        joint e: revolute [0, 0, 1] on B at [0.8, 0, 0] moves E { armature 0.1; }
        loop position(E) = position(D), E.R = D.R;
        start a = 1, b ~ -1, c ~ 0.1;
    }";
    for command in ["check", "ops", "emit", "eval", "linearize"] {
        let output = hamel(&[command, "-"], weld);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{command}: {said}");
        for part in [
            "entry [3] of this loop always holds, and is left out",
            "entries [1, 3], [2, 3], [3, 1], [3, 2], [3, 3] of this loop always hold, and are left out",
            "entries [2, 1], [2, 2] of this loop follow from the other rows, and are left out",
        ] {
            assert_eq!(said.matches(part).count(), 1, "{command}: {said}");
        }
    }
    let printed = hamel(&["eval", "-"], weld);
    let all: serde_json::Value = serde_json::from_slice(&printed.stdout).expect("JSON");
    assert_eq!(
        all["constraints"][1],
        "position(E) = position(D), entry [2]"
    );
    assert_eq!(all["constraint_force"].as_array().map(Vec::len), Some(4));
    assert_eq!(
        all["undetermined"],
        serde_json::json!(["E.R = D.R, entry [1, 1]", "E.R = D.R, entry [1, 2]"])
    );
    let printed = hamel(&["check", "-"], weld);
    let lines = text(&printed.stdout);
    assert_eq!(
        lines
            .matches(": not determined, as rows depend on it")
            .count(),
        2,
        "{lines}"
    );
}
