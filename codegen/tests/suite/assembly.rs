//! Starts from guesses: the branch in which a loop is assembled is compared with the intersections of two circles in
//! closed form, and the distance from the guesses with that of all branches.

use crate::common::size;
use hamel_codegen::algebra::residue_pair::Random;
use hamel_codegen::lower::build;
use hamel_codegen::syntax::parse_text;
use std::f64::consts::{PI, TAU};

const FIVE_BAR: &str = include_str!("../../../tests/models/five_bar.eom");
/// Lengths of cranks and rods, and the distance of the pivots, in the model.
const LENGTHS: (f64, f64, f64) = (0.3, 0.5, 0.25);

/// Returns x at the start of the five-bar for these start statements, in the order q1, q2, p1, p2.
fn started(starts: &str) -> Vec<f64> {
    let (text, _) = FIVE_BAR.split_once("start q1").expect("starts");
    let text = format!("{text}{starts} output tip = tip1; }}");
    build(&parse_text(&text).expect("a description"))
        .expect("a start")
        .start_x
}

/// Returns the relative angles of the two rods for the two intersections of the circles about the ends of the cranks.
fn modes(q1: f64, q2: f64) -> [[f64; 2]; 2] {
    let (a, b, d) = LENGTHS;
    let (left, right) = (
        [a * q1.cos(), a * q1.sin()],
        [d + a * q2.cos(), a * q2.sin()],
    );
    let way = [right[0] - left[0], right[1] - left[1]];
    let half = way[0].hypot(way[1]) / 2.0;
    let height = (b * b - half * half).sqrt();
    [1.0, -1.0].map(|side| {
        let tip = [
            left[0] + way[0] / 2.0 - side * height * way[1] / (2.0 * half),
            left[1] + way[1] / 2.0 + side * height * way[0] / (2.0 * half),
        ];
        let angle = |from: [f64; 2]| (tip[1] - from[1]).atan2(tip[0] - from[0]);
        [angle(left) - q1, angle(right) - q2]
    })
}

/// Returns an angle modulo full turns, within π of another one.
fn near(angle: f64, other: f64) -> f64 {
    other + (angle - other + PI).rem_euclid(TAU) - PI
}

/// The prescribed position of a crank is known before guesses are used: a four-bar is assembled as guessed for any
/// crank angle, in both modes.
#[test]
fn guesses_beside_a_driven_crank_choose_the_mode() {
    let (l1, l2, l3, d) = (0.4, 1.2, 0.8, 0.9);
    for k in 0..24 {
        let crank = 0.1 + TAU * f64::from(k) / 24.0;
        let (px, py) = (l1 * f64::cos(crank), l1 * f64::sin(crank));
        let way = f64::hypot(d - px, -py);
        let towards = f64::atan2(-py, d - px);
        for side in [1.0, -1.0] {
            let opening = (l2 * l2 + way * way - l3 * l3) / (2.0 * l2 * way);
            let b = towards + side * opening.acos();
            let c = (py + l2 * b.sin()).atan2(px + l2 * b.cos() - d);
            let text = format!(
                "system A {{
                    time t;
                    coord a, b, c;
                    velocity u, v, w;
                    rate a = u, b = v, c = w;
                    kinetic u^2 + v^2 + w^2;
                    loop {l1} * cos(a) + {l2} * cos(b) = {d} + {l3} * cos(c);
                    loop {l1} * sin(a) + {l2} * sin(b) = {l3} * sin(c);
                    prescribe a = {crank} + 2 * t;
                    start b ~ {}, c ~ {};
                }}",
                b + 0.05,
                c - 0.05
            );
            let model = build(&parse_text(&text).expect("a description")).expect("a start");
            for (found, expected) in model.start_x.iter().zip([0.0, crank, b, c]) {
                let off = (found - expected).abs();
                assert!(off < 1e-12, "{side} {:?} {crank} {b} {c}", model.start_x);
            }
        }
    }
}

#[test]
fn guesses_choose_between_both_ways_to_assemble_a_five_bar() {
    let (q1, q2) = (2.0, 1.0);
    for (mode, guess) in [(0, [-1.0, 1.0]), (1, [-2.9, 2.9])] {
        let x = started(&format!(
            "start q1 = {q1}, q2 = {q2}; start p1 ~ {}, p2 ~ {};",
            guess[0], guess[1]
        ));
        let expected = modes(q1, q2)[mode];
        assert_eq!(x[..2], [q1, q2], "exact starts stay exact");
        for k in 0..2 {
            let expected = near(expected[k], guess[k]);
            assert!((x[2 + k] - expected).abs() < 1e-10, "{x:?} {expected}");
        }
    }
}

/// With fixed cranks, M of the two rods is a multiple of the identity, so that distance is measured in the plane of the
/// angles.
#[test]
fn what_is_found_is_the_nearest_of_all_assemblies() {
    let mut random = Random::new(0x5ba2);
    let mut number = || (random.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    for _ in 0..size(40, 160) {
        let (q1, q2) = (1.6 + 0.6 * number(), 1.2 + 0.6 * number());
        let guess = [2.5 * number(), 2.5 * number()];
        let away = |angles: [f64; 2]| {
            let k = |k: usize| near(angles[k], guess[k]) - guess[k];
            k(0).hypot(k(1))
        };
        let [one, other] = modes(q1, q2);
        // If both are about equally near, either one is correct.
        if (away(one) - away(other)).abs() < 0.05 {
            continue;
        }
        let expected = if away(one) < away(other) { one } else { other };
        let x = started(&format!(
            "start q1 = {q1}, q2 = {q2}; start p1 ~ {}, p2 ~ {};",
            guess[0], guess[1]
        ));
        for k in 0..2 {
            let expected = near(expected[k], guess[k]);
            let close = (x[2 + k] - expected).abs() < 1e-12;
            assert!(close, "{q1} {q2} {guess:?}: {x:?} {:?}", [one, other]);
        }
    }
}

/// The metric is the kinetic one at the guess: a light crank moves more than a heavy one, by the ratio from Lagrange's
/// multipliers. The time has no mass, and parts that move with it make M singular; neither this nor an uninvolved
/// massless coordinate changes the result.
#[test]
fn what_is_light_gives_way() {
    for [more, moved] in [
        ["", ""],
        ["time t;", ""],
        ["time t;", "+ 0.2 * sin(t)"],
        ["coord z; velocity w; rate z = w;", ""],
    ] {
        let text = format!(
            "system S {{
                coord x, y;
                velocity u, v;
                rate x = u, y = v;
                {more}
                particle mass 1 at [x {moved}, 0, 0];
                particle mass 9 at [0, y, 0];
                loop x + y = 3;
                start x ~ 1, y ~ 1, u ~ 2, v ~ 1;
            }}"
        );
        let model = build(&parse_text(&text).expect("a description")).expect("a start");
        // Minimises (x - 1)² + 9 (y - 1)² with x + y = 3, and (u - 2)² + 9 (v - 1)² with u + v = 0.
        for (found, expected) in [(&model.start_x, [1.9, 1.1]), (&model.start_xi, [-0.7, 0.7])] {
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-14,
                    "{text}: {found} {expected}"
                );
            }
        }
    }
}

/// Constraints among coordinates are handled, too: at the nearest point of an ellipse, the normal passes through the
/// guess.
#[test]
fn constraints_are_solved_near_the_guesses() {
    let mut random = Random::new(3);
    let mut number = || (random.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    for _ in 0..20 {
        let guess = [3.0 * number(), 2.0 * number()];
        let text = format!(
            "system S {{ coord x, y; velocity u; constraint x^2 / 4 + y^2 = 1;
                rate x = -2 * y * u, y = x * u / 2;
                particle mass 1 at [x, y, 0]; start x ~ {}, y ~ {}; }}",
            guess[0], guess[1]
        );
        let x = build(&parse_text(&text).expect("a description"))
            .expect("a start")
            .start_x;
        assert!((x[0] * x[0] / 4.0 + x[1] * x[1] - 1.0).abs() < 1e-11);
        let distance = |x: f64, y: f64| (x - guess[0]).hypot(y - guess[1]);
        let least = (0..10_000)
            .map(|k| f64::from(k) * TAU / 10_000.0)
            .map(|angle| distance(2.0 * angle.cos(), angle.sin()))
            .fold(f64::INFINITY, f64::min);
        assert!(distance(x[0], x[1]) < least + 1e-5, "{x:?} {guess:?}");
        let turn = (x[0] - guess[0]) * 2.0 * x[1] - (x[1] - guess[1]) * x[0] / 2.0;
        assert!(turn.abs() < 1e-12, "{turn} {x:?} {guess:?}");
    }
}

/// On the parabola b = a², (1, 1) is nearest to (3, 0): 2 (a − 3) + 4 a³ vanishes there. It is found for any
/// orientation of the axes, and to all digits, which a minimum of distances alone would not give.
#[test]
fn the_nearest_is_found_to_all_digits() {
    for axes in [
        ["[1, 0, 0]", "[0, 1, 0]"],
        ["[1, 1, 0]", "[1, -1, 0]"],
        ["[1, 2, 2]", "[2, 1, -2]"],
    ] {
        let [first, second] = axes;
        let text = format!(
            "system S {{
                joint a: prismatic {first} moves f;
                joint b: prismatic {second} on f moves g;
                body on g {{ mass 2; }}
                loop b = a^2;
                start a ~ 3, b ~ 0;
            }}"
        );
        let model = build(&parse_text(&text).expect("a description")).expect("a start");
        let x = &model.start_x;
        assert!(x.iter().all(|x| (x - 1.0).abs() < 1e-14), "{axes:?} {x:?}");
    }
}

/// A body that hangs from a ball joint and a rod, with a rotation matrix or a quaternion.
#[test]
fn rotations_are_guessed_by_rotations() {
    for (kind, guess) in [
        ("spherical", "rotx(0.4)"),
        (
            "spherical S3",
            "[0.98, 0.2, 0, 0] / norm([0.98, 0.2, 0, 0])",
        ),
    ] {
        let text = format!(
            "system S {{
                joint ball: {kind} moves arm;
                body on arm {{ mass 1; com [0, 0, -1]; inertia diag(0.3, 0.2, 0.1) about com; }}
                let tip = position(arm, [0, 0, -1]);
                loop tip[3] = -0.8;
                start ball ~ {guess};
            }}"
        );
        let model = build(&parse_text(&text).expect("a description")).expect("a start");
        let x = &model.start_x;
        let tip = match x.len() {
            9 => [-x[2], -x[5], -x[8]],
            _ => [
                -2.0 * (x[1] * x[3] + x[0] * x[2]),
                -2.0 * (x[2] * x[3] - x[0] * x[1]),
                -(x[0] * x[0] - x[1] * x[1] - x[2] * x[2] + x[3] * x[3]),
            ],
        };
        // The shortest way is a rotation about the first axis, the axis of the guess.
        let expected = [0.0, 0.6, -0.8];
        assert!(
            (0..3).all(|k| (tip[k] - expected[k]).abs() < 1e-13),
            "{tip:?}"
        );
    }
}

/// A bead on a ring of any size: a start off by half of the size is refused, one off by rounding is not.
#[test]
fn rings_are_of_any_size() {
    let start = |radius: f64, start: &str| {
        let text = format!(
            "system Bead {{
                param r = {radius:e}; coord x, z; constraint x^2 + z^2 = r^2;
                velocity w; rate x = -z * w, z = x * w; kinetic w^2 / 2; start {start};
            }}"
        );
        build(&parse_text(&text).expect("a description")).map(|model| model.start_x)
    };
    for radius in [1e-6, 1e-5, 1e-3, 1.0, 1e4, 5e4, 1e6] {
        assert!(start(radius, "x = r, z = r").is_err(), "{radius:e}");
        assert!(
            start(radius, "x = 0.6 * r, z = r / 2").is_err(),
            "{radius:e}"
        );
        for (part, other) in [(0.6, 0.8), (0.37, 0.929_031_75)] {
            let x = start(radius, &format!("x = {part} * r, z ~ 0.5 * r"));
            let x = x.unwrap_or_else(|errors| panic!("{radius:e}: {errors:?}"));
            assert_eq!(x[0], part * radius);
            assert!((x[1] / radius - other).abs() < 1e-7, "{radius:e}: {x:?}");
        }
    }
}

/// A linkage is closed and set in motion for any unit of length.
#[test]
fn lengths_are_in_any_unit() {
    let start = |unit: f64, closing: &str| {
        let text = format!(
            "system Linkage {{
                param a = {:e}, b = {:e}, c = {:e}, d = {:e};
                coord q1, q2, q3;
                velocity w1, w2, w3;
                rate q1 = w1, q2 = w2, q3 = w3;
                kinetic (w1^2 + w2^2 + w3^2) / 2;
                {closing}
            }}",
            0.4 * unit,
            unit,
            0.8 * unit,
            unit
        );
        let model = build(&parse_text(&text).expect("a description"));
        let model = model.unwrap_or_else(|errors| panic!("{unit:e}: {errors:?}"));
        [model.start_x, model.start_xi].concat()
    };
    for closing in [
        "loop [a * cos(q1) + b * cos(q2), a * sin(q1) + b * sin(q2)] = [d + c * cos(q3), c * sin(q3)]; start q1 = 1, w1 = 2;",
        "loop a * cos(q1) + b * cos(q2) = d + c * cos(q3); loop a * sin(q1) + b * sin(q2) = c * sin(q3); start q1 ~ 1, w1 = 2;",
    ] {
        let wanted = start(1.0, closing);
        for unit in [1e-12, 1e-9, 1e-6, 1e-3, 1e3, 3e4, 1e5, 3e5, 1e6, 1e8] {
            for (found, wanted) in start(unit, closing).iter().zip(&wanted) {
                assert!((found - wanted).abs() < 1e-9, "{unit:e}: {found} {wanted}");
            }
        }
    }
}

/// Each loop is judged by the size of its terms: neither a loop of a million metres nor a distant guess excuses another
/// that cannot be closed.
#[test]
fn large_loops_excuse_no_others() {
    let open = |text: &str| {
        let text = format!(
            "system A {{ coord a, b, c; velocity u, v, w; rate a = u, b = v, c = w;
                kinetic (u^2 + v^2 + w^2) / 2; {text} }}"
        );
        build(&parse_text(&text).expect("a description")).is_err()
    };
    assert!(open(
        "loop a^2 + b^2 = 1e6^2; loop cos(c) = 1.4; start a ~ 6e5, b ~ 8e5;"
    ));
    assert!(!open(
        "loop a^2 + b^2 = 1e6^2; loop cos(c) = 0.9; start a ~ 6e5, b ~ 8e5, c ~ 0.3;"
    ));
    assert!(open(
        "loop 0.3 * sin(a) + 0.5 * sin(b) = 0.9; loop c = 6.371e6; start a = 1;"
    ));
    assert!(open(
        "loop cos(a) + 3 * cos(b) = c, sin(a) + 3 * sin(b) = 5; start c ~ 1e13;"
    ));
}

/// Redundant loops with massless velocities: the projection onto them is proved.
#[test]
fn redundant_loops_without_mass_are_led_back_to() {
    crate::common::generated(
        "system Twice { coord a, b; velocity u, v; rate a = u, b = v; kinetic u^2 / 2;
            loop cos(b) = cos(a), sin(b) = sin(a); start a = 0.7, b ~ 0.6; }",
    );
}

/// A step along A violates a coordinate constraint to second order: a start moved by loops still satisfies φ = 0.
#[test]
fn starts_that_loops_have_moved_keep_constraints() {
    let mut random = Random::new(0x9_4a1);
    let mut number = || (random.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    for _ in 0..size(10, 40) {
        let (angle, a, lean) = (3.0 * number(), 2.0 * number(), 0.4 * number());
        let text = format!(
            "system Bead {{
                coord x, z, a, q: S1; constraint x^2 + z^2 = 1;
                velocity w, u, s; rate x = -z * w, z = x * w, a = u, q = s;
                kinetic (w^2 + u^2 + s^2) / 2 + {lean} * u * w;
                loop a = 1.5 * x + 0.3 * q.c; loop q.s = z / 2;
                start x ~ {:?}, z ~ {:?}, a ~ {a:?};
            }}",
            angle.cos(),
            angle.sin()
        );
        let x = build(&parse_text(&text).expect("a description"))
            .unwrap_or_else(|errors| panic!("{text}: {errors:?}"))
            .start_x;
        let left = [
            x[0] * x[0] + x[1] * x[1] - 1.0,
            x[3] * x[3] + x[4] * x[4] - 1.0,
            x[2] - 1.5 * x[0] - 0.3 * x[3],
            x[4] - x[1] / 2.0,
        ];
        assert!(
            left.iter().all(|left| left.abs() < 1e-14),
            "{left:?}\n{text}"
        );
    }
}
