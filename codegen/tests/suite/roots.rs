//! Square roots have the sign of real roots: √ of products, of sums of roots and squares, of numbers, parameters and
//! coordinates, in any order.

use crate::common::{Random, generated, value};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::count::count;

/// Rounding of a few operations, with some cancellation.
const TOLERANCE: f64 = 1e-13;

/// An expression of parameters a, b and coordinates x, y, with its value.
type Case = (&'static str, fn([f64; 4]) -> f64);

const NUMBERS: [Case; 18] = [
    ("sqrt(3) * sqrt(7)", |_| 21_f64.sqrt()),
    ("sqrt(21)", |_| 21_f64.sqrt()),
    ("sqrt(5) * sqrt(7)", |_| 35_f64.sqrt()),
    ("sqrt(35)", |_| 35_f64.sqrt()),
    ("sqrt(3 / 7) - sqrt(21) / 7 + 1", |_| 1.0),
    ("sqrt(5 - 2 * sqrt(6))", |_| 3_f64.sqrt() - 2_f64.sqrt()),
    ("sqrt(3) - sqrt(2)", |_| 3_f64.sqrt() - 2_f64.sqrt()),
    ("sqrt(2) - sqrt(3)", |_| 2_f64.sqrt() - 3_f64.sqrt()),
    ("sqrt(2 - sqrt(3))", |_| (2.0 - 3_f64.sqrt()).sqrt()),
    ("(sqrt(6) - sqrt(2)) / 2", |_| {
        (6_f64.sqrt() - 2_f64.sqrt()) / 2.0
    }),
    ("(sqrt(2) - sqrt(6)) / 2", |_| {
        (2_f64.sqrt() - 6_f64.sqrt()) / 2.0
    }),
    ("sqrt(sqrt(2) - 1) * sqrt(sqrt(2) + 1)", |_| 1.0),
    ("tan(pi / 12) + sqrt(3)", |_| 2.0),
    ("sin(7 * pi / 12)", |_| {
        (7.0 * std::f64::consts::PI / 12.0).sin()
    }),
    ("sqrt(10 - 2 * sqrt(5)) / 4", |_| {
        (std::f64::consts::PI / 5.0).sin()
    }),
    ("sqrt(2 * pi) - sqrt(2) * sqrt(pi)", |_| 0.0),
    (
        "(sqrt(4099) * sqrt(4111) - sqrt(4099 * 4111)) / 4096",
        |_| 0.0,
    ),
    ("sqrt(1 / 2) * sqrt(8)", |_| 2.0),
];

const EXPRESSIONS: [Case; 16] = [
    ("sqrt(a) * sqrt(b)", |[a, b, ..]| (a * b).sqrt()),
    ("sqrt(a * b)", |[a, b, ..]| (a * b).sqrt()),
    ("sqrt(3 * a) * sqrt(7 * b)", |[a, b, ..]| {
        (21.0 * a * b).sqrt()
    }),
    ("sqrt(21 * a * b)", |[a, b, ..]| (21.0 * a * b).sqrt()),
    ("sqrt(3 * a + 3 * b)", |[a, b, ..]| (3.0 * (a + b)).sqrt()),
    ("sqrt(a + b) * sqrt(3)", |[a, b, ..]| (3.0 * (a + b)).sqrt()),
    ("sqrt(a / b)", |[a, b, ..]| (a / b).sqrt()),
    ("sqrt(a) / sqrt(b)", |[a, b, ..]| (a / b).sqrt()),
    ("sqrt(a + b + 2 * sqrt(a * b))", |[a, b, ..]| {
        a.sqrt() + b.sqrt()
    }),
    ("sqrt(a) + sqrt(b)", |[a, b, ..]| a.sqrt() + b.sqrt()),
    ("sqrt(a + b - 2 * sqrt(a * b))", |[a, b, ..]| {
        (a.sqrt() - b.sqrt()).abs()
    }),
    ("sqrt(a) - sqrt(b)", |[a, b, ..]| a.sqrt() - b.sqrt()),
    ("sqrt(x^2 + 2 * x + 1)", |[_, _, x, _]| (x + 1.0).abs()),
    ("(x + 1) * y", |[_, _, x, y]| (x + 1.0) * y),
    ("y * sqrt((x + 1)^2)", |[_, _, x, y]| y * (x + 1.0).abs()),
    ("sqrt(x^2 * y^2) + x * y", |[_, _, x, y]| {
        (x * y).abs() + x * y
    }),
];

/// Hyperbolic functions, and inverse ones, which are angles of points with a root.
const FUNCTIONS: [Case; 11] = [
    ("sinh(x - y)", |[_, _, x, y]| (x - y).sinh()),
    ("tanh(x) * cosh(x) / sinh(x)", |_| 1.0),
    ("cosh(x)^2 - sinh(x)^2", |_| 1.0),
    ("exp(x) - cosh(x)", |[_, _, x, _]| x.sinh()),
    ("tanh(x / 10^9) * 10^9", |[_, _, x, _]| x),
    ("asin(x / 5)", |[_, _, x, _]| (x / 5.0).asin()),
    ("acos(-x / 5)", |[_, _, x, _]| (-x / 5.0).acos()),
    ("atan(3 * x)", |[_, _, x, _]| (3.0 * x).atan()),
    ("tan(atan(x - y))", |[_, _, x, y]| x - y),
    ("asin(x / 5) + acos(x / 5)", |_| std::f64::consts::FRAC_PI_2),
    ("sin(asin(x / 5)) + acos(-1)", |[_, _, x, _]| {
        x / 5.0 + std::f64::consts::PI
    }),
];

/// Checks the outputs of a system, optionally declared in reverse order.
fn outputs(cases: &[Case], reversed: bool) {
    let order: Vec<&Case> = if reversed {
        cases.iter().rev().collect()
    } else {
        cases.iter().collect()
    };
    let lines: String = order
        .iter()
        .enumerate()
        .map(|(index, (text, _))| format!("output o{index} = {text};\n"))
        .collect();
    let of = generated(&format!(
        "system Roots {{
            coord x, y; velocity v, w; rate x = v; rate y = w;
            param a = 2, b = 3;
            particle mass 1 at [x, y, 0];
            {lines}
        }}"
    ));
    let mut random = Random::new(11);
    for _ in 0..8 {
        let x: Vec<f64> = random.numbers(2).iter().map(|x| 4.0 * x).collect();
        for (index, (text, expected)) in order.iter().enumerate() {
            let found = output(&of, &format!("o{index}"), &x);
            let expected = expected([2.0, 3.0, x[0], x[1]]);
            let error = (found - expected).abs();
            assert!(
                error <= TOLERANCE * (1.0 + expected.abs()),
                "{text} is {expected}, not {found}"
            );
        }
    }
}

/// Returns an output at a configuration, at rest.
fn output(of: &Generated, name: &str, x: &[f64]) -> f64 {
    let rest = vec![0.0; of.active.xi.len()];
    value(of, name, [x, &rest, &[], &[]])[0]
}

#[test]
fn of_numbers() {
    outputs(&NUMBERS, false);
    outputs(&NUMBERS, true);
}

#[test]
fn of_parameters_and_coordinates() {
    outputs(&EXPRESSIONS, false);
    outputs(&EXPRESSIONS, true);
}

#[test]
fn within_other_functions() {
    outputs(&FUNCTIONS, false);
    outputs(&FUNCTIONS, true);
}

#[test]
fn on_a_circle_and_on_a_loop() {
    // |s| of a circle, and the distance of a slider kept away by a rod: both change sign.
    let of = generated(
        "system Crank {
            coord q: S1, x;
            param r = 0.4, l = 1;
            constraint (x - r * q.c)^2 + r^2 * q.s^2 = l^2;
            velocity w = rate(q);
            particle mass 1 at [x, 0, 0];
            kinetic w^2 / 2;
            start x = 1.4;
            output a = sqrt(1 - q.c^2); output b = q.s;
            output d = sqrt(l^2 - r^2 * q.s^2); output e = x - r * q.c;
        }",
    );
    for angle in [-2.5_f64, -0.7, 0.4, 1.9] {
        let (s, c) = angle.sin_cos();
        for side in [-1.0, 1.0] {
            let rod = (1.0 - 0.16 * s * s).sqrt();
            let x = [c, s, 0.4 * c + side * rod];
            let expected = [("a", s.abs()), ("b", s), ("d", rod), ("e", side * rod)];
            for (name, expected) in expected {
                let found = output(&of, name, &x);
                assert!(
                    (found - expected).abs() <= TOLERANCE,
                    "{found} for {expected}"
                );
            }
        }
    }
}

#[test]
fn many_roots_and_roots_of_both_signs_have_points() {
    let outputs: String = (1..16)
        .map(|k| format!("output o{k} = sqrt(x + {k} * y) + sqrt(a - {k} * b);\n"))
        .collect();
    let of = generated(&format!(
        "system Many {{
            coord x, y; velocity v, w; rate x = v; rate y = w;
            param a = 40, b = 2;
            particle mass 1 at [x, y, 0];
            output e = sqrt(a - b); output h = sqrt(b - a + 2 * a);
            output g = sqrt(x - y) * sqrt(y - x + 10);
            {outputs}
        }}"
    ));
    let x = [3.0, 1.0];
    assert!((output(&of, "g", &x) - 4.0).abs() < TOLERANCE);
    for k in 1..16 {
        let found = output(&of, &format!("o{k}"), &x);
        let k = f64::from(k);
        let expected = (3.0 + k).sqrt() + (40.0 - 2.0 * k).sqrt();
        assert!((found - expected).abs() < TOLERANCE * expected);
    }
}

/// Numbers with special values modulo 2⁶¹ − 1, where √2 is ±2³¹.
#[test]
fn powers_of_two_are_no_roots() {
    let of = generated(
        "system Powers {
            coord q; velocity v; rate q = v; kinetic v^2 / 2; start q = 1;
            output a = 1073741824 * q; output b = cos(pi / 4) * q; output c = (2^61 - 1) * q;
            output d = 2^31 * q - sqrt(2) * q; output e = sqrt(2) * 2^30 * q;
        }",
    );
    let expected = [
        ("a", 1073741824.0),
        ("b", 0.5_f64.sqrt()),
        ("c", 2_f64.powi(61)),
        ("d", 2_f64.powi(31) - 2_f64.sqrt()),
        ("e", 2_f64.sqrt() * 2_f64.powi(30)),
    ];
    for (name, expected) in expected {
        let found = output(&of, name, &[1.0]);
        assert!((found / expected - 1.0).abs() < 1e-15, "{name}: {found}");
    }
}

/// Deeply nested roots.
#[test]
fn eighteen_deep() {
    let mut text = "2".to_string();
    let mut expected = 2.0_f64;
    for _ in 0..18 {
        text = format!("sqrt(1 + {text})");
        expected = (1.0 + expected).sqrt();
    }
    let of = generated(&format!(
        "system Deep {{
            coord x; velocity v; rate x = v; kinetic v^2 / 2; start x = 1;
            output a = x * {text};
        }}"
    ));
    assert!((output(&of, "a", &[1.0]) - expected).abs() < 1e-14);
}

/// Roots that are defined only far from the usual points.
#[test]
fn where_the_start_is_far_away() {
    for (potential, start, slope) in [
        ("sqrt(x - 5)", 6.0, 0.5),
        ("sqrt(-x)", -4.0, -0.25),
        ("sqrt(1 - x^2 / 100)", 6.0, -0.075),
    ] {
        let of = generated(&format!(
            "system Far {{ coord x; velocity v; rate x = v; kinetic v^2 / 2; potential {potential}; start x = {start}; }}"
        ));
        let found = value(&of, "accel", [&[start], &[0.0], &[], &[]])[0];
        assert!((found + slope).abs() < 1e-15, "{potential}: {found}");
    }
}

/// Identities that hold on only one branch of a constraint are not used on another.
#[test]
fn branches_of_constraints_are_told_apart() {
    let text = |start: &str| {
        format!(
            "system Branches {{
                coord x, y; velocity v = rate(y); constraint (x^2 + y^2 - 1) * (x - 3) = 0;
                kinetic (1 + (x - 3)^2) * v^2 / 2; {start}
            }}"
        )
    };
    let of = generated(&text("start x = 0.6; start y = 0.8;"));
    let mass = value(&of, "mass_matrix", [&[0.6, 0.8], &[0.0], &[], &[]]);
    assert!((mass[0] - 6.76).abs() < 1e-14, "{mass:?}");
    // On the other branch
    let of = generated(&text("start x = 3; start y = 1;"));
    let mass = value(&of, "mass_matrix", [&[3.0, 1.0], &[0.0], &[], &[]]);
    assert!((mass[0] - 1.0).abs() < 1e-14, "{mass:?}");
    let rate = value(&of, "rate", [&[3.0, 1.0], &[0.7], &[], &[]]);
    assert!(
        rate[0].abs() < 1e-14 && (rate[1] - 0.7).abs() < 1e-14,
        "{rate:?}"
    );
}

/// A product as a constraint means the factor that vanishes at the start, also with parameters, several rows and powers
/// of other factors.
#[test]
fn products_mean_the_factor_of_the_start() {
    let text = |constraint: &str, start: &str| {
        format!(
            "system Branches {{
                param c = 2; coord x, y, z; velocity v = rate(z); constraint {constraint};
                kinetic (1 + x^2 + y^2) * v^2 / 2; {start}
            }}"
        )
    };
    for (constraint, start, at, rate) in [
        // The plane and the curve x = z², y = z
        (
            "[c * x * (x - y^2), y - z] = [0, 0]",
            "start x = 0, y = 0.5, z = 0.5;",
            [0.0, 0.5, 0.5],
            [0.0, 1.0],
        ),
        (
            "[c * x * (x - y^2), y - z] = [0, 0]",
            "start x = 0.25, y = 0.5, z = 0.5;",
            [0.25, 0.5, 0.5],
            [1.0, 1.0],
        ),
        (
            "[(x - 1)^2 * (x + z), (y + 3) * (y - z) / c] = [0, 0]",
            "start x = -0.5; start y = 0.5; start z = 0.5;",
            [-0.5, 0.5, 0.5],
            [-1.0, 1.0],
        ),
        (
            "[(x - 1)^2 * (x + z), (y + 3) * (y - z) / c] = [0, 0]",
            "start x = -0.5; start y = -3; start z = 0.5;",
            [-0.5, -3.0, 0.5],
            [-1.0, 0.0],
        ),
    ] {
        let of = generated(&text(constraint, start));
        let found = value(&of, "rate", [&at, &[1.0], &[], &[]]);
        assert!(
            (found[0] - rate[0]).abs() < 1e-13 && (found[1] - rate[1]).abs() < 1e-13,
            "{constraint} {start}: {found:?}"
        );
        let mass = value(&of, "mass_matrix", [&at, &[0.0], &[], &[]])[0];
        let expected = 1.0 + at[0] * at[0] + at[1] * at[1];
        assert!(
            (mass - expected).abs() < 1e-13,
            "{constraint} {start}: {mass}"
        );
    }
    // At the intersection of two branches, the constraint does not determine the motion.
    let errors = hamel_codegen::generate::from_text(&text(
        "[x * (x - y^2), y - z] = [0, 0]",
        "start x = 0; start y = 0; start z = 0;",
    ));
    let errors = errors.expect_err("a crossing");
    assert!(!errors[0].message.contains("internal"), "{errors:?}");
}

/// Whether log n is a square modulo p is random; if it is not, its root is outside of F_p.
#[test]
fn roots_of_roots_of_logarithms_have_values() {
    for n in 2..60 {
        let text = format!(
            "system A {{ param a = 2; coord x, y; velocity v, w; rate x = v; rate y = w; kinetic v^2/2 + w^2/2; \
             output o = sqrt(sqrt(log({n})) + x * a); output none = sqrt(sqrt(log({n})) - a - 9); \
             start x = 1.25; start y = 0.75; }}"
        );
        let of = generated(&text);
        let found = value(&of, "o", [&[1.25, 0.75], &[], &[], &[]])[0];
        let expected = (f64::from(n).ln().sqrt() + 2.5).sqrt();
        assert!((found - expected).abs() < TOLERANCE, "{n}: {found}");
    }
}

/// An expression e of x and y, and a form of e, with their values.
type Part = (&'static str, fn(f64, f64) -> f64);
type Form = (&'static str, fn(f64) -> f64);

/// |e| as a root, and e, in various combinations: e has either sign and contains roots that are undefined for many
/// values of the coordinates.
#[test]
fn roots_of_squares_are_absolute() {
    let parts: [Part; 6] = [
        ("asin(x)", |x, _| x.asin()),
        ("(x * sqrt(2 + x))", |x, _| x * (2.0 + x).sqrt()),
        ("(acos(x) - acos(y))", |x, y| x.acos() - y.acos()),
        ("(x * sqrt(1 - x^2))", |x, _| x * (1.0 - x * x).sqrt()),
        ("(acos(x * x) - 1)", |x, _| (x * x).acos() - 1.0),
        ("asin(x * y)", |x, y| (x * y).asin()),
    ];
    let forms: [Form; 6] = [
        ("((E)^(-2))^(-1/2)", f64::abs),
        ("1 / sqrt((E)^2)", |e| 1.0 / e.abs()),
        ("sqrt((E)^2) * (E)", |e| e.abs() * e),
        ("sqrt((E)^2)", f64::abs),
        ("((E)^2)^(3/2)", |e| e.abs().powi(3)),
        ("1 / (E)", |e| 1.0 / e),
    ];
    for (part, of_part) in parts {
        for case in 0..8 {
            // Other symbols before them change the points.
            let count = 2 + case % 3;
            let chosen: Vec<_> = (0..count)
                .map(|k| forms[(case + k * (1 + case / 3)) % 6])
                .collect();
            let lines = chosen.iter().enumerate();
            let lines =
                lines.map(|(k, (form, _))| format!("output o{k} = {};", form.replace('E', part)));
            let parameters = (0..case).map(|k| format!("param _a{k} = {k} / 3 + 1;"));
            let of = generated(&format!(
                "system Roots {{ {} coord x, y; velocity v, w; rate x = v, y = w; kinetic (v^2 + w^2) / 2; {} }}",
                parameters.collect::<String>(),
                lines.collect::<String>(),
            ));
            for [x, y] in [[0.4, 0.7], [-0.4, 0.7], [0.4, -0.7], [-0.4, -0.7]] {
                for (k, (form, value)) in chosen.iter().enumerate() {
                    let (found, expected) =
                        (output(&of, &format!("o{k}"), &[x, y]), value(of_part(x, y)));
                    let error = (found - expected).abs();
                    assert!(
                        error <= TOLERANCE * (1.0 + expected.abs()),
                        "{form} of {part} at {x}, {y} is {expected}, not {found} (case {case})"
                    );
                }
            }
        }
    }
}

/// The length of an axis tilted by 1e-7 contains a root, and some entries are close to rounding: equal expressions are
/// still one node, and the hinge is recognised.
#[test]
fn hinges_that_are_tilted_by_little_are_hinges() {
    let of = generated(
        "system Tilted {
            gravity [0.3, -1.1, -9.81];
            joint a: revolute [0, 1e-7, 1] at pose(identity(3), [-0.31, -0.23, 0]) moves f;
            joint b: prismatic [0.4, 0.835, 0.1] on f at pose(roty(-pi / 2), [-0.52, 0, 0]) moves g;
            body on f { mass 1; com [0, 0, 0]; inertia diag(1, 1, 1) about com; }
            body on g { mass 1; com [0, 0, 0]; inertia diag(1, 1, 1) about com; }
        }",
    );
    let function = of
        .program
        .function("inverse_dynamics")
        .expect("it is there");
    let flops = count(&of.program.graph, &function.outputs).flops();
    assert!(flops <= 60, "{flops}");
}
