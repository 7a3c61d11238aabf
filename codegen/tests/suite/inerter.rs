//! Inerters (Smith 2002), whose force is proportional to the relative acceleration, compared with equations by hand.

use crate::common::{Random, difference, generated, value};
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::proof::check::{Verdict, check};
use hamel_codegen::scene::{CoordKind, Element, Expr, Point, Scene, ShapeKind, WORLD};

/// Returns ξ̇ at (x, ξ, u).
fn accel(of: &Generated, x: &[f64], xi: &[f64], u: &[f64]) -> Vec<f64> {
    value(of, "accel", [x, xi, u, &[]])
}

fn proved(of: &Generated) {
    for identity in check(&of.model, &of.program) {
        let failed = matches!(identity.verdict, Verdict::Failed(_));
        assert!(!failed, "{identity:?}");
    }
}

/// A quarter-car model: two masses with a spring, damper and inerter between them.
const SUSPENSION: &str = "
system Suspension {
    param m = 250, w = 35, k = 15000, c = 900, b = 130, tyre = 150000;
    joint wheel: prismatic [0, 0, 1] moves hub;
    joint strut: prismatic [0, 0, 1] on hub at translation([0, 0, 0.4]) moves cabin;
    body on hub { mass w; }
    body on cabin { mass m; }
    spring stiffness tyre on wheel;
    spring stiffness k on strut;
    damper coefficient c from hub to cabin;
    inerter inertance b from hub to cabin;
}";

#[test]
fn a_suspension_has_the_textbook_equations() {
    let of = generated(SUSPENSION);
    proved(&of);
    let [m, w, k, c, b, tyre] = [250.0, 35.0, 15000.0, 900.0, 130.0, 150000.0];
    let mut random = Random::new(5);
    for _ in 0..8 {
        let (x, xi) = (random.numbers(2), random.numbers(2));
        // m (z̈ + s̈) = −k s − c ṡ − b s̈ for the cabin, w z̈ = −tyre z + k s + c ṡ + b s̈ for the wheel
        let pull = k * x[1] + c * xi[1];
        let road = -tyre * x[0];
        let determinant = w * (m + b) + m * b;
        let hub = ((m + b) * (road + pull) - b * pull) / determinant;
        let stretch = (-pull - m * hub) / (m + b);
        let found = accel(&of, &x, &xi, &[]);
        let largest = hub.abs().max(stretch.abs());
        assert!(difference(&found, &[hub, stretch]) <= 1e-12 * largest);
    }
}

/// Along a rotating line: (m + b) r̈ = m r θ̇², and m r² θ̇ is constant.
const TURNING: &str = "
system Turning {
    param m = 2;
    param b = 3;
    coord r: R2;
    velocity v: vec2;
    rate r = v;
    particle mass m at [r[1], r[2], 0];
    frame bob = pose(identity(3), [r[1], r[2], 0]);
    inerter inertance b from [0, 0, 0] on world to bob;
    start r = [1, 0.5];
}";

#[test]
fn a_line_that_turns_bears_no_moment() {
    let of = generated(TURNING);
    proved(&of);
    let mut random = Random::new(7);
    for _ in 0..8 {
        let (r, v) = (random.numbers(2), random.numbers(2));
        let [x, y] = [r[0], r[1]];
        let length = x.hypot(y);
        let [radial, across] = [
            (x * v[0] + y * v[1]) / length,
            (x * v[1] - y * v[0]) / length,
        ];
        // r̈ differs from the acceleration along the line by r θ̇² = across² / r; no force acts across the line.
        let outwards = 2.0 * across * across / length / 5.0 - across * across / length;
        let expected = [outwards * x / length, outwards * y / length];
        let found = accel(&of, &r, &v, &[]);
        assert!(difference(&found, &expected) <= 1e-12 * (1.0 + radial.abs() + outwards.abs()));
    }
}

/// A flywheel between two shafts, driven by the difference of their speeds.
#[test]
fn rates_are_as_good_as_lines() {
    let of = generated(
        "system Shafts {
            param J1 = 2, J2 = 5, b = 0.5;
            input u;
            joint one: revolute [0, 0, 1] moves first { force u; }
            joint two: revolute [0, 0, 1] moves second;
            body on first { mass 1; inertia diag(1, 1, J1); }
            body on second { mass 1; inertia diag(1, 1, J2); }
            inerter inertance b on two_dot - 3 * one_dot;
        }",
    );
    proved(&of);
    // [J₁ + 9 b, −3 b; −3 b, J₂ + b] q̈ = (u, 0)
    let (a, off, d) = (2.0 + 4.5, -1.5, 5.5);
    let determinant = a * d - off * off;
    let found = accel(&of, &[0.3, 0.2], &[1.0, -2.0], &[0.7]);
    let expected = [0.7 * d / determinant, -0.7 * off / determinant];
    assert!(difference(&found, &expected) <= 1e-15);
}

#[test]
fn what_is_built_is_what_is_written() {
    let written = Scene::parse(TURNING).expect("a description");
    let mut turning = Scene::builder("Turning");
    turning.public(false);
    turning.param("m", 2);
    turning.param("b", 3);
    let r = turning.coordinate("r", CoordKind::Euclidean(2));
    let v = turning.velocity("v", ShapeKind::Vector(2));
    turning.rate("r", v);
    let place = || Expr::from([r.entry(1), r.entry(2), 0.into()]);
    turning.particle(Expr::name("m"), place());
    let pose = hamel_codegen::scene::shifted(place());
    let bob = turning.frame("bob", WORLD, pose);
    let ends = (Point::of(WORLD, [0, 0, 0]), Point::origin(&bob));
    turning.element(Element::inerter(Expr::name("b"), ends));
    turning.start("r", [1.0, 0.5]);
    assert_eq!(turning.build().expect("a scene"), written);
    assert_eq!(
        Scene::parse(&written.to_string()).expect("a scene"),
        written
    );
}

#[test]
fn wrong_ones_are_refused() {
    for (statement, message) in [
        (
            "inerter inertance 1 on x;",
            "what an inerter acts on has to be a rate that is linear in the velocities",
        ),
        (
            "inerter inertance 1 on 0 * v;",
            "this inerter does nothing: the rate that it acts on is 0",
        ),
        (
            "inerter inertance v on v;",
            "the inertance of an inerter has to be constant",
        ),
        (
            "inerter inertance 1 from [0, 0, 0] on world to [1, 0, 0] on world;",
            "this inerter does nothing: both its endpoints are fixed to `world`",
        ),
        (
            "inerter inertance 1 on if x < 0 { v } else { 2 * v };",
            "a kinetic energy has to be continuous",
        ),
        ("inerter 1 on v;", "expected `inertance`, found `1`"),
    ] {
        let text =
            format!("system S {{ coord x; velocity v; rate x = v; kinetic v^2; {statement} }}");
        let errors = from_text(&text).expect_err("wrong");
        let [error] = &errors[..] else {
            panic!("{statement}: {errors:?}");
        };
        assert!(error.message.starts_with(message), "{}", error.message);
        assert!(error.help.is_some(), "{statement}");
    }
}
