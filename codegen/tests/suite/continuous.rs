//! Expressions that must be continuous: those with jumps are refused in every statement, and those with kinks are
//! accepted.

use crate::common::{difference, generated, value};
use hamel_codegen::generate::from_text;

/// Returns a system of a particle, a number and an angle, with further statements.
fn text(said: &str) -> String {
    format!(
        "system A {{ param k = 50, L = 1; coord r: R3, x, z, a: S1; velocity v: vec3, u, w, o;
            rate r = v; rate x = u; rate z = w; rate a = o;
            particle mass 2 at r; kinetic u^2 / 2 + w^2 / 2 + o^2 / 2;
            start r = [2, 0, 0]; {said} generate accel; }}"
    )
}

/// Returns the pull of a rope of length L, by its definition.
fn pull(r: &[f64]) -> Vec<f64> {
    let length = r.iter().map(|r| r * r).sum::<f64>().sqrt();
    let pull = 50.0 * (length - 1.0).max(0.0);
    r.iter().map(|r| -pull * r / length / 2.0).collect()
}

#[test]
fn slack_ropes_pull_where_they_are_tight() {
    for rope in [
        "potential k * max(norm(r) - L, 0)^2 / 2;",
        "potential if norm(r) > L { k * (norm(r) - L)^2 / 2 } else { 0 };",
        "spring stiffness k on max(norm(r) - L, 0);",
    ] {
        let of = generated(&text(rope));
        for r in [[1.2, -0.9, 0.4], [0.3, 0.2, -0.1], [-0.7, 0.1, 0.72]] {
            let x = [r[0], r[1], r[2], 0.3, -0.4, 1.0, 0.0];
            let dot = value(&of, "accel", [&x, &[0.1; 6], &[], &[]]);
            assert!(difference(&pull(&r), &dot[..3]) < 1e-12, "{rope}");
        }
    }
}

#[test]
fn what_only_bends_is_continuous() {
    for said in [
        "potential max(z^2, 0.01);",
        "potential clamp(x, -1, 1) * z;",
        "potential max(abs(x) - 0.5, 0)^2;",
        "potential max(angle(a) - 0.5, 0)^2;",
        "potential max(a.s, 0.5)^2;",
        "potential min(max(norm(r), x), max(z, sin(x)));",
        "potential if z / norm(r) > 0 { z^2 } else { 0 };",
        "potential if x * z > 0 { x^2 * z } else { 0 };",
        "frame f = pose(identity(3), [0, max(r[2]^2, 1), 0]); body on f { mass 1; }",
        "potential x^2 / 2; invariant s = max(x^2 + u^2, 0);",
    ] {
        generated(&text(said));
    }
}

#[test]
fn what_jumps_is_refused() {
    for said in [
        "if x > 0 { 1 } else { 0 }",
        "if norm(r) > L { norm(r) } else { 0 }",
        "if z^2 > 0.01 { z } else { 0.1 }",
        "if a.s > 0.5 { a.s } else { 0 }",
        "if x * z > 0 { x } else { 0 }",
        "if x > 0 { 1 / x } else { 0 }",
        "if x > 0 { if z > 0 { x } else { 1 } } else { 0 }",
        "if x > 0 { if 2 * x > 0 { 1 } else { 0 } } else { 0 }",
        "max(norm(r) - L, 0) * sign(z)",
    ] {
        let errors = from_text(&text(&format!("potential {said};"))).expect_err(said);
        assert!(errors[0].message.contains("may jump where"), "{said}");
    }
}

/// A piecewise linear table as a prescribed position implies impulses, and gives a warning; as a velocity it does not.
#[test]
fn corners_of_motions_over_time_are_shown() {
    let text = |between: &str, said: &str| {
        format!(
            "system A {{ time t; table way = [(0, 0), (1, 2), (3, 1)] {between} extrapolate linear;
                coord x, y; velocity u, w; rate x = u; rate y = w; {said}
                kinetic u^2 / 2 + w^2; generate accel; }}"
        )
    };
    let warned = |between: &str, said: &str| {
        let of = generated(&text(between, said));
        let warnings = of.model.warnings.iter();
        let mut of_corners = warnings.filter(|one| one.message.contains("jumps where"));
        let found = of_corners.next().map(|one| one.message.clone());
        assert!(of_corners.next().is_none());
        found
    };
    let moving = "frame f = pose(rotz(way(t)), [y, 0, 0]); body on f { mass 1; com [1, 0, 0]; }";
    let found = warned("linear", "prescribe x = way(t);").expect("a corner");
    assert!(
        found.starts_with("the speed of `x` jumps where t - 1 = 0"),
        "{found}"
    );
    let found = warned("linear", moving).expect("a corner");
    assert!(
        found.starts_with("the speed of frame `f` jumps where t - 1 = 0"),
        "{found}"
    );
    assert_eq!(warned("linear", "prescribe u = way(t);"), None);
    assert_eq!(warned("linear", "potential way(y) * sin(t);"), None);
    for said in ["prescribe x = way(t);", moving] {
        assert_eq!(warned("pchip", said), None);
    }
}
