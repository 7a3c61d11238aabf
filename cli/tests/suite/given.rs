//! A given state is completed as the description would be with the same values in its text.

use crate::common::{hamel, text};
use serde_json::Value;
use std::process::Output;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Tolerance of numbers determined by equations.
const CLOSE: f64 = 1e-11;

/// A cart with prescribed motion, with a pendulum that is initially at rest.
const CART: &str = "system CartP {
    param l = 0.5, A = 0.3;
    time t;
    joint x: prismatic [1, 0, 0] moves cart;
    joint q: revolute [0, -1, 0] on cart moves rod;
    body on cart { mass 1; }
    particle mass 1 at [0, 0, -l] on rod;
    gravity [0, 0, -9.81];
    prescribe x = A * cos(2 * t) + 0.1 * sin(t);
    start q = 0.3;
}";

/// A four-bar linkage of 0.3, Lc, 0.7 and 1, with a pendulum on its coupler.
const FOUR_BAR: &str = "system FourBarPendulum {
    param m = 1, Lc = 0.9;
    joint a: revolute [0, 0, 1] moves f1;
    joint b: revolute [0, 0, 1] on f1 at [0.3, 0, 0] moves f2;
    joint c: revolute [0, 0, 1] at [1, 0, 0] moves f3;
    joint p: revolute [0, 0, 1] on f2 at [0.5, 0, 0] moves bob;
    body on f1 { mass m; com [0.15, 0, 0]; inertia diag(1, 1, 1) / 100 about com; }
    body on f2 { mass m; com [0.45, 0, 0]; inertia diag(1, 1, 1) / 100 about com; }
    body on f3 { mass m; com [0.35, 0, 0]; inertia diag(1, 1, 1) / 100 about com; }
    particle mass 1 at [0, -0.4, 0] on bob;
    loop position(f2, [Lc, 0, 0]) = position(f3, [0.7, 0, 0]);
    gravity [0, -9.81, 0];
    start a_dot = 2, p_dot = 1, a = 0.9, p = 0.3, b ~ -0.4, c ~ 1.6;
}";

fn evaluated(description: &str, state: &str) -> Output {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let name = format!("given-{}.eom", COUNT.fetch_add(1, Ordering::Relaxed));
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, description).expect("a description");
    hamel(&["eval", &path.display().to_string(), "--at", "-"], state)
}

/// x and ξ.
fn eval(description: &str, state: &str) -> (Vec<f64>, Vec<f64>) {
    let output = evaluated(description, state);
    assert!(output.status.success(), "{state}: {}", text(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let numbers = |name: &str| -> Vec<f64> {
        let list = found[name].as_array().expect("a list");
        let numbers = list.iter().map(|n| n.as_f64().expect("a number"));
        numbers.collect()
    };
    (numbers("x"), numbers("xi"))
}

fn refused(description: &str, state: &str) -> String {
    let output = evaluated(description, state);
    assert_eq!(output.status.code(), Some(2), "{state}");
    text(&output.stderr)
}

/// The state of a description with an edited text.
fn edited(description: &str, edits: &[(&str, &str)]) -> (Vec<f64>, Vec<f64>) {
    let mut text = description.to_string();
    for (from, to) in edits {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    eval(&text, "{}")
}

fn near(found: &[f64], wanted: &[f64]) {
    assert_eq!(found.len(), wanted.len());
    for (a, b) in found.iter().zip(wanted) {
        assert!((a - b).abs() < CLOSE, "{found:?} {wanted:?}");
    }
}

/// The cart follows its motion; the pendulum keeps the angle of the text, at rest.
#[test]
fn parameters_and_time_leave_alone_what_is_free() {
    for q in [0.3, 0.0] {
        let text = CART.replace("start q = 0.3", &format!("start q = {q}"));
        for (state, [t, x]) in [
            (r#"{"param": {"A": 1}}"#, [0.0, 1.0]),
            (
                r#"{"coord": {"t": 0.9}}"#,
                [0.9, 0.3 * 1.8_f64.cos() + 0.1 * 0.9_f64.sin()],
            ),
            (
                r#"{"param": {"A": 0.7}, "coord": {"t": -2}}"#,
                [-2.0, 0.7 * 4.0_f64.cos() - 0.1 * 2.0_f64.sin()],
            ),
        ] {
            let (found, xi) = eval(&text, state);
            near(&found, &[t, x, q]);
            near(&xi, &[0.0]);
        }
    }
    let unsaid = CART.replace("start q = 0.3;", "");
    near(&eval(&unsaid, r#"{"param": {"A": 1}}"#).0, &[0.0, 1.0, 0.0]);
    // A coordinate alone is exact, and the rest is unchanged.
    near(
        &eval(CART, r#"{"coord": {"q": -0.2}}"#).0,
        &[0.0, 0.3, -0.2],
    );
}

/// A guess of a coordinate does not affect velocities; a guess of a velocity is its value unless something contradicts
/// it.
#[test]
fn guesses_do_not_change_what_is_not_guessed() {
    for start in ["start q ~ 0.3;", "start q = 0.3, q_dot ~ 0;"] {
        let (x, xi) = eval(&CART.replace("start q = 0.3;", start), "{}");
        near(&x, &[0.0, 0.3, 0.3]);
        near(&xi, &[0.0]);
    }
}

#[test]
fn a_crank_that_is_driven_moves_its_slider_and_not_a_pendulum() {
    let crank = include_str!("../../../tests/models/crank_drive.eom");
    for (state, a, t, edit) in [
        (
            r#"{"param": {"a": 0.4}}"#,
            0.4_f64,
            0.3_f64,
            ("a = 0.3", "a = 0.4"),
        ),
        (r#"{"coord": {"t": 0.5}}"#, 0.3, 0.5, ("t = 0.3", "t = 0.5")),
    ] {
        let (x, xi) = eval(crank, state);
        let angle = 5.0 * t + 0.1 * (3.0 * t).sin();
        let rod = -(a * angle.sin()).asin();
        near(&x, &[t, angle, rod, a * angle.cos() + rod.cos(), 0.5]);
        let same = edited(crank, &[edit]);
        near(&x, &same.0);
        near(&xi, &same.1);
    }
}

#[test]
fn exact_starts_of_a_linkage_stay() {
    let closed = |x: &[f64], length: f64| {
        let (a, b, c) = (x[0], x[0] + x[1], x[2]);
        let across = 0.3 * a.cos() + length * b.cos() - 1.0 - 0.7 * c.cos();
        let up = 0.3 * a.sin() + length * b.sin() - 0.7 * c.sin();
        assert!(across.abs() < CLOSE && up.abs() < CLOSE, "{x:?}");
    };
    let (x, xi) = eval(FOUR_BAR, r#"{"param": {"Lc": 0.95}}"#);
    assert_eq!((x[0], x[3], xi[0], xi[3]), (0.9, 0.3, 2.0, 1.0));
    closed(&x, 0.95);
    let same = edited(FOUR_BAR, &[("Lc = 0.9;", "Lc = 0.95;")]);
    near(&x, &same.0);
    near(&xi, &same.1);
    let (x, xi) = eval(FOUR_BAR, r#"{"coord": {"a": 1.2}, "velocity": {"p": 3}}"#);
    assert_eq!((x[0], x[3], xi[0], xi[3]), (1.2, 0.3, 2.0, 3.0));
    closed(&x, 0.9);
    let same = edited(
        FOUR_BAR,
        &[(" a = 0.9", " a = 1.2"), ("p_dot = 1", "p_dot = 3")],
    );
    near(&x, &same.0);
    near(&xi, &same.1);
    // The given values contradict an exact start, which is moved; the pendulum is not affected.
    let (x, xi) = eval(
        FOUR_BAR,
        &format!(
            r#"{{"coord": {{"b": {}, "c": {}}}, "velocity": {{"c": 1}}}}"#,
            x[1], x[2]
        ),
    );
    near(&x[..1], &[1.2]);
    closed(&x, 0.9);
    assert_eq!((x[3], xi[2], xi[3]), (0.3, 1.0, 1.0));
    let (a, b, c) = (x[0], x[0] + x[1], x[2]);
    let (w, v) = (xi[0], xi[0] + xi[1]);
    near(
        &[
            0.3 * a.sin() * w + 0.9 * b.sin() * v,
            0.3 * a.cos() * w + 0.9 * b.cos() * v,
        ],
        &[0.7 * c.sin(), 0.7 * c.cos()],
    );
}

/// Both ends of a loop are exact: one is given, and the other follows.
#[test]
fn exact_starts_give_way_to_what_contradicts_them() {
    let slider = "system Slider {
        param r = 0.3, h = 0.4;
        joint s: prismatic [1, 0, 0] moves block;
        joint k: prismatic [1, 0, 0] moves other;
        joint free: prismatic [1, 0, 0] on other moves third;
        body on block { mass 1; }
        body on other { mass 1; }
        body on third { mass 1; }
        loop s = 2 * k;
        start s = 0.6, k = r, free = 2 * h, s_dot = 1, k_dot = 0.5, free_dot = h;
    }";
    near(&eval(slider, "{}").0, &[0.6, 0.3, 0.8]);
    let (x, xi) = eval(slider, r#"{"coord": {"s": 1}, "velocity": {"k": 2}}"#);
    near(&x, &[1.0, 0.5, 0.8]);
    near(&xi[xi.len() - 1..], &[0.4]);
    // Starts that depend on parameters follow these; one end of the loop has to move.
    let (x, _) = eval(slider, r#"{"param": {"h": 1}}"#);
    near(&x, &[0.6, 0.3, 2.0]);
    let (x, _) = eval(slider, r#"{"param": {"r": 0.5, "h": 1}}"#);
    near(&[x[0] - 2.0 * x[1], x[2]], &[0.0, 2.0]);
    let both = r#"{"coord": {"s": 1, "k": 2}}"#;
    assert!(refused(slider, both).contains("leaves `s = 2 * k` open by 3.00e0"));
}

/// A blade that cannot slip: one of its three velocities depends on the others, and may be given with the right value.
#[test]
fn velocities_that_follow_may_be_given() {
    let sleigh = "system Sleigh {
        param a = 0.3;
        coord x, y, q;
        velocity u, v, w;
        rate x = cos(q) * u - sin(q) * v, y = sin(q) * u + cos(q) * v, q = w;
        nonholonomic v = -a * w;
        kinetic (u^2 + v^2 + w^2) / 2;
    }";
    let wanted = eval(sleigh, r#"{"velocity": {"u": 1, "w": 2}}"#);
    let follows = r#"{"velocity": {"u": 1, "v": -0.6}}"#;
    let both = r#"{"velocity": {"u": 1, "v": -0.6, "w": 2}}"#;
    for state in [follows, both] {
        near(&eval(sleigh, state).1, &wanted.1);
    }
    let wrong = r#"{"velocity": {"v": -0.6, "w": 1}}"#;
    let said = refused(sleigh, wrong);
    assert!(
        said.contains("velocity: violates `v = -a * w` by 3.00e-1"),
        "{said}"
    );
    assert!(refused(CART, r#"{"velocity": {"x": 1}}"#).contains("velocity: violates `x = "));
    assert!(
        refused(CART, r#"{"velocity": {"t_dot": 1}}"#)
            .contains("velocity.t_dot: not a velocity of the state")
    );
    let drive = r#"{"velocity": {"x": 0.1}}"#;
    near(&eval(CART, drive).1, &[0.0]);
}
