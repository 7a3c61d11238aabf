//! Wrong descriptions, `wrong/*/*.eom`, which state their errors in comments: every message has a place in the text and
//! a help. Also similar descriptions that are correct.
//!
//! Below the line of an error, comments that begin with `//~` contain its column, the text there, the message, other
//! places with their labels, and the help. `cargo xtask bless` writes them.

#[path = "../../codegen/tests/suite/common/wrong_descriptions.rs"]
mod wrong_descriptions;

use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::generate::from_text;
use hamel_codegen::render::render;
use std::ops::Range;
use std::path::Path;
use wrong_descriptions::{EXPECTED, without_expected, wrong_descriptions};

/// Returns the errors of a description that must have some.
fn errors(text: &str) -> Vec<Diagnostic> {
    match from_text(text) {
        Ok(generated) => panic!("`{}` was accepted", generated.model.name),
        Err(errors) => errors,
    }
}

#[test]
fn messages() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("wrong");
    let paths = wrong_descriptions(&folder);
    assert!(!paths.is_empty());
    let bless = std::env::var_os("INSTA_UPDATE").is_some_and(|update| update == "always");
    let mut outdated = Vec::new();
    for path in paths {
        let written = std::fs::read_to_string(&path).expect("readable");
        let text = without_expected(&written);
        let name = path.strip_prefix(&folder).expect("below").to_string_lossy();
        let mut errors = errors(&text);
        errors.sort_by_key(|error| {
            let range = error.span.range().unwrap_or_default();
            (range.start, range.end)
        });
        let rendered = render(&errors, &name, &text, false);
        for error in &errors {
            let range = error.span.range();
            let placed = range
                .as_ref()
                .is_some_and(|range| !range.is_empty() && range.end <= text.len());
            assert!(
                placed || text.trim().is_empty(),
                "{name}: no place: {}",
                error.message
            );
            assert!(error.help.is_some(), "{name}: no help: {}", error.message);
            let (line, column) = place(&text, range.unwrap_or_default().start);
            let shown = format!("{name}:{}:{column}\n", line + 1);
            assert!(rendered.contains(&shown), "{rendered}\nhas no {shown}");
        }
        let expected = annotated(&text, &errors);
        if expected != written && bless {
            std::fs::write(&path, &expected).expect("writable");
        } else if expected != written {
            outdated.push(format!("--- {name}\n{expected}"));
        }
    }
    assert!(
        outdated.is_empty(),
        "`cargo xtask bless` would change {} descriptions:\n{}",
        outdated.len(),
        outdated.join("\n")
    );
}

/// Inserts comments with errors, which are in the order of the text, below their lines.
fn annotated(text: &str, errors: &[Diagnostic]) -> String {
    let start = |error: &Diagnostic| error.span.range().unwrap_or_default().start;
    // Number of comments above each line of the text, and so the number of the line in the result.
    let comments = |error: &Diagnostic| 2 + error.notes.len();
    let moved = |line: usize| {
        let above = errors
            .iter()
            .filter(|error| place(text, start(error)).0 < line);
        1 + line + above.map(comments).sum::<usize>()
    };
    let there = |range: &Range<usize>| {
        let words = text[range.clone()].split_whitespace();
        words.collect::<Vec<_>>().join(" ")
    };
    let mut lines: Vec<String> = text.lines().map(|line| format!("{line}\n")).collect();
    for error in errors {
        let range = error.span.range().unwrap_or_default();
        let (line, column) = place(text, range.start);
        let indent: String = text
            .lines()
            .nth(line)
            .unwrap_or_default()
            .chars()
            .take_while(|letter| *letter == ' ')
            .collect();
        let mut comment = |words: String| {
            lines.resize(lines.len().max(line + 1), String::new());
            lines[line] += &format!("{indent}{EXPECTED} {words}\n");
        };
        comment(format!("{column} «{}» {}", there(&range), error.message));
        for (span, label) in &error.notes {
            let range = span.range().unwrap_or_default();
            let (line, column) = place(text, range.start);
            let line = moved(line);
            comment(format!("note: {line}:{column} «{}» {label}", there(&range)));
        }
        comment(format!(
            "help: {}",
            error.help.as_deref().unwrap_or_default()
        ));
    }
    lines.concat()
}

/// Returns the line of a byte, from 0, and its column, from 1.
fn place(text: &str, byte: usize) -> (usize, usize) {
    let before = &text[..byte];
    let line = before.rsplit('\n').next().unwrap_or_default();
    (before.matches('\n').count(), line.chars().count() + 1)
}

/// Returns a system of one coordinate, with further statements.
fn system(statements: &str) -> String {
    format!("system S {{ coord x; velocity v; rate x = v; kinetic v^2; {statements} }}")
}

fn message(statements: &str) -> String {
    let errors = errors(&system(statements));
    assert_eq!(errors.len(), 1, "one mistake, one error: {errors:?}");
    errors[0].message.clone()
}

/// A name with an error in its definition causes no further errors where it is used.
#[test]
fn one_mistake_is_one_error() {
    for statements in [
        "let a = unknown; let b = a + 1; output c = b;",
        "frame f = pose(unknown, [0, 0, 0]); particle mass 1 at [0, 0, x] on f; frame g on f = world;",
        "frame f = pose(diag(1, 2, 3), [0, 0, 0]); torque [0, 0, v] on f in body;",
        "param p = unknown; start x = p; output q = p;",
        "const k = unknown; const l = k * 2; param p = l;",
        "output speed = unknown; generate speed;",
        "velocity x; generalized force v = 1;",
        "coord x; start x = 1;",
        "coord sin; start sin = 1; rate sin = v;",
        "velocity norm; generalized force norm = 1; start norm = 1;",
        "param m = 1 / 0; particle mass m at [x, 0, 0]; start v = m;",
        "constraint x = unknown;",
        "constraint v = 1;",
        "constraint x^2 = 0;",
    ] {
        message(statements);
    }
}

#[test]
fn products_of_large_matrices_are_refused_in_time() {
    let statements =
        "param A: mat64 = identity(64), v64: vec64 = A[1]; output b = A * A * A * v64;";
    let errors = errors(&system(statements));
    assert!(
        errors
            .iter()
            .any(|error| error.message.contains("too large")),
        "{errors:?}"
    );
}

/// Nested powers reach degrees that polynomials cannot have.
#[test]
fn towers_of_powers_are_refused_in_constraints() {
    let found = message("constraint (((x^1000)^1000)^1000)^1000 = 1;");
    assert_eq!(found, "the degree of this constraint is above 32");
}

/// Correct descriptions that resemble wrong ones.
#[test]
fn right_descriptions_are_accepted() {
    for text in [
        // Functions of parameters in constraints, directly and by name.
        "system A {
            param l = 4, alpha = 0.3;
            coord x, y;
            constraint x * cos(alpha) = y * sin(alpha);
            velocity v;
            rate x = v * sin(alpha);
            rate y = v * cos(alpha);
            particle mass sqrt(l) at [x, y, 0];
        }",
        "system B {
            param l = 4;
            let r = sqrt(l);
            coord x, y;
            constraint dot([x, y], [x, y]) = r;
            velocity v;
            rate x = -y * v;
            rate y = x * v;
            particle mass 1 at [x, y, 0];
            start x = l^(1/4);
        }",
        // Square roots, each of which has a value at only half of the points; roots of 3 and 5.
        "system C {
            param a = 1, b = 2, c = 3, d = 5;
            coord x;
            velocity v;
            rate x = v;
            kinetic (sqrt(a) + sqrt(b) + sqrt(c) + sqrt(d) + sqrt(a + x^2) + norm([b, x])) * v^2;
            potential sqrt(3) * x - sqrt(5) * x;
        }",
        // A loop closed through a frame.
        "system D {
            param l = 1;
            coord q: S1, x, y;
            frame rod = pose(rotz(q), [x, y, 0]);
            let tip = rod * [l, 0, 0];
            constraint [tip[1], tip[2]] = [0, 0];
            velocity w;
            rate q = w;
            rate x = l * q.s * w;
            rate y = -l * q.c * w;
            body on rod { mass 1; inertia diag(0, 0, 1); }
            start x = -l;
        }",
        // Constraints that follow from others, also from the kind of a coordinate.
        "system R {
            param l = 1;
            coord x, y, q: S1;
            velocity v, w;
            constraint x^2 + y^2 = l^2;
            constraint 2 * x^2 + 2 * y^2 = 2 * l^2;
            constraint q.c^2 = 1 - q.s^2;
            rate x = -y * v;
            rate y = x * v;
            rate q = w;
            kinetic v^2 + w^2;
            start x = 1;
        }",
        // A velocity that is defined although all rates are given; another one that is not.
        "system T {
            coord R: SO3, x;
            velocity w: vec3 = vee(R.T * rate(R)), v;
            rate R = R * hat(w);
            rate x = v;
            frame f = pose(R, [x, 0, 0]);
            body on f { mass 1; inertia diag(1, 2, 3); }
        }",
        // A pose and a quaternion by the definitions of their velocities.
        "system U {
            coord X: SE3, q: S3;
            velocity v: vec3 = X.R.T * rate(X.p), w: vec3 = vee(rate(X.R) * X.R.T);
            velocity u: vec3 = [2 * qmul([q[1], -q[2], -q[3], -q[4]], rate(q))[2],
                                2 * qmul([q[1], -q[2], -q[3], -q[4]], rate(q))[3],
                                2 * qmul([q[1], -q[2], -q[3], -q[4]], rate(q))[4]];
            body on f { mass 1; inertia diag(1, 2, 3); }
            kinetic dot(u, u);
            frame f = X;
        }",
        // Signed zeros; an axis that is a unit vector only on the manifold.
        "system E {
            param angle = 1, nought = -0;
            coord R: SO3;
            velocity w: vec3;
            rate R = R * hat(w);
            frame f = pose(R, [0, 0, 0]);
            frame g on f = pose(axis_angle(R[1], angle), [0, 0, 0]);
            body on f { mass 1; com [0, -0, 0]; inertia diag(1, 2, 3); }
        }",
        // An output with the name of the expression that it returns.
        &system("let speed = v; output speed = speed;"),
        // A tree of links with independent velocities under constraints, and a platform that stretches.
        "system F {
            param r = 0.1, b = 0.2;
            coord x, y, q: S1, ql, qr;
            velocity u, v, w, wl, wr;
            rate x = q.c * u - q.s * v;
            rate y = q.c * v;
            rate q = w;
            rate ql = wl;
            rate qr = wr;
            nonholonomic w = r * wl;
            nonholonomic u + b * w = r * wr;
            frame platform = pose(rotz(q), [x, y, 0]);
            frame left on platform = pose(roty(ql), [0, b, 0]);
            frame right on platform = pose(roty(qr), [0, b, 0]);
            body on platform { mass 9; com [0.05, 0, 0]; inertia diag(0, 0, 0.3) about com; }
            body on left { mass 0.5; inertia diag(1, 3, 1); }
            body on right { mass 0.5; inertia diag(1, 3, 1); }
        }",
        // A kinetic energy that is quadratic only after cancelling.
        &system("kinetic v^3 / v + (v + x)^2 - x * (2 * v + x);"),
    ] {
        if let Err(errors) = from_text(text) {
            panic!("{}", render(&errors, "right.eom", text, false));
        }
    }
}
