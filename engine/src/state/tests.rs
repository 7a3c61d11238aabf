//! States as users write them: accepted and refused ones.

use super::{State, parse};
use hamel_codegen::generate::{Generated, from_text};

const SYSTEM: &str = "system Mixed {
    param m = 2, J: sym3 = diag(1, 1, 1);
    coord q: S1, X: SE3;
    velocity a, v: vec3, w: vec3;
    rate q = a;
    rate X.p = X.R * v;
    rate X.R = X.R * hat(w);
    frame hull = X;
    kinetic a^2 / 2;
    body on hull { mass m; inertia J about com; }
}";

fn model() -> Generated {
    from_text(SYSTEM).expect("a sound description")
}

fn read(text: &str) -> Result<State, Vec<String>> {
    of(&model(), "", text)
}

/// Reads a state from a text, or returns its errors as lines.
fn of(generated: &Generated, description: &str, text: &str) -> Result<State, Vec<String>> {
    let state = State::of(generated, description, &parse(text).expect("JSON"));
    state.map_err(|problems| problems.iter().map(ToString::to_string).collect())
}

#[test]
fn every_shape_is_read() {
    let text = r#"{"param": {"m": 3, "J": [[1, 0.1, 0.2], [0.1, 2, 0.3], [0.2, 0.3, 3]]},
        "coord": {"q": 0.5, "X": {"p": [1, 2, 3], "R": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]}},
        "velocity": {"w": [4, 5, 6]}}"#;
    let state = read(text).expect("a sound state");
    assert_eq!(state.params, [3.0, 1.0, 0.1, 0.2, 2.0, 0.3, 3.0]);
    assert_eq!(state.x[..2], [0.5_f64.cos(), 0.5_f64.sin()]);
    assert_eq!(
        state.x[2..],
        [1.0, 2.0, 3.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    );
    assert_eq!(state.xi, [0.0, 0.0, 0.0, 0.0, 4.0, 5.0, 6.0]);
}

#[test]
fn every_mistake_is_named_at_once() {
    let text = r#"{"param": {"mm": 1, "J": [[1, 2, 0], [3, 1, 0], [0, 0, 1]]},
        "coord": {"q": [1, 0, 0], "X": {"p": [1, "2", 3], "r": 1}},
        "velocity": {"w": 4}, "inputs": {}, "input": []}"#;
    let errors = read(text).expect_err("mistakes");
    let expected = [
        "inputs: unknown name; did you mean `input`?",
        "param.mm: unknown name; known are m, J",
        "param.J[1][0]: has to be symmetric: 3 here, 2 at [0][1]",
        "velocity.w: expected a list of 3 numbers, found a number",
        "input: expected an object, found a list",
        "coord.q: expected a list of 2 numbers, found a list of 3",
        "coord.X.r: unknown name; known are p, R",
        "coord.X.p[1]: expected a number, found a text",
    ];
    assert_eq!(errors, expected);
}

#[test]
fn states_off_the_manifold_are_refused() {
    let stretched =
        r#"{"coord": {"q": [1, 0.1], "X": {"R": [[1, 0, 0], [0, 1.1, 0], [0, 0, 1]]}}}"#;
    let errors = read(stretched).expect_err("off");
    assert_eq!(
        errors[0],
        "coord.q: violates q.c^2 + q.s^2 = 1, the difference is 1.00e-2"
    );
    assert!(
        errors[1].starts_with("coord.X: violates")
            && errors[1].ends_with("the difference is 2.10e-1"),
        "{errors:?}"
    );
    let reflected = r#"{"coord": {"X": {"R": [[1, 0, 0], [0, 1, 0], [0, 0, -1]]}}}"#;
    let errors = read(reflected).expect_err("reflected");
    assert_eq!(errors, ["coord.X: a reflection: its determinant is -1"]);
}

/// A blade that cannot slip sideways; its angular velocity has one nonzero component.
const SLEIGH: &str = "system Sleigh {
    coord x, y, q;
    velocity u, v, w: vec3;
    rate x = cos(q) * u - sin(q) * v;
    rate y = sin(q) * u + cos(q) * v;
    rate q = w[3];
    coord a, b;
    rate a = w[1];
    rate b = w[2];
    inactive v, w[1], w[2];
    kinetic (u^2 + v^2 + dot(w, w)) / 2;
}";

/// Velocities determined by constraints may be given if they agree, by the vector's name or by those of its entries.
#[test]
fn velocities_that_follow_are_read_and_judged() {
    let generated = from_text(SLEIGH).expect("a sound description");
    let read = |text: &str| of(&generated, SLEIGH, text);
    for text in [
        r#"{"velocity": {"u": 1, "v": 0, "w": [0, 0, 2]}}"#,
        r#"{"velocity": {"u": 1, "w_3": 2}}"#,
    ] {
        assert_eq!(read(text).expect("a sound state").xi, [1.0, 2.0], "{text}");
    }
    for (text, expected) in [
        (
            r#"{"velocity": {"v": 1}}"#,
            "velocity: violates `inactive v` by 1.00e0, and no choice of the velocities that are not given satisfies it",
        ),
        (
            r#"{"velocity": {"w": [0, 3, 2]}}"#,
            "velocity: violates `inactive w[2]` by 3.00e0, and no choice of the velocities that are not given satisfies it",
        ),
        (
            r#"{"velocity": {"w": [0, 0, 2], "w_3": 2}}"#,
            "velocity.w_3: given twice, also by another of its names",
        ),
        (
            r#"{"velocity": {"z": 1}}"#,
            "velocity.z: unknown name; known are u, v, w, w_3",
        ),
        (
            r#"{"velocity": {"q_dot": 1}}"#,
            "velocity.q_dot: unknown name; the rate of `q` is `w[3]`",
        ),
    ] {
        assert_eq!(read(text).expect_err("a mistake"), [expected]);
    }
}
